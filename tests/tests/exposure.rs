//! The camera's node on a bus, before a stand-in for the camera: what the stripe looks like comes back, and sets the exposure
//! of the pictures that follow.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps")]

use bus::{Bus, BusConfig, Publisher, Router};
use camera_v4l::{Device, DriverFormat, DriverStamp, Exposed, Layout, Opener, Setting, Trouble, monotonic_nanos};
use kit::{Node, NodeSpec};
use std::sync::{Arc, Mutex};
use std::time::{Duration, SystemTime, UNIX_EPOCH};
use system_tests::rig::wait_on;
use wire::{
    Calibration, CameraIntrinsics, Clock, Frame, Header, LaserPlane, Light, PeaksPer, Phase, RigidPose, RunPhase,
    Stripe, StripePeak, topic,
};

const WIDTH: u32 = 64;
const HEIGHT: u32 = 48;
const RATE_HZ: f64 = 50.0;
/// Exposure that the stand-in is opened with.
const FIRST_US: f64 = 1000.0;
/// The light in which the line has the height that is wanted.
const RIGHT_US: f64 = 2500.0;
const TARGET: f64 = 160.0;

/// A camera whose pictures say how it is set; each setting that it was given is kept.
#[derive(Clone, Default)]
struct StandIn(Arc<Mutex<Vec<Setting>>>);

struct Open {
    given: StandIn,
    setting: Setting,
    picture: Vec<u8>,
    sequence: u32,
}

impl Opener for StandIn {
    fn open(&mut self) -> Result<Box<dyn Device>, Trouble> {
        let setting = Setting { exposure_us: FIRST_US, gain: 1.0 };
        let picture = vec![40; (WIDTH * HEIGHT) as usize];
        Ok(Box::new(Open { given: self.clone(), setting, picture, sequence: 0 }))
    }

    fn silence(&self) -> (Duration, Trouble) {
        (Duration::from_secs(60), Trouble::Silent { device: "stand-in".into(), seconds: 60 })
    }
}

impl Device for Open {
    fn found(&self) -> String {
        "a stand-in".to_owned()
    }

    fn expose(&mut self, _: Duration) -> Result<Option<Exposed<&[u8]>>, Trouble> {
        std::thread::sleep(Duration::from_secs_f64(1.0 / RATE_HZ));
        self.sequence += 1;
        let nanos = monotonic_nanos();
        Ok(Some(Exposed {
            bytes: &self.picture,
            layout: Layout {
                format: DriverFormat::Grey,
                full_range: false,
                width: WIDTH,
                height: HEIGHT,
                stride: WIDTH,
            },
            stamp: DriverStamp { nanos, flags: 0x2000, arrival_nanos: nanos },
            sequence: self.sequence,
            damaged: false,
            setting: self.setting,
        }))
    }

    fn set(&mut self, setting: Setting) -> Result<Setting, Trouble> {
        self.given.0.lock().unwrap().push(setting);
        self.setting = setting;
        Ok(setting)
    }
}

fn calibration() -> Calibration {
    let normal = [1.0, 0.0, 0.0];
    Calibration {
        header: Header::default(),
        camera: CameraIntrinsics {
            width: WIDTH,
            height: HEIGHT,
            fx: 90.0,
            fy: 90.0,
            cx: 32.0,
            cy: 24.0,
            distortion: [0.0; 5],
        },
        laser: LaserPlane { normal, distance_m: 0.1, channel_weights: [1.0, 0.0, 0.0], peaks_per: PeaksPer::Row },
        body_from_camera: RigidPose::IDENTITY,
        pose_offset_nanos: 0,
        name: "stand-in".to_owned(),
    }
}

/// A line as it would be in this picture: its height follows the light.
fn stripe_of(frame: &Frame) -> Stripe {
    let amplitude = (TARGET * frame.exposure_nanos as f64 * 1e-3 / RIGHT_US) as f32;
    let peak = |row: u32| StripePeak {
        u_px: 30.0,
        v_px: row as f32,
        sigma_px: 0.1,
        amplitude,
        width_px: 1.5,
        flags: StripePeak::BEST,
    };
    Stripe {
        header: frame.header,
        width: WIDTH,
        height: HEIGHT,
        light: Light { laser: true, lamp: false },
        peaks: (0..HEIGHT).map(peak).collect::<Vec<_>>().into(),
        refused: Vec::new(),
    }
}

