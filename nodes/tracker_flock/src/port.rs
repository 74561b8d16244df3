//! The flock at the other end of a line: set up from any state, and listened to.

mod blind;
mod examination;

use crate::config::Config;
use crate::protocol::address::addressed;
use crate::protocol::commands::{self, POINT, XON};
use crate::protocol::decoder::Decoder;
use crate::protocol::modem;
use crate::protocol::reading::{QuaternionSense, Reading, settle_sense};
use crate::protocol::records::{Format, Layout, Record};
use crate::protocol::test_mode::is_test_mode;
use crate::tracker::Heard;
use blind::Blind;
use examination::{EAVESDROP, Examination, Found, Greeting};
use serial_line::{Device, Heard as HeardAt, Line, LineSettings, Tally, Trouble};
use std::time::Duration;

/// Answers come within a cycle or two, at the slowest line within a few more.
pub(crate) const ANSWER: Duration = Duration::from_millis(300);
/// So often a still sensor is looked for when the quaternion's sense is not known.
const SENSE_TRIES: usize = 3;
/// A sensor that measures nothing for so long is asked why.
const BLIND_S: f64 = 0.5;

/// A flock, as `serial_line::Session` listens to it.
pub struct Flock {
    config: Config,
    layout: Layout,
    decoder: Decoder,
    sense: QuaternionSense,
    /// It was told that a bird may be starting up.
    starting: bool,
    blind: Blind,
}

impl Flock {
    /// Until it is said that nobody answers on a line that is quiet.
    pub const FIRST_WORD: Duration = Line::QUIET.saturating_add(ANSWER).saturating_add(EAVESDROP);

    /// The flock of a configuration that was checked.
    pub fn new(config: Config) -> Self {
        let layout = Layout { metal: config.metal, ..Layout::plain(config.output) };
        let (decoder, blind) = (Decoder::new(layout), Blind::new(&config.addresses()));
        Self { layout, decoder, sense: QuaternionSense::AsMatrix, starting: false, blind, config }
    }

    /// How its port is opened.
    pub fn line_settings(&self) -> LineSettings {
        // DTR low would hold all output; RTS high would hold the bird in standby.
        LineSettings { path: self.config.port.clone(), baud: self.config.baud, rts: self.config.raise_rts, dtr: true }
    }

    /// Makes it fly, and looks who is there. What takes longer than a second is told first, and done when this is called
    /// once more on the same line.
    fn wake(&mut self, line: &mut Line) -> Result<Greeting, Trouble> {
        if !line.has_modem_lines() {
            return self.greet(line);
        }
        let (reset, starting) = (self.config.reset, std::mem::take(&mut self.starting));
        if reset && !starting {
            return self.wait_for(|port| format!("the bird on {port} is reset by RTS, which takes three seconds"));
        }
        for step in modem::wake(reset, starting) {
            line.set_rts(step.high || (self.config.raise_rts && !reset));
            line.pause(step.wait)?;
        }
        match self.greet(line) {
            Err(Trouble::Device(sentence)) if !starting => {
                self.wait_for(|_| format!("{sentence}. It may be starting up: it is asked again in two seconds"))
            }
            greeted => greeted,
        }
    }

    fn wait_for(&mut self, told: impl FnOnce(std::path::Display) -> String) -> Result<Greeting, Trouble> {
        self.starting = true;
        Err(Trouble::Starting(told(self.config.port.display())))
    }

    fn greet(&self, line: &mut Line) -> Result<Greeting, Trouble> {
        self.hush(line)?;
        Examination { line, config: &self.config }.greet()
    }

    /// Ends the stream and lets it run dry: answers to EXAMINE have no mark of their own.
    fn hush(&self, line: &mut Line) -> Result<(), Trouble> {
        line.write(&[XON, POINT])?;
        if line.drain()? { Ok(()) } else { Err(Trouble::Device(self.garbage(&[]))) }
    }

    /// All that have a sensor speak in group mode, so all are told the same format.
    fn choose_format(&mut self, line: &mut Line, found: &Found, format: Format) -> Result<(), Trouble> {
        for &address in &found.with_sensor {
            line.carry_out(&[commands::format(address, format)])?;
        }
        self.layout.format = format;
        Ok(())
    }

    /// One record of one unit, outside group mode.
    fn point(&self, line: &mut Line, address: u8) -> Result<Option<Record>, Trouble> {
        line.drain()?;
        let bytes = line.ask(&addressed(address, &[POINT]), self.layout.bytes(), ANSWER)?;
        let mut decoder = Decoder::new(self.layout);
        Ok(bytes.iter().find_map(|&byte| decoder.push(byte)))
    }

