//! Where the laser's light falls (paper, section 2.2: the rays l + delta m of one line).
//!
//! The sheet is a finite fan from one source. It has a thickness: it is taken as a few parallel layers whose weights are
//! those of its Gaussian cross-section. Each layer cuts the mesh in segments; seen from the source a segment covers
//! some of the fan's angles, and at each angle the nearest one is lit and shadows what is behind it: the z-buffer of the
//! picture again, with one dimension less.

use super::section::LaserLightSection;
use super::{OpticsError, stage::Stage};
use geometry::{LaserSheet, METRES_PER_MM};
use nalgebra::{Isometry3, Point3, Vector3};

/// Full width at half maximum of a Gaussian, in standard deviations.
const FWHM: f64 = 2.354_820_045;
/// Nothing nearer to the source than this is cut.
const NEAR_M: f64 = 2e-3;

/// The fan in the camera's frame.
#[derive(Debug, Clone)]
pub(super) struct Fan {
    source: Point3<f64>,
    /// Across the sheet.
    normal: Vector3<f64>,
    /// Down the middle of the fan.
    along: Vector3<f64>,
    /// Along the line.
    side: Vector3<f64>,
    /// Tangent of half the opening angle.
    reach: f64,
    layers: Vec<Layer>,
    /// Angles that are told apart.
    bins: usize,
    end_level: f64,
    /// Light at 1 m, integrated over the thickness: signal times metres.
    strength: f64,
}

/// A thin slice of the sheet.
#[derive(Debug, Clone, Copy)]
struct Layer {
    /// From the sheet's middle, along its normal.
    offset_m: f64,
    /// Share of the light.
    weight: f64,
}

/// What the light meets in one direction of one layer. Along a straight segment 1/x is linear in the tangent y/x.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Cut {
    /// 1/x of the nearest segment, x along the fan; 0 where there is none.
    inverse: f32,
    /// d(1/x) / d(y/x).
    slope: f32,
    /// Whose segment.
    pub triangle: u32,
}

/// The cuts of one picture, layer by layer.
#[derive(Debug, Clone, Default)]
pub(super) struct Cuts {
    cuts: Vec<Cut>,
    distances: Vec<f32>,
}

/// The fan as it stands in the world at one moment.
pub(super) struct Placed<'a> {
    fan: &'a Fan,
    pub source: Point3<f64>,
    pub normal: Vector3<f64>,
    along: Vector3<f64>,
    side: Vector3<f64>,
}

impl Fan {
    /// `bins` angles are told apart; `blur_m` is the lens's blur at the line's distance, which hides the layers.
    pub fn new(section: &LaserLightSection, sheet: &LaserSheet, bins: usize, blur_m: f64) -> Result<Self, OpticsError> {
        let normal = sheet.normal;
        let source = match section.source_mm {
            Some(mm) => Vector3::from(mm) * METRES_PER_MM,
            None => beside_the_lens(sheet),
        };
        let source = Point3::from(source - normal * (normal.dot(&source) - sheet.distance_m));
        let no_direction = || OpticsError::Fan { source_mm: source.coords.map(|x| x / METRES_PER_MM).into() };
        // Towards where the sheet crosses the camera's axis, or straight ahead when it does so nowhere.
        let crossing = sheet.intersect(&Vector3::z()).map(|p| p - source);
        let ahead = crossing.unwrap_or_else(|| Vector3::z() - normal * normal.z);
        let along = ahead.try_normalize(1e-6).ok_or_else(no_direction)?;
        let sigma_m = section.thickness_mm * METRES_PER_MM / FWHM;
        let ridge_to_sum = sigma_m * std::f64::consts::TAU.sqrt();
        Ok(Self {
            source,
            normal,
            along,
            side: normal.cross(&along),
            reach: 0.5 * section.line_length_mm / section.line_distance_mm,
            layers: layers(sigma_m, blur_m),
            bins,
            end_level: section.end_level,
            strength: section.level * section.line_distance_mm * METRES_PER_MM * ridge_to_sum,
        })
    }

