//! A launch file, read and checked: what to start where, and with which configuration.

use crate::file;
use crate::include;
use crate::kind::Kind;
use crate::planned::{self, PlannedNode};
use crate::section::{Section, refuse_unknown};
use crate::set;
use crate::setting::{Origin, Setting, Settings, Value, merge};
use anyhow::{Result, bail};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::Duration;
use wire::Phase;

/// The tables of a launch file.
pub const SECTIONS: &[&str] = &["rig", "bus", "run", "machines", "nodes"];

const BUS_KEYS: &[&str] = &["endpoint", "reach", "shared_memory", "connect_ms", "tls"];

/// A rig that can be started.
#[derive(Debug, Clone)]
pub struct Plan {
    /// The stem of the launch file: what `limn scan` and the like call the rig.
    pub name: String,
    /// Of the handset, if any: its calibration is published for all nodes.
    pub rig_file: Option<PathBuf>,
    /// The instance under which it is published.
    pub rig_instance: String,
    /// Where the router listens.
    pub bus: bus::BusConfig,
    /// host:port under which nodes reach it, when that is not where it listens: the name in its certificate.
    pub reach: Option<String>,
    /// How time passes and how long to wait for what.
    pub run: Run,
    /// Other machines, by name.
    pub machines: BTreeMap<String, Machine>,
    /// What to start, by name.
    pub nodes: Vec<PlannedNode>,
    /// All settings with their origins, defaults included.
    pub settings: Settings,
    /// What is odd but no reason to refuse.
    pub warnings: Vec<String>,
}

/// `[run]`.
#[derive(Debug, Clone)]
pub struct Run {
    /// Whether simulated and replayed sources keep to the clock on the wall.
    pub pace: kit::Pace,
    /// The phase in which the rig begins when all nodes are ready; `Aim` waits for the operator.
    pub begin: Phase,
    /// Stop when the first scan has gone through.
    pub once: bool,
    /// How far a fast source runs ahead of its slowest consumer, in the scan's own time.
    pub window_ms: u64,
    /// Who speaks how loud, as `tracing` filters are written: `info`, `warn,stripe=debug`.
    pub log: String,
    /// How long the nodes may take until they are ready.
    pub ready: Duration,
    /// How long they may take to finish behind the end of the scan.
    pub end: Duration,
    /// How long they may take to stop when their standard input closes.
    pub close: Duration,
    /// How long they may take to stop at SIGTERM, before SIGKILL.
    pub term: Duration,
}

/// `[machines.NAME]`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Machine {
    /// user@host: its nodes are started from here. Without it, `limn up FILE --machine NAME` is run there by hand.
    pub ssh: Option<String>,
    /// The program over there.
    pub limn: String,
    /// host:port at which that machine reaches the bus; the bus's own when not said.
    pub endpoint: Option<String>,
}

impl Plan {
    /// Reads a launch file with its includes, lays `node.key=value` arguments on it, and checks the whole.
    pub fn load(file: &Path, sets: &[String], kinds: &[Kind]) -> Result<Self> {
        let mut settings = file::defaults(include_str!("defaults.toml"))?;
        merge(&mut settings, include::load(file)?);
        for argument in sets {
            set::apply(&mut settings, argument)?;
        }
        let name = file.file_stem().map_or("rig".into(), |stem| stem.to_string_lossy()).to_lowercase();
        let name = name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
        Self::from_settings(name, settings, kinds)
    }

    fn from_settings(name: String, settings: Settings, kinds: &[Kind]) -> Result<Self> {
        refuse_unknown("", Some(&settings), SECTIONS)?;
        let rig = Section::new("rig", settings.get("rig"), &["file", "instance", "namespace"])?;
        let rig_file = rig.path("file")?;
        if let Some(file) = rig_file.as_ref().filter(|file| !file.is_file()) {
            bail!("{}: rig.file: there is no {}", rig.origin("file"), file.display());
        }
        let mut plan = Self {
            name,
            rig_file,
            rig_instance: rig.must("instance", rig.text("instance")?)?,
            reach: Section::new("bus", settings.get("bus"), BUS_KEYS)?.text("reach")?,
            bus: bus(&settings, &rig)?,
            run: run(&settings)?,
            machines: machines(&settings)?,
            nodes: Vec::new(),
            settings,
            warnings: Vec::new(),
        };
        planned::read(&mut plan, kinds)?;
        Ok(plan)
    }

