//! Whole rigs whose tracker is a real driver node on `limn emulate`, beside the simulated camera: the model is that of the
//! simulated tracker, poses come at once, and a line that is cut costs what it was cut for and nothing else.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps")]

mod model;

use model::{Judged, Known, LEVER_MM, NOISE_DEG, NOISE_MM, SECONDS, apart, judged, known};
use serial_line::{FaultsConfig, HostClock, Pty};
use std::path::Path;
use std::sync::mpsc::{Receiver, Sender, channel};
use system_tests::emulated::{Emulated, Tracker, one_at_a_time};
use system_tests::limn;
use system_tests::rig::{Rig, first, wait_on, wait_until};
use tracker_flock::emulator::{EmulatorConfig, FlockEmulator, World};
use wire::{Phase, Pose, Quality, topic};

const FLOCK: Tracker = Tracker {
    played: &["flock"],
    found: "6DFOB, revision 3.67",
    kind: "tracker_flock",
    instance: "head",
    beside: "",
    config: "hemisphere = 'lower'\nrate_hz = 100.0",
    seconds: SECONDS,
};

const LIBERTY: Tracker = Tracker {
    played: &["polhemus", "--family", "liberty"],
    found: "Polhemus Liberty, emulated",
    kind: "tracker_polhemus",
    instance: "head",
    beside: "",
    config: "hemisphere = [0.0, 0.0, 1.0]",
    seconds: SECONDS,
};

/// Three birds on the handset, 50 mm apart, in group mode; what they measure is made one pose. Their mounts are known to the
/// last digit, so what sets them apart beyond the noise that the driver states is, along each axis, the step of their numbers
/// (0.11 mm / sqrt 12 = 0.03 mm; the matrix's 1/8192 is nothing) and what the hand goes in half a millisecond, to which
/// stamps are held (at its 250 mm/s 0.12 mm / sqrt 3 = 0.07 mm; at its 60 degrees/s 0.03 / sqrt 3 = 0.02 degrees). With the
/// millimetre and half a degree of a mount measured with a ruler, the surface would be smoothed as theirs has to be.
const BIRDS: Tracker = Tracker {
    played: &["flock", "--units", "3"],
    found: "sensors on units [1, 2, 3]",
    instance: "bird",
    beside: "[nodes.fuse]\nkind = 'fuse'\ninstance = 'head'\nconfig.apart_mm = 0.08\nconfig.apart_deg = 0.02\n\
             config.receivers = [{ tracker = 'bird' }, { tracker = 'bird_2', translation_m = [0.05, 0.0, 0.0] }, \
             { tracker = 'bird_3', translation_m = [0.1, 0.0, 0.0] }]",
    config: "sensors = [1, 2, 3]\nhemisphere = 'lower'\nrate_hz = 100.0",
    ..FLOCK
};

/// `step_mm` is the step of the device's numbers.
fn the_model_is_that_of_the_simulated_tracker(tracker: &Tracker, step_mm: f64) -> String {
    let Known { mesh, alike } = known();
    let folder = tempfile::tempdir().unwrap();
    let [played, known] = ["played", "known"].map(|name| folder.path().join(name));
    std::fs::create_dir_all(&known).and_then(|()| std::fs::write(known.join("mesh.ply"), mesh)).unwrap();
    let mut rig = Emulated::start(tracker, &played);
    let bus = rig.rig.bus();
    let mut poses = bus.subscribe(&topic::pose("head"), 4096).unwrap();
    rig.scan(&bus);
    let poses: Vec<Pose> = std::iter::from_fn(|| poses.next()).collect();
    drop(bus);
    let (status, said) = rig.end();
    assert!(status.success() && !said.contains("messages lost"), "{said}");

    // Noise, steps in three axes, and the hand's way in half a millisecond: what the driver's stamps are held to.
    let Judged { median_mm, near, speed_mm_per_s } = judged(&played, tracker.seconds, &poses);
    let sigma = (NOISE_MM.powi(2) + step_mm.powi(2) / 4.0 + (speed_mm_per_s * 0.5e-3).powi(2)).sqrt();
    println!("{}: half of the positions within {median_mm:.4} mm; sigma {sigma:.4} mm", tracker.kind);
    assert!(median_mm < sigma, "half of the positions are wrong by more than {median_mm} mm; sigma {sigma} mm");
    // Two surfaces differ by what the poses of both do, along one axis of three, turned or moved: half of a normal
    // distribution lies within 0.67 sigma.
    let turn = NOISE_DEG.to_radians() * LEVER_MM;
    let sigma = ((sigma.powi(2) + NOISE_MM.powi(2) + 2.0 * turn.powi(2)) / 3.0).sqrt();
    let (median, share) = apart(&played, &known);
    println!("the models are {median:.4} mm apart in the median; sigma {sigma:.4} mm");
    assert!(median < 0.67 * sigma, "{median} mm; sigma {sigma} mm\n{said}");
    // Noise alone lets one surface close a hole and leaves it open in the other; and where there is no good pose, there is no
    // good surface: a place is seen twice or more, and one bad pose of two spoils it. But most of the poses are good.
    println!("{share:.3} are within 0.25 mm; {near:.3} of the poses are, and {alike:.3} where noise alone differs");
    assert!(near > 0.5 && share > near * near * alike, "{share}; {near} of the poses, {alike} by noise alone\n{said}");
    said
}

