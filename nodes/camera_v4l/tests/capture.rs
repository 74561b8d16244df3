//! The thread, before a camera that does what a test tells it.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps")]

use camera_v4l::{Capture, Device, DriverFormat, DriverStamp, Exposed, Layout, News, Opener, Setting, Trouble};
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::Duration;

const LONG: Duration = Duration::from_secs(20);
const START: Setting = Setting { exposure_us: 1000.0, gain: 1.0 };

/// What the camera does next.
enum Act {
    Picture(u32),
    Damaged(u32),
    Fail(Trouble),
}

struct Played {
    acts: Receiver<Act>,
    setting: Setting,
}

struct Script {
    /// One open after the other: a camera, or why there is none.
    opens: Receiver<Result<Played, Trouble>>,
    silence: Duration,
}

fn device() -> PathBuf {
    PathBuf::from("/dev/v4l/by-id/played")
}

fn silent() -> Trouble {
    Trouble::Silent { device: device(), seconds: 1 }
}

impl Opener for Script {
    fn open(&mut self) -> Result<Box<dyn Device>, Trouble> {
        let gone = Err(Trouble::NotThere { device: device() });
        self.opens.try_recv().unwrap_or(gone).map(|played| Box::new(played) as Box<dyn Device>)
    }

    fn silence(&self) -> (Duration, Trouble) {
        (self.silence, silent())
    }
}

impl Device for Played {
    fn found(&self) -> String {
        "a played camera".to_owned()
    }

    fn expose(&mut self, wait: Duration) -> Result<Option<Exposed<&[u8]>>, Trouble> {
        let exposed = |sequence, damaged| Exposed {
            bytes: &[0_u8; 4][..],
            layout: Layout { format: DriverFormat::Grey, full_range: false, width: 2, height: 2, stride: 2 },
            stamp: DriverStamp { nanos: 0, flags: 0x2000, arrival_nanos: 0 },
            sequence,
            damaged,
            setting: self.setting,
        };
        match self.acts.recv_timeout(wait) {
            Ok(Act::Picture(sequence)) => Ok(Some(exposed(sequence, false))),
            Ok(Act::Damaged(sequence)) => Ok(Some(exposed(sequence, true))),
            Ok(Act::Fail(trouble)) => Err(trouble),
            Err(_) => Ok(None),
        }
    }

    fn set(&mut self, setting: Setting) -> Result<Setting, Trouble> {
        self.setting = setting;
        Ok(setting)
    }
}

struct Bench {
    capture: Capture,
    news: Receiver<News>,
    opens: Sender<Result<Played, Trouble>>,
}

impl Bench {
    fn new(silence: Duration) -> Self {
        let (say, news) = channel();
        let (opens, taken) = channel();
        let script = Script { opens: taken, silence };
        Self { capture: Capture::start(script, move |n| drop(say.send(n))), news, opens }
    }

    /// Plugs a camera in.
    fn plug(&self) -> Sender<Act> {
        let (act, acts) = channel();
        self.opens.send(Ok(Played { acts, setting: START })).unwrap();
        act
    }

    fn hears(&self, wanted: &News) {
        while self.news.recv_timeout(LONG).unwrap() != *wanted {}
    }

    fn sequence(&self) -> u32 {
        self.capture.next(LONG).unwrap().sequence
    }

    fn until(&self, reached: impl Fn(&camera_v4l::Counts) -> bool) {
        let started = std::time::Instant::now();
        while !reached(&self.capture.counts()) {
            assert!(started.elapsed() < LONG, "{:?}", self.capture.counts());
            std::thread::sleep(Duration::from_millis(1));
        }
    }
}

fn streaming() -> News {
    News::Streaming("a played camera".to_owned())
}

#[test]
fn the_newest_picture_is_held_and_what_was_lost_is_counted() {
    let bench = Bench::new(LONG);
    let camera = bench.plug();
    for number in [5, 6, 9, 9, 10] {
        camera.send(Act::Picture(number)).unwrap();
    }
    camera.send(Act::Damaged(11)).unwrap();
    bench.until(|counts| counts.damaged == 1);
    assert_eq!(bench.sequence(), 10);
    assert_eq!(bench.capture.next(Duration::ZERO), None, "each is given once");
    let counts = bench.capture.counts();
    assert_eq!((counts.pictures, counts.lost, counts.repeated, counts.skipped, counts.damaged), (5, 2, 1, 4, 1));
}

#[test]
fn an_unplugged_camera_is_named_and_opened_again_by_its_name() {
    let bench = Bench::new(LONG);
    let camera = bench.plug();
    camera.send(Act::Picture(100)).unwrap();
    bench.hears(&streaming());
    assert_eq!(bench.sequence(), 100);
    let unplugged = Trouble::Unplugged { device: device() };
    camera.send(Act::Fail(unplugged.clone())).unwrap();
    bench.hears(&News::Trouble(unplugged));
    // While it is away there is none; then it counts from 0 again, which is no loss.
    bench.hears(&News::Trouble(Trouble::NotThere { device: device() }));
    let camera = bench.plug();
    camera.send(Act::Picture(0)).unwrap();
    bench.hears(&streaming());
    assert_eq!(bench.sequence(), 0);
    assert_eq!((bench.capture.counts().lost, bench.capture.counts().starts), (0, 2));
}

#[test]
fn a_broken_and_a_silent_stream_are_started_again() {
    let bench = Bench::new(Duration::from_millis(200));
    let camera = bench.plug();
    let broken = Trouble::Stream { device: device(), reason: "input/output error".to_owned() };
    camera.send(Act::Fail(broken.clone())).unwrap();
    bench.hears(&News::Trouble(broken));
    let quiet = bench.plug();
    bench.hears(&News::Trouble(silent()));
    drop(quiet);
    let camera = bench.plug();
    camera.send(Act::Picture(1)).unwrap();
    bench.hears(&streaming());
}

#[test]
fn an_exposure_is_set_between_two_pictures_and_told_by_the_next() {
    let bench = Bench::new(LONG);
    let camera = bench.plug();
    let wanted = Setting { exposure_us: 300.0, gain: 2.0 };
    bench.capture.set(wanted);
    camera.send(Act::Picture(0)).unwrap();
    assert_eq!(bench.capture.next(LONG).unwrap().setting, START);
    camera.send(Act::Picture(1)).unwrap();
    assert_eq!(bench.capture.next(LONG).unwrap().setting, wanted);
}

#[test]
fn it_stops_whatever_the_camera_does() {
    for plugged in [true, false] {
        let bench = Bench::new(LONG);
        let camera = plugged.then(|| bench.plug());
        bench.until(|counts| counts.starts == u64::from(plugged));
        drop(bench);
        drop(camera);
    }
}