    pub fn placed(&self, world_from_camera: &Isometry3<f64>) -> Placed<'_> {
        Placed {
            fan: self,
            source: world_from_camera * self.source,
            normal: world_from_camera * self.normal,
            along: world_from_camera * self.along,
            side: world_from_camera * self.side,
        }
    }

    /// The tangent at the middle of a bin.
    fn tangent(&self, bin: usize) -> f64 {
        self.reach * ((2 * bin + 1) as f64 / self.bins as f64 - 1.0)
    }

    /// From one bin to the next.
    pub fn tangent_step(&self) -> f64 {
        2.0 * self.reach / self.bins as f64
    }
}

/// Layers of a Gaussian sheet with its standard deviation, no farther apart than the lens's blur: at least five.
fn layers(sigma_m: f64, blur_m: f64) -> Vec<Layer> {
    const REACH: f64 = 3.0;
    const MOST_BESIDE: f64 = 100.0;
    let beside = (REACH * sigma_m / blur_m).ceil().min(MOST_BESIDE) as i32;
    // Five samples, one standard deviation apart, will do for the usual thin sheet.
    let (beside, step) = if beside <= 2 { (2, 1.0) } else { (beside, REACH / f64::from(beside)) };
    let places: Vec<f64> = (-beside..=beside).map(|k| f64::from(k) * step).collect();
    let weights: Vec<f64> = places.iter().map(|x| (-0.5 * x * x).exp()).collect();
    let sum: f64 = weights.iter().sum();
    let variance = places.iter().zip(&weights).map(|(x, weight)| x * x * weight).sum::<f64>() / sum;
    let scale = sigma_m / variance.sqrt();
    places.iter().zip(weights).map(|(x, weight)| Layer { offset_m: x * scale, weight: weight / sum }).collect()
}

/// The sheet's point beside the camera's centre: on its line of sight at right angles to the axis, when it has one.
fn beside_the_lens(sheet: &LaserSheet) -> Vector3<f64> {
    let across = Vector3::new(sheet.normal.x, sheet.normal.y, 0.0);
    match across.norm_squared() {
        square if square > 1e-6 => across * (sheet.distance_m / square),
        _ => Vector3::new(-0.1, 0.0, 0.0),
    }
}

