//! The picture of the laser's line: each lit piece of surface throws its light where the lens puts it.

use super::fan::{Cut, Cuts, Placed};
use super::psf::{MOST_TAPS, Psf};
use super::stage::Stage;
use super::texture;
use geometry::{Camera, VisibilityBuffer};
use nalgebra::{Isometry3, Point2, Point3, Vector3};
use wire::PeaksPer;

/// Light of the laser alone, red, before the vignette; and where there is any.
#[derive(Debug, Clone, Default)]
pub(super) struct LaserImage {
    width: usize,
    pub light: Vec<f32>,
    /// First and last lit column of each row, the last excluded.
    pub spans: Vec<[u32; 2]>,
    /// The light on the line's ridge, along it.
    pub ridge: Vec<f32>,
}

/// Where a picture is taken from.
pub(super) struct View<'a> {
    pub camera: &'a Camera,
    pub camera_from_world: Isometry3<f64>,
    pub eye: Point3<f64>,
    pub seen: &'a VisibilityBuffer,
}

/// Pieces of the line are no longer than this on the picture ...
const PIECE_PX: f64 = 0.5;
/// ... but no more of them than this are made of one direction of the fan.
const MOST_PIECES: usize = 24;
/// A point counts as seen when it is no farther behind what the picture shows there; in shares of the depth.
const BEHIND: f32 = 2e-3;

impl View<'_> {
    fn project(&self, p_in_world: &Point3<f64>) -> Option<(Point2<f64>, Point3<f64>)> {
        let p_in_camera = self.camera_from_world * p_in_world;
        Some((self.camera.project(&p_in_camera)?, p_in_camera))
    }

    /// Not hidden: before the farthest of the four pixels around it.
    fn sees(&self, pixel: &Point2<f64>, depth_m: f64) -> bool {
        if !self.camera.contains(pixel) {
            return false;
        }
        let seen = self.seen;
        let [u, v] = [pixel.x.max(0.0) as usize, pixel.y.max(0.0) as usize];
        let [u_next, v_next] = [(u + 1).min(seen.width - 1), (v + 1).min(seen.height - 1)];
        let around = [(u, v), (u_next, v), (u, v_next), (u_next, v_next)];
        let farthest = around.map(|(u, v)| seen.inverse_depth[v * seen.width + u]).into_iter().fold(f32::MAX, f32::min);
        1.0 / depth_m as f32 >= farthest * (1.0 - BEHIND)
    }
}

impl LaserImage {
    fn clear(&mut self, width: usize, height: usize) {
        if [self.width, self.spans.len()] == [width, height] {
            // Most of it is dark already.
            for (row, [first, last]) in self.light.chunks_exact_mut(width).zip(&self.spans) {
                if let Some(lit) = row.get_mut(*first as usize..*last as usize) {
                    lit.fill(0.0);
                }
            }
        } else {
            self.width = width;
            self.light.clear();
            self.light.resize(width * height, 0.0);
        }
        self.spans.clear();
        self.spans.resize(height, [width as u32, 0]);
        self.ridge.clear();
    }

    /// Light of all layers, blurred by the lens.
    pub fn draw(&mut self, stage: &Stage, fan: &Placed, cuts: &Cuts, view: &View, psf: &Psf) {
        self.clear(view.seen.width, view.seen.height);
        for layer in 0..fan.layers() {
            for (bin, cut) in fan.lit(cuts, layer) {
                self.draw_cut(stage, fan, (layer, bin, cut), view, psf);
            }
        }
        let middle = fan.middle();
        for (bin, cut) in fan.lit(cuts, middle) {
            let Some((pixel, _)) = view.project(&fan.point(middle, bin, cut, 0.0)) else { continue };
            if view.camera.contains(&pixel) {
                let [u, v] = [pixel.x, pixel.y].map(|x| (x + 0.5).max(0.0) as usize);
                let light = self.light[v.min(view.seen.height - 1) * self.width + u.min(self.width - 1)];
                self.ridge.extend((light > 0.0).then_some(light));
            }
        }
    }

    fn draw_cut(
        &mut self,
        stage: &Stage,
        fan: &Placed,
        (layer, bin, cut): (usize, usize, &Cut),
        view: &View,
        psf: &Psf,
    ) {
        let ends = [-0.5, 0.5].map(|by| view.project(&fan.point(layer, bin, cut, by)));
        let [Some((from, _)), Some((to, _))] = ends else { return };
        let pieces = (((to - from).norm() / PIECE_PX).ceil() as usize).clamp(1, MOST_PIECES);
        let flux = fan.flux(layer, bin) / pieces as f64;
        for piece in 0..pieces {
            let p_in_world = fan.point(layer, bin, cut, (piece as f64 + 0.5) / pieces as f64 - 0.5);
            let Some((pixel, p_in_camera)) = view.project(&p_in_world) else { continue };
            if view.sees(&pixel, p_in_camera.z) {
                let light = flux * view.pixels_per_area(stage, cut.triangle, &p_in_world, &p_in_camera);
                let albedo = albedo(stage, cut.triangle, &p_in_world, &fan.source, &view.eye);
                self.splat(psf, pixel, light as f32 * albedo);
            }
        }
    }

