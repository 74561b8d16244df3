//! A sweep over the known world without pictures: each frame's points are the exact meeting of laser rays and surfaces,
//! seen by the camera, with noise and outliers of stated size; the tracker is the simulator's.

#![allow(dead_code, reason = "each user needs its own part")]
#![allow(clippy::unwrap_used, reason = "helpers of tests")]

use geometry::{
    Camera, MeshIndex, Rig, SmoothTrajectory, Smoothing, TimedPose, TriangleMesh, rigid_from_wire, rigid_to_wire,
};
use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion, Vector3};
use rayon::prelude::*;
use refine::{Config, Refiner};
use wire::{Calibration, Extent, Header, Phase, Pose, Profile, ProfilePoint, Scan, ScanPoint};
use world::{Hand, Scene, Tracker};

pub mod measure;

/// What is swept, how, and with which errors.
#[derive(Clone)]
pub struct Spec {
    /// Keys of `[simulation.tracker]` that differ from a perfect tracker.
    pub tracker: String,
    /// A file of config/rigs; its tracker is used when `tracker` is empty.
    pub rig: &'static str,
    pub seconds: f64,
    pub seed: u64,
    /// Laser rays in a frame; about four in five are seen.
    pub rays: usize,
    pub rate_hz: f64,
    pub range_noise_mm: f64,
    pub outliers: f64,
    /// What the calibration gets wrong: millimetres and degrees of the hand-eye transform, along (1, 1, 1).
    pub hand_eye_error: [f64; 2],
    /// All strokes of one direction.
    pub one_way: bool,
    pub scene: &'static str,
    /// At this moment the thing, but not the table, is pushed by so much.
    pub pushed: Option<(f64, Vector3<f64>)>,
}

impl Default for Spec {
    fn default() -> Self {
        Self {
            tracker: "position_noise_mm = 0".into(),
            rig: "paper.toml",
            seconds: 60.0,
            seed: 1,
            rays: 245,
            rate_hz: 25.0,
            range_noise_mm: 0.1,
            outliers: 0.015,
            hand_eye_error: [0.0; 2],
            one_way: false,
            scene: "",
            pushed: None,
        }
    }
}

const PERFECT: &str = "position_noise_mm = 0\nrotation_noise_deg = 0\nfield_position_mm = 0\nfield_rotation_deg = 0\n\
    field_growth = 0\nposition_step_mm = 0\nrotation_step_deg = 0\nfilter_rest_s = 0\nfilter_moving_s = 0\nlatency_s = 0\n\
    clock_offset_s = 0\nstamp_jitter_s = 0\ndropped = 0";

impl Spec {
    /// The trackers of the table in the issue: W, C, M, O, X (three times W), P (paper.toml as it is), F (fine.toml).
    pub fn named(name: &str, seed: u64) -> Self {
        let spec = Self { seed, ..Self::default() };
        let tracker = |keys: &str| keys.to_owned();
        match name {
            "perfect" => spec,
            "W" => Self { tracker: tracker("position_noise_mm = 1.5\nrotation_noise_deg = 3.0"), ..spec },
            "X" => Self { tracker: tracker("position_noise_mm = 4.5\nrotation_noise_deg = 9.0"), ..spec },
            "C" => Self {
                tracker: tracker(
                    "position_noise_mm = 0.5\nrotation_noise_deg = 0.3\nfield_position_mm = 3\nfield_rotation_deg = 2.5\n\
                     field_wavelength_m = 1",
                ),
                ..spec
            },
            "M" => Self {
                tracker: tracker(
                    "position_noise_mm = 1\nrotation_noise_deg = 1.5\nfield_position_mm = 1.5\nfield_rotation_deg = 1.5\n\
                     field_wavelength_m = 1\nclock_offset_s = 0.015",
                ),
                hand_eye_error: [1.0, 1.0],
                ..spec
            },
            "O" => Self {
                tracker: tracker(
                    "position_noise_mm = 0.5\nrotation_noise_deg = 0.3\ndrift_position_mm = 1\ndrift_rotation_deg = 1.5\n\
                     drift_time_s = 0.3\nposition_step_mm = 0.11\nrotation_step_deg = 0.022\nfilter_rest_s = 0.05\n\
                     filter_moving_s = 0.005\nstamp_jitter_s = 0.0002\ndropped = 0.01\ndropped_in_a_row = 3",
                ),
                ..spec
            },
            "P" => Self { tracker: String::new(), ..spec },
            "F" => {
                Self { tracker: String::new(), rig: "fine.toml", rate_hz: 60.0, rays: 60, range_noise_mm: 0.05, ..spec }
            }
            other => panic!("no tracker {other}"),
        }
    }

