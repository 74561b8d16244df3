//! Lamp and room light on what the camera sees. Light is computed at the corners of each visible triangle and runs
//! evenly over its pixels; a texture is looked up at each pixel.

use super::stage::Stage;
use super::texture::LinearTexture;
use geometry::{NO_TRIANGLE, VisibilityBuffer};
use nalgebra::{Point3, Vector3};
use wide::f32x4;

/// What lights a picture, beside the laser and the room.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lighting {
    /// The camera's centre, in the world.
    pub eye: Point3<f32>,
    /// The lamp, when it is on: where in the world, and the signal of a white surface square to it at [`LAMP_DISTANCE_M`].
    pub lamp: Option<(Point3<f32>, f32)>,
}

/// Where the lamp's level is stated.
pub(super) const LAMP_DISTANCE_M: f32 = 0.2;
/// What is seen where there is nothing: a far wall's share of the room's light.
const NOTHING: f32 = 0.02;

/// Pixels that are written at a time, and from one look at a texture to the next, at most.
const LANES: usize = 4;
/// A row of light has so much room behind each of its channels: a run's last pixels are written whole, and what lies
/// behind them is written over by the next run.
pub(super) const ROOM: usize = LANES - 1;

/// Four values that are linear over a triangle's pixels: red, green, blue; or, under a texture, light, gloss, u and v.
#[derive(Debug, Clone, Copy)]
struct Patch {
    /// Where `value` holds.
    origin: [f32; 2],
    value: [f32; 4],
    per_u: [f32; 4],
    per_v: [f32; 4],
    /// Whose triangle.
    owner: u16,
}

/// The patches of one picture, made when first seen.
#[derive(Debug, Clone, Default)]
pub(super) struct Patches {
    /// One more than the patch's place, for each triangle; 0 is none yet.
    slots: Vec<u32>,
    patches: Vec<Patch>,
}

impl Patches {
    pub fn clear(&mut self, triangles: usize) {
        self.slots.clear();
        self.slots.resize(triangles, 0);
        self.patches.clear();
    }

    #[inline(always)]
    fn of(&mut self, triangle: u32, stage: &Stage, light: &Lighting, seen: &VisibilityBuffer) -> &Patch {
        let slot = &mut self.slots[triangle as usize];
        if *slot == 0 {
            self.patches.push(patch(triangle as usize, stage, light, seen));
            *slot = self.patches.len() as u32;
        }
        &self.patches[*slot as usize - 1]
    }

    /// The light of one pixel.
    pub fn shade_pixel(
        &mut self,
        column: usize,
        row: usize,
        stage: &Stage,
        light: &Lighting,
        seen: &VisibilityBuffer,
    ) -> [f32; 3] {
        let triangle = seen.triangle[row * seen.width + column];
        if triangle == NO_TRIANGLE {
            return [nothing(stage); 3];
        }
        let patch = self.of(triangle, stage, light, seen);
        let [a, b, c, d] = patch.start(column, row);
        match &stage.finish_of(triangle as usize).texture {
            None => [a, b, c],
            Some(picture) => {
                let [red, green, blue, _] = (picture.sample([c, d]) * a + f32x4::splat(b)).to_array();
                [red, green, blue]
            }
        }
    }

    /// The light of one row of pixels: red, then green, then blue, each with its [`ROOM`].
    #[inline(always)]
    pub fn shade_row(&mut self, row: usize, stage: &Stage, light: &Lighting, seen: &VisibilityBuffer, out: &mut [f32]) {
        let triangles = &seen.triangle[row * seen.width..][..seen.width];
        let (red, rest) = out.split_at_mut(seen.width + ROOM);
        let (green, blue) = rest.split_at_mut(seen.width + ROOM);
        let mut first = 0;
        while first < triangles.len() {
            let triangle = triangles[first];
            let count = triangles[first..].iter().take_while(|next| **next == triangle).count();
            let out = [&mut red[first..], &mut green[first..], &mut blue[first..]];
            if triangle == NO_TRIANGLE {
                out.into_iter().for_each(|channel| channel[..count].fill(nothing(stage)));
            } else {
                let patch = self.of(triangle, stage, light, seen);
                match &stage.finish[usize::from(patch.owner)].texture {
                    None => patch.fill_plain(first, row, count, out),
                    Some(picture) => patch.fill_textured(first, row, count, picture, out),
                }
            }
            first += count;
        }
    }
}

impl Patch {
    fn start(&self, column: usize, row: usize) -> [f32; 4] {
        let [u, v] = [column as f32 - self.origin[0], row as f32 - self.origin[1]];
        std::array::from_fn(|k| self.value[k] + self.per_u[k] * u + self.per_v[k] * v)
    }

    #[inline(always)]
    fn fill_plain(&self, column: usize, row: usize, count: usize, mut out: [&mut [f32]; 3]) {
        let start = self.start(column, row);
        for first in (0..count).step_by(LANES) {
            let along = lanes() + f32x4::splat(first as f32);
            for (k, out) in out.iter_mut().enumerate() {
                write(f32x4::splat(start[k]) + f32x4::splat(self.per_u[k]) * along, &mut out[first..]);
            }
        }
    }

