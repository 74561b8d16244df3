//! How far the borders between the patches of colour lie from the true ones.
//!
//! Places are drawn evenly along the borders of the truth, from its vertex colours or its texture: random points of its
//! surface, moved across onto the border beside them. A place counts when the truth has two even colours to both sides,
//! well apart. Then the model's colours are read along the same line (in the truth's tangent plane, square to the border,
//! 2 mm to each side, each point taken to the closest one of either surface), and the place where they are half-way from
//! the one side's mean to the other's is held against the truth's. Light is linear, so that an even blur moves nothing.

use crate::albedo::{albedo, encoded_255, painted};
use crate::colour::{ColourErrorReason, check_texture};
use formats::mesh::LoadedMesh;
use geometry::{METRES_PER_MM, MeshIndex};
use nalgebra::{Point3, Vector3};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Where the model's borders between colours lie, across the border, on the surface.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct BorderError {
    /// Places on the truth's borders where the model's border was found.
    pub places: usize,
    /// Places where the model was seen, but its colours do not go from the one side's to the other's.
    pub lost: usize,
    /// Places where the model has no surface, or cells that no picture saw.
    pub unseen: usize,
    /// Root mean square distance.
    pub rms_mm: f64,
    /// Half of the places are closer.
    pub median_mm: f64,
    /// 95 % of them are.
    pub p95_mm: f64,
}

/// Points of the truth's surface that are tried.
const TRIED: usize = 60_000;
const SEED: u64 = 1;
/// A border is looked for, and its direction taken, on a circle of this radius.
const RING_M: f64 = 1.0 * METRES_PER_MM;
const RING_PLACES: usize = 12;
/// A profile goes so far to each side ...
const REACH_M: f64 = 2.0 * METRES_PER_MM;
/// ... in so many steps, of 0.05 mm; ...
const STEPS: usize = 40;
/// ... the outer half of which is even in colour, on the truth.
const EVEN_FROM: usize = 20;
/// Two colours of the truth are well apart from this difference (of sRGB values, the three channels together).
const CONTRAST_255: f32 = 40.0;
/// A side is even when no colour on it is farther from its mean than this share of the difference.
const EVEN: f32 = 0.1;
/// The model's difference must be at least this share of the truth's.
const CONTRAST_LEFT: f32 = 0.25;
/// Farther than this from the truth, the model has no surface there.
const NEAR_M: f64 = 1.0 * METRES_PER_MM;
/// Two normals within 60 degrees are those of one sheet.
const SAME_SHEET: f64 = 0.5;

type Light = Vector3<f32>;

/// Measures the borders of a model, laid onto the truth; `None` when the truth has no border between two even colours.
/// Fails as [`crate::colour_error`] does.
pub fn border_error(model: &wire::Model, truth: &LoadedMesh) -> Result<Option<BorderError>, ColourErrorReason> {
    let made = painted(model);
    made.mesh.check().map_err(ColourErrorReason::Model)?;
    check_texture(model)?;
    let truth = Coloured { index: MeshIndex::new(&truth.mesh)?, surface: truth };
    let made = Coloured { index: MeshIndex::new(&made.mesh)?, surface: &made };
    let found: Vec<Found> = truth
        .index
        .sample(TRIED, SEED)
        .par_iter()
        .filter_map(|sample| {
            let border = Border::near(&truth, &sample.point, &sample.normal)?;
            Some(border.found(&made, |triangle, weights| is_seen(model, triangle, weights)))
        })
        .collect();
    Ok(summarise(&found))
}

/// A surface whose colours can be asked for anywhere.
struct Coloured<'a> {
    index: MeshIndex,
    surface: &'a LoadedMesh,
}

/// A point of a coloured surface.
struct At {
    point: Point3<f64>,
    triangle: u32,
    weights: [f64; 3],
    light: Light,
}