    fn rig(&self) -> Rig {
        let file = format!("{}/../../config/rigs/{}", env!("CARGO_MANIFEST_DIR"), self.rig);
        let mut rig: toml::Table = std::fs::read_to_string(file).unwrap().parse().unwrap();
        if !self.tracker.is_empty() {
            let mut section: toml::Table = PERFECT.parse().unwrap();
            section.extend(self.tracker.parse::<toml::Table>().unwrap());
            rig["simulation"].as_table_mut().unwrap().insert("tracker".into(), section.into());
            rig["clock"].as_table_mut().unwrap().insert("pose_offset_s".into(), 0.0.into());
        }
        Rig::parse(&toml::to_string(&rig).unwrap()).unwrap()
    }
}

/// A sweep, and the truth.
pub struct Sweep {
    pub calibration: Calibration,
    pub poses: Vec<Pose>,
    pub profiles: Vec<Profile>,
    /// For each profile, which of its points are outliers.
    pub wild: Vec<Vec<bool>>,
    pub truth: MeshIndex,
    /// Triangles below this number are the thing's, the others the table's.
    pub thing_triangles: u32,
    pub hand: Hand,
    pub seconds: f64,
}

impl Sweep {
    pub fn new(spec: &Spec) -> Self {
        let rig = spec.rig();
        let scene =
            if spec.scene.is_empty() { Scene::cow().unwrap() } else { Scene::parse(spec.scene, "".as_ref()).unwrap() };
        let hand = Hand::new(&scene, &rig, spec.seconds, spec.seed).unwrap();
        let tracker = Tracker::new(&rig, hand.clone(), spec.seed).unwrap();
        let poses: Vec<Pose> = (0..tracker.count()).into_par_iter().filter_map(|i| tracker.sample(i)).collect();
        let thing = scene.subject().mesh.clone();
        let scene_with = |thing: &TriangleMesh| {
            let mut whole = thing.clone();
            let others = scene.surfaces.iter().enumerate().filter(|(i, _)| *i != scene.subject);
            others.for_each(|(_, surface)| whole.append(&surface.mesh));
            MeshIndex::new(&whole).unwrap()
        };
        let truth = scene_with(&thing);
        let afterwards = spec.pushed.map(|(_, by)| {
            let vertices = thing.vertices.iter().map(|p| p + by.cast::<f32>()).collect();
            scene_with(&TriangleMesh { vertices, ..thing.clone() })
        });
        let eye = Eye::new(&rig, spec);
        let frames = (spec.seconds * spec.rate_hz) as u64;
        let lit = (0..frames).filter(|k| k % 6 != 0).filter(|k| {
            let t_s = (*k as f64 + 0.5) / spec.rate_hz;
            hand.phase(t_s) != Phase::Aim && (!spec.one_way || one_way(&hand, &rig, t_s))
        });
        let lit: Vec<u64> = lit.collect();
        let seen: Vec<(Profile, Vec<bool>)> = lit
            .into_par_iter()
            .map(|k| {
                let t_s = (k as f64 + 0.5) / spec.rate_hz;
                let pushed = afterwards.as_ref().filter(|_| spec.pushed.is_some_and(|(from, _)| t_s > from));
                eye.profile(pushed.unwrap_or(&truth), &hand.world_from_camera(t_s), t_s, k)
            })
            .collect();
        let (profiles, wild) = seen.into_iter().unzip();
        let mut calibration = rig.calibration().unwrap();
        let [mm, degrees] = spec.hand_eye_error;
        let along = Vector3::new(1.0, 1.0, 1.0).normalize();
        let off = Isometry3::from_parts(
            Translation3::from(along * mm * 1e-3),
            UnitQuaternion::new(along * degrees.to_radians()),
        );
        calibration.body_from_camera = rigid_to_wire(&(rig.body_from_camera().unwrap() * off));
        let thing_triangles = thing.triangles.len() as u32;
        Self { calibration, poses, profiles, wild, truth, thing_triangles, hand, seconds: spec.seconds }
    }

    /// A refiner that has been told everything, in the order of the stamps.
    pub fn refiner(&self, config: Config) -> Refiner {
        let mut refiner = Refiner::new(config, &self.calibration).unwrap();
        self.poses.iter().for_each(|pose| refiner.pose(pose));
        self.profiles.iter().for_each(|profile| refiner.profile(profile));
        refiner
    }

    /// The points as the smoothed tracker alone places them.
    pub fn smoothed(&self) -> Vec<Scan> {
        let offset = self.calibration.pose_offset_nanos;
        let reading = |pose: &Pose| TimedPose {
            stamp_nanos: pose.header.stamp_nanos + offset,
            pose: rigid_from_wire(&pose.world_from_body).unwrap(),
            position_sigma_m: 1e-3,
            rotation_sigma_rad: 1e-2,
        };
        let readings: Vec<TimedPose> = self.poses.iter().map(reading).collect();
        let way = SmoothTrajectory::fit(&readings, &Smoothing::default()).unwrap();
        let hand_eye = rigid_from_wire(&self.calibration.body_from_camera).unwrap();
        let scan = |profile: &Profile| {
            let world_from_camera = way.at(profile.header.stamp_nanos)? * hand_eye;
            let place = |point: &ProfilePoint| ScanPoint {
                position_m: (world_from_camera * Point3::from(point.position_m).cast::<f64>()).cast::<f32>().into(),
                ..ScanPoint::default()
            };
            Some(Scan {
                header: profile.header,
                extent: Extent::Whole,
                world_from_camera: rigid_to_wire(&world_from_camera),
                position_sigma_m: 0.0,
                rotation_sigma_rad: 0.0,
                region_sigma_m: 0.0,
                points: profile.points.iter().map(place).collect(),
                refused: vec![],
            })
        };
        self.profiles.iter().filter_map(scan).collect()
    }

