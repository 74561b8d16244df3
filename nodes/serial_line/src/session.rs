//! A device that is listened to, whatever happens to its line.

use crate::{HostClock, Line, LineError, LineSettings, wire_nanos};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

const FIRST_BACKOFF: Duration = Duration::from_millis(250);
const LAST_BACKOFF: Duration = Duration::from_secs(4);
/// Who streamed for so long is believed to work: the next trouble is met without delay.
const WORKS_AFTER: Duration = Duration::from_secs(5);
/// The same trouble is named again after so long.
const NAMED_AGAIN: Duration = Duration::from_secs(30);
/// Records that wait for the node; more than ten seconds of any tracker.
const WAITING: usize = 4096;
/// A line on which more of the bytes than this belong to no record is half dead.
const NOISY_SHARE: f64 = 0.25;
const NOISE_WINDOW: Duration = Duration::from_secs(1);

/// What a decoder has seen since it was made.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Tally {
    /// Whole records.
    pub records: u64,
    /// Records that began and did not end as they should.
    pub broken: u64,
    /// Bytes that belong to no whole record.
    pub skipped_bytes: u64,
}

/// Why nothing is measured.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum Trouble {
    /// The port.
    #[error(transparent)]
    Line(#[from] LineError),
    /// What is at its other end; a sentence with what to do.
    #[error("{0}")]
    Device(String),
}

/// A device at the other end of a line.
pub trait Device: Send + 'static {
    /// What it sends.
    type Record: Send + 'static;
    /// Brings it from any state to sending records; what it found, in a sentence.
    fn set_up(&mut self, line: &mut Line) -> Result<String, Trouble>;
    /// Takes bytes; calls back for each whole record.
    fn take(&mut self, bytes: &[u8], each: &mut dyn FnMut(Heard<Self::Record>));
    /// What it has seen so far.
    fn tally(&self) -> Tally;
    /// How long it may be quiet.
    fn most_silence(&self) -> Duration;
    /// What to say when nothing comes.
    fn silence(&self) -> String;
    /// What to say when bytes come that are no records; a sample of them.
    fn garbage(&self, sample: &[u8]) -> String;
}

/// A record within the bytes that a device was given.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Heard<R> {
    /// What was read.
    pub record: R,
    /// How many of the bytes lie behind it.
    pub behind: usize,
    /// Records since the one before that came in pieces.
    pub missed: u32,
}

/// A record, and when its last byte came, on the host's clock.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Arrived<R> {
    /// The arrival.
    pub nanos: i64,
    /// What came.
    pub record: R,
    /// Records since the one before that came in pieces.
    pub missed: u32,
}

/// What the operator should know.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum News {
    /// It works (again); what was found.
    Streaming(String),
    /// It does not; it is tried again.
    Trouble(Trouble),
    /// It works, but not well.
    Noisy(String),
}

/// The account of a session.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Counts {
    /// Whole records.
    pub records: u64,
    /// Records that began and did not end as they should.
    pub broken: u64,
    /// Bytes that belong to no whole record.
    pub skipped_bytes: u64,
    /// How often it was set up.
    pub starts: u64,
    /// Records that nobody fetched in time.
    pub overflowed: u64,
}

#[derive(Default)]
struct SharedCounts([AtomicU64; 5]);

/// The thread that listens, and what it heard.
pub struct Session<R> {
    records: Receiver<Arrived<R>>,
    counts: Arc<SharedCounts>,
    stopping: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl<R: Send + 'static> Session<R> {
    /// Starts to listen; `say` is called with news, on the session's own thread.
    pub fn start<D: Device<Record = R>>(
        device: D,
        settings: LineSettings,
        clock: HostClock,
        say: impl FnMut(News) + Send + 'static,
    ) -> Self {
        let (sender, records) = sync_channel(WAITING);
        let counts = Arc::<SharedCounts>::default();
        let stopping = Arc::<AtomicBool>::default();
        let listener = Listener {
            device,
            settings,
            clock,
            say: Box::new(say),
            sender,
            counts: counts.clone(),
            stopping: stopping.clone(),
            named: None,
        };
        let thread = std::thread::spawn(move || listener.live());
        Self { records, counts, stopping, thread: Some(thread) }
    }

    /// The next record; `None` when none came in this time.
    pub fn next(&self, wait: Duration) -> Option<Arrived<R>> {
        match self.records.recv_timeout(wait) {
            Ok(record) => Some(record),
            Err(RecvTimeoutError::Timeout) => None,
            Err(RecvTimeoutError::Disconnected) => {
                std::thread::sleep(wait);
                None
            }
        }
    }

    /// The account so far.
    pub fn counts(&self) -> Counts {
        let [records, broken, skipped_bytes, starts, overflowed] =
            [0, 1, 2, 3, 4].map(|i: usize| self.counts.0[i].load(Ordering::Relaxed));
        Counts { records, broken, skipped_bytes, starts, overflowed }
    }
}

