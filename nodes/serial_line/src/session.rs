//! A device that is listened to, whatever happens to its line.

use crate::device::{Arrived, Counts, Device, News, Trouble};
use crate::ring::Ring;
use crate::{HostClock, Line, LineError, LineSettings, Noise, wire_nanos};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

const FIRST_BACKOFF: Duration = Duration::from_millis(250);
const LAST_BACKOFF: Duration = Duration::from_secs(4);
/// So much of what is no record is shown to the device, to say what it may be.
const SAMPLE_BYTES: usize = 64;
/// The same trouble is named again after so long.
const NAMED_AGAIN: Duration = Duration::from_secs(30);

#[derive(Default)]
struct SharedCounts([AtomicU64; 5]);

/// The thread that listens, and what it heard.
pub struct Session<R> {
    records: Arc<Ring<Arrived<R>>>,
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
        let records = Arc::new(Ring::new());
        let counts = Arc::<SharedCounts>::default();
        let stopping = Arc::<AtomicBool>::default();
        let listener = Listener {
            device,
            settings,
            clock,
            say: Box::new(say),
            records: records.clone(),
            counts: counts.clone(),
            stopping: stopping.clone(),
            named: [None, None],
        };
        let thread = std::thread::spawn(move || listener.live());
        Self { records, counts, stopping, thread: Some(thread) }
    }

    /// The next record; `None` when none came in this time.
    pub fn next(&self, wait: Duration) -> Option<Arrived<R>> {
        self.records.pop(wait)
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
    records: Arc<Ring<Arrived<D::Record>>>,
    counts: Arc<SharedCounts>,
    stopping: Arc<AtomicBool>,
    /// What was said last of a device that may be starting up, and of anything else.
    named: [Option<(Trouble, Instant)>; 2],
}

impl<D: Device> Listener<D> {
    fn live(mut self) {
        let mut backoff = FIRST_BACKOFF;
        while !self.stopping.load(Ordering::SeqCst) {
            let starts = self.counts.0[3].load(Ordering::Relaxed);
            let trouble = match self.attempt() {
                Trouble::Line(LineError::Stopped) => return,
                trouble => trouble,
            };
            if self.counts.0[3].load(Ordering::Relaxed) > starts {
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
        let named = &mut self.named[usize::from(!matches!(trouble, Trouble::Starting(_)))];
        let known = named.as_ref().is_some_and(|(said, at)| *said == trouble && at.elapsed() < NAMED_AGAIN);
        if !known {
            *named = Some((trouble.clone(), Instant::now()));
            (self.say)(News::Trouble(trouble));
        }
    }

    /// Opens, sets up and listens until something is wrong.
    fn attempt(&mut self) -> Trouble {
        let mut line = match Line::open(&self.settings, self.clock, self.stopping.clone()) {
            Ok(line) => line,
            Err(error) => return error.into(),
        };
        let mut set_up = self.device.set_up(&mut line);
        if let Err(trouble @ Trouble::Starting(_)) = set_up {
            self.name(trouble);
            set_up = self.device.set_up(&mut line);
        }
        match set_up {
            Ok(found) => (self.say)(News::Streaming(found)),
            Err(trouble) => return trouble,
        }
        self.counts.0[3].fetch_add(1, Ordering::Relaxed);
        self.listen(&mut line)
    }

    fn listen(&mut self, line: &mut Line) -> Trouble {
        let mut buffer = [0u8; 1024];
        let mut unread: Vec<u8> = Vec::with_capacity(2 * SAMPLE_BYTES);
        let mut last_byte = Instant::now();
        let mut last_record = Instant::now();
        let mut noise = Noise::default();
        loop {
            let chunk = match line.read(&mut buffer) {
                Ok(chunk) => chunk,
                Err(error) => return error.into(),
            };
            if chunk.len > 0 {
                last_byte = Instant::now();
                let skipped = self.device.tally().skipped_bytes;
                if self.take(&buffer[..chunk.len], chunk.arrival_nanos) > 0 {
                    last_record = last_byte;
                    self.named = [None, None];
                    unread.clear();
                } else if unread.len() < SAMPLE_BYTES {
                    unread.extend(buffer[..chunk.len].iter().take(SAMPLE_BYTES));
                }
                let skipped = self.device.tally().skipped_bytes - skipped;
                if let Some(share) = noise.hear(chunk.arrival_nanos, chunk.len as u64, skipped) {
                    (self.say)(News::Noisy(half_dead(&self.settings.path, share)));
                }
                match self.device.ask_why(line) {
                    Ok(None) => {}
                    Ok(Some(why)) => (self.say)(News::Noisy(why)),
                    Err(trouble) => return trouble,
                }
            }
            let most = self.device.most_silence();
            if last_byte.elapsed() > most {
                return Trouble::Device(self.device.silence());
            }
            if last_record.elapsed() > most {
                return Trouble::Device(self.device.garbage(&unread));
            }
        }
    }

    fn take(&mut self, bytes: &[u8], arrival_nanos: i64) -> u64 {
        let Self { device, records, counts, settings, .. } = self;
        let mut whole = 0;
        device.take(bytes, &mut |heard| {
            whole += 1;
            // What lies behind it in the same chunk came later, at the pace of the line.
            let nanos = arrival_nanos - wire_nanos(heard.behind, settings.baud);
            let arrived = Arrived { nanos, record: heard.record, missed: heard.missed };
            if records.push(arrived) {
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

fn half_dead(path: &Path, share: f64) -> String {
    format!(
        "{:.0} % of the bytes from {} belong to no record: a shorter or better cable, or a lower baud rate",
        100.0 * share,
        path.display()
    )
}