/// The sentences in which the driver tells the jitter that it has taken off, for each of its sensors.
fn tells_its_jitter(said: &str, sensors: &[u8]) {
    for sensor in sensors {
        let words = format!("sensor {sensor}: arrivals are freed of");
        assert!(said.lines().any(|line| line.contains(&words) && line.contains("ms rms of jitter")), "{words}: {said}");
    }
}

#[test]
fn a_flock_on_a_serial_line_gives_the_model_of_the_simulated_tracker() {
    let said = the_model_is_that_of_the_simulated_tracker(&FLOCK, 0.11);
    tells_its_jitter(&said, &[0]);
}

#[test]
fn three_birds_in_group_mode_give_the_model_of_the_simulated_tracker_by_one_pose() {
    let said = the_model_is_that_of_the_simulated_tracker(&BIRDS, 0.11);
    tells_its_jitter(&said, &[1, 2, 3]);
}

#[test]
fn a_liberty_on_a_serial_line_gives_the_model_of_the_simulated_tracker() {
    let said = the_model_is_that_of_the_simulated_tracker(&LIBERTY, 0.0);
    tells_its_jitter(&said, &[1]);
}

#[test]
fn a_line_that_is_cut_in_mid_scan_is_named_and_comes_back_and_nothing_else_is_lost() {
    let folder = tempfile::tempdir().unwrap();
    let cut = Tracker { played: &["flock", "--cut-every", "5", "--cut-for", "1"], seconds: 12.0, ..FLOCK };
    let mut rig = Emulated::start(&cut, folder.path());
    let bus = rig.rig.bus();
    let mut poses = bus.subscribe(&topic::pose("head"), 4096).unwrap();
    let mut lines = bus.subscribe(&topic::log("**"), 4096).unwrap();
    let mut healths = bus.subscribe(&topic::health("**"), 4096).unwrap();
    rig.scan(&bus);
    let epoch = first(&bus, &topic::run_phase()).header.stamp_nanos;
    let poses: Vec<_> = std::iter::from_fn(|| poses.next()).filter(|pose| !pose.header.is_end()).collect();
    let lines: Vec<_> = std::iter::from_fn(|| lines.next()).filter(|line| line.node == "tracker_flock/head").collect();
    let lost =
        std::iter::from_fn(|| healths.next()).flat_map(|health| health.inputs).map(|input| input.lost).sum::<u64>();
    drop(bus);
    let (status, said) = rig.end();
    assert!(status.success(), "{said}");
    assert_eq!(lost, 0, "{said}");
    // The longest time without a pose is the one of the cut, or of a cut and what the driver needed to find it whole.
    let stamps: Vec<i64> = poses.iter().map(|pose| pose.header.stamp_nanos).collect();
    let gap = stamps.windows(2).max_by_key(|pair| pair[1] - pair[0]).unwrap();
    let seconds = |nanos: i64| nanos as f64 * 1e-9;
    assert!(gap[1] - gap[0] > 1_000_000_000, "{} s", seconds(gap[1] - gap[0]));
    let told = |words: &str| {
        let mut after =
            lines.iter().filter(|line| line.text.contains(words)).map(|line| line.header.stamp_nanos - epoch);
        after.find(|at| *at > gap[0]).unwrap_or_else(|| panic!("{words:?} was not told:\n{said}"))
    };
    let (named, found) = (told("says nothing"), told(cut.found));
    assert!(named < gap[1] && named < found, "{} s, {} s, {} s", seconds(named), seconds(found), seconds(gap[1]));
    println!("no pose for {:.2} s, named after {:.2}", seconds(gap[1] - gap[0]), seconds(named - gap[0]));
    assert!(stamps.last().is_some_and(|last| *last > gap[1]), "it came back");
    assert!(folder.path().join("mesh.ply").is_file(), "{said}");
}

