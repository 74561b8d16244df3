//! What the flock says of itself, and whether it is the flock that was configured.

use super::{ANSWER, garbage, silence};
use crate::config::Config;
use crate::protocol::address::{Addressing, addressed};
use crate::protocol::errors::{DeviceError, Severity};
use crate::protocol::examine::{self, Parameter, Status, UnitStatus};
use serial_line::{Line, Trouble};
use std::time::{Duration, Instant};

/// So long is listened to a unit that did not answer, to say what it does instead: test mode speaks twice a second.
pub(super) const EAVESDROP: Duration = Duration::from_millis(550);
/// Group mode came with this revision.
const GROUP_REVISION: [u8; 2] = [3, 33];
/// Questions above number 16 came with this one.
const ADDRESSING_REVISION: [u8; 2] = [3, 45];
/// The code of the error that a setting leaves which a revision does not know.
const UNKNOWN_COMMAND: u8 = 6;

/// Who answered.
pub(super) struct Greeting {
    words: String,
    revision: [u8; 2],
}

/// What is there.
pub(super) struct Found {
    /// In words.
    pub words: String,
    /// The units that speak when all are asked; 0 is a bird alone.
    pub with_sensor: Vec<u8>,
}

/// Asks; the stream stands still.
pub(super) struct Examination<'a> {
    pub line: &'a mut Line,
    pub config: &'a Config,
}

impl Examination<'_> {
    /// Looks whether somebody is there, and who.
    pub fn greet(&mut self) -> Result<Greeting, Trouble> {
        let mut heard = self.raw(Parameter::Status)?;
        let Ok(status) = <[u8; 2]>::try_from(&heard[..]) else { return Err(self.eavesdrop(heard)?) };
        let letters = self.raw(Parameter::Model)?;
        let model = examine::model(&letters);
        let whole = letters.len() == Parameter::Model.answer_bytes(self.config.addressing);
        if !whole || model.is_empty() || !model.chars().all(|letter| letter.is_ascii_alphanumeric()) {
            heard.extend(letters);
            return Err(Trouble::Device(garbage(self.config, &heard)));
        }
        let revision = self.two(Parameter::Revision)?.unwrap_or_default();
        let error = self.last_error()?;
        if error.severity() == Severity::Fatal {
            return Err(self.failed(error));
        }
        if self.config.is_group() && !Status::of(status).is_master() {
            return Err(self.failed(DeviceError { code: 7, detail: 0 }));
        }
        if self.config.is_group() && revision < GROUP_REVISION {
            let sentence = format!(
                "the bird on {} has revision {}; group mode needs 3.33: leave `sensors` empty and use one bird alone",
                self.config.port.display(),
                examine::revision(revision)
            );
            return Err(Trouble::Device(sentence));
        }
        let mut words = format!("{model}, revision {}", examine::revision(revision));
        if error.code != 0 {
            words += &format!(", which had reported: {}", error.sentence());
        }
        Ok(Greeting { words, revision })
    }

    /// Looks which units are there, behind the auto-configuration.
    pub fn units(&mut self, greeting: Greeting) -> Result<Found, Trouble> {
        let Greeting { words, revision } = greeting;
        if !self.config.is_group() {
            return Ok(Found { words, with_sensor: vec![0] });
        }
        if revision >= ADDRESSING_REVISION {
            self.check_addressing()?;
        }
        let configured = self.two(Parameter::Status)?.is_some_and(|status| Status::of(status).is_configured());
        if !configured {
            let error = self.last_error()?;
            return Err(self.failed(if error.code == 0 { DeviceError { code: 9, detail: 0 } } else { error }));
        }
        let flock = self.ask(Parameter::FlockStatus)?.unwrap_or_default();
        let unit = |address: u8| {
            flock.get(usize::from(address).wrapping_sub(1)).map_or(UnitStatus(0), |&byte| UnitStatus(byte))
        };
        for &address in &self.config.sensors {
            let trouble = match unit(address) {
                unit if !unit.is_accessible() => "cannot be reached: check its power, its FLY switch and its FBB cable",
                unit if !unit.has_sensor() => "has no sensor: switch it off, plug the sensor in, switch it on",
                unit if !unit.runs() => "does not run: set its switch to FLY",
                _ => continue,
            };
            let port = self.config.port.display();
            return Err(Trouble::Device(format!("unit {address} of the flock on {port} {trouble}")));
        }
        let speaks = |address: &u8| unit(*address).is_accessible() && unit(*address).has_sensor();
        let with_sensor: Vec<u8> = (1..=self.config.addressing.most()).filter(speaks).collect();
        Ok(Found { words: format!("{words}, sensors on units {with_sensor:?}"), with_sensor })
    }

    /// How many bytes tell the state of the flock depends on it.
    fn check_addressing(&mut self) -> Result<(), Trouble> {
        let answer = self.ask(Parameter::Addressing)?;
        let said = answer.and_then(|answer| Addressing::from_code(*answer.first()?));
        let Some(said) = said.filter(|said| *said != self.config.addressing) else { return Ok(()) };
        let (port, name) = (self.config.port.display(), said.name());
        Err(Trouble::Device(format!(
            "the switches of the flock on {port} say {name} addressing: set `addressing = \"{name}\"`, or the switches"
        )))
    }

    /// What it says to the settings; an old revision does not know all of them, and measures all the same.
    pub fn complaint(&mut self) -> Result<Option<String>, Trouble> {
        let error = self.last_error()?;
        let about = if error.code == UNKNOWN_COMMAND { "did not take all settings" } else { "reports" };
        Ok((error.code != 0).then(|| format!(", which {about}: {}", error.sentence())))
    }

    fn last_error(&mut self) -> Result<DeviceError, Trouble> {
        self.error_of(0)
    }

    /// The last error of a unit; 0 is whoever is on the line.
    pub fn error_of(&mut self, address: u8) -> Result<DeviceError, Trouble> {
        let answer = self.line.ask(&addressed(address, &Parameter::Error.question()), 1, ANSWER)?;
        Ok(DeviceError { code: answer.first().copied().unwrap_or(0), detail: 0 })
    }

    fn failed(&self, error: DeviceError) -> Trouble {
        Trouble::Device(format!("the bird on {}: {}", self.config.port.display(), error.sentence()))
    }

    /// Nobody answered as a bird does: what is there instead?
    fn eavesdrop(&mut self, mut heard: Vec<u8>) -> Result<Trouble, Trouble> {
        let started = Instant::now();
        let mut buffer = [0u8; 256];
        while started.elapsed() < EAVESDROP {
            let chunk = self.line.read(&mut buffer)?;
            heard.extend_from_slice(&buffer[..chunk.len]);
        }
        let sentence = if heard.is_empty() { silence(self.config) } else { garbage(self.config, &heard) };
        Ok(Trouble::Device(sentence))
    }

    fn two(&mut self, parameter: Parameter) -> Result<Option<[u8; 2]>, Trouble> {
        Ok(self.ask(parameter)?.and_then(|answer| <[u8; 2]>::try_from(answer).ok()))
    }

    /// The answer, when it came whole.
    fn ask(&mut self, parameter: Parameter) -> Result<Option<Vec<u8>>, Trouble> {
        let answer = self.raw(parameter)?;
        Ok((answer.len() == parameter.answer_bytes(self.config.addressing)).then_some(answer))
    }

    /// What came of an answer.
    fn raw(&mut self, parameter: Parameter) -> Result<Vec<u8>, Trouble> {
        let len = parameter.answer_bytes(self.config.addressing);
        Ok(self.line.ask(&parameter.question(), len, ANSWER)?)
    }
}