    fn splat(&mut self, psf: &Psf, pixel: Point2<f64>, light: f32) {
        let (mut across, mut down) = ([0.0; MOST_TAPS], [0.0; MOST_TAPS]);
        let (left, top) = (psf.at(pixel.x as f32, &mut across), psf.at(pixel.y as f32, &mut down));
        let taps = psf.taps();
        let first = left.max(0) as usize;
        let last = (left + taps as isize).clamp(0, self.width as isize) as usize;
        if first >= last {
            return;
        }
        let across = &across[(first as isize - left) as usize..][..last - first];
        for (row, weight) in (top..).zip(&down[..taps]) {
            let Ok(row) = usize::try_from(row) else { continue };
            let Some(span) = self.spans.get_mut(row) else { break };
            *span = [span[0].min(first as u32), span[1].max(last as u32)];
            let out = &mut self.light[row * self.width + first..row * self.width + last];
            let light = light * weight;
            out.iter_mut().zip(across).for_each(|(pixel, across)| *pixel += light * across);
        }
    }
}

impl View<'_> {
    /// Pixels that a square metre of surface covers: its slant, its distance, and the lens's scale.
    fn pixels_per_area(&self, stage: &Stage, triangle: u32, p_in_world: &Point3<f64>, p: &Point3<f64>) -> f64 {
        let to_eye = (self.eye - p_in_world).normalize();
        let normal = stage.mesh.area_normal(triangle as usize).cast::<f64>();
        let slant = normal.try_normalize(0.0).map_or(0.0, |normal| normal.dot(&to_eye).abs());
        // A pixel's solid angle is cos³ / (fx fy); area cos(slant) / d² is the surface's, and d = z / cos.
        slant * self.camera.fx * self.camera.fy * p.coords.norm() / p.z.powi(3)
    }
}

/// What a surface sends to the eye of the laser's light, beside a white and matt one.
fn albedo(stage: &Stage, triangle: u32, p: &Point3<f64>, source: &Point3<f64>, eye: &Point3<f64>) -> f32 {
    let index = triangle as usize;
    let corners = stage.mesh.triangles[index].map(|i| i as usize);
    let weights = barycentric(&stage.mesh.corners(index), &p.cast());
    let finish = stage.finish_of(index);
    let red = match &finish.texture {
        Some(picture) => picture.sample(texture::blend(corners.map(|i| stage.mesh.uv[i]), weights)).to_array()[0],
        None => (0..3).map(|i| weights[i] * stage.albedo[corners[i]][0]).sum(),
    };
    if finish.specular <= 0.0 {
        return red;
    }
    let normal: Vector3<f32> = (0..3).map(|i| stage.mesh.normals[corners[i]] * weights[i]).sum();
    let unit = |v: Vector3<f64>| v.cast::<f32>().try_normalize(0.0).unwrap_or_else(Vector3::z);
    let (to_light, to_eye) = (unit(source - p), unit(eye - p));
    red + finish.gloss(&normal.try_normalize(0.0).unwrap_or_else(Vector3::z), &to_light, &to_eye)
}

/// The share of each corner at a point in the triangle's plane.
fn barycentric([a, b, c]: &[Point3<f32>; 3], p: &Point3<f32>) -> [f32; 3] {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let normal = ab.cross(&ac);
    let square = normal.norm_squared();
    if square <= 0.0 {
        return [1.0, 0.0, 0.0];
    }
    let to_b = (ap.cross(&ac).dot(&normal) / square).clamp(0.0, 1.0);
    let to_c = (ab.cross(&ap).dot(&normal) / square).clamp(0.0, 1.0 - to_b);
    [1.0 - to_b - to_c, to_b, to_c]
}

/// The true centre of the line where it crosses rows (or columns): the middle layer, where it is seen.
pub(super) fn crossings(fan: &Placed, cuts: &Cuts, view: &View, peaks_per: PeaksPer) -> Vec<(f64, f64)> {
    // Along the line first, across it second.
    let turned = |p: Point2<f64>| match peaks_per {
        PeaksPer::Row => [p.y, p.x],
        PeaksPer::Column => [p.x, p.y],
    };
    let layer = fan.middle();
    let mut found = Vec::new();
    let mut before: Option<(usize, Point2<f64>, Point2<f64>)> = None;
    for (bin, cut) in fan.lit(cuts, layer) {
        let seen = view.project(&fan.point(layer, bin, cut, 0.0)).filter(|(pixel, p)| view.sees(pixel, p.z));
        let ends = [-0.5, 0.5].map(|by| view.project(&fan.point(layer, bin, cut, by)));
        let (Some((middle, _)), [Some((from, _)), Some((to, _))]) = (seen, ends) else {
            before = None;
            continue;
        };
        // Two cuts in a row are one line when one ends where the next begins.
        const TOGETHER_PX: f64 = 0.5;
        if let Some((_, start, _)) =
            before.filter(|(last, _, end)| last + 1 == bin && (end - from).norm() < TOGETHER_PX)
        {
            cross_lines(turned(start), turned(middle), &mut found);
        }
        before = Some((bin, middle, to));
    }
    found.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    found
        .iter()
        .map(|&[along, across]| match peaks_per {
            PeaksPer::Row => (across, along),
            PeaksPer::Column => (along, across),
        })
        .collect()
}

/// Where the way from a to b passes a whole number.
fn cross_lines(a: [f64; 2], b: [f64; 2], found: &mut Vec<[f64; 2]>) {
    let (low, high) = if a[0] <= b[0] { (a, b) } else { (b, a) };
    let mut line = low[0].ceil();
    while line < high[0] {
        let t = (line - low[0]) / (high[0] - low[0]);
        found.push([line, low[1] + t * (high[1] - low[1])]);
        line += 1.0;
    }
}
