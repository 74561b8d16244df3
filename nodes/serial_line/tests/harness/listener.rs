//! A tracker's driver that listens to a port: for the tests of every tracker.

use serial_line::{Device, HostClock, LineSettings, News, PoseTracker, SensorPose, Session};
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

/// Nothing here takes so long unless it hangs.
const LONG: Duration = Duration::from_secs(20);

pub struct Listener<T: PoseTracker> {
    pub session: Session<T::Record>,
    pub tracker: T,
    pub news: Receiver<(Instant, News)>,
}

impl<T: PoseTracker> Listener<T> {
    pub fn start(device: impl Device<Record = T::Record>, line: LineSettings, tracker: T, clock: HostClock) -> Self {
        let (say, news) = channel();
        let session = Session::start(device, line, clock, move |n| drop(say.send((Instant::now(), n))));
        Self { session, tracker, news }
    }

    /// The next so many poses.
    pub fn poses(&mut self, count: usize) -> Vec<SensorPose> {
        let (mut poses, started) = (Vec::new(), Instant::now());
        while poses.len() < count && started.elapsed() < LONG {
            let Some(arrived) = self.session.next(Duration::from_millis(50)) else { continue };
            poses.extend(self.tracker.process(&arrived.record, arrived.nanos, arrived.missed));
        }
        assert_eq!(poses.len(), count, "{:?}", self.news.try_iter().collect::<Vec<_>>());
        poses
    }

    /// The sentence of the next trouble.
    pub fn trouble(&self) -> String {
        let is_trouble = |news| if let News::Trouble(trouble) = news { Some(trouble.to_string()) } else { None };
        self.first(is_trouble)
    }

    /// What is told while it streams, but not well.
    pub fn noisy(&self) -> String {
        self.first(|news| if let News::Noisy(words) = news { Some(words) } else { None })
    }

    /// What was found when it began to stream.
    pub fn streaming(&self) -> String {
        self.first(|news| if let News::Streaming(words) = news { Some(words) } else { None })
    }

    /// What is done to it is named in these words; when that is undone, poses come again. Returns what undoing gave.
    pub fn survives<P>(&mut self, words: &str, ill: impl FnOnce(), well: impl FnOnce() -> P) -> P {
        while self.news.try_recv().is_ok() {}
        let began = Instant::now();
        ill();
        let mut told = self.trouble();
        println!("named after {:?}: {told}", began.elapsed());
        // The stream ends before it is clear why.
        while !told.contains(words) {
            told = self.trouble();
        }
        let undone = well();
        self.streaming();
        while self.session.next(Duration::ZERO).is_some() {}
        self.poses(20);
        undone
    }

    fn first(&self, mut wanted: impl FnMut(News) -> Option<String>) -> String {
        let mut next = || self.news.recv_timeout(LONG).unwrap().1;
        std::iter::repeat_with(&mut next).find_map(&mut wanted).unwrap()
    }
}