impl Coloured<'_> {
    /// The closest point, if it is near and on a sheet that faces the same way.
    fn at(&self, point: &Point3<f64>, normal: &Vector3<f64>) -> Option<At> {
        let closest = self.index.closest_within(point, NEAR_M)?;
        if self.index.normal(closest.triangle).dot(normal) < SAME_SHEET {
            return None;
        }
        let weights = self.index.barycentric(closest.triangle, &closest.point);
        let light = albedo(self.surface, closest.triangle, weights)?;
        Some(At { point: closest.point, triangle: closest.triangle, weights, light: light.into() })
    }
}

/// A place on a border of the truth.
struct Border {
    /// Along the line across it, from the darker side to the brighter.
    line: Vec<Point3<f64>>,
    normal: Vector3<f64>,
    /// Where on that line, in steps from its first point.
    at: f64,
    /// The brighter colour less the darker.
    difference: Light,
}

/// What the model has there.
enum Found {
    Unseen,
    Lost,
    /// How far from the truth, in metres.
    Shifted(f64),
}

impl Border {
    /// The border beside a point of the truth, if there is one of two even colours.
    fn near(truth: &Coloured<'_>, point: &Point3<f64>, normal: &Vector3<f64>) -> Option<Self> {
        // First onto the border, then square across it.
        let across = direction(truth, point, normal)?;
        let (_, lights) = profile(truth, point, &across, normal)?;
        let at = crossing(&lights)?;
        let moved = truth.at(&(point + across * (REACH_M * (at / STEPS as f64 - 1.0))), normal)?;
        let normal = truth.index.normal(moved.triangle);
        let across = direction(truth, &moved.point, &normal)?;
        let (line, lights) = profile(truth, &moved.point, &across, &normal)?;
        let [dark, bright] = sides(&lights);
        let difference = bright - dark;
        let encoded = |light: Light| light.map(encoded_255);
        let even = |side: &[Light], mean: &Light| side.iter().all(|l| (l - mean).norm() <= EVEN * difference.norm());
        let is_border = (encoded(bright) - encoded(dark)).norm() >= CONTRAST_255
            && even(&lights[..=EVEN_FROM], &dark)
            && even(&lights[lights.len() - 1 - EVEN_FROM..], &bright);
        if !is_border {
            return None;
        }
        Some(Self { at: crossing(&lights)?, line, normal, difference })
    }

    fn found(&self, made: &Coloured<'_>, is_seen: impl Fn(u32, [f64; 3]) -> bool) -> Found {
        let read = |point: &Point3<f64>| {
            let at = made.at(point, &self.normal)?;
            is_seen(at.triangle, at.weights).then_some(at.light)
        };
        let Some(lights) = self.line.iter().map(read).collect::<Option<Vec<Light>>>() else { return Found::Unseen };
        let [dark, bright] = sides(&lights);
        if (bright - dark).dot(&self.difference) < CONTRAST_LEFT * self.difference.norm_squared() {
            return Found::Lost;
        }
        match crossing(&lights) {
            Some(at) => Found::Shifted((at - self.at) * REACH_M / STEPS as f64),
            None => Found::Lost,
        }
    }
}

/// Across the border inside a circle, towards the brighter side; `None` where all of it has one colour.
fn direction(truth: &Coloured<'_>, point: &Point3<f64>, normal: &Vector3<f64>) -> Option<Vector3<f64>> {
    let helper = if normal.x.abs() < 0.7 { Vector3::x() } else { Vector3::y() };
    let u = normal.cross(&helper).try_normalize(1e-9)?;
    let v = normal.cross(&u);
    let ring = (0..RING_PLACES).map(|i| {
        let (sine, cosine) = (std::f64::consts::TAU * i as f64 / RING_PLACES as f64).sin_cos();
        u * cosine + v * sine
    });
    let ring: Option<Vec<(Vector3<f64>, Light)>> =
        ring.map(|d| Some((d, truth.at(&(point + d * RING_M), normal)?.light))).collect();
    let ring = ring?;
    let by_sum = |a: &&(Vector3<f64>, Light), b: &&(Vector3<f64>, Light)| a.1.sum().total_cmp(&b.1.sum());
    let (dark, bright) = (ring.iter().min_by(by_sum)?.1, ring.iter().max_by(by_sum)?.1);
    let axis = bright - dark;
    let sum: Vector3<f64> = ring.iter().map(|(d, light)| d * f64::from((light - dark).dot(&axis))).sum();
    // The truth's own steps of rounding are no border.
    let enough = (bright.map(encoded_255) - dark.map(encoded_255)).norm() >= CONTRAST_255;
    if enough { sum.try_normalize(1e-9) } else { None }
}

