//! When the operator of a rig begins a scan.

use crate::operator::is_scanning;
use crate::running::{self, Running};
use anyhow::Result;
use bus::{Bus, BusConfig, BusError, Subscriber};
use std::time::Duration;
use wire::{RunPhase, topic};

/// A scan has begun.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Begun {
    /// Its number.
    pub scan: u64,
    /// The system clock when the scan's own clock stood at 0.
    pub epoch_nanos: i64,
}

/// Waits for the rig of a name, and listens to its operator while it is up.
pub struct Follow {
    name: String,
    joined: Option<Joined>,
    last: Option<Begun>,
}

struct Joined {
    rig: Running,
    bus: Bus,
    phases: Subscriber<RunPhase>,
}

impl Follow {
    /// Nothing is up yet.
    pub fn new(name: String) -> Self {
        Self { name, joined: None, last: None }
    }

    /// Rests for so long or until something has come; the scan that has begun since it was asked last.
    pub fn look(&mut self, nap: Duration) -> Result<Option<Begun>> {
        let up = running::all(&running::folder()?)?.into_iter().find(|rig| rig.name == self.name);
        if self.joined.as_ref().map(|joined| &joined.rig) != up.as_ref() {
            self.joined = up.and_then(|rig| self.join(rig));
        }
        let Some(Joined { bus, phases, .. }) = &mut self.joined else {
            std::thread::sleep(nap);
            return Ok(None);
        };
        bus.wait(nap);
        let newest = std::iter::from_fn(|| phases.next()).last().filter(|run| is_scanning(run.header.phase));
        let begun = newest.map(|run| Begun { scan: run.header.scan, epoch_nanos: run.header.stamp_nanos });
        if begun.is_none() || begun == self.last {
            return Ok(None);
        }
        self.last = begun;
        Ok(begun)
    }

    /// A rig that is about to end may be gone by now: that is no failure.
    fn join(&self, rig: Running) -> Option<Joined> {
        let open = || -> Result<_, BusError> {
            let bus = Bus::open(&BusConfig { onlooker: true, ..rig.bus.clone() })?;
            let phases = bus.subscribe(&topic::run_phase(), 16)?;
            Ok((bus, phases))
        };
        match open() {
            Ok((bus, phases)) => {
                tracing::info!("the rig {} is up", self.name);
                Some(Joined { rig, bus, phases })
            }
            Err(error) => {
                tracing::debug!("{error}");
                None
            }
        }
    }
}
