//! The device's end of a line that needs no hardware: a pseudo-terminal with an emulated device behind it.

use crate::{Delivery, Emulated, Faults, FaultsConfig, HostClock};
use serialport::{SerialPort as _, TTYPort};
use std::collections::VecDeque;
use std::io::{Read as _, Write as _};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;

/// Why there is no pseudo-terminal.
#[derive(Debug, thiserror::Error)]
pub enum PtyError {
    /// The system gives none.
    #[error("opening a pseudo-terminal: {0}")]
    Open(#[from] serialport::Error),
    /// The name that was asked for cannot be had.
    #[error("linking {link} to the pseudo-terminal: {reason}", link = .link.display())]
    Link {
        /// The name.
        link: PathBuf,
        /// The system's words.
        reason: std::io::Error,
    },
}

/// An emulated device at the end of a line. Dropping it pulls the plug.
pub struct Pty<E> {
    path: PathBuf,
    link: Option<PathBuf>,
    device: Arc<Mutex<E>>,
    stopping: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

/// How often the device looks whether it has something to say.
const TICK: Duration = Duration::from_micros(500);

impl<E: Emulated> Pty<E> {
    /// Plugs a device in. With a `link`, that name leads to it, as those under /dev/serial/by-id do.
    pub fn start(device: E, faults: FaultsConfig, clock: HostClock, link: Option<&Path>) -> Result<Self, PtyError> {
        let (mut host_end, terminal) = TTYPort::pair()?;
        let path = PathBuf::from(terminal.name().unwrap_or_default());
        // Held open it would stay locked to whoever opened it last.
        drop(terminal);
        if let Some(link) = link {
            relink(&path, link)?;
        }
        let device = Arc::new(Mutex::new(device));
        let stopping = Arc::<AtomicBool>::default();
        let (played, stop) = (device.clone(), stopping.clone());
        let thread = std::thread::spawn(move || {
            let mut faults = Faults::new(faults);
            let mut due = VecDeque::new();
            while !stop.load(Ordering::SeqCst) {
                play(&mut host_end, &played, &mut faults, &mut due, clock);
            }
        });
        Ok(Self { path, link: link.map(Path::to_owned), device, stopping, thread: Some(thread) })
    }

    /// What the host opens.
    pub fn path(&self) -> &Path {
        self.link.as_deref().unwrap_or(&self.path)
    }

    /// The device itself, to look at or to change.
    pub fn device(&self) -> MutexGuard<'_, E> {
        self.device.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl<E> Drop for Pty<E> {
    fn drop(&mut self) {
        self.stopping.store(true, Ordering::SeqCst);
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
        if let Some(link) = &self.link {
            let _ = std::fs::remove_file(link);
        }
    }
}

fn relink(path: &Path, link: &Path) -> Result<(), PtyError> {
    // A link from a run before is replaced; anything else that bears the name is left alone, and the error tells.
    if link.is_symlink() {
        let _ = std::fs::remove_file(link);
    }
    std::os::unix::fs::symlink(path, link).map_err(|reason| PtyError::Link { link: link.to_owned(), reason })
}

fn play<E: Emulated>(
    port: &mut TTYPort,
    device: &Mutex<E>,
    faults: &mut Faults,
    due: &mut VecDeque<Delivery>,
    clock: HostClock,
) {
    // What waits for its moment leaves at it, not at the next tick.
    let next = due.front().map_or(TICK, |delivery| {
        Duration::from_nanos(delivery.due_nanos.saturating_sub(clock.now_nanos()).max(1) as u64).min(TICK)
    });
    let _ = port.set_timeout(next);
    let mut heard = [0u8; 256];
    match port.read(&mut heard) {
        // A cut line does not carry the host's words either.
        Ok(_) if faults.is_cut(clock.now_nanos()) => {}
        Ok(count) => device.lock().unwrap_or_else(PoisonError::into_inner).hear(&heard[..count], clock.now_nanos()),
        Err(error) if error.kind() == std::io::ErrorKind::TimedOut => {}
        // Nobody has it open.
        Err(_) => std::thread::sleep(TICK),
    }
    let now = clock.now_nanos();
    while let Some((sent, bytes)) = device.lock().unwrap_or_else(PoisonError::into_inner).speak(now) {
        due.push_back(faults.deliver(sent, &bytes));
    }
    while due.front().is_some_and(|delivery| delivery.due_nanos <= now) {
        let Some(delivery) = due.pop_front() else { break };
        // A host that does not read loses it, as it would on a real line.
        let _ = port.write(&delivery.bytes);
    }
}
