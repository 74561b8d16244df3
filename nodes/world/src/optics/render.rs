//! One picture: see, light, blur, expose.

use super::blur::BlurRows;
use super::fan::{Cuts, Fan};
use super::gain;
use super::line::{self, LaserImage, View};
use super::psf::Psf;
use super::random_field::{NormalTable, SpeckleField};
use super::sensor::{Noise, Sensor};
use super::shade::{Lighting, Patches, ROOM};
use super::stage::Stage;
use super::{OpticsError, OpticsSection};
use crate::random::word;
use crate::{Scene, Simulation};
use geometry::{Camera, METRES_PER_MM, Rig, RigError, VisibilityBuffer};
use nalgebra::{Isometry3, Point3};
use wire::{Frame, Header, Light, PeaksPer, PixelFormat};

/// A camera and its lights before a scene. A picture is a pure function of (scene, rig, seed, index, pose, light).
#[derive(Debug, Clone)]
pub struct CameraModelSim {
    stage: Stage,
    camera: Camera,
    peaks_per: PeaksPer,
    section: OpticsSection,
    fan: Fan,
    psf: Psf,
    sensor: Sensor,
    normal: NormalTable,
    speckle: SpeckleField,
    seed: u64,
    /// The vectors that this machine has. Nothing is fused for them, so bytes are the same with any.
    arch: pulp::Arch,
}

/// Memory that pictures are made in, to be used again; one for each thread.
#[derive(Debug, Clone, Default)]
pub struct Workspace {
    seen: VisibilityBuffer,
    patches: Patches,
    cuts: Cuts,
    laser: LaserImage,
    shaded: Vec<f32>,
    blur: BlurRows,
    row: Vec<f32>,
    places: Vec<u32>,
    levels: Vec<f32>,
}

/// Bins of the fan for each pixel along the longer side of the picture.
const BINS_PER_PIXEL: usize = 2;

impl CameraModelSim {
    /// Prepares a scene for a handset; the same seed gives the same noise.
    pub fn new(scene: &Scene, rig: &Rig, seed: u64) -> Result<Self, OpticsError> {
        rig.check()?;
        let section = Simulation::from_rig(rig)?.optics;
        section.check()?;
        let sheet = rig.sheet().map_err(RigError::from)?;
        let bins = BINS_PER_PIXEL * rig.camera.width.max(rig.camera.height) as usize;
        let line_distance_m = section.laser.line_distance_mm * METRES_PER_MM;
        let blur_m = section.psf_sigma_px * line_distance_m / rig.camera.fx.max(rig.camera.fy);
        Ok(Self {
            stage: Stage::new(scene, section.lamp.level)?,
            camera: rig.camera,
            peaks_per: rig.laser.peaks_per,
            fan: Fan::new(&section.laser, &sheet, bins, blur_m)?,
            psf: Psf::new(section.psf_sigma_px),
            sensor: Sensor::new(&section.sensor),
            normal: NormalTable::new(word(seed, 1)),
            speckle: SpeckleField::new(word(seed, 2)),
            section,
            seed,
            arch: pulp::Arch::new(),
        })
    }

    /// The numbers of light, lens and sensor.
    pub fn section(&self) -> &OpticsSection {
        &self.section
    }

    /// The picture `index`, taken from there. Its header holds nothing but `seq` = `index`: the stamp is the caller's.
    pub fn render(&self, index: u64, world_from_camera: &Isometry3<f64>, light: Light, out: &mut Workspace) -> Frame {
        self.see(world_from_camera, out);
        let lighting = self.lighting(world_from_camera, light);
        let Workspace { seen, patches, cuts, laser, levels, .. } = out;
        patches.clear(self.stage.mesh.triangles.len());
        let gain = if light.laser {
            let fan = self.fan.placed(world_from_camera);
            fan.cut(&self.stage, cuts);
            laser.draw(&self.stage, &fan, cuts, &self.view(world_from_camera, seen), &self.psf);
            gain::of_line(&self.section, &laser.ridge, levels)
        } else {
            gain::of_picture(&self.section, &self.stage, &lighting, seen, patches, levels)
        };
        let data = self.arch.dispatch(Exposure { model: self, index, light, lighting, gain, memory: out });
        let Camera { width, height, .. } = self.camera;
        Frame {
            header: Header { seq: index, ..Header::default() },
            width,
            height,
            stride: 3 * width,
            format: PixelFormat::Rgb8,
            light,
            exposure_nanos: (self.section.exposure_us * 1e3) as i64,
            gain,
            gamma: self.section.sensor.gamma as f32,
            data: data.into(),
        }
    }

    /// The truth for tests and reports: (u, v) in pixels of the line's centre wherever it crosses a row (or a column, as
    /// the rig says), before blur and noise; in the order of the rows, and along each from small to large.
    pub fn truth_stripe(&self, world_from_camera: &Isometry3<f64>, out: &mut Workspace) -> Vec<(f64, f64)> {
        self.see(world_from_camera, out);
        let fan = self.fan.placed(world_from_camera);
        fan.cut(&self.stage, &mut out.cuts);
        line::crossings(&fan, &out.cuts, &self.view(world_from_camera, &out.seen), self.peaks_per)
    }

