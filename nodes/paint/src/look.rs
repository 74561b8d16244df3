//! One look at the surface: which cells a picture colours, and how.

use crate::atlas::Texel;
use crate::light::{Light, Lit, WORKING_DISTANCE_M};
use crate::occlusion::Occlusion;
use crate::region::Region;
use crate::sample::{Sample, mix};
use crate::{Config, Picture};
use nalgebra::{Isometry3, Matrix3, Point2, Point3, Vector3};

/// Why a cell gets no colour from a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, thiserror::Error)]
pub enum CellRefusal {
    /// Farther from the optical axis than the working angle, or beside the picture.
    #[error("far from the optical axis")]
    OffAxis,
    /// The surface is turned too far from the line of sight.
    #[error("seen at too steep an angle")]
    Steep,
    /// Another part of the surface is in front.
    #[error("hidden")]
    Hidden,
    /// Too near to an edge in depth.
    #[error("near an edge in depth")]
    NearEdge,
    /// A pixel of the cell is saturated.
    #[error("saturated")]
    Saturated,
    /// The lamp does not shine there.
    #[error("in the lamp's shadow")]
    Unlit,
    /// It lies on a cap: where that surface really is nobody measured, and so not what the picture shows there.
    #[error("on a cap that nobody measured")]
    Guessed,
}

impl CellRefusal {
    /// All of them.
    pub const ALL: [Self; 7] =
        [Self::OffAxis, Self::Steep, Self::Hidden, Self::NearEdge, Self::Saturated, Self::Unlit, Self::Guessed];
}

/// A gleam counts this much.
const GLEAM_WEIGHT: f32 = 0.1;

/// The rules, in the units of the science.
#[derive(Debug, Clone)]
pub struct Rules {
    facing_cosine: f32,
    saturated_from: u8,
    depth_tolerance_m: f32,
    cell_m: f32,
    has_ambient: bool,
    light: Light,
}

impl Rules {
    /// As configured.
    pub fn new(config: &Config) -> Self {
        Self {
            facing_cosine: config.facing_degrees.to_radians().cos() as f32,
            saturated_from: config.saturated_from,
            depth_tolerance_m: (config.depth_tolerance_mm * geometry::METRES_PER_MM) as f32,
            cell_m: config.cell_m() as f32,
            has_ambient: config.ambient.is_some_and(|a| a.iter().any(|a| *a > 0.0)),
            light: Light::new(config),
        }
    }
}

/// A picture, from where it was taken, and the depth that it saw.
pub struct Look<'a> {
    rules: &'a Rules,
    region: &'a Region,
    picture: &'a Picture,
    depth: &'a Occlusion,
    light_of_value: [f32; 256],
    rotation: Matrix3<f32>,
    translation: Vector3<f32>,
    hash: u64,
}

/// Where a cell lies in a picture.
#[derive(Debug, Clone, Copy)]
pub struct Place {
    /// In the working region.
    pub pixel: Point2<f32>,
    /// Size of a pixel at that distance.
    pub metres_per_pixel: f32,
    /// The light there.
    pub lit: Lit,
    /// How much an estimate from there counts.
    pub weight: f32,
}

impl<'a> Look<'a> {
    /// `depth` must have been seen from the same place.
    pub fn new(
        rules: &'a Rules,
        region: &'a Region,
        picture: &'a Picture,
        depth: &'a Occlusion,
        camera_from_world: &Isometry3<f64>,
    ) -> Self {
        Self {
            rules,
            region,
            picture,
            depth,
            light_of_value: picture.light_of_value(),
            rotation: camera_from_world.rotation.to_rotation_matrix().matrix().cast(),
            translation: camera_from_world.translation.vector.cast(),
            hash: mix(picture.header.stamp_nanos as u64),
        }
    }

    /// The estimate of one cell, by the paper's rules (section 2.6).
    pub fn at(&self, number: u32, texel: &Texel) -> Result<Sample, CellRefusal> {
        let place = self.place(texel)?;
        self.sample(number, &place)
    }

