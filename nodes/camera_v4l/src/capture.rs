//! A thread that keeps the newest picture, whatever happens to the camera.

use crate::device::{Device, Exposed, Opener};
use crate::exposure::Setting;
use crate::sequence::SequenceCount;
use crate::trouble::Trouble;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// What the operator should know.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum News {
    /// Pictures come (again).
    Streaming(String),
    /// None come; it is tried again.
    Trouble(Trouble),
}

/// The account of a camera since the start.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Counts {
    /// Whole pictures from the driver.
    pub pictures: u64,
    /// Never came, by the driver's numbers.
    pub lost: u64,
    /// Came under the number of the one before.
    pub repeated: u64,
    /// The driver marked as damaged.
    pub damaged: u64,
    /// Made room for a newer one before they were fetched.
    pub skipped: u64,
    /// How often the camera was opened.
    pub starts: u64,
}

#[derive(Default)]
struct Shared {
    held: Mutex<Held>,
    came: Condvar,
    stopping: AtomicBool,
}

#[derive(Default)]
struct Held {
    newest: Option<Exposed>,
    wanted: Option<Setting>,
    counts: Counts,
}

impl Shared {
    fn held(&self) -> MutexGuard<'_, Held> {
        self.held.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn is_stopping(&self) -> bool {
        self.stopping.load(Ordering::SeqCst)
    }
}

/// The thread, and the picture that it holds.
pub struct Capture {
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
}

impl Capture {
    /// Starts; `say` is called with news, on the thread.
    pub fn start(opener: impl Opener, say: impl FnMut(News) + Send + 'static) -> Self {
        let shared = Arc::<Shared>::default();
        let thread = Watcher { opener, say, shared: shared.clone(), named: None, sequence: SequenceCount::default() };
        Self { shared, thread: Some(std::thread::spawn(move || thread.live())) }
    }

    /// The newest picture that was not fetched yet; waits so long for one.
    pub fn next(&self, wait: Duration) -> Option<Exposed> {
        let none = |held: &mut Held| held.newest.is_none();
        let held = self.shared.held();
        let (mut held, _) =
            self.shared.came.wait_timeout_while(held, wait, none).unwrap_or_else(PoisonError::into_inner);
        held.newest.take()
    }

    /// Sets exposure and gain as soon as the next picture has come.
    pub fn set(&self, setting: Setting) {
        self.shared.held().wanted = Some(setting);
    }

    /// The account so far.
    pub fn counts(&self) -> Counts {
        self.shared.held().counts
    }
}

impl Drop for Capture {
    fn drop(&mut self) {
        self.shared.stopping.store(true, Ordering::SeqCst);
        if let Some(thread) = self.thread.take() {
            // A driver's library that panicked has said so on stderr.
            let _ = thread.join();
        }
    }
}

const FIRST_BACKOFF: Duration = Duration::from_millis(250);
const LAST_BACKOFF: Duration = Duration::from_secs(4);
/// Waits are cut into pieces of this length, so that a node that was told to stop does.
const NAP: Duration = Duration::from_millis(50);
/// The same trouble is named again after so long.
const NAMED_AGAIN: Duration = Duration::from_secs(30);

struct Watcher<O, S> {
    opener: O,
    say: S,
    shared: Arc<Shared>,
    named: Option<(Trouble, Instant)>,
    sequence: SequenceCount,
}

impl<O: Opener, S: FnMut(News)> Watcher<O, S> {
    fn live(mut self) {
        let mut backoff = FIRST_BACKOFF;
        while !self.shared.is_stopping() {
            let pictures = self.shared.held().counts.pictures;
            let trouble = match self.opener.open() {
                Ok(device) => self.watch(device),
                Err(trouble) => Some(trouble),
            };
            let Some(trouble) = trouble else { return };
            self.name(trouble);
            if self.shared.held().counts.pictures > pictures {
                backoff = FIRST_BACKOFF;
            }
            let until = Instant::now() + backoff;
            while Instant::now() < until && !self.shared.is_stopping() {
                std::thread::sleep(NAP.min(backoff));
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

    /// Takes pictures until something is wrong; none when it was told to stop.
    fn watch(&mut self, mut device: Box<dyn Device>) -> Option<Trouble> {
        self.shared.held().counts.starts += 1;
        self.sequence.restart();
        let (most_silence, silent) = self.opener.silence();
        let mut last = Instant::now();
        let mut told = false;
        while !self.shared.is_stopping() {
            match device.expose(NAP) {
                Ok(Some(exposed)) => {
                    last = Instant::now();
                    let wanted = self.keep(exposed);
                    if !std::mem::replace(&mut told, true) {
                        self.named = None;
                        (self.say)(News::Streaming(device.found()));
                    }
                    if let Some(Err(trouble)) = wanted.map(|setting| device.set(setting)) {
                        return Some(trouble);
                    }
                }
                Ok(None) if last.elapsed() > most_silence => return Some(silent),
                Ok(None) => {}
                Err(trouble) => return Some(trouble),
            }
        }
        None
    }

    /// Holds a picture for whoever fetches it; what the camera is to be set to.
    fn keep(&mut self, exposed: Exposed<&[u8]>) -> Option<Setting> {
        self.sequence.note(exposed.sequence);
        // Whoever fetches is not kept waiting for the copy.
        let whole = (!exposed.damaged).then(|| exposed.copied());
        let mut held = self.shared.held();
        held.counts.lost = self.sequence.lost;
        held.counts.repeated = self.sequence.repeated;
        if let Some(whole) = whole {
            held.counts.pictures += 1;
            if held.newest.replace(whole).is_some() {
                held.counts.skipped += 1;
            }
            self.shared.came.notify_one();
        } else {
            held.counts.damaged += 1;
        }
        held.wanted.take()
    }
}
