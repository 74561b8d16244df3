//! Which points of the surface each picture sees, and in what light.

use crate::ambient;
use crate::atlas::Texel;
use crate::edge::Edge;
use crate::light::{Lit, WORKING_DISTANCE_M};
use crate::look::Look;
use crate::painter::{Painter, Surface};
use crate::sample::{Sample, offer};
use crate::settle::Shot;
use crate::settle::fit::Prior;
use crate::settle::level::encoded;
use crate::settle::view::{Seen, View};
use geometry::TriangleMesh;
use nalgebra::{Point3, Vector3};
use rayon::prelude::*;

/// Points are this far apart, unless they would be too many.
const SPACING_M: f64 = 0.5e-3;
const POINTS_MAX: usize = 80_000;
/// Places on the surface are drawn by this seed.
const SEED: u64 = 1;
/// Points that one task looks at.
const CHUNK: usize = 4096;

/// Points of the surface, in the world.
#[derive(Debug, Clone, Default)]
pub struct Points {
    /// In metres.
    pub places: Vec<Point3<f64>>,
    /// Unit normals of the surface there.
    pub normals: Vec<Vector3<f32>>,
}

/// A point that a picture sees: its number, its light, and how much the picture's word counts.
type InLight = (u32, Lit, f32);

impl Painter {
    /// Points spread over the surface, and for each picture those that it sees. A picture that cannot be painted sees
    /// none.
    pub(super) fn views(&mut self, shots: &[Shot<'_>], prior: &Prior) -> (Points, Vec<View>) {
        let Some(mut surface) = self.surface.take() else {
            return (Points::default(), shots.iter().map(|(_, pose)| View::blind(pose)).collect());
        };
        let texels = points_on(&TriangleMesh::from(&surface.mesh.without_caps()));
        let mut kept = vec![Sample::EMPTY; texels.len() * self.config.samples_per_cell];
        let seen: Vec<Vec<InLight>> =
            shots.iter().map(|shot| self.in_light(&mut surface, shot, prior, &texels, &mut kept)).collect();
        self.surface = Some(surface);
        let ambient = match self.config.ambient {
            Some(known) => known.map(|a| a as f32),
            None => ambient::estimate(&kept, self.config.samples_per_cell),
        };
        let to_seen = |(point, lit, weight): InLight| {
            let scale = ambient.map(|a| encoded(lit.vignetting * (lit.irradiance + a)).recip());
            Seen { point, scale, weight }
        };
        let view = |(seen, (_, pose)): (Vec<InLight>, &Shot<'_>)| {
            let seen = seen.into_iter().map(to_seen).filter(|seen| seen.scale.iter().all(|s| s.is_finite()));
            View { seen: seen.collect(), ..View::blind(pose) }
        };
        let views = seen.into_iter().zip(shots).map(view).collect();
        let place = |texel: &Texel| (Point3::from(texel.position_m.map(f64::from)), Vector3::from(texel.normal));
        let (places, normals) = texels.iter().map(place).unzip();
        (Points { places, normals }, views)
    }

    /// The points that one picture sees, clear of edges in depth even when its pose errs as far as it may.
    fn in_light(
        &self,
        surface: &mut Surface,
        (picture, world_from_camera): &Shot<'_>,
        prior: &Prior,
        texels: &[Texel],
        kept: &mut [Sample],
    ) -> Vec<InLight> {
        if self.refusal(picture, world_from_camera).is_some() {
            return Vec::new();
        }
        let camera_from_world = world_from_camera.inverse();
        let distance_m = f64::from(WORKING_DISTANCE_M);
        let error_px = self.region.camera.fx * prior.turn_rad.hypot(prior.shift_m / distance_m);
        let margin_px = self.config.edge_margin_px as usize + error_px.ceil().min(64.0) as usize;
        let edge = Edge { margin_px, ..self.edge() };
        surface.occlusion.see(&self.region.camera, &camera_from_world, self.region.corner_rad, &edge);
        let look = Look::new(&self.rules, &self.region, picture, &surface.occlusion, &camera_from_world);
        let per_point = self.config.samples_per_cell;
        let chunks = texels.par_chunks(CHUNK).zip(kept.par_chunks_mut(CHUNK * per_point)).enumerate();
        let seen = chunks.map(|(chunk, (texels, kept))| {
            let mut seen = Vec::new();
            for (at, (texel, kept)) in texels.iter().zip(kept.chunks_exact_mut(per_point)).enumerate() {
                let number = (chunk * CHUNK + at) as u32;
                let Ok(place) = look.place(texel) else { continue };
                let Ok(sample) = look.sample(number, &place) else { continue };
                offer(kept, sample);
                seen.push((number, place.lit, place.weight));
            }
            seen
        });
        seen.collect::<Vec<_>>().concat()
    }
}

/// Points spread evenly over a surface.
fn points_on(mesh: &TriangleMesh) -> Vec<Texel> {
    let area = |t: usize| {
        let [a, b, c] = mesh.corners(t).map(|p| p.coords.cast::<f64>());
        0.5 * (b - a).cross(&(c - a)).norm()
    };
    let area_m2: f64 = (0..mesh.triangles.len()).map(area).sum();
    let count = ((area_m2 / SPACING_M.powi(2)) as usize).min(POINTS_MAX);
    let samples = geometry::sample_surface(mesh, count, SEED).unwrap_or_default();
    let texel = |sample: geometry::SurfaceSample| {
        // The surface's smooth normals, as painting has them.
        let corners = mesh.triangles[sample.triangle as usize].map(|i| mesh.normals[i as usize].cast::<f64>());
        let normal = corners[0] * sample.barycentric[0]
            + corners[1] * sample.barycentric[1]
            + corners[2] * sample.barycentric[2];
        Texel {
            place: 0,
            triangle: sample.triangle,
            position_m: sample.point.coords.cast::<f32>().into(),
            normal: normal.try_normalize(1e-9).unwrap_or(sample.normal).cast::<f32>().into(),
            inside: true,
        }
    };
    samples.into_iter().map(texel).collect()
}