/// A rig of a camera alone, and who plays its operator and its stripe detector.
struct Rig {
    bus: Bus,
    given: StandIn,
    phases: Publisher<RunPhase>,
    stripes: Publisher<Stripe>,
    _calibrations: Publisher<Calibration>,
    stop: Box<dyn FnOnce()>,
    _router: Router,
}

fn started(follow: bool) -> Rig {
    let router = Router::start(&BusConfig::default()).unwrap();
    let place = BusConfig { endpoint: router.endpoint().to_owned(), ..BusConfig::default() };
    let bus = Bus::open(&place).unwrap();
    let mut calibrations = bus.publisher(&topic::calibration("head")).unwrap();
    calibrations.send(calibration()).unwrap();
    let config = serde_json::json!({
        "format": "GREY", "width": WIDTH, "height": HEIGHT, "rate_hz": RATE_HZ, "exposure_us": FIRST_US, "gamma": 1.0,
        "exposure": { "follow": follow, "target_peak": TARGET, "settle_frames": 4 },
    });
    let node = Node::open_unattended(NodeSpec { config, ..NodeSpec::new("camera_v4l", "head", place) }).unwrap();
    let (given, stopper) = (StandIn::default(), node.stopper());
    let camera = given.clone();
    let at_work = std::thread::spawn(move || camera_v4l::node::run_with(node, |_| camera));
    let stop = Box::new(move || {
        stopper.stop();
        at_work.join().unwrap().unwrap();
    });
    let (phases, stripes) =
        (bus.publisher(&topic::run_phase()).unwrap(), bus.publisher(&topic::stripe("head")).unwrap());
    Rig { bus, given, phases, stripes, _calibrations: calibrations, stop, _router: router }
}

/// Exposures in microseconds of the pictures of a scan whose stripes are told, until one is as is wanted or so many came.
fn exposures(rig: &mut Rig, wanted_us: f64, most: usize) -> Vec<f64> {
    let mut frames = rig.bus.subscribe(&topic::frame("head"), 256).unwrap();
    let stamp_nanos = SystemTime::now().duration_since(UNIX_EPOCH).unwrap().as_nanos() as i64;
    let header = Header { scan: 1, phase: Phase::Shape, stamp_nanos, clock: Clock::System, ..Header::default() };
    rig.phases.send(RunPhase { header, discard: false }).unwrap();
    let mut seen = Vec::new();
    let (bus, stripes) = (rig.bus.clone(), &mut rig.stripes);
    wait_on(&bus, "the exposure does not follow", || {
        while let Some(frame) = frames.next() {
            stripes.send(stripe_of(&frame)).unwrap();
            seen.push(frame.exposure_nanos as f64 * 1e-3);
        }
        (seen.last().is_some_and(|us| (us / wanted_us - 1.0).abs() < 0.1) || seen.len() >= most).then_some(())
    });
    seen
}

#[test]
fn the_stripe_sets_the_exposure_of_the_pictures_that_follow() {
    let mut rig = started(true);
    let seen = exposures(&mut rig, RIGHT_US, 500);
    assert!(seen[0] == FIRST_US && (seen[seen.len() - 1] / RIGHT_US - 1.0).abs() < 0.1, "{seen:?}");
    let given = rig.given.0.lock().unwrap().clone();
    assert!(given.windows(2).all(|pair| pair[0].exposure_us < pair[1].exposure_us), "{given:?}");
    assert!((2..=4).contains(&given.len()), "at most 1.6 times as much in a step, and each waited for: {given:?}");
    (rig.stop)();
}

#[test]
fn an_exposure_that_is_not_to_follow_stays() {
    let mut rig = started(false);
    let seen = exposures(&mut rig, RIGHT_US, 50);
    assert!(seen.iter().all(|us| *us == FIRST_US), "{seen:?}");
    assert_eq!(rig.given.0.lock().unwrap().len(), 0);
    (rig.stop)();
}
