//! A rig that stays up behind its scan, so that its page can be looked at.

use crate::launcher::Launcher;
use crate::running::Announced;
use crate::up::Interrupts;
use anyhow::Result;
use tokio::runtime::Runtime;

/// What runs, and what would stop it.
pub(super) struct Rig {
    pub launcher: Launcher,
    pub interrupts: Interrupts,
    pub announced: Option<Announced>,
}

impl Rig {
    pub async fn stop(&mut self) {
        drop(self.announced.take());
        self.launcher.stop().await;
    }
}

/// A rig that runs still. When it is dropped, its nodes are killed.
pub struct Standing {
    rig: Rig,
    runtime: Runtime,
}

impl Standing {
    pub(super) fn new(runtime: Runtime, rig: Rig) -> Self {
        Self { rig, runtime }
    }

    /// Until somebody interrupts it, or has done so since the scan began; then its nodes are stopped. Fails when one of them
    /// has failed meanwhile.
    pub fn stay(self) -> Result<()> {
        let Self { mut rig, runtime } = self;
        runtime.block_on(async {
            rig.interrupts.next().await;
            rig.stop().await;
        });
        let outcome = rig.launcher.check();
        runtime.shutdown_background();
        outcome
    }
}