impl<R> Drop for Session<R> {
    fn drop(&mut self) {
        self.stopping.store(true, Ordering::SeqCst);
        if let Some(thread) = self.thread.take() {
            // A device that panicked has said so on stderr.
            let _ = thread.join();
        }
    }
}

struct Listener<D: Device> {
    device: D,
    settings: LineSettings,
    clock: HostClock,
    say: Box<dyn FnMut(News) + Send>,
    sender: SyncSender<Arrived<D::Record>>,
    counts: Arc<SharedCounts>,
    stopping: Arc<AtomicBool>,
    named: Option<(Trouble, Instant)>,
}

impl<D: Device> Listener<D> {
    fn live(mut self) {
        let mut backoff = FIRST_BACKOFF;
        while !self.stopping.load(Ordering::SeqCst) {
            let started = Instant::now();
            let trouble = match self.attempt() {
                Trouble::Line(LineError::Stopped) => return,
                trouble => trouble,
            };
            if started.elapsed() > WORKS_AFTER {
                backoff = FIRST_BACKOFF;
            }
            self.name(trouble);
            let until = Instant::now() + backoff;
            while Instant::now() < until && !self.stopping.load(Ordering::SeqCst) {
                std::thread::sleep(Duration::from_millis(20));
            }
            backoff = (backoff * 2).min(LAST_BACKOFF);
        }
    }

    fn name(&mut self, trouble: Trouble) {
        let known = self.named.as_ref().is_some_and(|(said, at)| *said == trouble && at.elapsed() < NAMED_AGAIN);
        if !known {
            self.named = Some((trouble.clone(), Instant::now()));
            (self.say)(News::Trouble(trouble));
        }
    }

    /// Opens, sets up and listens until something is wrong.
    fn attempt(&mut self) -> Trouble {
        let mut line = match Line::open(&self.settings, self.clock, self.stopping.clone()) {
            Ok(line) => line,
            Err(error) => return error.into(),
        };
        match self.device.set_up(&mut line) {
            Ok(found) => (self.say)(News::Streaming(found)),
            Err(trouble) => return trouble,
        }
        self.counts.0[3].fetch_add(1, Ordering::Relaxed);
        self.listen(&mut line)
    }

    fn listen(&mut self, line: &mut Line) -> Trouble {
        let mut buffer = [0u8; 1024];
        let mut last_byte = Instant::now();
        let mut last_record = Instant::now();
        let mut noise =
            Noise { since: Instant::now(), bytes: 0, skipped: self.device.tally().skipped_bytes, named: None };
        loop {
            let chunk = match line.read(&mut buffer) {
                Ok(chunk) => chunk,
                Err(error) => return error.into(),
            };
            if chunk.len > 0 {
                last_byte = Instant::now();
                if self.take(&buffer[..chunk.len], chunk.arrival_nanos) > 0 {
                    last_record = last_byte;
                    self.named = None;
                }
                noise.bytes += chunk.len as u64;
            }
            let most = self.device.most_silence();
            if last_byte.elapsed() > most {
                return Trouble::Device(self.device.silence());
            }
            if last_record.elapsed() > most {
                return Trouble::Device(self.device.garbage(&buffer[..chunk.len]));
            }
            if let Some(share) = noise.share(self.device.tally().skipped_bytes) {
                let path = self.settings.path.display();
                let text = format!(
                    "{:.0} % of the bytes from {path} belong to no record: a shorter or better cable, or a lower baud rate",
                    100.0 * share
                );
                (self.say)(News::Noisy(text));
            }
        }
    }

    fn take(&mut self, bytes: &[u8], arrival_nanos: i64) -> u64 {
        let Self { device, sender, counts, settings, .. } = self;
        let mut whole = 0;
        device.take(bytes, &mut |heard| {
            whole += 1;
            // What lies behind it in the same chunk came later, at the pace of the line.
            let nanos = arrival_nanos - wire_nanos(heard.behind, settings.baud);
            let arrived = Arrived { nanos, record: heard.record, missed: heard.missed };
            if sender.try_send(arrived).is_err() {
                counts.0[4].fetch_add(1, Ordering::Relaxed);
            }
        });
        let tally = device.tally();
        for (count, value) in counts.0.iter().zip([tally.records, tally.broken, tally.skipped_bytes]) {
            count.store(value, Ordering::Relaxed);
        }
        whole
    }
}

struct Noise {
    since: Instant,
    bytes: u64,
    skipped: u64,
    named: Option<Instant>,
}

impl Noise {
    /// The share of bytes that were skipped in the last second, when it is high and was not told lately.
    fn share(&mut self, skipped: u64) -> Option<f64> {
        if self.since.elapsed() < NOISE_WINDOW {
            return None;
        }
        let share = (skipped - self.skipped) as f64 / self.bytes.max(1) as f64;
        (self.since, self.bytes, self.skipped) = (Instant::now(), 0, skipped);
        let lately = self.named.is_some_and(|at| at.elapsed() < NAMED_AGAIN);
        if share < NOISY_SHARE || lately {
            return None;
        }
        self.named = Some(Instant::now());
        Some(share.min(1.0))
    }
}
