//! What is known of every node, and what happens to them, for whoever waits or watches.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};
use tokio::sync::{broadcast, watch};
use wire::Phase;

/// What happens in a rig.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Event {
    /// A process was started.
    Started {
        /// The node's name in the launch file.
        node: String,
        /// The process; of `ssh` for a node on another machine.
        pid: u32,
    },
    /// A node has opened all its inputs.
    Ready {
        /// The node's name in the launch file.
        node: String,
    },
    /// A node that was ready is no longer on the bus.
    Gone {
        /// The node's name in the launch file.
        node: String,
    },
    /// A node has seen the end of a scan and done its work on it.
    Finished {
        /// The node's name in the launch file.
        node: String,
        /// Which scan.
        scan: u64,
    },
    /// A node failed and is started again after a pause.
    Restarting {
        /// The node's name in the launch file.
        node: String,
        /// How it failed.
        reason: String,
    },
    /// A node has failed for good.
    Failed {
        /// The node's name in the launch file.
        node: String,
        /// How it failed.
        reason: String,
    },
    /// A node has ended without an error, by itself or because it was told to stop.
    Ended {
        /// The node's name in the launch file.
        node: String,
    },
    /// The operator chose a phase.
    Phase {
        /// Which scan.
        scan: u64,
        /// Which phase.
        phase: Phase,
    },
}

/// Where a node's process stands.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Process {
    /// Started by somebody else, on another machine.
    Elsewhere,
    /// Not started yet, or about to be started again.
    Waiting,
    /// Running.
    Running(u32),
    /// Ended without an error.
    Ended,
    /// Failed for good.
    Failed(String),
}

/// What is known of one node.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NodeStatus {
    /// The rig has failed when this node has failed for good.
    pub required: bool,
    /// Begins a stream.
    pub source: bool,
    /// Its process.
    pub process: Process,
    /// It has opened all its inputs.
    pub ready: bool,
    /// The latest scan that it has done its work on.
    pub finished: Option<u64>,
    /// How often it was started again.
    pub restarts: u32,
}

impl NodeStatus {
    /// True while a process of this launcher lives or will.
    pub fn is_alive(&self) -> bool {
        matches!(self.process, Process::Waiting | Process::Running(_))
    }
}

/// What is known of a rig.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Status {
    /// The nodes by their names in the launch file.
    pub nodes: BTreeMap<String, NodeStatus>,
    /// The number of the scan.
    pub scan: u64,
    /// What the operator is doing.
    pub phase: Phase,
}

impl Status {
    /// True when every required node is ready: sources, when what they listen to has spoken.
    pub fn all_ready(&self) -> bool {
        self.nodes.values().all(|node| !node.required || node.ready || node.process == Process::Ended)
    }

    /// True when every required node behind the sources has done its work on this scan, or is gone.
    pub fn all_finished(&self) -> bool {
        self.nodes.values().all(|node| {
            let done = node.finished >= Some(self.scan) || matches!(node.process, Process::Ended | Process::Failed(_));
            !node.required || node.source || done
        })
    }

    /// The required nodes that have failed for good, and how.
    pub fn failures(&self) -> Vec<(String, String)> {
        let failed = self.nodes.iter().filter(|(_, node)| node.required);
        failed
            .filter_map(|(name, node)| match &node.process {
                Process::Failed(reason) => Some((name.clone(), reason.clone())),
                _ => None,
            })
            .collect()
    }

    fn apply(&mut self, event: &Event) {
        if let Event::Phase { scan, phase } = event {
            (self.scan, self.phase) = (*scan, *phase);
        }
        let Some(node) = event.node().and_then(|name| self.nodes.get_mut(name)) else { return };
        match event {
            Event::Started { pid, .. } => node.process = Process::Running(*pid),
            Event::Ready { .. } => node.ready = true,
            Event::Gone { .. } => node.ready = false,
            Event::Finished { scan, .. } => node.finished = node.finished.max(Some(*scan)),
            Event::Restarting { .. } => {
                node.process = Process::Waiting;
                node.restarts += 1;
            }
            Event::Failed { reason, .. } => node.process = Process::Failed(reason.clone()),
            Event::Ended { .. } => node.process = Process::Ended,
            Event::Phase { .. } => {}
        }
    }
}

impl Event {
    /// The node that it happens to.
    pub fn node(&self) -> Option<&str> {
        match self {
            Self::Started { node, .. }
            | Self::Ready { node }
            | Self::Gone { node }
            | Self::Finished { node, .. }
            | Self::Restarting { node, .. }
            | Self::Failed { node, .. }
            | Self::Ended { node } => Some(node),
            Self::Phase { .. } => None,
        }
    }
}

/// Keeps the status, and tells it on.
#[derive(Debug, Clone)]
pub(crate) struct Board {
    status: watch::Sender<Status>,
    events: broadcast::Sender<Event>,
    /// For each node, the number behind the last message that it has finished. It changes too often to be an event.
    next_seq: Arc<Mutex<BTreeMap<String, u64>>>,
}

/// Events that wait for a listener who is slow; he is told how many he missed.
const EVENTS: usize = 1024;

impl Board {
    pub(crate) fn new(status: Status) -> Self {
        Self { status: watch::Sender::new(status), events: broadcast::Sender::new(EVENTS), next_seq: Arc::default() }
    }

    pub(crate) fn tell(&self, event: Event) {
        // Within the change, so that who sees the one finds the other. Nobody listening is no error.
        self.status.send_modify(|status| {
            status.apply(&event);
            let _ = self.events.send(event);
        });
    }

    pub(crate) fn note_finished_seq(&self, node: &str, seq: u64) {
        self.next_seq.lock().unwrap_or_else(PoisonError::into_inner).insert(node.to_owned(), seq.saturating_add(1));
    }

    pub(crate) fn next_seq(&self, node: &str) -> u64 {
        self.next_seq.lock().unwrap_or_else(PoisonError::into_inner).get(node).copied().unwrap_or(0)
    }

    pub(crate) fn status(&self) -> Status {
        self.status.borrow().clone()
    }

    pub(crate) fn watch(&self) -> watch::Receiver<Status> {
        self.status.subscribe()
    }

    pub(crate) fn events(&self) -> broadcast::Receiver<Event> {
        self.events.subscribe()
    }
}