    /// The true way of the camera.
    pub fn world_from_camera(&self, stamp_nanos: i64) -> Isometry3<f64> {
        self.hand.world_from_camera(stamp_nanos as f64 * 1e-9)
    }
}

/// True while the thing is seen from one side with the stripe upright.
fn one_way(hand: &Hand, rig: &Rig, t_s: f64) -> bool {
    let along = rig.sheet().unwrap().normal.cross(&Vector3::z()).normalize();
    let way = hand.world_from_camera(t_s);
    let [x, y] = [way.translation.x, way.translation.y];
    (way.rotation * along).z.abs() > 0.8 && x > 0.0 && y.abs() < 0.5 * x
}

struct Eye {
    camera: Camera,
    source: Point3<f64>,
    /// Down the middle of the fan, and along the line.
    axes: [Vector3<f64>; 2],
    spec: Spec,
}

/// Tangent of half the fan's opening: 12 cm at 20 cm.
const REACH: f64 = 0.3;
const FAR_M: f64 = 0.45;

impl Eye {
    fn new(rig: &Rig, spec: &Spec) -> Self {
        let sheet = rig.sheet().unwrap();
        let n = sheet.normal;
        // Where the sheet passes beside the lens.
        let across = Vector3::new(n.x, n.y, 0.0);
        let source = Point3::from(across * (sheet.distance_m / across.norm_squared()));
        let along = n.cross(&Vector3::z()).normalize();
        let down = along.cross(&n).normalize();
        let down = if down.z < 0.0 { -down } else { down };
        Self { camera: rig.camera, source, axes: [down, along], spec: spec.clone() }
    }

    fn profile(&self, truth: &MeshIndex, way: &Isometry3<f64>, t_s: f64, k: u64) -> (Profile, Vec<bool>) {
        let spec = &self.spec;
        let mut random = Random(spec.seed.wrapping_mul(0x9e37_79b9).wrapping_add(k << 20));
        let (mut points, mut wild) = (Vec::new(), Vec::new());
        for ray in 0..spec.rays {
            let at = REACH * (2.0 * (ray as f64 + random.uniform()) / spec.rays as f64 - 1.0);
            let direction = (self.axes[0] + self.axes[1] * at).normalize();
            let Some(hit) = truth.cast(&(way * self.source), &(way * direction), FAR_M) else { continue };
            let p = way.inverse_transform_point(&hit.point);
            let normal = way.inverse_transform_vector(&truth.normal(hit.triangle));
            let facing = normal.dot(&-p.coords.normalize()).min(normal.dot(&-direction));
            let Some(pixel) = self.camera.project(&p).filter(|pixel| self.camera.contains(pixel)) else { continue };
            let eye = Point3::from(way.translation.vector);
            let blocked = truth.cast(&eye, &(hit.point - eye), 1.0 - 1e-3 / p.coords.norm());
            if facing < 0.17 || blocked.is_some() {
                continue;
            }
            let is_wild = random.uniform() < spec.outliers;
            let noise = random.normal() * spec.range_noise_mm * 1e-3;
            let sign = if random.uniform() < 0.5 { -1.0 } else { 1.0 };
            let error = if is_wild { sign * (3.0 + 27.0 * random.uniform()) * 1e-3 } else { noise };
            let position = p.coords + p.coords.normalize() * error;
            points.push(ProfilePoint {
                position_m: position.cast::<f32>().into(),
                range_sigma_m: (spec.range_noise_mm * 1e-3) as f32,
                lateral_sigma_m: 1e-5,
                amplitude: 100.0,
                line: pixel.y as u32,
            });
            wild.push(is_wild);
        }
        let header =
            Header { phase: Phase::Both, seq: k, stamp_nanos: (t_s * 1e9).round() as i64, ..Header::default() };
        (Profile { header, points: points.into(), refused: vec![] }, wild)
    }
}

/// SplitMix64.
struct Random(u64);

impl Random {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (((z ^ (z >> 31)) >> 11) as f64 + 0.5) / (1u64 << 53) as f64
    }

    fn normal(&mut self) -> f64 {
        (-2.0 * self.uniform().ln()).sqrt() * (std::f64::consts::TAU * self.uniform()).cos()
    }
}
