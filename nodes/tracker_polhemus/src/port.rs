//! The tracker at the other end of a line: set up from any state, and listened to.

use crate::config::Config;
use crate::protocol::commands;
use crate::protocol::decoder::Decoder;
use crate::protocol::records::{Family, Layout, Record};
use crate::protocol::status::{FastrakStatus, printable};
use serial_line::{Device, Heard, Line, LineSettings, Tally, Trouble};
use std::time::Duration;

const ANSWER: Duration = Duration::from_millis(400);
/// A text of fewer letters is noise.
const LEAST_NAME: usize = 8;

/// A Polhemus, as `serial_line::Session` listens to it.
pub struct Polhemus {
    config: Config,
    decoder: Decoder,
}

impl Polhemus {
    /// The tracker of a configuration that was checked.
    pub fn new(config: Config) -> Self {
        Self { decoder: Decoder::new(Layout::of(config.family)), config }
    }

    /// How its port is opened: both modem lines raised, as a host that is ready does.
    pub fn line_settings(&self) -> LineSettings {
        LineSettings { path: self.config.port.clone(), baud: self.config.baud, rts: true, dtr: true }
    }

    /// Who is there, in words.
    fn greet(&self, line: &mut Line) -> Result<String, Trouble> {
        let (question, most) = commands::who(self.config.family);
        let answer = line.ask(question, most, ANSWER)?;
        if answer.is_empty() {
            return Err(Trouble::Device(self.silence()));
        }
        if self.config.family != Family::Fastrak {
            let name = printable(&answer);
            let readable = answer.iter().filter(|byte| byte.is_ascii_graphic() || byte.is_ascii_whitespace()).count();
            let is_text = name.len() >= LEAST_NAME && 10 * readable > 9 * answer.len();
            return if is_text { Ok(name) } else { Err(Trouble::Device(self.garbage(&answer))) };
        }
        let Some(status) = FastrakStatus::of(&answer) else { return Err(Trouble::Device(self.garbage(&answer))) };
        if status.self_test != 0 {
            let (port, code) = (self.config.port.display(), status.self_test);
            let sentence =
                format!("the Fastrak on {port} fails its own test ({code:03X}): switch it off and on; see its manual");
            return Err(Trouble::Device(sentence));
        }
        Ok(format!("{}, firmware {}", status.name, status.firmware))
    }
}

impl Device for Polhemus {
    type Record = Record;

    fn set_up(&mut self, line: &mut Line) -> Result<String, Trouble> {
        line.carry_out(&commands::hush(self.config.family))?;
        if !line.drain()? {
            return Err(Trouble::Device(self.garbage(&[])));
        }
        let name = self.greet(line)?;
        line.carry_out(&commands::settings(&self.config))?;
        line.drain()?;
        self.decoder.start_anew();
        line.carry_out(&commands::stream(self.config.family))?;
        Ok(name)
    }

    fn take(&mut self, bytes: &[u8], each: &mut dyn FnMut(Heard<Record>)) {
        for (k, &byte) in bytes.iter().enumerate() {
            if let Some(record) = self.decoder.push(byte) {
                each(Heard { record, behind: bytes.len() - 1 - k, missed: self.decoder.take_missed() });
            }
        }
    }

    fn tally(&self) -> Tally {
        self.decoder.tally()
    }

    fn most_silence(&self) -> Duration {
        Duration::from_secs_f64((4.0 / self.config.sheet().rate_hz).max(0.7))
    }

    fn silence(&self) -> String {
        format!(
            "the tracker on {} says nothing: is it on, and started up (10 s)? Is the cable a null-modem cable, and is its \
             baud rate {}?",
            self.config.port.display(),
            self.config.baud
        )
    }

    fn garbage(&self, _sample: &[u8]) -> String {
        format!(
            "what comes from {} is no record of a {:?}: set `baud` (now {}) as its switches have it, `family` as its label \
             says, and let nothing else use the port",
            self.config.port.display(),
            self.config.family,
            self.config.baud
        )
    }
}
