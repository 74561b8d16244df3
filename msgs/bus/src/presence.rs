//! Who is ready: every node declares a token behind its last subscription.

use crate::BusError;
use crate::ring::Bell;
use std::collections::BTreeSet;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use wire::topic::ready_key;
use zenoh::pubsub::Subscriber;
use zenoh::sample::SampleKind;
use zenoh::{Session, Wait};

/// The nodes that are ready now.
pub struct Presence {
    ready: Arc<Mutex<BTreeSet<String>>>,
    arrivals: Arc<AtomicU64>,
    #[allow(dead_code, reason = "held for its drop")]
    subscriber: Subscriber<()>,
}

impl Presence {
    pub(crate) fn watch(session: &Session, bell: Arc<Bell>) -> Result<Self, BusError> {
        let ready: Arc<Mutex<BTreeSet<String>>> = Arc::default();
        let arrivals = Arc::<AtomicU64>::default();
        let (seen, came, prefix) = (ready.clone(), arrivals.clone(), ready_key(""));
        let subscriber = session
            .liveliness()
            .declare_subscriber(ready_key("**"))
            .history(true)
            .callback(move |sample| {
                let Some(node) = sample.key_expr().as_str().strip_prefix(prefix.as_str()) else { return };
                let mut ready = seen.lock().unwrap_or_else(PoisonError::into_inner);
                match sample.kind() {
                    SampleKind::Put => {
                        came.fetch_add(1, Ordering::SeqCst);
                        ready.insert(node.to_owned())
                    }
                    SampleKind::Delete => ready.remove(node),
                };
                drop(ready);
                bell.ring();
            })
            .wait()
            .map_err(BusError::zenoh("watching who is ready"))?;
        Ok(Self { ready, arrivals, subscriber })
    }

    /// How often any node has become ready so far; one that is started again counts again.
    pub fn arrivals(&self) -> u64 {
        self.arrivals.load(Ordering::SeqCst)
    }

    /// kind/instance of every node that is ready.
    pub fn nodes(&self) -> BTreeSet<String> {
        self.ready.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}