impl Placed<'_> {
    /// How many layers there are.
    pub fn layers(&self) -> usize {
        self.fan.layers.len()
    }

    /// The layer in the middle.
    pub fn middle(&self) -> usize {
        self.fan.layers.len() / 2
    }

    /// Cuts the stage with all layers.
    pub fn cut(&self, stage: &Stage, out: &mut Cuts) {
        out.cuts.clear();
        out.cuts.resize(self.fan.layers.len() * self.fan.bins, Cut::default());
        let normal = self.normal.cast::<f32>();
        let offset = self.normal.dot(&self.source.coords) as f32;
        out.distances.clear();
        out.distances.extend(stage.mesh.vertices.iter().map(|p| normal.dot(&p.coords) - offset));
        let half = self.fan.layers.iter().fold(0.0, |half, layer| layer.offset_m.max(half)) as f32;
        for (index, triangle) in stage.mesh.triangles.iter().enumerate() {
            let [a, b, c] = triangle.map(|i| out.distances[i as usize]);
            if a.max(b).max(c) >= -half && a.min(b).min(c) <= half {
                let corners = triangle.map(|i| self.in_fan(&stage.mesh.vertices[i as usize].cast()));
                for (layer, bins) in self.fan.layers.iter().zip(out.cuts.chunks_exact_mut(self.fan.bins)) {
                    self.enter(&corners, layer.offset_m, index as u32, bins);
                }
            }
        }
    }

    /// x along the fan, y along the line, and the distance from the sheet.
    fn in_fan(&self, p_in_world: &Point3<f64>) -> [f64; 3] {
        let from_source = p_in_world - self.source;
        [self.along.dot(&from_source), self.side.dot(&from_source), self.normal.dot(&from_source)]
    }

    /// One layer's segment of one triangle, into the bins that it covers.
    fn enter(&self, corners: &[[f64; 3]; 3], offset_m: f64, triangle: u32, bins: &mut [Cut]) {
        let Some([p, q]) = segment(corners, offset_m) else { return };
        if p[0] < NEAR_M || q[0] < NEAR_M {
            return;
        }
        let [(from, from_inverse), (to, to_inverse)] = [p, q].map(|[x, y]| (y / x, 1.0 / x));
        let bin_of = |tangent: f64| (tangent / self.fan.reach + 1.0) * 0.5 * bins.len() as f64 - 0.5;
        let first = bin_of(from.min(to)).ceil().max(0.0);
        let last = bin_of(from.max(to)).floor().min(bins.len() as f64 - 1.0);
        if first > last {
            return;
        }
        let slope = (to_inverse - from_inverse) / (to - from);
        let (first, count) = (first as usize, (last - first) as usize + 1);
        for (bin, cut) in bins.iter_mut().enumerate().skip(first).take(count) {
            let inverse = (from_inverse + slope * (self.fan.tangent(bin) - from)) as f32;
            if inverse > cut.inverse {
                *cut = Cut { inverse, slope: slope as f32, triangle };
            }
        }
    }

    /// The cuts of a layer, each with its bin.
    pub fn lit<'c>(&self, cuts: &'c Cuts, layer: usize) -> impl Iterator<Item = (usize, &'c Cut)> {
        let bins = self.fan.bins;
        cuts.cuts[layer * bins..][..bins].iter().enumerate().filter(|(_, cut)| cut.inverse > 0.0)
    }

    /// The point in the world that lies `by` bins beside the middle of a cut, on its segment.
    pub fn point(&self, layer: usize, bin: usize, cut: &Cut, by: f64) -> Point3<f64> {
        let shift = by * self.fan.tangent_step();
        let inverse = (f64::from(cut.inverse) + f64::from(cut.slope) * shift).max(1e-3);
        let x = 1.0 / inverse;
        let y = x * (self.fan.tangent(bin) + shift);
        self.source + self.along * x + self.side * y + self.normal * self.fan.layers[layer].offset_m
    }

    /// Light that arrives in one bin of a layer, for all distances: signal of a white surface times its area, over the
    /// thickness of the layer (the fan spreads with the distance, the surface that a bin meets with it).
    pub fn flux(&self, layer: usize, bin: usize) -> f64 {
        let tangent = self.fan.tangent(bin);
        let angle = self.fan.tangent_step() / (1.0 + tangent * tangent);
        let to_the_end = tangent / self.fan.reach;
        let evenness = 1.0 - (1.0 - self.fan.end_level) * to_the_end * to_the_end;
        self.fan.strength * evenness * self.fan.layers[layer].weight * angle
    }
}

/// Where a plane parallel to the sheet cuts a triangle.
fn segment(corners: &[[f64; 3]; 3], offset_m: f64) -> Option<[[f64; 2]; 2]> {
    let mut ends = [[0.0; 2]; 2];
    let mut found = 0;
    for i in 0..3 {
        let (a, b) = (&corners[i], &corners[(i + 1) % 3]);
        let (da, db) = (a[2] - offset_m, b[2] - offset_m);
        if (da < 0.0) != (db < 0.0) && found < 2 {
            // From the same corner whichever triangle asks, so that neighbours meet.
            let (a, b, t) = if da < 0.0 { (a, b, da / (da - db)) } else { (b, a, db / (db - da)) };
            ends[found] = [a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t];
            found += 1;
        }
    }
    (found == 2).then_some(ends)
}