#[test]
fn a_scan_waits_for_its_tracker() {
    let folder = tempfile::tempdir().unwrap();
    let _alone = one_at_a_time();
    let (launch, port) = (folder.path().join("late.toml"), folder.path().join("port"));
    std::fs::write(&launch, alone(&port)).unwrap();
    let mut rig = Rig::start(limn().arg("up").arg(&launch));
    let bus = rig.bus();
    let mut phases = bus.subscribe(&topic::run_phase(), 16).unwrap();
    let mut newest = || std::iter::from_fn(|| phases.next()).last();
    wait_until("what is missing is not named", || rig.said().contains("there is no"));
    let before = wait_on(&bus, "no phase is told", &mut newest);
    assert_eq!(before.header.phase, Phase::Aim, "no scan without a tracker: {}", rig.said());
    let clock = HostClock::start();
    let _pty = Pty::start(still_bird(), FaultsConfig::default(), clock, Some(&port)).unwrap();
    wait_on(&bus, "the scan does not begin", || newest().filter(|run| run.header.phase == Phase::Both));
}

/// A rig of a Flock of Birds alone, which begins as soon as it can.
fn alone(port: &Path) -> String {
    format!(
        "[run]\nbegin = 'both'\n[nodes.tracker]\nkind = 'tracker_flock'\ninstance = 'head'\n\
         [nodes.tracker.config]\nport = {port:?}\nrate_hz = 100.0\n"
    )
}

fn still_bird() -> FlockEmulator {
    let world: World = Box::new(|_, _| (nalgebra::Vector3::new(0.3, -0.1, 0.2), nalgebra::UnitQuaternion::identity()));
    FlockEmulator::new(EmulatorConfig { rate_hz: 100.0, ..EmulatorConfig::default() }, world)
}

/// An emulator that tells when it gave each record away.
struct Told {
    flock: FlockEmulator,
    clock: HostClock,
    told: Sender<(i64, i64)>,
}

impl serial_line::Emulated for Told {
    fn hear(&mut self, bytes: &[u8], now_nanos: i64) {
        self.flock.hear(bytes, now_nanos);
    }
    fn speak(&mut self, now_nanos: i64) -> Option<(i64, Vec<u8>)> {
        let said = self.flock.speak(now_nanos)?;
        // Nobody listens any more when the test is over.
        let _ = self.told.send((said.0, self.clock.now_nanos()));
        Some(said)
    }
}

/// From the write of each record into the pseudo-terminal to its pose on the bus, in another process: milliseconds, sorted.
fn delays_ms(bus: &bus::Bus, clock: HostClock, told: &Receiver<(i64, i64)>, count: usize) -> Vec<f64> {
    let mut poses = bus.subscribe(&topic::pose("head"), 4096).unwrap();
    let (mut written, mut delays) = (Vec::new(), Vec::new());
    let older_nanos = tracker_flock::Config::default().latencies_nanos().0 + serial_line::wire_nanos(24, 115_200);
    wait_on(bus, "too few poses", || {
        while let Some(pose) = poses.next() {
            let now = clock.now_nanos();
            written.extend(told.try_iter());
            let left = clock.from_system(pose.header.stamp_nanos) + older_nanos;
            // Whose it is, its stamp tells: it is good to a fraction of the 10 ms between two records.
            let of: Option<&(i64, i64)> = written.iter().min_by_key(|(at, _)| (at - left).abs());
            if let Some((at, wrote)) = of.filter(|_| pose.quality == Quality::Good)
                && (at - left).abs() < 4_000_000
            {
                delays.push((now - wrote) as f64 * 1e-6);
            }
        }
        (delays.len() >= count).then_some(())
    });
    delays.sort_by(f64::total_cmp);
    delays
}

/// A figure, not a bound: `cargo test --workspace --test emulated -- --nocapture from_the_emulators_write`.
#[test]
fn from_the_emulators_write_to_the_pose_on_the_bus() {
    let folder = tempfile::tempdir().unwrap();
    let clock = HostClock::start();
    let (told, written) = channel();
    let _alone = one_at_a_time();
    let pty = Pty::start(Told { flock: still_bird(), clock, told }, FaultsConfig::default(), clock, None).unwrap();
    let launch = folder.path().join("alone.toml");
    std::fs::write(&launch, alone(pty.path())).unwrap();
    let mut rig = Rig::start(limn().arg("up").arg(&launch));
    let bus = rig.bus();
    let delays = delays_ms(&bus, clock, &written, 1000);
    let at = |share: f64| delays[((delays.len() - 1) as f64 * share) as usize];
    println!("from write to bus: {:.2} ms median, {:.2} ms 99 %, {} records", at(0.5), at(0.99), delays.len());
    assert!(delays[0] > 0.0, "nothing comes before it was sent: {} ms", delays[0]);
}
