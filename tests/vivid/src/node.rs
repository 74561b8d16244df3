//! The node itself, as a launcher starts it: a process that reads its configuration from stdin and sends its pictures on a bus.

use crate::bench::Bench;
use crate::pictures::{is_the_pattern, laser, row_of_bars};
use anyhow::{Context as _, bail, ensure};
use bus::{Bus, BusConfig, Publisher, Router};
use camera_v4l::{Config, DriverFormat};
use kit::{Node, NodeSpec};
use std::io::Write as _;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};
use wire::{Calibration, CameraIntrinsics, Clock, Frame, Header, Phase, PixelFormat, RigidPose, RunPhase, topic};

/// Under emulation everything takes its time.
const LONG: Duration = Duration::from_secs(60);
const PICTURES: usize = 10;

/// This program as that node.
pub fn run() -> anyhow::Result<()> {
    camera_v4l::node::run(Node::open(NodeSpec::from_stdin()?)?)
}

/// A rig of a camera alone: what a launcher gives it.
struct Rig {
    bus: Bus,
    phases: Publisher<RunPhase>,
    camera: Child,
    _calibrations: Publisher<Calibration>,
    _router: Router,
}

impl Rig {
    fn start(config: &Config) -> anyhow::Result<Self> {
        let slow = BusConfig { connect_timeout_ms: LONG.as_millis() as u64, ..BusConfig::default() };
        let router = Router::start(&slow)?;
        let place = BusConfig { endpoint: router.endpoint().to_owned(), ..slow };
        let bus = Bus::open(&place)?;
        let mut calibrations = bus.publisher(&topic::calibration("head"))?;
        calibrations.send(calibration(config))?;
        let phases = bus.publisher(&topic::run_phase())?;
        let spec = NodeSpec { config: serde_json::to_value(config)?, ..NodeSpec::new("camera_v4l", "head", place) };
        let mut camera = Command::new(std::env::current_exe()?).arg("node").stdin(Stdio::piped()).spawn()?;
        let line = serde_json::to_string(&spec)? + "\n";
        // Its stdin stays open: with it the node would end.
        camera.stdin.as_mut().context("no stdin")?.write_all(line.as_bytes())?;
        Ok(Self { bus, phases, camera, _calibrations: calibrations, _router: router })
    }

    fn say(&mut self, scan: u64, phase: Phase) -> anyhow::Result<()> {
        let header = Header { scan, phase, stamp_nanos: now_nanos()?, clock: Clock::System, ..Header::default() };
        Ok(self.phases.send(RunPhase { header, discard: false })?)
    }

    fn wait_for<T>(&self, what: &str, mut look: impl FnMut() -> Option<T>) -> anyhow::Result<T> {
        let started = Instant::now();
        while started.elapsed() < LONG {
            if let Some(found) = look() {
                return Ok(found);
            }
            self.bus.wait(Duration::from_millis(50));
        }
        bail!("waited in vain: {what}")
    }
}

impl Drop for Rig {
    fn drop(&mut self) {
        // It has ended by itself, or the proof has failed.
        let _ = self.camera.kill();
        let _ = self.camera.wait();
    }
}

fn now_nanos() -> anyhow::Result<i64> {
    Ok(SystemTime::now().duration_since(UNIX_EPOCH)?.as_nanos() as i64)
}

fn calibration(config: &Config) -> Calibration {
    let (width, height) = (config.width, config.height);
    let (cx, cy) = (f64::from(width) / 2.0, f64::from(height) / 2.0);
    Calibration {
        header: Header::default(),
        camera: CameraIntrinsics { width, height, fx: 900.0, fy: 900.0, cx, cy, distortion: [0.0; 5] },
        laser: laser(),
        body_from_camera: RigidPose::IDENTITY,
        pose_offset_nanos: 0,
        name: "vivid".to_owned(),
    }
}

pub fn sends_its_pictures(bench: &Bench) -> anyhow::Result<()> {
    // vivid's stamps at the end of a frame lie ahead, those at its start are honest.
    bench.turn("timestamp_source", 1)?;
    let config = bench.config(DriverFormat::Rgb3);
    let mut rig = Rig::start(&config)?;
    let mut frames = rig.bus.subscribe(&topic::frame("head"), 256)?;
    let mut lines = rig.bus.subscribe(&topic::log("**"), 256)?;
    let presence = rig.bus.presence()?;
    rig.say(1, Phase::Aim)?;
    rig.wait_for("the node", || presence.nodes().contains("camera_v4l/head").then_some(()))?;
    let began = now_nanos()?;
    rig.say(1, Phase::Shape)?;
    let row = row_of_bars(PixelFormat::Rgb8, config.width as usize);
    let mut seen: Vec<Frame> = Vec::new();
    let mut more = |rig: &Rig, seen: &mut Vec<Frame>, count: usize| {
        rig.wait_for("pictures", || {
            seen.extend(std::iter::from_fn(|| frames.next()));
            (seen.len() >= count).then_some(())
        })
    };
    more(&rig, &mut seen, PICTURES)?;
    println!("    {} pictures on the bus", seen.len());

    std::fs::remove_file(&bench.by_id)?;
    bench.turn("disconnect", 1)?;
    let mut told = |rig: &Rig, words: &str| {
        rig.wait_for(words, || std::iter::from_fn(|| lines.next()).find(|line| line.text.contains(words)))
    };
    told(&rig, "was unplugged")?;
    bench.link()?;
    told(&rig, "RGB3 640x480")?;
    let before = seen.len();
    more(&rig, &mut seen, before + PICTURES)?;
    println!("    {} pictures behind the unplugging", seen.len() - before);

    rig.say(1, Phase::End)?;
    while !seen.last().is_some_and(|frame| frame.header.is_end()) {
        let count = seen.len() + 1;
        more(&rig, &mut seen, count)?;
    }
    let end = seen.pop().context("no end")?.header;
    for frame in &seen {
        ensure!((frame.header.scan, frame.header.clock) == (1, Clock::System), "{:?}", frame.header);
        ensure!(frame.light.laser && !frame.light.lamp, "{:?}", frame.light);
        is_the_pattern(frame, &row)?;
    }
    let stamps: Vec<i64> = seen.iter().map(|frame| frame.header.stamp_nanos).collect();
    ensure!(stamps.windows(2).all(|pair| pair[0] < pair[1]), "{stamps:?}");
    ensure!(stamps[0] > began - 1_000_000_000 && end.stamp_nanos < now_nanos()?, "{began} {stamps:?}");

    drop(rig.camera.stdin.take());
    let status = rig.camera.wait()?;
    ensure!(status.success(), "the node ended with {status}");
    bench.turn("timestamp_source", 0)
}
