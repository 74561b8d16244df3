//! Keeps one node alive until the rig stops.

use crate::backoff::Backoff;
use crate::board::{Board, Event};
use crate::log::{Line, Sink};
use crate::planned::Restart;
use crate::process::{Process, Start};
use crate::stop::Rung;
use crate::story::story;
use anyhow::Result;
use std::time::Instant;
use tokio::sync::watch;
use wire::LogLevel;

/// What one supervisor needs to know.
pub(crate) struct Supervisor {
    pub(crate) start: Start,
    pub(crate) restart: Restart,
    pub(crate) board: Board,
    pub(crate) sink: Sink,
    pub(crate) rung: watch::Receiver<Rung>,
}

impl Supervisor {
    /// Starts the node, and again when it fails, until it ends, has failed for good, or is stopped.
    pub(crate) async fn run(mut self) {
        let mut backoff = Backoff::default();
        loop {
            let Err(reason) = self.live().await else { return self.tell(|node| Event::Ended { node }) };
            let reason = story(&reason);
            if *self.rung.borrow() > Rung::Finish {
                // Told to stop, it stopped; that it did so by a signal is the ladder's affair.
                return self.tell(|node| Event::Ended { node });
            }
            let may_restart = self.restart == Restart::OnFailure && *self.rung.borrow() == Rung::Run;
            let Some(pause) = may_restart.then(|| backoff.failed(Instant::now())).flatten() else {
                self.say(&format!("failed for good: {reason}"));
                return self.tell(|node| Event::Failed { node, reason });
            };
            self.start.spec.next_seq = Some(self.board.next_seq(&self.start.name));
            self.say(&format!("failed: {reason}; again in {} ms", pause.as_millis()));
            self.tell(|node| Event::Restarting { node, reason: reason.clone() });
            let stopping = self.rung.wait_for(|rung| *rung > Rung::Run);
            if tokio::time::timeout(pause, stopping).await.is_ok() {
                return self.tell(|node| Event::Failed { node, reason });
            }
        }
    }

    async fn live(&mut self) -> Result<()> {
        let mut process = Process::start(&self.start, self.rung.clone(), &self.sink)?;
        let pid = process.pid;
        self.tell(|node| Event::Started { node, pid });
        let status = process.wait(&mut self.rung).await?;
        match (status.success(), process.last_words()) {
            (true, _) => Ok(()),
            (false, words) if words.is_empty() => Err(anyhow::anyhow!("{status}")),
            (false, words) => Err(anyhow::anyhow!("{words} ({status})")),
        }
    }

    fn tell(&self, event: impl FnOnce(String) -> Event) {
        self.board.tell(event(self.start.name.clone()));
    }

    fn say(&self, text: &str) {
        (self.sink)(&Line { node: self.start.name.clone(), level: LogLevel::Error, text: text.to_owned() });
    }
}