    /// The node of a name.
    pub fn node(&self, name: &str) -> Option<&PlannedNode> {
        self.nodes.iter().find(|node| node.name == name)
    }
}

fn bus(settings: &Settings, rig: &Section<'_>) -> Result<bus::BusConfig> {
    let section = Section::new("bus", settings.get("bus"), BUS_KEYS)?;
    let tls = Section::new("bus.tls", section.get("tls"), &["root_ca", "certificate", "private_key"])?;
    let file = |key: &str| match tls.path(key)? {
        Some(path) if path.is_file() => Ok(path.to_string_lossy().into_owned()),
        Some(path) => bail!("{}: bus.tls.{key}: there is no {}", tls.origin(key), path.display()),
        None => bail!("{}: bus.tls needs {key} (a PEM file)", section.origin("tls")),
    };
    let tls = match section.get("tls") {
        Some(_) => Some(bus::Tls {
            root_ca: file("root_ca")?,
            certificate: file("certificate")?,
            private_key: file("private_key")?,
        }),
        None => None,
    };
    let config = bus::BusConfig {
        endpoint: section.must("endpoint", section.text("endpoint")?)?,
        namespace: rig.must("namespace", rig.text("namespace")?)?,
        tls,
        shared_memory: section.must("shared_memory", section.truth("shared_memory")?)?,
        connect_timeout_ms: section.must("connect_ms", section.count("connect_ms")?)?,
        onlooker: false,
    };
    if let Err(error) = config.check() {
        let said = [section.origin("endpoint"), rig.origin("namespace")];
        bail!("{}: {error}", said.iter().find(|o| **o != Origin::Default).unwrap_or(&said[0]));
    }
    Ok(config)
}

fn run(settings: &Settings) -> Result<Run> {
    let phases = [("aim", Phase::Aim), ("shape", Phase::Shape), ("colour", Phase::Colour), ("both", Phase::Both)];
    let known = ["pace", "begin", "once", "window_ms", "log", "ready_s", "end_s", "close_s", "term_s"];
    let section = Section::new("run", settings.get("run"), &known)?;
    let seconds = |key: &str| anyhow::Ok(Duration::from_secs_f64(section.must(key, section.seconds(key)?)?));
    Ok(Run {
        pace: section.must("pace", section.word("pace", &[("real", kit::Pace::Real), ("fast", kit::Pace::Fast)])?)?,
        begin: section.must("begin", section.word("begin", &phases)?)?,
        once: section.must("once", section.truth("once")?)?,
        window_ms: section.must("window_ms", section.count("window_ms")?)?,
        log: section.must("log", section.text("log")?)?,
        ready: seconds("ready_s")?,
        end: seconds("end_s")?,
        close: seconds("close_s")?,
        term: seconds("term_s")?,
    })
}

fn machines(settings: &Settings) -> Result<BTreeMap<String, Machine>> {
    let Some(Setting { value: Value::Table(table), .. }) = settings.get("machines") else {
        return Ok(BTreeMap::new());
    };
    table
        .iter()
        .map(|(name, setting)| {
            let section = Section::new(&format!("machines.{name}"), Some(setting), &["ssh", "limn", "endpoint"])?;
            let machine = Machine {
                ssh: section.text("ssh")?,
                limn: section.text("limn")?.unwrap_or_else(|| "limn".to_owned()),
                endpoint: section.text("endpoint")?,
            };
            if let Some(host) = machine.ssh.as_ref().filter(|host| host.is_empty() || host.starts_with('-')) {
                bail!("{}: machines.{name}.ssh = {host:?}: say user@host", section.origin("ssh"));
            }
            Ok((name.clone(), machine))
        })
        .collect()
}
