//! Error codes as sentences (manual, chapter 9).

/// What a unit does about an error.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Severity {
    /// It has stopped, and its lamp blinks: ten short, then as many long as the code says.
    Fatal,
    /// It goes on; the lamp has blinked once.
    Warning,
    /// It goes on, and only says so when it is asked.
    Note,
}

/// An error that a unit has reported.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct DeviceError {
    /// As parameter 10 or 16 tells it; 0 is none.
    pub code: u8,
    /// With code 13: the address of the unit that did not answer.
    pub detail: u8,
}

impl DeviceError {
    /// What has happened, and what to do.
    pub fn sentence(&self) -> &'static str {
        match self.code {
            0 => "no error",
            1 => "its memory fails its own test: the unit needs repair",
            2 => "its settings cannot be stored: the unit needs repair",
            3 => {
                "its board is not calibrated or does not answer: switch it off and on; if that does not help it needs repair"
            }
            4 => "no transmitter, or its memory cannot be read: switch off, plug the transmitter in firmly, switch on",
            5 => "no sensor, or its memory cannot be read: switch off, plug the sensor in firmly, switch on",
            6 => {
                "it got a command that it does not know: bytes are lost towards it; lower the baud rate or shorten the cable"
            }
            7 => "it is not the master: the unit on the serial line must have address 1",
            8 => "no bird can be reached from the master: check the FBB cables and that all units fly",
            9 => "the flock is not configured: check `units`, the number of boxes",
            10 => "bytes between the units were lost: check the FBB cables and their terminators",
            11 => "bytes from the host were lost or broken: check the baud rate, and that nothing else uses the port",
            12 => "bytes on the FBB from its host were lost: check the FBB cables",
            13 => "a unit does not answer on the FBB: check its cable, its address switches and that it flies",
            14 => "it got an unknown command over the FBB: check the FBB cables and the units' revisions",
            15 => "it ran out of time on the FBB: switch it off and on",
            16 => "its processor's speed is not known: the unit needs repair",
            17 => "it has no data to give: check that the sensor is plugged in and a transmitter runs",
            18 => "its baud rate switches are set to a rate that does not exist: see the table of rates in the manual",
            19 => "a unit did not acknowledge the master: check the FBB cables and the address switches",
            20..=27 => "its processor trapped: switch it off and on; if it comes again the unit needs repair",
            28 => "there is no CRT synchronisation: none is asked for; set SYNC to 0",
            29 => "the transmitter cannot be reached: check that the unit that drives it is on and flies",
            30 => "the extended range transmitter is not attached: plug it in, or say `scale_inches = 36`",
            31 => "its processor has no time left: lower `rate_hz` or the number of filters",
            32 => "the sensor is saturated: it is too near the transmitter or a source of magnetism",
            33 => "a unit has another configuration than the master: configure the flock anew",
            34 => "its watchdog barked: it was asked for something that it has not, such as a button",
            35 => "it is too hot: let air through, or it will stop",
            _ => "an error that the manual does not know: switch it off and on",
        }
    }

    /// How bad it is.
    pub fn severity(&self) -> Severity {
        match self.code {
            1 | 2 | 15 | 16 | 20..=27 => Severity::Fatal,
            0 | 6..=9 | 31 => Severity::Note,
            _ => Severity::Warning,
        }
    }
}
