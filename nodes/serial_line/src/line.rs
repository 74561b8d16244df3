//! An open port.

use crate::{HostClock, LineError, Step};
use serialport::{ClearBuffer, SerialPort as _, TTYPort};
use std::io::{ErrorKind as IoKind, Read as _, Write as _};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Waits are cut into pieces of this length, so that a node that was told to stop does.
const NAP: Duration = Duration::from_millis(20);
const MOST_WRITE: Duration = Duration::from_millis(500);
/// Who was told to be quiet, and is not by then, did not understand.
const NEVER_QUIET: Duration = Duration::from_millis(700);

/// How a port is opened: 8 data bits, no parity, 1 stop bit, no flow control (data hold the bytes of XON and XOFF).
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LineSettings {
    /// Stable names under /dev/serial/by-id survive unplugging.
    pub path: PathBuf,
    /// Bits a second.
    pub baud: u32,
    /// Request To Send is raised. Systems raise it as they open a port; here it is lowered at once unless this says so.
    pub rts: bool,
    /// Data Terminal Ready is raised.
    pub dtr: bool,
}

/// Bytes that came.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Chunk {
    /// How many; 0 when nothing came in the time.
    pub len: usize,
    /// When the last of them was read, on the host's clock.
    pub arrival_nanos: i64,
}

/// Raises or lowers RTS; false when there is no such line.
pub type RaiseRts = Box<dyn FnMut(bool) -> bool + Send>;

/// A port, open and raw.
pub struct Line {
    port: TTYPort,
    settings: LineSettings,
    clock: HostClock,
    stopping: Arc<AtomicBool>,
    has_modem_lines: bool,
    other_rts: Option<RaiseRts>,
}

impl Line {
    /// A line on which nothing has come for so long has run dry.
    pub const QUIET: Duration = Duration::from_millis(60);

    /// Opens a port for this program alone.
    pub fn open(settings: &LineSettings, clock: HostClock, stopping: Arc<AtomicBool>) -> Result<Self, LineError> {
        let builder = serialport::new(settings.path.to_string_lossy(), settings.baud)
            .timeout(NAP)
            .dtr_on_open(settings.dtr)
            .exclusive(true);
        let port =
            TTYPort::open(&builder).map_err(|error| LineError::opening(&settings.path, settings.baud, &error))?;
        let mut line =
            Self { port, settings: settings.clone(), clock, stopping, has_modem_lines: true, other_rts: None };
        line.has_modem_lines = line.set_rts(settings.rts);
        line.port.set_timeout(NAP).map_err(|error| line.gone(&error.to_string()))?;
        Ok(line)
    }

    /// From now on RTS is another wire than the port's own: for a pseudo-terminal, which has none.
    pub fn wire_rts(&mut self, mut raise: RaiseRts) {
        self.has_modem_lines = raise(self.settings.rts);
        self.other_rts = Some(raise);
    }

    /// Raises or lowers RTS; false when the line has none (a pseudo-terminal).
    pub fn set_rts(&mut self, high: bool) -> bool {
        match &mut self.other_rts {
            Some(raise) => raise(high),
            None => self.port.write_request_to_send(high).is_ok(),
        }
    }

    /// Whether RTS and DTR are real here.
    pub fn has_modem_lines(&self) -> bool {
        self.has_modem_lines
    }

    /// Its settings.
    pub fn settings(&self) -> &LineSettings {
        &self.settings
    }

    /// Its clock.
    pub fn clock(&self) -> HostClock {
        self.clock
    }

    /// What has come, as soon as anything has; nothing after 20 ms of silence.
    pub fn read(&mut self, buffer: &mut [u8]) -> Result<Chunk, LineError> {
        self.check_stop()?;
        match self.port.read(buffer) {
            // A serial port has no end: this one is gone.
            Ok(0) => Err(self.gone("end of file")),
            Ok(len) => Ok(Chunk { len, arrival_nanos: self.clock.now_nanos() }),
            Err(error) if passing(error.kind()) => Ok(Chunk { len: 0, arrival_nanos: self.clock.now_nanos() }),
            Err(error) => Err(self.gone(&error.to_string())),
        }
    }

    /// Sends all bytes.
    pub fn write(&mut self, mut bytes: &[u8]) -> Result<(), LineError> {
        let started = Instant::now();
        while !bytes.is_empty() {
            self.check_stop()?;
            match self.port.write(bytes) {
                Ok(sent) => bytes = &bytes[sent..],
                Err(error) if passing(error.kind()) => {
                    if started.elapsed() > MOST_WRITE {
                        return Err(LineError::Stuck { path: self.settings.path.clone() });
                    }
                }
                Err(error) => return Err(self.gone(&error.to_string())),
            }
        }
        Ok(())
    }

    /// Rests, and lets arrive what may.
    pub fn pause(&self, time: Duration) -> Result<(), LineError> {
        let until = Instant::now() + time;
        loop {
            self.check_stop()?;
            let left = until.saturating_duration_since(Instant::now());
            if left.is_zero() {
                return Ok(());
            }
            std::thread::sleep(left.min(NAP));
        }
    }

    /// Says one thing after the other.
    pub fn carry_out(&mut self, steps: &[Step]) -> Result<(), LineError> {
        for step in steps {
            self.write(&step.send)?;
            self.pause(step.wait)?;
        }
        Ok(())
    }

    /// Throws away what comes until nothing has come for 60 ms; false when it did not fall quiet.
    pub fn drain(&mut self) -> Result<bool, LineError> {
        let started = Instant::now();
        let mut last = Instant::now();
        let mut scrap = [0u8; 512];
        // What the system has gathered so far is old; a port without such a buffer has none to clear.
        let _ = self.port.clear(ClearBuffer::Input);
        while last.elapsed() < Self::QUIET {
            if self.read(&mut scrap)?.len > 0 {
                last = Instant::now();
            }
            if started.elapsed() > NEVER_QUIET {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Sends a question and reads an answer of `len` bytes; fewer when no more came in `most`.
    pub fn ask(&mut self, question: &[u8], len: usize, most: Duration) -> Result<Vec<u8>, LineError> {
        self.write(question)?;
        let started = Instant::now();
        let mut answer = vec![0; len];
        let mut have = 0;
        while have < len && started.elapsed() < most {
            have += self.read(&mut answer[have..])?.len;
        }
        answer.truncate(have);
        Ok(answer)
    }

    fn check_stop(&self) -> Result<(), LineError> {
        if self.stopping.load(Ordering::SeqCst) { Err(LineError::Stopped) } else { Ok(()) }
    }

    fn gone(&self, reason: &str) -> LineError {
        LineError::Unplugged { path: self.settings.path.clone(), reason: reason.to_owned() }
    }
}

impl Drop for Line {
    fn drop(&mut self) {
        // Where the other end stays open (a pseudo-terminal), the lock would outlive this and keep its own user out.
        let _ = self.port.set_exclusive(false);
    }
}

fn passing(kind: IoKind) -> bool {
    matches!(kind, IoKind::TimedOut | IoKind::Interrupted | IoKind::WouldBlock)
}
