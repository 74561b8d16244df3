//! How far the painted colours are from the true ones.

use crate::albedo::{albedo, encoded_255, linear};
use formats::mesh::LoadedMesh;
use geometry::{MeshError, MeshIndex, TriangleMesh};
use nalgebra::Point3;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// The colours of a model against the albedo of the truth.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ColourError {
    /// Texture cells that were compared: those that were seen and lie on a triangle.
    pub cells: usize,
    /// What the model's light was multiplied with in each channel: light and camera have a colour of their own.
    pub gain: [f64; 3],
    /// Root mean square difference over cells and channels, in sRGB values of 0..255.
    pub rms_255: f64,
    /// The same for red, green and blue alone.
    pub channel_rms_255: [f64; 3],
    /// 95 % of cells and channels are closer.
    pub p95_255: f64,
}

/// Why colours cannot be compared.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ColourErrorReason {
    /// The one that is true.
    #[error("the truth cannot be compared with: {0}")]
    Truth(#[from] MeshError),
    /// The one that was made.
    #[error("the model cannot be compared: {0}")]
    Model(MeshError),
    /// The texture's size contradicts its header, or a vertex has no place in it.
    #[error("the model's texture is {width}x{height}, but has {cells} cells, and {uv} places for {vertices} vertices")]
    Texture {
        /// Columns.
        width: u32,
        /// Rows.
        height: u32,
        /// Cells that came.
        cells: usize,
        /// Texture coordinates.
        uv: usize,
        /// Vertices.
        vertices: usize,
    },
    /// There is nothing to compare with.
    #[error("the truth has no colours")]
    TruthWithoutColours,
    /// Nothing was painted.
    #[error("no cell of the model was seen by the lamp")]
    NothingSeen,
}

/// The truth's colour of a cell is the mean over so many places in each direction of it: an edge between two colours
/// runs through cells, and the camera saw their mean too.
const PLACES: usize = 3;
const GAUSS_NEWTON_STEPS: usize = 8;

/// One cell: what was painted and what is true, in linear light.
struct Cell {
    painted: [f32; 3],
    truth: [f32; 3],
}

/// Compares the cells that were seen (alpha 255) with the albedo of the closest points of the truth, after one gain per
/// channel on the light, the one with the smallest rms. Differences are those of sRGB values.
pub fn colour_error(model: &wire::Model, truth: &LoadedMesh) -> Result<ColourError, ColourErrorReason> {
    let mesh = TriangleMesh { uv: model.uv.to_vec(), ..TriangleMesh::from(&model.mesh) };
    mesh.check().map_err(ColourErrorReason::Model)?;
    check_texture(model)?;
    if truth.texture.is_none() && truth.mesh.colours.is_empty() {
        return Err(ColourErrorReason::TruthWithoutColours);
    }
    let index = MeshIndex::new(&truth.mesh)?;
    let on_triangle = |t: usize| cells_of(model, &mesh, t, |point| true_colour(&index, truth, point));
    let cells: Vec<Cell> = (0..mesh.triangles.len()).into_par_iter().flat_map_iter(on_triangle).collect();
    if cells.is_empty() { Err(ColourErrorReason::NothingSeen) } else { Ok(summarise(&cells)) }
}

/// Refuses a texture that cannot be read.
pub(crate) fn check_texture(model: &wire::Model) -> Result<(), ColourErrorReason> {
    let (width, height, cells) = (model.texture_width, model.texture_height, model.texture.len());
    let (uv, vertices) = (model.uv.len(), model.mesh.vertices_m.len());
    if u64::from(width) * u64::from(height) != cells as u64 || uv != vertices {
        return Err(ColourErrorReason::Texture { width, height, cells, uv, vertices });
    }
    Ok(())
}

fn true_colour(index: &MeshIndex, truth: &LoadedMesh, point: Point3<f64>) -> Option<[f32; 3]> {
    let closest = index.closest(&point)?;
    albedo(truth, closest.triangle, index.barycentric(closest.triangle, &closest.point))
}