    /// Where a cell lies in the picture, if it may be coloured by it.
    pub fn place(&self, texel: &Texel) -> Result<Place, CellRefusal> {
        let p_in_camera = self.rotation * Vector3::from(texel.position_m) + self.translation;
        let distance = p_in_camera.norm();
        let on_axis = p_in_camera.z > 0.0 && p_in_camera.z >= self.region.axis_cosine * distance;
        if !on_axis {
            return Err(CellRefusal::OffAxis);
        }
        let normal = self.rotation * Vector3::from(texel.normal);
        let facing = -normal.dot(&p_in_camera) / distance;
        if facing.is_nan() || facing < self.rules.facing_cosine {
            return Err(CellRefusal::Steep);
        }
        let pixel = self.region.camera.project(&Point3::from(p_in_camera.cast::<f64>()));
        let pixel = pixel.filter(|p| self.region.camera.contains(p)).ok_or(CellRefusal::OffAxis)?.cast::<f32>();
        let metres_per_pixel = p_in_camera.z / self.region.camera.fx as f32;
        self.check_visible(&pixel, p_in_camera.z, metres_per_pixel)?;
        let lit = self.rules.light.at(&p_in_camera, &normal);
        if lit.irradiance == 0.0 && !self.rules.has_ambient {
            return Err(CellRefusal::Unlit);
        }
        // Facing surfaces are shaded least, near ones seen finest.
        let nearness = (WORKING_DISTANCE_M / distance).powi(2).clamp(0.1, 4.0);
        let weight = facing * facing * nearness * if lit.gleams { GLEAM_WEIGHT } else { 1.0 };
        Ok(Place { pixel, metres_per_pixel, lit, weight })
    }

    /// The estimate of a cell that lies there.
    pub fn sample(&self, number: u32, place: &Place) -> Result<Sample, CellRefusal> {
        let side = (self.rules.cell_m / place.metres_per_pixel).max(1.0);
        let light = self.mean_light(&place.pixel, side)?;
        let radiance = light.map(|light| light / place.lit.vignetting);
        Ok(Sample::new(radiance, place.lit.irradiance, place.weight, mix(self.hash ^ u64::from(number))))
    }

    /// By the depth of the surface at the pixel; the tolerance allows for the slope across a pixel and a half.
    fn check_visible(&self, pixel: &Point2<f32>, depth_m: f32, metres_per_pixel: f32) -> Result<(), CellRefusal> {
        let [width, height] = [self.region.camera.width, self.region.camera.height].map(|size| size as usize);
        // A place just inside the border may have been rounded onto it.
        let (column, row) = ((pixel.x.round() as usize).min(width - 1), (pixel.y.round() as usize).min(height - 1));
        let at = row * width + column;
        let inverse = self.depth.inverse_depth[at];
        let tolerance = self.rules.depth_tolerance_m + 1.5 * metres_per_pixel;
        if inverse > 0.0 && depth_m > inverse.recip() + tolerance {
            return Err(CellRefusal::Hidden);
        }
        if self.depth.near_edge[at] != 0 { Err(CellRefusal::NearEdge) } else { Ok(()) }
    }

    /// Mean light over a square of `side` pixels around a place, pixels cut by its border counted in part (with side 1
    /// that is bilinear). The cell is seen as this square.
    fn mean_light(&self, pixel: &Point2<f32>, side: f32) -> Result<[f32; 3], CellRefusal> {
        let half = 0.5 * side;
        let span = |centre: f32| ((centre - half).round() as i64, (centre + half).round() as i64);
        let ((left, right), (top, bottom)) = (span(pixel.x), span(pixel.y));
        let (width, height) = (i64::from(self.picture.width), i64::from(self.picture.height));
        if left < 0 || top < 0 || right >= width || bottom >= height {
            return Err(CellRefusal::OffAxis);
        }
        let share = |at: i64, centre: f32| {
            let at = at as f32;
            ((centre + half).min(at + 0.5) - (centre - half).max(at - 0.5)).max(0.0)
        };
        let mut sum = [0.0; 3];
        let mut total = 0.0;
        for row in top..=bottom {
            let row_share = share(row, pixel.y);
            for column in left..=right {
                let at = (row * width + column) as usize;
                let value = self.picture.pixels[at];
                if value.iter().any(|&v| v >= self.rules.saturated_from) {
                    return Err(CellRefusal::Saturated);
                }
                if self.depth.near_edge[at] != 0 {
                    return Err(CellRefusal::NearEdge);
                }
                let weight = row_share * share(column, pixel.x);
                total += weight;
                (0..3).for_each(|c| sum[c] += weight * self.light_of_value[value[c] as usize]);
            }
        }
        Ok(sum.map(|s| s / total))
    }
}
