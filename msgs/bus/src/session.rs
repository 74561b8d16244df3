//! One node's door to the bus.

use crate::presence::Presence;
use crate::ring::{Bell, Ring};
use crate::{BusConfig, BusError, Publisher, RawSubscriber, Subscriber, publisher, subscriber};
use std::sync::Arc;
use std::time::Duration;
use wire::Message;
use wire::topic::{Topic, ready_key};
use zenoh::liveliness::LivelinessToken;
use zenoh::{Session, Wait};

/// A session with the router, and the bell that all its subscriptions ring.
#[derive(Clone)]
pub struct Bus {
    session: Session,
    onlooker: bool,
    bell: Arc<Bell>,
}

/// Says that a node is there until it is dropped.
pub struct Token(#[allow(dead_code, reason = "held for its drop")] LivelinessToken);

impl Bus {
    /// Connects to the router, waiting for it as long as the configuration says.
    pub fn open(config: &BusConfig) -> Result<Self, BusError> {
        let session = zenoh::open(config.client()?)
            .wait()
            .map_err(BusError::zenoh(format!("connecting to the router at {}", config.endpoint)))?;
        Ok(Self { session, onlooker: config.onlooker, bell: Arc::default() })
    }

    /// A counted, versioned publisher.
    pub fn publisher<M: Message>(&self, topic: &Topic<M>) -> Result<Publisher<M>, BusError> {
        publisher::declare(&self.session, topic)
    }

    /// The messages of a topic, of which the newest `depth` are held for this node.
    pub fn subscribe<M: Message>(&self, topic: &Topic<M>, depth: usize) -> Result<Subscriber<M>, BusError> {
        let subscriber = subscriber::declare(&self.session, topic, self.onlooker, Ring::new(depth, self.bell.clone()))?;
        Ok(if self.onlooker { subscriber.glimpses() } else { subscriber })
    }

    /// Every message whose key matches, undecoded; what was latched or streamed before comes first.
    pub fn subscribe_raw(&self, key_expression: &str, depth: usize) -> Result<RawSubscriber, BusError> {
        crate::raw::declare(&self.session, key_expression, Ring::new(depth, self.bell.clone()))
    }

    /// Sends bytes as they are, under the schema that wrote them: for replaying a recording.
    pub fn forward(&self, key: &str, schema: &str, bytes: Vec<u8>) -> Result<(), BusError> {
        crate::raw::forward(&self.session, key, schema, bytes)
    }

    /// Waits until any subscription has something, or somebody rings; false when the time ran out.
    pub fn wait(&self, timeout: Duration) -> bool {
        self.bell.wait(timeout)
    }

    /// A handle that ends a [`Bus::wait`] from another thread.
    pub fn ringer(&self) -> impl Fn() + Send + Sync + 'static {
        let bell = self.bell.clone();
        move || bell.ring()
    }

    /// Declares that a node (kind/instance) has all its subscriptions and may be sent to.
    pub fn declare_ready(&self, node: &str) -> Result<Token, BusError> {
        let token = self.session.liveliness().declare_token(ready_key(node)).wait();
        token.map(Token).map_err(BusError::zenoh(format!("declaring {node} ready")))
    }

    /// Who is ready, and who has gone, from now on.
    pub fn presence(&self) -> Result<Presence, BusError> {
        Presence::watch(&self.session, self.bell.clone())
    }

    /// Leaves the bus.
    pub fn close(&self) -> Result<(), BusError> {
        self.session.close().wait().map_err(BusError::zenoh("leaving the bus"))
    }
}