/// The seen cells whose centres lie on triangle `t`.
fn cells_of(
    model: &wire::Model,
    mesh: &TriangleMesh,
    t: usize,
    truth_at: impl Fn(Point3<f64>) -> Option<[f32; 3]>,
) -> Vec<Cell> {
    let (width, height) = (model.texture_width, model.texture_height);
    let size = [f64::from(width), f64::from(height)];
    let corners = mesh.corners(t).map(|p| p.map(f64::from));
    let uv = mesh.triangles[t].map(|i| [0, 1].map(|k| f64::from(mesh.uv[i as usize][k]) * size[k] - 0.5));
    let range = |k: usize| {
        let low = uv.iter().map(|p| p[k]).fold(f64::INFINITY, f64::min).ceil().max(0.0);
        let high = uv.iter().map(|p| p[k]).fold(f64::NEG_INFINITY, f64::max).floor().min(size[k] - 1.0);
        // A place that is not a number, or beside the texture, gives no cell.
        if low <= high { low as usize..high as usize + 1 } else { 0..0 }
    };
    let mut cells = Vec::new();
    for row in range(1) {
        for column in range(0) {
            let [r, g, b, how] = model.texture[row * width as usize + column];
            if how != 255 || weights(&uv, [column as f64, row as f64]).is_none_or(|w| w.iter().any(|w| *w < 0.0)) {
                continue;
            }
            if let Some(truth) = mean_in_cell(&uv, &corners, [column as f64, row as f64], &truth_at) {
                cells.push(Cell { painted: [r, g, b].map(linear), truth });
            }
        }
    }
    cells
}

fn mean_in_cell(
    uv: &[[f64; 2]; 3],
    corners: &[Point3<f64>; 3],
    centre: [f64; 2],
    truth_at: impl Fn(Point3<f64>) -> Option<[f32; 3]>,
) -> Option<[f32; 3]> {
    let step = |i: usize| (i as f64 + 0.5) / PLACES as f64 - 0.5;
    let mut sum = [0.0; 3];
    for (i, j) in (0..PLACES).flat_map(|i| (0..PLACES).map(move |j| (i, j))) {
        // A cell on the rim reaches a little over its triangle's edges, in its plane.
        let [a, b, c] = weights(uv, [centre[0] + step(i), centre[1] + step(j)])?;
        let point = Point3::from(corners[0].coords * a + corners[1].coords * b + corners[2].coords * c);
        let colour = truth_at(point)?;
        for (sum, c) in sum.iter_mut().zip(colour) {
            *sum += c / (PLACES * PLACES) as f32;
        }
    }
    Some(sum)
}

/// The barycentric coordinates of a place in the plane of the texture.
fn weights([a, b, c]: &[[f64; 2]; 3], p: [f64; 2]) -> Option<[f64; 3]> {
    let cross =
        |o: &[f64; 2], p: &[f64; 2], q: &[f64; 2]| (p[0] - o[0]) * (q[1] - o[1]) - (p[1] - o[1]) * (q[0] - o[0]);
    let area = cross(a, b, c);
    let weights = [cross(b, c, &p) / area, cross(c, a, &p) / area, cross(a, b, &p) / area];
    weights.iter().all(|w| w.is_finite()).then_some(weights)
}

fn summarise(cells: &[Cell]) -> ColourError {
    let gain = [0, 1, 2].map(|channel| best_gain(cells, channel));
    let difference =
        |cell: &Cell, k: usize| f64::from(encoded_255(cell.painted[k] * gain[k] as f32) - encoded_255(cell.truth[k]));
    let squares = [0, 1, 2].map(|k| cells.iter().map(|cell| difference(cell, k).powi(2)).sum::<f64>());
    let count = cells.len() as f64;
    let mut sorted: Vec<f64> = cells.iter().flat_map(|cell| [0, 1, 2].map(|k| difference(cell, k).abs())).collect();
    sorted.sort_unstable_by(f64::total_cmp);
    ColourError {
        cells: cells.len(),
        gain,
        rms_255: (squares.iter().sum::<f64>() / (3.0 * count)).sqrt(),
        channel_rms_255: squares.map(|sum| (sum / count).sqrt()),
        p95_255: sorted[(sorted.len() - 1) * 95 / 100],
    }
}

/// The gain on the light of one channel with the smallest sum of squared sRGB differences: least squares on the light to
/// begin with, then Gauss-Newton.
fn best_gain(cells: &[Cell], channel: usize) -> f64 {
    let pair = |cell: &Cell| (f64::from(cell.painted[channel]), f64::from(cell.truth[channel]));
    let products: f64 = cells.iter().map(pair).map(|(m, t)| m * t).sum();
    let squares: f64 = cells.iter().map(pair).map(|(m, _)| m * m).sum();
    if squares <= 0.0 || products <= 0.0 {
        return 1.0;
    }
    let encoded = |light: f64| f64::from(encoded_255(light as f32));
    let mut gain = products / squares;
    for _ in 0..GAUSS_NEWTON_STEPS {
        let (mut down, mut up) = (0.0, 0.0);
        for (m, t) in cells.iter().map(pair) {
            let here = encoded(gain * m);
            let slope = (encoded(gain * m * 1.01) - here) / (0.01 * gain);
            down += slope * (encoded(t) - here);
            up += slope * slope;
        }
        if up <= 0.0 {
            break;
        }
        gain = (gain + down / up).clamp(0.5 * gain, 2.0 * gain);
    }
    gain
}