    /// The texture is looked up once in each of its own pixels where those are the larger ones, up to every
    /// [`LANES`], and runs evenly in between.
    #[inline(always)]
    fn fill_textured(
        &self,
        column: usize,
        row: usize,
        count: usize,
        picture: &LinearTexture,
        mut out: [&mut [f32]; 3],
    ) {
        let start = self.start(column, row);
        let at = |k: usize, i: usize| start[k] + self.per_u[k] * i as f32;
        let look = |i: usize| picture.sample([at(2, i), at(3, i)]);
        let apart = (1.0 / picture.pixels_along([self.per_u[2], self.per_u[3]])).clamp(1.0, LANES as f32);
        let apart = apart as usize;
        let (mut first, mut from) = (0, look(0));
        let [light_step, gloss_step] = [0, 1].map(|k| lanes() * self.per_u[k]);
        while first < count {
            let length = apart.min(count - first);
            let to = look(first + length);
            let (seen, step) = (from.to_array(), ((to - from) * (1.0 / length as f32)).to_array());
            let (light, gloss) = (light_step + f32x4::splat(at(0, first)), gloss_step + f32x4::splat(at(1, first)));
            for (k, out) in out.iter_mut().enumerate() {
                write((lanes() * step[k] + f32x4::splat(seen[k])) * light + gloss, &mut out[first..]);
            }
            (first, from) = (first + length, to);
        }
    }
}

#[inline(always)]
fn lanes() -> f32x4 {
    f32x4::new([0.0, 1.0, 2.0, 3.0])
}

/// Writes the next pixels of a channel; with its room it has as many.
#[inline(always)]
fn write(values: f32x4, channel: &mut [f32]) {
    if let Some(pixels) = channel.first_chunk_mut::<LANES>() {
        *pixels = values.to_array();
    }
}

fn nothing(stage: &Stage) -> f32 {
    stage.ambient.first().map_or(0.0, |light| light * NOTHING)
}

#[inline(never)]
fn patch(triangle: usize, stage: &Stage, light: &Lighting, seen: &VisibilityBuffer) -> Patch {
    let corners = stage.mesh.triangles[triangle].map(|i| i as usize);
    let values = corners.map(|corner| corner_value(triangle, corner, stage, light));
    let mean = std::array::from_fn(|k| (values[0][k] + values[1][k] + values[2][k]) / 3.0);
    let owner = stage.owner[triangle];
    let flat = Patch { origin: [0.0; 2], value: mean, per_u: [0.0; 4], per_v: [0.0; 4], owner };
    let [Some(a), Some(b), Some(c)] = corners.map(|corner| seen.projected(corner)) else { return flat };
    let (ab, ac) = ([b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]]);
    let doubled_area = ab[0] * ac[1] - ab[1] * ac[0];
    if doubled_area.abs() < 1e-6 {
        return flat;
    }
    let scale = 1.0 / doubled_area;
    let to_b: [f32; 4] = std::array::from_fn(|k| (values[1][k] - values[0][k]) * scale);
    let to_c: [f32; 4] = std::array::from_fn(|k| (values[2][k] - values[0][k]) * scale);
    Patch {
        origin: [a[0], a[1]],
        value: values[0],
        per_u: std::array::from_fn(|k| to_b[k] * ac[1] - to_c[k] * ab[1]),
        per_v: std::array::from_fn(|k| to_c[k] * ab[0] - to_b[k] * ac[0]),
        owner,
    }
}

fn corner_value(triangle: usize, corner: usize, stage: &Stage, lighting: &Lighting) -> [f32; 4] {
    let (p, finish) = (&stage.mesh.vertices[corner], stage.finish_of(triangle));
    let (mut light, mut gloss) = (stage.ambient[corner], 0.0);
    if let Some((lamp, level)) = &lighting.lamp {
        let to_eye = (lighting.eye - p).try_normalize(0.0).unwrap_or_else(Vector3::z);
        // The back of an open surface is seen as its front.
        let outward = stage.mesh.normals[corner];
        let facing = if stage.closed || stage.mesh.area_normal(triangle).dot(&to_eye) > 0.0 { 1.0 } else { -1.0 };
        let normal = outward * facing;
        let to_lamp = lamp - p;
        let distance = to_lamp.norm().max(1e-3);
        let to_lamp = to_lamp / distance;
        let irradiance = level * (LAMP_DISTANCE_M / distance).powi(2) * normal.dot(&to_lamp).max(0.0);
        light += irradiance;
        if irradiance > 0.0 {
            gloss = irradiance * finish.gloss(&normal, &to_lamp, &to_eye);
        }
    }
    if finish.texture.is_some() {
        let [u, v] = stage.mesh.uv[corner];
        return [light, gloss, u, v];
    }
    let [red, green, blue] = stage.albedo[corner].map(|albedo| albedo * light + gloss);
    [red, green, blue, 0.0]
}
