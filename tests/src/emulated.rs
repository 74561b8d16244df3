//! A rig whose tracker is a real driver on an emulated device, beside the simulated camera.

use crate::rig::{Course, Rig, wait_until};
use crate::{UNREFINED, limn, repository, short_sets, succeed};
use bus::Bus;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Which tracker, and how driver and emulator are told so.
pub struct Tracker {
    /// As `limn emulate` calls it, with its options.
    pub played: &'static [&'static str],
    /// What the driver says when it has found it.
    pub found: &'static str,
    /// The kind of the driver's node.
    pub kind: &'static str,
    /// Its instance: `head`, when it alone tells the pose.
    pub instance: &'static str,
    /// Further tables of the launch file.
    pub beside: &'static str,
    /// The rest of the driver's table in the launch file.
    pub config: &'static str,
    /// How long the hand sweeps.
    pub seconds: f64,
}

/// A hand that keeps to the clock on the wall needs the machine: no other test of this program runs meanwhile.
pub fn one_at_a_time() -> MutexGuard<'static, ()> {
    static ALONE: Mutex<()> = Mutex::new(());
    // One that failed has let go.
    ALONE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A rig that is up, its tracker found, nothing scanned yet.
pub struct Emulated {
    /// The rig.
    pub rig: Rig,
    /// What plays its tracker.
    pub played: Rig,
    _alone: MutexGuard<'static, ()>,
}

impl Emulated {
    /// Starts rig and device, and waits until the driver has set the device up.
    ///
    /// # Panics
    /// When they do not find each other.
    pub fn start(tracker: &Tracker, out: &Path) -> Self {
        let alone = one_at_a_time();
        let (launch, port) = (out.join("emulated.toml"), out.join("port"));
        let text = format!(
            "include = {:?}\n[run]\nbegin = 'aim'\n[nodes.tracker]\nenabled = false\n\
             [nodes.emulated]\nkind = '{}'\ninstance = '{}'\n[nodes.emulated.config]\nport = {port:?}\n\
             scan_clock = true\nposition_sigma_mm = 0.029\nrotation_sigma_deg = 0.0115\n{}\n{}\n",
            repository("launch/demo.toml"),
            tracker.kind,
            tracker.instance,
            tracker.config,
            tracker.beside,
        );
        assert!(
            std::fs::create_dir_all(out).and_then(|()| std::fs::write(&launch, text)).is_ok(),
            "{}",
            launch.display()
        );
        let mut rig =
            Rig::start(sweep(limn().arg("up").arg(&launch), out, tracker.seconds).args(["--set", "run.pace=real"]));
        rig.config();
        let mut play = limn();
        play.arg("emulate").args(tracker.played).args(["--follow", "emulated", "--seed", "1", "--link"]).arg(&port);
        play.arg("--rig").arg(quick(out)).arg("--scene").arg(repository("config/scenes/cow.toml"));
        play.args(["--seconds", &format!("{:?}", tracker.seconds)]).env("XDG_RUNTIME_DIR", rig.runtime.path());
        let played = Rig::start(&mut play);
        wait_until("the driver has not found its device", || rig.said().contains(tracker.found));
        wait_until("the device does not follow", || played.said().contains("the rig emulated is up"));
        Self { rig, played, _alone: alone }
    }

    /// Scans the whole sweep.
    ///
    /// # Panics
    /// When it does not come to its end.
    pub fn scan(&self, bus: &Bus) {
        let mut course = Course::follow(bus);
        let order = |word| {
            succeed(limn().args(["scan", word]).env("XDG_RUNTIME_DIR", self.rig.runtime.path()));
        };
        order("both");
        course.wait_for_end("camera_sim/head");
        order("end");
        course.wait_for_end("export/model");
        assert!(self.played.said().contains("the hand begins"), "{}", self.played.said());
    }

    /// How the rig has ended, and what it said.
    pub fn end(self) -> (ExitStatus, String) {
        self.rig.end()
    }
}

/// The same sweep with the simulated tracker; nothing is waited for.
pub fn simulated(out: &Path, seconds: f64) -> Command {
    let mut up = limn();
    up.arg("up").arg(repository("launch/demo.toml"));
    sweep(&mut up, out, seconds);
    up
}

/// The same sweep once more with the simulated tracker, read at other moments: its noise is another there, and nothing else.
///
/// # Panics
/// When the rig of the tests cannot be read or written.
pub fn simulated_at_other_moments(out: &Path, seconds: f64) -> Command {
    let mut up = simulated(out, seconds);
    let other = out.join("other.toml");
    let write = || -> anyhow::Result<()> {
        let mut rig: toml::Table = std::fs::read_to_string(quick(out))?.parse()?;
        rig["simulation"]["tracker"]["rate_hz"] = 190.0.into();
        Ok(std::fs::write(&other, toml::to_string(&rig)?)?)
    };
    assert!(write().is_ok(), "{}", other.display());
    up.args(["--set", &format!("tracker.rig={other:?}")]);
    up
}

fn sweep<'a>(up: &'a mut Command, out: &Path, seconds: f64) -> &'a mut Command {
    short_sets(up, out);
    let seconds = ["camera", "tracker"].map(|node| format!("{node}.seconds={seconds:?}"));
    up.args(["--set", &seconds[0], "--set", &seconds[1]]).args(UNREFINED)
}

/// The rig that `short_sets` has written.
fn quick(out: &Path) -> PathBuf {
    out.join("quick.toml")
}
