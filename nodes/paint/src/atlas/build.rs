//! From a surface to its atlas.

use super::chart::Chart;
use super::plane::{Cell, Plane};
use super::{Atlas, NO_TEXEL, Texel, adjacency, chart, pack, seam};
use geometry::TriangleMesh;
use nalgebra::{Point3, Vector3};
use rayon::prelude::*;

/// Why a surface has no texture.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum AtlasError {
    /// Too many cells.
    #[error(
        "the texture would need {texels:.2e} texels, more than {side_max} x {side_max}: raise cell_mm from {cell_mm} to \
         at least {enough_mm:.2}, or raise texture_side_max"
    )]
    TooLarge {
        /// Texels of all charts with their padding.
        texels: f64,
        /// The largest side allowed.
        side_max: u32,
        /// The size of a cell as it was asked for.
        cell_mm: f64,
        /// A size of cell that fits.
        enough_mm: f64,
    },
}

/// A chart on its plane.
pub(super) struct Projected {
    pub chart: Chart,
    pub plane: Plane,
    pub cells: Vec<Cell>,
}

impl Atlas {
    /// Charts and texels of a surface that passed [`TriangleMesh::check`] and has a normal for each vertex; cells of
    /// `cell_m`, charts of triangles within `chart_degrees` of their axis.
    pub fn build(mesh: &TriangleMesh, cell_m: f64, chart_degrees: f64, side_max: u32) -> Result<Self, AtlasError> {
        let neighbours = adjacency::neighbours(mesh);
        let cell = cell_m as f32;
        let charts = chart::cut(mesh, &neighbours, chart_degrees.to_radians().cos() as f32, cell);
        let too_large = |texels: f64| AtlasError::TooLarge {
            texels,
            side_max,
            cell_mm: cell_m / geometry::METRES_PER_MM,
            enough_mm: cell_m / geometry::METRES_PER_MM * 1.1 * (texels.sqrt() / f64::from(side_max)).max(1.0),
        };
        let texels = |planes: &[Plane]| planes.iter().map(|p| f64::from(p.size[0]) * f64::from(p.size[1])).sum::<f64>();
        let planes: Vec<Plane> = charts.par_iter().map(|chart| Plane::of(chart, mesh, cell)).collect();
        if texels(&planes) > f64::from(side_max).powi(2) {
            return Err(too_large(texels(&planes)));
        }
        let projected: Vec<Projected> = charts
            .into_par_iter()
            .zip(planes)
            .map(|(chart, plane)| sheets(chart, plane, mesh, &neighbours, cell))
            .flatten_iter()
            .collect();
        let sizes: Vec<[u32; 2]> = projected.iter().map(|p| p.plane.size).collect();
        let layout = pack::pack(&sizes, side_max)
            .ok_or_else(|| too_large(texels(&projected.iter().map(|p| p.plane.clone()).collect::<Vec<_>>())))?;
        let mut atlas = Self::laid_out(&projected, &layout, mesh);
        atlas.seams = seam::pairs(&projected, &layout, &atlas, mesh, &neighbours);
        Ok(atlas)
    }

    fn laid_out(projected: &[Projected], layout: &pack::Layout, mesh: &TriangleMesh) -> Self {
        let (width, height) = (layout.width, layout.height);
        let texels: Vec<Texel> = projected
            .par_iter()
            .zip(&layout.corners)
            .flat_map_iter(|(p, corner)| texels_of(p, *corner, width, mesh))
            .collect();
        let mut number_at = vec![NO_TEXEL; width as usize * height as usize];
        for (number, texel) in texels.iter().enumerate() {
            number_at[texel.place as usize] = number as u32;
        }
        let mut atlas = Self { width, height, charts: projected.len(), texels, number_at, ..Self::default() };
        atlas.triangles = vec![[0; 3]; mesh.triangles.len()];
        for (p, corner) in projected.iter().zip(&layout.corners) {
            atlas.add_vertices(p, *corner, mesh);
        }
        atlas
    }

