//! The launcher's own place on the bus: it publishes phase and calibration, takes orders, and watches who is ready and
//! who has finished. A thread of its own, because receiving blocks.

use crate::accounts::Accounts;
use crate::board::{Board, Event};
use crate::operator::{Operator, Order};
use anyhow::{Context as _, Result};
use bus::{Bus, BusConfig, Presence, Publisher, Subscriber};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, mpsc};
use std::thread::JoinHandle;
use std::time::{Duration, SystemTime, UNIX_EPOCH};
use wire::{Calibration, Health, Progress, RunPhase, topic};

/// Handle of the thread.
pub(crate) struct Desk {
    orders: mpsc::SyncSender<Order>,
    ring: Box<dyn Fn() + Send + Sync>,
    closing: Arc<AtomicBool>,
    lost: Arc<AtomicU64>,
    thread: Option<JoinHandle<()>>,
}

/// What the desk publishes besides the phase.
pub(crate) struct Calibrated {
    /// The instance of the handset.
    pub(crate) instance: String,
    /// As its rig file has it.
    pub(crate) calibration: Calibration,
}

const NAP: Duration = Duration::from_millis(200);
/// Progress comes once a message from each node.
const PROGRESS_DEPTH: usize = 65_536;
/// An account comes once a second from each.
const HEALTH_DEPTH: usize = 1024;

impl Desk {
    /// Opens the desk of a rig. `names` gives the name in the launch file for each kind/instance; the keeper of a rig
    /// publishes, a launcher that only lends its machine does not.
    pub(crate) fn open(
        config: &BusConfig,
        keeper: bool,
        calibrated: Option<Calibrated>,
        names: BTreeMap<String, String>,
        board: Board,
    ) -> Result<Self> {
        let bus = Bus::open(config)?;
        let (orders, inbox) = mpsc::sync_channel(64);
        let (closing, lost) = (Arc::new(AtomicBool::new(false)), Arc::<AtomicU64>::default());
        let mut work = Work {
            phases: keeper.then(|| bus.publisher(&topic::run_phase())).transpose()?,
            followed: (!keeper).then(|| bus.subscribe(&topic::run_phase(), 16)).transpose()?,
            orders: bus.subscribe(&topic::order(), 64)?,
            progress: bus.subscribe(&topic::progress("**"), PROGRESS_DEPTH)?,
            healths: bus.subscribe(&topic::health("**"), HEALTH_DEPTH)?,
            accounts: Accounts::default(),
            lost: lost.clone(),
            presence: bus.presence()?,
            operator: Operator::default(),
            ready: BTreeSet::new(),
            finished: BTreeMap::new(),
            calibration: None,
            inbox,
            names,
            board,
            closing: closing.clone(),
            bus: bus.clone(),
        };
        if let Some(Calibrated { instance, calibration }) = calibrated {
            let mut publisher = bus.publisher(&topic::calibration(&instance))?;
            publisher.send(calibration)?;
            work.calibration = Some(publisher);
        }
        let first = work.operator.to_wire();
        work.publish(first);
        let thread =
            std::thread::Builder::new().name("desk".to_owned()).spawn(move || work.run()).context("a thread")?;
        Ok(Self { orders, ring: Box::new(bus.ringer()), closing, lost, thread: Some(thread) })
    }

    /// Passes an order of the operator on.
    pub(crate) fn order(&self, order: Order) {
        // A full inbox means a key that is held down.
        let _ = self.orders.try_send(order);
        (self.ring)();
    }

    /// Messages lost on all inputs of all nodes, as far as they have told, and here; it counts on until the desk is closed.
    pub(crate) fn lost(&self) -> Arc<AtomicU64> {
        self.lost.clone()
    }
}

impl Drop for Desk {
    fn drop(&mut self) {
        self.closing.store(true, Ordering::SeqCst);
        (self.ring)();
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

struct Work {
    bus: Bus,
    phases: Option<Publisher<RunPhase>>,
    /// What the rig's keeper says, for a launcher that only lends its machine.
    followed: Option<Subscriber<RunPhase>>,
    calibration: Option<Publisher<Calibration>>,
    orders: Subscriber<RunPhase>,
    progress: Subscriber<Progress>,
    healths: Subscriber<Health>,
    accounts: Accounts,
    lost: Arc<AtomicU64>,
    presence: Presence,
    operator: Operator,
    ready: BTreeSet<String>,
    finished: BTreeMap<String, u64>,
    inbox: mpsc::Receiver<Order>,
    names: BTreeMap<String, String>,
    board: Board,
    closing: Arc<AtomicBool>,
}

impl Work {
    fn run(mut self) {
        while !self.closing.load(Ordering::SeqCst) {
            self.bus.wait(NAP);
            while let Ok(order) = self.inbox.try_recv() {
                self.obey(order);
            }
            while let Some(order) = self.orders.next() {
                self.obey(Order::from_wire(&order));
            }
            while let Some(told) = self.followed.as_mut().and_then(Subscriber::next) {
                self.board.tell(Event::Phase { scan: told.header.scan, phase: told.header.phase });
            }
            self.note_presence();
            self.note_progress();
            self.note_accounts();
        }
        self.note_accounts();
        drop(self.calibration);
        if let Err(error) = self.bus.close() {
            tracing::debug!("{error}");
        }
    }

    fn obey(&mut self, order: Order) {
        let now = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_nanos() as i64);
        if self.phases.is_some()
            && let Some(phase) = self.operator.obey(order, now)
        {
            self.publish(phase);
        }
    }

    fn publish(&mut self, phase: RunPhase) {
        let Some(publisher) = &mut self.phases else { return };
        let (scan, now) = (phase.header.scan, phase.header.phase);
        match publisher.send(phase) {
            Ok(()) => self.board.tell(Event::Phase { scan, phase: now }),
            Err(error) => tracing::error!("the phase could not be published: {error}"),
        }
    }

    fn note_presence(&mut self) {
        let ready = self.presence.nodes();
        let known = |address: &String| self.names.get(address).cloned();
        for node in ready.difference(&self.ready).filter_map(known) {
            self.board.tell(Event::Ready { node });
        }
        for node in self.ready.difference(&ready).filter_map(known) {
            self.board.tell(Event::Gone { node });
        }
        self.ready = ready;
    }

    fn note_accounts(&mut self) {
        while let Some(health) = self.healths.next() {
            self.accounts.note(health);
        }
        // Whoever watches the nodes may miss something as well.
        self.lost.store(self.accounts.lost() + self.progress.counts().lost, Ordering::Relaxed);
    }

    fn note_progress(&mut self) {
        while let Some(progress) = self.progress.next() {
            let (Some(node), scan) = (self.names.get(&progress.node).cloned(), progress.header.scan) else { continue };
            self.board.note_finished_seq(&node, progress.finished_seq);
            if !progress.header.is_end() {
                continue;
            }
            if self.finished.insert(progress.node, scan).is_none_or(|before| before < scan) {
                self.board.tell(Event::Finished { node, scan });
            }
        }
    }
}
