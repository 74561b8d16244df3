//! A rig of a camera alone: what a launcher gives the node, and what comes of it on the bus.

use crate::pictures::laser;
use anyhow::{Context as _, bail, ensure};
use bus::{Bus, BusConfig, Presence, Publisher, Router, Subscriber};
use camera_v4l::Config;
use kit::NodeSpec;
use std::io::Write as _;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};
use wire::{Calibration, CameraIntrinsics, Clock, Frame, Header, Health, LogLine, Phase, RigidPose, RunPhase, topic};

/// Under emulation everything takes its time.
const LONG: Duration = Duration::from_secs(60);
const DEPTH: usize = 256;

/// The node as a process, and the bus that it is on.
pub struct Rig {
    bus: Bus,
    phases: Publisher<RunPhase>,
    camera: Child,
    frames: Subscriber<Frame>,
    lines: Subscriber<LogLine>,
    accounts: Subscriber<Health>,
    account: Option<Health>,
    presence: Presence,
    _calibrations: Publisher<Calibration>,
    _router: Router,
}

impl Rig {
    pub fn start(config: &Config) -> anyhow::Result<Self> {
        let slow = BusConfig { connect_timeout_ms: LONG.as_millis() as u64, ..BusConfig::default() };
        let router = Router::start(&slow)?;
        let place = BusConfig { endpoint: router.endpoint().to_owned(), ..slow };
        let bus = Bus::open(&place)?;
        let mut calibrations = bus.publisher(&topic::calibration("head"))?;
        calibrations.send(calibration(config))?;
        let phases = bus.publisher(&topic::run_phase())?;
        let frames = bus.subscribe(&topic::frame("head"), DEPTH)?;
        let lines = bus.subscribe(&topic::log("**"), DEPTH)?;
        let accounts = bus.subscribe(&topic::health("**"), DEPTH)?;
        let presence = bus.presence()?;
        let spec = NodeSpec { config: serde_json::to_value(config)?, ..NodeSpec::new("camera_v4l", "head", place) };
        let mut camera = Command::new(std::env::current_exe()?).arg("node").stdin(Stdio::piped()).spawn()?;
        let line = serde_json::to_string(&spec)? + "\n";
        // Its stdin stays open: with it the node would end.
        camera.stdin.as_mut().context("no stdin")?.write_all(line.as_bytes())?;
        let (account, _calibrations, _router) = (None, calibrations, router);
        Ok(Self { bus, phases, camera, frames, lines, accounts, account, presence, _calibrations, _router })
    }

    /// Begins scan 1; when.
    pub fn begin(&mut self) -> anyhow::Result<i64> {
        self.say(Phase::Aim)?;
        let presence = &self.presence;
        wait_for(&self.bus, "the node", || presence.nodes().contains("camera_v4l/head").then_some(()))?;
        let began = now_nanos()?;
        self.say(Phase::Shape)?;
        Ok(began)
    }

    fn say(&mut self, phase: Phase) -> anyhow::Result<()> {
        let header = Header { scan: 1, phase, stamp_nanos: now_nanos()?, clock: Clock::System, ..Header::default() };
        Ok(self.phases.send(RunPhase { header, discard: false })?)
    }

    /// Puts so many more pictures behind those that were seen.
    pub fn see(&mut self, more: usize, seen: &mut Vec<Frame>) -> anyhow::Result<()> {
        let (count, frames) = (seen.len() + more, &mut self.frames);
        wait_for(&self.bus, "pictures", || {
            seen.extend(std::iter::from_fn(|| frames.next()));
            (seen.len() >= count).then_some(())
        })
    }

    /// Ends the scan; all that came till its end, and the end.
    pub fn end(&mut self, seen: &mut Vec<Frame>) -> anyhow::Result<Header> {
        self.say(Phase::End)?;
        while !seen.last().is_some_and(|frame| frame.header.is_end()) {
            self.see(1, seen)?;
        }
        Ok(seen.pop().context("no end")?.header)
    }

    /// Waits until the node's log has these words.
    pub fn logs(&mut self, words: &str) -> anyhow::Result<()> {
        let lines = &mut self.lines;
        let line = || std::iter::from_fn(|| lines.next()).find(|line| line.text.contains(words));
        let found = wait_for(&self.bus, words, line)?;
        println!("    the node: {}", found.text);
        Ok(())
    }

    /// Waits until the node's account has so many of a refusal; how many there are.
    pub fn counts(&mut self, reason: &str, least: u64) -> anyhow::Result<u64> {
        let (accounts, account) = (&mut self.accounts, &mut self.account);
        wait_for(&self.bus, reason, || {
            while let Some(newer) = accounts.next() {
                *account = Some(newer);
            }
            let refused = account.as_ref().map_or(&[][..], |account| &account.refused);
            refused.iter().find(|refusal| refusal.reason == reason && refusal.count >= least).map(|found| found.count)
        })
    }

    /// The node's process.
    pub fn process(&self) -> u32 {
        self.camera.id()
    }

    /// Closes the node's stdin: it is to end by itself.
    pub fn close(mut self) -> anyhow::Result<()> {
        drop(self.camera.stdin.take());
        let status = self.camera.wait()?;
        ensure!(status.success(), "the node ended with {status}");
        Ok(())
    }
}

impl Drop for Rig {
    fn drop(&mut self) {
        // It has ended by itself, or the proof has failed.
        let _ = self.camera.kill();
        let _ = self.camera.wait();
    }
}

fn wait_for<T>(bus: &Bus, what: &str, mut look: impl FnMut() -> Option<T>) -> anyhow::Result<T> {
    let started = Instant::now();
    while started.elapsed() < LONG {
        if let Some(found) = look() {
            return Ok(found);
        }
        bus.wait(Duration::from_millis(50));
    }
    bail!("waited in vain: {what}")
}

pub fn now_nanos() -> anyhow::Result<i64> {
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
