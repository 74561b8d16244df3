//! Where the bus is, and who may reach it.

use crate::BusError;
use serde::{Deserialize, Serialize};
use zenoh::Config;

/// How to reach the router of a rig.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct BusConfig {
    /// `host:port`; port 0 lets the router choose.
    pub endpoint: String,
    /// Set before every key, so that two rigs on one router never meet.
    pub namespace: String,
    /// Certificates, without which nothing but loopback is listened to.
    pub tls: Option<Tls>,
    /// Large messages between processes of one machine by shared memory.
    pub shared_memory: bool,
    /// How long a node waits for the router.
    pub connect_timeout_ms: u64,
}

/// Mutual TLS: both sides show a certificate of the same authority.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Tls {
    /// The authority's certificate (PEM file).
    pub root_ca: String,
    /// This side's certificate (PEM file).
    pub certificate: String,
    /// This side's private key (PEM file).
    pub private_key: String,
}

impl Default for BusConfig {
    fn default() -> Self {
        Self {
            endpoint: "127.0.0.1:0".to_owned(),
            namespace: "limn".to_owned(),
            tls: None,
            shared_memory: false,
            connect_timeout_ms: 10_000,
        }
    }
}

impl BusConfig {
    /// Refuses to leave loopback without certificates.
    pub fn check(&self) -> Result<(), BusError> {
        let host = self.endpoint.rsplit_once(':').map_or(self.endpoint.as_str(), |(host, _)| host);
        let loopback = matches!(host, "localhost" | "[::1]") || host.starts_with("127.");
        if !loopback && self.tls.is_none() {
            return Err(BusError::Config(format!(
                "endpoint {:?} is not loopback: anybody on that network could read and steer the rig. Give [bus.tls] \
                 root_ca, certificate and private_key, or use 127.0.0.1",
                self.endpoint
            )));
        }
        if self.namespace.is_empty() || self.namespace.split('/').any(|chunk| wire::topic::check_name(chunk).is_err()) {
            return Err(BusError::Config(format!("namespace {:?}: a-z, 0-9, _ and single slashes", self.namespace)));
        }
        Ok(())
    }

    fn locator(&self) -> String {
        let protocol = if self.tls.is_some() { "tls" } else { "tcp" };
        format!("{protocol}/{}", self.endpoint)
    }

    /// For the router: listens, finds nobody by itself.
    pub(crate) fn router(&self) -> Result<Config, BusError> {
        self.check()?;
        let mut config = self.base("router")?;
        set(&mut config, "listen/endpoints", &format!("[{:?}]", self.locator()))?;
        Ok(config)
    }

    /// For a node: connects, never listens.
    pub(crate) fn client(&self) -> Result<Config, BusError> {
        self.check()?;
        let mut config = self.base("client")?;
        set(&mut config, "namespace", &format!("{:?}", self.namespace))?;
        set(&mut config, "connect/endpoints", &format!("[{:?}]", self.locator()))?;
        set(&mut config, "connect/timeout_ms", &self.connect_timeout_ms.to_string())?;
        Ok(config)
    }

    fn base(&self, mode: &str) -> Result<Config, BusError> {
        let mut config = Config::default();
        set(&mut config, "mode", &format!("{mode:?}"))?;
        set(&mut config, "scouting/multicast/enabled", "false")?;
        set(&mut config, "scouting/gossip/enabled", "false")?;
        set(&mut config, "transport/shared_memory/enabled", &self.shared_memory.to_string())?;
        if let Some(tls) = &self.tls {
            set(&mut config, "transport/link/tls/root_ca_certificate", &format!("{:?}", tls.root_ca))?;
            set(&mut config, "transport/link/tls/enable_mtls", "true")?;
            for side in ["listen", "connect"] {
                set(&mut config, &format!("transport/link/tls/{side}_certificate"), &format!("{:?}", tls.certificate))?;
                set(&mut config, &format!("transport/link/tls/{side}_private_key"), &format!("{:?}", tls.private_key))?;
            }
        }
        Ok(config)
    }
}

fn set(config: &mut Config, key: &str, json5: &str) -> Result<(), BusError> {
    config.insert_json5(key, json5).map_err(|e| BusError::Config(format!("{key} = {json5}: {e}")))
}
