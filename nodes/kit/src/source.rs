//! What a source waits for: the operator's word, and its turn.

use crate::node::{NAP, Node};
use crate::pace::{Go, Pace, until};
use crate::window::Turn;
use std::time::Duration;
use wire::{Header, Phase, RunPhase};

impl Node {
    /// For a source: waits until its device gives something, so that no scan begins without it by itself; or until the
    /// operator has begun one all the same. False when the node was told to stop.
    pub fn wait_for_device(&mut self, gives: impl Fn() -> bool) -> bool {
        let begun = |run: &RunPhase| !matches!(run.header.phase, Phase::Aim | Phase::End);
        while !gives() && !self.phase.as_ref().is_some_and(begun) {
            if !self.wait() {
                return false;
            }
        }
        true
    }

    /// For a source: waits until the nodes it needs are ready and the operator has chosen a phase. `None` when the node
    /// was told to stop.
    pub fn wait_for_go(&mut self, after_scan: Option<u64>) -> anyhow::Result<Option<Go>> {
        let presence = self.bus.presence()?;
        loop {
            let ready = presence.nodes();
            let all_ready = self.spec.wait_for.iter().all(|node| ready.contains(node));
            if let Some(run) = &self.phase
                && all_ready
                && !matches!(run.header.phase, Phase::Aim | Phase::End)
                && after_scan.is_none_or(|scan| run.header.scan > scan)
            {
                let Header { scan, phase, stamp_nanos, .. } = run.header;
                if let Some(window) = &mut self.window {
                    window.start_scan(scan);
                }
                return Ok(Some(Go { scan, phase, epoch_nanos: stamp_nanos }));
            }
            if !self.wait() {
                return Ok(None);
            }
        }
    }

    /// For a source: waits until a message with this stamp may be sent. False when the node was told to stop, or the
    /// operator has ended the scan.
    pub fn wait_for_turn(&mut self, go: &Go, stamp_nanos: i64) -> bool {
        loop {
            // A source that is behind its time never rests, and must hear the operator all the same.
            self.hear();
            let ended =
                self.phase.as_ref().is_some_and(|run| run.header.phase == Phase::End || run.header.scan > go.scan);
            if ended || self.stopper.is_stopping() {
                return false;
            }
            let nap = match self.spec.pace {
                Pace::Real => until(go.epoch_nanos, stamp_nanos),
                Pace::Fast => self.nap_behind_window(stamp_nanos),
            };
            let Some(nap) = nap else {
                self.say();
                return true;
            };
            self.rest(nap.min(NAP));
        }
    }

    /// How long to rest before asking again; `None` when it may be sent.
    fn nap_behind_window(&mut self, stamp_nanos: i64) -> Option<Duration> {
        let window = self.window.as_mut()?;
        match window.turn(stamp_nanos) {
            Turn::Now => None,
            Turn::Wait => Some(NAP),
            Turn::Anyway => {
                tracing::warn!("waited long for {}, which does not move: sending on", window.slowest());
                self.refuse("wait for a node that did not move", 1);
                None
            }
        }
    }
}