/// The points of the surface along a line across a border, and their colours.
fn profile(
    truth: &Coloured<'_>,
    middle: &Point3<f64>,
    across: &Vector3<f64>,
    normal: &Vector3<f64>,
) -> Option<(Vec<Point3<f64>>, Vec<Light>)> {
    let place = |i: usize| middle + across * (REACH_M * (i as f64 / STEPS as f64 - 1.0));
    let read = |i: usize| truth.at(&place(i), normal).map(|at| (at.point, at.light));
    (0..=2 * STEPS).map(read).collect::<Option<Vec<_>>>().map(|read| read.into_iter().unzip())
}

/// The mean colours of the outer halves of a profile.
fn sides(lights: &[Light]) -> [Light; 2] {
    let mean = |side: &[Light]| side.iter().sum::<Light>() / side.len() as f32;
    [mean(&lights[..=EVEN_FROM]), mean(&lights[lights.len() - 1 - EVEN_FROM..])]
}

/// Where a profile is half-way from its one side to the other, in steps from its first point. Where it is so more than
/// once, the first and the last are averaged.
fn crossing(lights: &[Light]) -> Option<f64> {
    let [from, to] = sides(lights);
    let axis = (to - from) / (to - from).norm_squared();
    let beyond: Vec<f32> = lights.iter().map(|light| (light - from).dot(&axis) - 0.5).collect();
    let between = |i: usize| i as f64 + f64::from(beyond[i] / (beyond[i] - beyond[i + 1]));
    let rises = |i: &usize| beyond[*i] < 0.0 && beyond[i + 1] >= 0.0;
    let first = (0..beyond.len() - 1).find(rises)?;
    let last = (0..beyond.len() - 1).rfind(rises)?;
    Some(0.5 * (between(first) + between(last)))
}

/// Whether a picture saw the cell of the model's texture at a point.
fn is_seen(model: &wire::Model, triangle: u32, weights: [f64; 3]) -> bool {
    let size = [model.texture_width, model.texture_height];
    let corners = model.mesh.triangles[triangle as usize];
    let [column, row] = [0, 1].map(|axis| {
        let at: f64 = corners.iter().zip(weights).map(|(&i, w)| f64::from(model.uv[i as usize][axis]) * w).sum();
        // What is beside the texture, or not a number, is taken to its rim.
        ((at * f64::from(size[axis])) as u32).min(size[axis].saturating_sub(1))
    });
    model.texture.get(row as usize * size[0] as usize + column as usize).is_some_and(|cell| cell[3] == 255)
}

fn summarise(found: &[Found]) -> Option<BorderError> {
    let count = |wanted: fn(&&Found) -> bool| found.iter().filter(wanted).count();
    let (unseen, lost) = (count(|f| matches!(f, Found::Unseen)), count(|f| matches!(f, Found::Lost)));
    let shift_mm = |f: &Found| if let Found::Shifted(metres) = f { Some(metres.abs() / METRES_PER_MM) } else { None };
    let mut sorted: Vec<f64> = found.iter().filter_map(shift_mm).collect();
    sorted.sort_unstable_by(f64::total_cmp);
    let (places, at) = (sorted.len(), |percent: usize| sorted.get((sorted.len().max(1) - 1) * percent / 100).copied());
    (!found.is_empty()).then(|| BorderError {
        places,
        lost,
        unseen,
        rms_mm: (sorted.iter().map(|d| d * d).sum::<f64>() / places.max(1) as f64).sqrt(),
        median_mm: at(50).unwrap_or_default(),
        p95_mm: at(95).unwrap_or_default(),
    })
}