    fn see(&self, world_from_camera: &Isometry3<f64>, out: &mut Workspace) {
        let [width, height] = [self.camera.width, self.camera.height].map(|size| size as usize);
        if [out.seen.width, out.seen.height] != [width, height] {
            out.seen = VisibilityBuffer::new(width, height);
        }
        out.seen.clear();
        out.seen.cull_back_faces = self.stage.closed;
        out.seen.draw(&self.camera, &world_from_camera.inverse(), &self.stage.mesh, 0);
    }

    fn view<'a>(&'a self, world_from_camera: &Isometry3<f64>, seen: &'a VisibilityBuffer) -> View<'a> {
        let camera_from_world = world_from_camera.inverse();
        View { camera: &self.camera, camera_from_world, eye: world_from_camera * Point3::origin(), seen }
    }

    fn lighting(&self, world_from_camera: &Isometry3<f64>, light: Light) -> Lighting {
        let lamp = world_from_camera * (Point3::from(self.section.lamp.position_mm) * METRES_PER_MM);
        Lighting {
            eye: (world_from_camera * Point3::origin()).cast(),
            lamp: light.lamp.then(|| (lamp.cast(), self.section.lamp.level as f32)),
        }
    }

    #[inline(always)]
    fn expose(&self, index: u64, light: Light, lighting: &Lighting, gain: f32, out: &mut Workspace) -> Vec<u8> {
        let Workspace { seen, patches, laser, shaded, blur, row: line, places, .. } = out;
        let (width, height) = (seen.width, seen.height);
        let mut data = vec![0; 3 * width * height];
        shaded.resize(3 * (width + ROOM), 0.0);
        line.resize(3 * width, 0.0);
        places.resize(3 * width, 0);
        let weights = self.psf.centred();
        blur.reset(width, weights.len());
        let key = word(self.seed, index);
        let mut taken = 0;
        for (row, bytes) in data.chunks_exact_mut(3 * width).enumerate() {
            while taken < height && taken <= row + self.psf.radius {
                patches.shade_row(taken, &self.stage, lighting, seen, shaded);
                blur.push(taken, shaded, weights);
                taken += 1;
            }
            blur.blurred(row, height, weights, line);
            if light.laser {
                self.add_laser(key, row, laser, line);
            }
            self.dim_corners(row, line);
            let noise = Noise { table: &self.normal, key, first_block: (row as u64) << 32 };
            self.sensor.expose(line, gain, noise, places, bytes);
        }
        data
    }

    /// The laser's light with its speckle, in what each channel makes of 635 nm.
    fn add_laser(&self, key: u64, row: usize, laser: &LaserImage, line: &mut [f32]) {
        let width = line.len() / 3;
        let entry = SpeckleField::entry(key);
        let contrast = self.section.laser.speckle_contrast as f32;
        let response = self.section.laser.response.map(|share| share as f32);
        let [first, last] = laser.spans[row];
        for column in first as usize..last as usize {
            let speckle = 1.0 + contrast * self.speckle.at(entry, column, row);
            let light = laser.light[row * width + column] * speckle.max(0.0);
            for (channel, share) in response.iter().enumerate() {
                line[channel * width + column] += share * light;
            }
        }
    }

    /// Natural vignetting: cos⁴ of the angle to the axis.
    #[inline(always)]
    fn dim_corners(&self, row: usize, line: &mut [f32]) {
        let strength = self.section.vignetting as f32;
        if strength == 0.0 {
            return;
        }
        let Camera { fx, fy, cx, cy, .. } = self.camera;
        let (scale, centre) = ((1.0 / fx) as f32, cx as f32);
        let y = ((row as f64 - cy) / fy) as f32;
        let start = 1.0 + y * y;
        let (red, rest) = line.split_at_mut(self.camera.width as usize);
        let (green, blue) = rest.split_at_mut(self.camera.width as usize);
        for (column, ((red, green), blue)) in red.iter_mut().zip(green).zip(blue).enumerate() {
            let x = (column as u32 as i32 as f32 - centre) * scale;
            let square = start + x * x;
            let kept = 1.0 - strength * (1.0 - 1.0 / (square * square));
            let kept = if kept > 0.0 { kept } else { 0.0 };
            (*red, *green, *blue) = (*red * kept, *green * kept, *blue * kept);
        }
    }
}

/// One exposure, to be compiled for each kind of vectors (a closure would be compiled once, for the least of them).
struct Exposure<'a> {
    model: &'a CameraModelSim,
    index: u64,
    light: Light,
    lighting: Lighting,
    gain: f32,
    memory: &'a mut Workspace,
}

impl pulp::NullaryFnOnce for Exposure<'_> {
    type Output = Vec<u8>;

    #[inline(always)]
    fn call(self) -> Vec<u8> {
        self.model.expose(self.index, self.light, &self.lighting, self.gain, self.memory)
    }
}