    /// Repeats the vertices of a chart, with their texture coordinates.
    fn add_vertices(&mut self, p: &Projected, [left, top]: [u32; 2], mesh: &TriangleMesh) {
        let corners = |t: u32| mesh.triangles[t as usize];
        let mut own: Vec<u32> = p.chart.triangles.iter().flat_map(|&t| corners(t)).collect();
        own.sort_unstable();
        own.dedup();
        let first = self.vertices.len();
        for &t in &p.chart.triangles {
            self.triangles[t as usize] = corners(t).map(|i| (first + own.partition_point(|&o| o < i)) as u32);
        }
        for &i in &own {
            let texel = p.plane.texel(&mesh.vertices[i as usize]);
            let u = (left as f32 + texel.x) / self.width as f32;
            let v = (top as f32 + texel.y) / self.height as f32;
            self.uv.push([u, v]);
        }
        self.vertices.extend(own);
    }

    /// Numbers of the texels around a texel that belong to its chart: left, right, above, below, then the corners.
    /// Charts never touch, so no neighbour is another chart's.
    pub fn around(&self, number: u32) -> [u32; 8] {
        let (place, width) = (self.texels[number as usize].place as usize, self.width as usize);
        // The outermost ring of the texture belongs to no chart.
        [
            place - 1,
            place + 1,
            place - width,
            place + width,
            place - width - 1,
            place - width + 1,
            place + width - 1,
            place + width + 1,
        ]
        .map(|at| self.number_at[at])
    }

    /// The texels that show the same place on the other side of a seam.
    pub fn across(&self, number: u32) -> impl Iterator<Item = u32> {
        let first = self.seams.partition_point(|pair| pair[0] < number);
        self.seams[first..].iter().take_while(move |pair| pair[0] == number).map(|pair| pair[1])
    }
}

/// Cuts a chart until no two of its sheets lie over each other.
fn sheets(chart: Chart, plane: Plane, mesh: &TriangleMesh, neighbours: &[[u32; 3]], cell_m: f32) -> Vec<Projected> {
    let mut done = Vec::new();
    let mut waiting = vec![(chart, plane)];
    while let Some((mut chart, plane)) = waiting.pop() {
        let (cells, mut second_sheet) = plane.cells(&chart, mesh);
        if !second_sheet.is_empty() {
            second_sheet.sort_unstable();
            chart.triangles.retain(|t| second_sheet.binary_search(t).is_err());
            for piece in chart::pieces(chart.axis, &second_sheet, neighbours) {
                let plane = Plane::of(&piece, mesh, cell_m);
                waiting.push((piece, plane));
            }
        }
        done.push(Projected { chart, plane, cells });
    }
    done
}

/// The texels of a chart whose top-left corner is at (left, top).
fn texels_of(p: &Projected, [left, top]: [u32; 2], width: u32, mesh: &TriangleMesh) -> Vec<Texel> {
    let used = p.cells.iter().enumerate().filter(|(_, cell)| cell.is_used());
    used.map(|(index, cell)| {
        let (column, row) = (index as u32 % p.plane.size[0], index as u32 / p.plane.size[0]);
        let corners = mesh.triangles[cell.triangle as usize];
        let [a, b, c] = corners.map(|i| mesh.normals[i as usize]);
        let [wa, wb, wc] = cell.weights;
        let normal = (a * wa + b * wb + c * wc).try_normalize(1e-6);
        Texel {
            place: (top + row) * width + left + column,
            triangle: cell.triangle,
            position_m: place_on(mesh, cell).into(),
            normal: normal.unwrap_or_else(|| flat_normal(mesh, cell.triangle)).into(),
            inside: cell.is_inside(),
        }
    })
    .collect()
}

/// Where a cell lies on the surface.
pub(super) fn place_on(mesh: &TriangleMesh, cell: &Cell) -> Point3<f32> {
    let [a, b, c] = mesh.corners(cell.triangle as usize);
    let [wa, wb, wc] = cell.weights;
    Point3::from(a.coords * wa + b.coords * wb + c.coords * wc)
}

fn flat_normal(mesh: &TriangleMesh, triangle: u32) -> Vector3<f32> {
    mesh.area_normal(triangle as usize).try_normalize(0.0).unwrap_or_else(Vector3::z)
}
