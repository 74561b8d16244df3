//! The meeting point of all nodes of a rig; the launcher embeds it.

use crate::{BusConfig, BusError};
use zenoh::{Session, Wait};

/// A Zenoh router inside this process.
pub struct Router {
    session: Session,
    endpoint: String,
}

impl Router {
    /// Starts listening where the configuration says.
    pub fn start(config: &BusConfig) -> Result<Self, BusError> {
        let session = zenoh::open(config.router()?)
            .wait()
            .map_err(BusError::zenoh(format!("starting the router on {}", config.endpoint)))?;
        let locators = session.info().locators().wait();
        let endpoint = locators
            .iter()
            .map(|locator| locator.address().to_string())
            .next()
            .ok_or_else(|| BusError::Config(format!("the router listens nowhere on {}", config.endpoint)))?;
        Ok(Self { session, endpoint })
    }

    /// `host:port` as it was given by the system.
    pub fn endpoint(&self) -> &str {
        &self.endpoint
    }

    /// Closes every link.
    pub fn stop(self) -> Result<(), BusError> {
        self.session.close().wait().map_err(BusError::zenoh("stopping the router"))
    }
}
