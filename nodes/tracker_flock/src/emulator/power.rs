//! Standby and reset by the line RTS, and of the slaves by their master.

use super::FlockEmulator;
use super::fault::Fault;
use super::unit::Unit;

/// From the moment that RTS falls until a unit hears.
const START_UP_NANOS: i64 = 1_500_000_000;

impl FlockEmulator {
    /// The host raises or lowers RTS (with a fully wired cable): high is standby, in which a unit neither hears nor speaks;
    /// when it falls, all units start up as if they had been switched on.
    pub fn set_rts(&mut self, high: bool, now_nanos: i64) {
        let falls = std::mem::replace(&mut self.standby, high) && !high;
        if !falls {
            return;
        }
        self.units = self.units.iter().map(|unit| Unit::new(unit.address)).collect();
        self.configured = self.config.units == 0;
        self.rate_hz = self.config.rate_hz;
        (self.group, self.streaming, self.held) = (false, false, false);
        (self.report_every, self.sync, self.fault) = (1, 0, Fault::new(0));
        self.heard.clear();
        self.busy_until = now_nanos + START_UP_NANOS;
    }

    /// FBB RESET: all but the master start up as if they had been switched on, and the flock wants to be configured anew.
    pub(super) fn restart_slaves(&mut self, now_nanos: i64) {
        self.units.iter_mut().skip(1).for_each(|unit| *unit = Unit::new(unit.address));
        self.configured &= self.units.len() == 1;
        self.streaming &= self.configured;
        self.busy_until = now_nanos + super::CONFIGURING_NANOS;
    }
}
