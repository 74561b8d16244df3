//! No node outlives its launcher: a node whose stdin closes stops, however the launcher died.

use std::io::Read;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// How long a node may take to put its things away once it was told to stop.
const GRACE: Duration = Duration::from_secs(8);

/// Tells a node to stop.
#[derive(Clone)]
pub struct Stopper {
    stopping: Arc<AtomicBool>,
    ring: Arc<dyn Fn() + Send + Sync>,
}

impl Stopper {
    pub(crate) fn new(ring: impl Fn() + Send + Sync + 'static) -> Self {
        Self { stopping: Arc::default(), ring: Arc::new(ring) }
    }

    /// Stop when the message in hand is done.
    pub fn stop(&self) {
        self.stopping.store(true, Ordering::SeqCst);
        (self.ring)();
    }

    /// True once it was told.
    pub fn is_stopping(&self) -> bool {
        self.stopping.load(Ordering::SeqCst)
    }

    /// Stops the node when stdin closes; ends the process when it does not stop within its grace.
    pub(crate) fn hold_stdin(&self) {
        let stopper = self.clone();
        std::thread::spawn(move || {
            let mut buffer = [0u8; 256];
            let mut stdin = std::io::stdin().lock();
            while !matches!(stdin.read(&mut buffer), Ok(0) | Err(_)) {}
            stopper.stop();
            std::thread::sleep(GRACE);
            tracing::error!("did not stop within {GRACE:?} of its launcher's end: ending the process");
            std::process::exit(70);
        });
    }
}
