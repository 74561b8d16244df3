//! Where the bus is, and who may reach it.

use crate::BusError;
use serde::{Deserialize, Serialize};
use std::sync::atomic::{AtomicU32, Ordering};
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
    /// Whoever only looks on: what it does not take in time is dropped. For all others the sender waits, and so would
    /// the whole rig for a viewer that is stuck.
    pub onlooker: bool,
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
            onlooker: false,
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
        // It looks for nobody, so there is no answer to wait for (zenoh: half a second).
        set(&mut config, "scouting/delay", "0")?;
        set(&mut config, "listen/endpoints", &format!("[{:?}]", self.locator()))?;
        let onlookers: Vec<String> = (0..ONLOOKERS).map(|number| format!("{:?}", onlooker_id(number))).collect();
        let drop_for_onlookers = format!(
            "[{{ zids: [{}], messages: [\"put\"], flows: [\"egress\"], overwrite: {{ congestion_control: \"drop\" }} }}]",
            onlookers.join(",")
        );
        set(&mut config, "qos/network", &drop_for_onlookers)?;
        Ok(config)
    }

    /// For a node: connects, never listens.
    pub(crate) fn client(&self) -> Result<Config, BusError> {
        self.check()?;
        let mut config = self.base("client")?;
        set(&mut config, "namespace", &format!("{:?}", self.namespace))?;
        set(&mut config, "connect/endpoints", &format!("[{:?}]", self.locator()))?;
        if self.onlooker {
            set(&mut config, "id", &format!("{:?}", onlooker_id(next_onlooker())))?;
        }
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

/// The router knows onlookers by their session's number; so many can look on at once.
const ONLOOKERS: u32 = 1024;
/// Onlookers in one process, before their numbers come again.
const IN_ONE_PROCESS: u32 = 4;

fn onlooker_id(number: u32) -> String {
    format!("100c{number:04x}")
}

fn next_onlooker() -> u32 {
    static OPENED: AtomicU32 = AtomicU32::new(0);
    let in_process = OPENED.fetch_add(1, Ordering::Relaxed) % IN_ONE_PROCESS;
    std::process::id().wrapping_mul(IN_ONE_PROCESS).wrapping_add(in_process) % ONLOOKERS
}

fn set(config: &mut Config, key: &str, json5: &str) -> Result<(), BusError> {
    config.insert_json5(key, json5).map_err(|e| BusError::Config(format!("{key} = {json5}: {e}")))
}