    /// Reads a still sensor as matrix and as quaternion. When that does not tell, matrices are sent instead: their sense
    /// was never in doubt. What was settled, in words.
    fn settle(&mut self, line: &mut Line, found: &Found) -> Result<String, Trouble> {
        let output = self.config.output;
        let address = self.config.addresses().first().copied().unwrap_or(0);
        for _ in 0..SENSE_TRIES {
            let mut turns = [None, None];
            for (turn, format) in turns.iter_mut().zip([Format::PositionMatrix, Format::PositionQuaternion]) {
                self.choose_format(line, found, format)?;
                let record = self.point(line, address)?;
                let read = |record| Reading::of(&record, self.config.scale_inches, QuaternionSense::AsMatrix).ok();
                *turn = record.and_then(read).and_then(|reading| reading.rotation);
            }
            let [Some(matrix), Some(quaternion)] = turns else { continue };
            if let Some(sense) = settle_sense(&matrix, &quaternion) {
                self.sense = sense;
                self.choose_format(line, found, output)?;
                return Ok(match sense {
                    QuaternionSense::AsMatrix => ", quaternions turn as the matrix does".to_owned(),
                    QuaternionSense::Inverse => ", quaternions turn against the matrix, and are inverted".to_owned(),
                });
            }
        }
        self.choose_format(line, found, Format::PositionMatrix)?;
        Ok(", matrices are sent: the sensor moved or stood straight, so the quaternion's sense could not be settled"
            .to_owned())
    }
}

impl Device for Flock {
    type Record = Heard;

    fn set_up(&mut self, line: &mut Line) -> Result<String, Trouble> {
        let greeting = self.wake(line)?;
        if self.config.is_group() {
            line.carry_out(&[commands::group_mode(false)])?;
            line.carry_out(&commands::auto_configuration(self.config.unit_count()))?;
        }
        line.drain()?;
        let found = Examination { line, config: &self.config }.units(greeting)?;
        line.carry_out(&commands::settings(&self.config))?;
        let mut words = found.words.clone();
        if let Some(complaint) = (Examination { line, config: &self.config }).complaint()? {
            words += &complaint;
        }
        self.layout.group = false;
        if self.config.output.has_quaternion() {
            words += &self.settle(line, &found)?;
        } else {
            self.choose_format(line, &found, self.config.output)?;
        }
        if self.config.is_group() {
            line.carry_out(&[commands::group_mode(true)])?;
            self.layout.group = true;
        }
        line.drain()?;
        self.decoder.expect(self.layout);
        line.carry_out(&commands::stream(self.config.report_every))?;
        Ok(words)
    }

    fn take(&mut self, bytes: &[u8], each: &mut dyn FnMut(HeardAt<Heard>)) {
        for (k, &byte) in bytes.iter().enumerate() {
            if let Some(record) = self.decoder.push(byte) {
                let missed = self.decoder.take_missed();
                let measured = Reading::of(&record, self.config.scale_inches, self.sense).is_ok();
                self.blind.note(record.address, measured);
                let heard = Heard { record, layout: self.layout, sense: self.sense };
                each(HeardAt { record: heard, behind: bytes.len() - 1 - k, missed });
            }
        }
    }

    /// A bird says only when it is asked that a sensor is saturated, and can be asked only when its stream stands still.
    fn ask_why(&mut self, line: &mut Line) -> Result<Option<String>, Trouble> {
        let records = BLIND_S * self.config.rate_hz / f64::from(self.config.report_every);
        let Some(address) = self.blind.whom(records.max(2.0) as u32) else { return Ok(None) };
        self.hush(line)?;
        let error = Examination { line, config: &self.config }.error_of(address)?;
        self.decoder.expect(self.layout);
        line.carry_out(&commands::stream(self.config.report_every))?;
        let port = self.config.port.display();
        Ok((error.code != 0).then(|| format!("unit {address} on {port} measures nothing: {}", error.sentence())))
    }

    fn tally(&self) -> Tally {
        self.decoder.tally()
    }

    fn most_silence(&self) -> Duration {
        let period = f64::from(self.config.report_every) / self.config.rate_hz;
        Duration::from_secs_f64((4.0 * period).max(0.7))
    }

    fn silence(&self) -> String {
        silence(&self.config)
    }

    fn garbage(&self, sample: &[u8]) -> String {
        garbage(&self.config, sample)
    }
}

pub(crate) fn silence(config: &Config) -> String {
    format!(
        "the bird on {} says nothing: is it on, and its switch at FLY? A fully wired cable holds it in standby while RTS is \
         high (cut all wires but 2, 3 and 5, or leave `raise_rts = false`); or its baud rate is not {}",
        config.port.display(),
        config.baud
    )
}

pub(crate) fn garbage(config: &Config, sample: &[u8]) -> String {
    let port = config.port.display();
    if is_test_mode(sample) {
        return format!(
            "the bird on {port} is in test mode: set its switch 8 to fly (off), and FLY/STBY once to and fro"
        );
    }
    format!(
        "what comes from {port} is no record of a bird: set `baud` (now {}) as its switches 1 to 3 have it, and let nothing \
         else use the port",
        config.baud
    )
}
