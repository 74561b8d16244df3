//! How messages travel: the only crate that names zenoh.
//!
//! A [`Router`] stands on loopback; every node is a client of it ([`Bus::open`]), so that no two nodes can ever be in
//! parts that do not see each other. A [`Publisher`] counts what it sends and says which version wrote it; a
//! [`Subscriber`] checks the version before it decodes, counts gaps, and holds the newest messages in a ring: a full
//! queue would stop every topic of its session. What is latched or streamed is kept by the publisher for whoever comes
//! late (`wire::topic::Class`).
//!
//! ```
//! use bus::{Bus, BusConfig, Router};
//! use wire::{RunPhase, Header, Phase, topic};
//! let router = Router::start(&BusConfig::default()).unwrap();
//! let config = BusConfig { endpoint: router.endpoint().to_owned(), ..BusConfig::default() };
//! let (sender, receiver) = (Bus::open(&config).unwrap(), Bus::open(&config).unwrap());
//! let mut publisher = sender.publisher(&topic::run_phase()).unwrap();
//! publisher.send(RunPhase { header: Header { phase: Phase::Shape, ..Header::default() }, discard: false }).unwrap();
//! // The subscriber comes late, and gets it all the same: the topic is latched.
//! let mut phases = receiver.subscribe(&topic::run_phase(), 8).unwrap();
//! let phase = loop {
//!     if let Some(message) = phases.next() { break message.header.phase; }
//!     receiver.wait(std::time::Duration::from_secs(1));
//! };
//! assert_eq!(phase, Phase::Shape);
//! ```

mod account;
mod config;
mod presence;
mod publisher;
mod raw;
mod ring;
mod router;
mod session;
mod subscriber;

pub use account::SequenceAccount;
pub use config::{BusConfig, Tls};
pub use presence::Presence;
pub use publisher::{GATHERED_HISTORY, Publisher, STREAM_HISTORY};
pub use raw::{RawMessage, RawSubscriber};
pub use router::Router;
pub use session::{Bus, Token};
pub use subscriber::{InputCounts, Subscriber};

/// Why the bus cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum BusError {
    /// The configuration asks for what is not safe or not possible.
    #[error("bus: {0}")]
    Config(String),
    /// Zenoh said no.
    #[error("bus: {doing}: {reason}")]
    Zenoh {
        /// What was being done.
        doing: String,
        /// What Zenoh said.
        reason: String,
    },
}

impl BusError {
    fn zenoh(doing: impl Into<String>) -> impl FnOnce(zenoh::Error) -> Self {
        let doing = doing.into();
        move |reason| Self::Zenoh { doing, reason: reason.to_string() }
    }
}
