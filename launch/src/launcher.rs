//! A rig that runs: the router, the nodes, the operator's desk.

use crate::board::{Board, Event, NodeStatus, Process, Status};
use crate::desk::{Calibrated, Desk};
use crate::log::Sink;
use crate::operator::{Operator, Order, is_scanning};
use crate::plan::Plan;
use crate::planned::PlannedNode;
use crate::spec;
use crate::stop::{self, Rung};
use crate::supervise::Supervisor;
use anyhow::{Context as _, Result, bail};
use bus::{BusConfig, Router};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use tokio::sync::{Notify, broadcast, watch};
use tokio::task::{JoinSet, spawn_blocking};
use wire::Phase;

/// Where and how to run a plan.
pub struct Options {
    /// The program that holds the nodes: this one.
    pub executable: PathBuf,
    /// Only the nodes of this machine, for a rig whose router stands elsewhere.
    pub machine: Option<String>,
    /// Where the log goes.
    pub sink: Sink,
}

/// A rig that runs. When it is dropped without [`Launcher::stop`], its nodes are killed.
pub struct Launcher {
    plan: Plan,
    bus: BusConfig,
    board: Board,
    rung: watch::Sender<Rung>,
    hurry: Arc<Notify>,
    supervisors: JoinSet<()>,
    desk: Option<Desk>,
    lost: Arc<AtomicU64>,
    router: Option<Router>,
}

impl Launcher {
    /// Starts the router and the nodes; sources wait until all others are ready.
    pub async fn start(plan: Plan, options: Options) -> Result<Self> {
        let machine = options.machine.as_deref();
        if let Some(unknown) = machine.filter(|name| !plan.machines.contains_key(*name)) {
            bail!("the launch file has no [machines.{unknown}]");
        }
        let keeper = machine.is_none();
        let (router, bus) = if keeper { open_router(&plan).await? } else { (None, away(&plan, machine)?) };
        let mine = |node: &&PlannedNode| is_mine(&plan, node, machine);
        let board = Board::new(first_status(&plan, machine));
        let calibrated = if keeper { calibrated(&plan)? } else { None };
        let names = plan.nodes.iter().map(|node| (node.address(), node.name.clone())).collect();
        let (desk_bus, desk_board) = (bus.clone(), board.clone());
        let desk = spawn_blocking(move || Desk::open(&desk_bus, keeper, calibrated, names, desk_board)).await??;
        let (rung, lost) = (watch::Sender::new(Rung::Run), desk.lost());
        let mut supervisors = JoinSet::new();
        for node in plan.nodes.iter().filter(mine) {
            let supervisor = Supervisor {
                start: spec::start(&plan, node, &bus, &options.executable),
                restart: node.restart,
                board: board.clone(),
                sink: options.sink.clone(),
                rung: rung.subscribe(),
            };
            supervisors.spawn(supervisor.run());
        }
        Ok(Self { plan, bus, board, rung, hurry: Arc::default(), supervisors, desk: Some(desk), lost, router })
    }

    /// What runs.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// How to reach the bus of this rig.
    pub fn bus(&self) -> &BusConfig {
        &self.bus
    }

    /// True for the launcher of the whole rig, which publishes the phase; false for one that only lends its machine.
    pub fn keeps_phase(&self) -> bool {
        self.router.is_some()
    }

    /// What happens from now on.
    pub fn events(&self) -> broadcast::Receiver<Event> {
        self.board.events()
    }

    /// What is known of every node.
    pub fn status(&self) -> Status {
        self.board.status()
    }

    /// Passes an order of the operator on.
    pub fn order(&self, order: Order) {
        if let Some(desk) = &self.desk {
            desk.order(order);
        }
    }

    /// Waits until all required nodes are ready. Fails when one has failed for good, or when time is up: nodes that are
    /// started elsewhere by hand have all the time they need, and so have sources, whose devices may be plugged in yet.
    pub async fn wait_ready(&self) -> Result<()> {
        let mut status = self.board.watch();
        let here = |status: &Status| {
            let late = |node: &NodeStatus| node.required && !node.source && !node.ready && node.is_alive();
            !status.nodes.values().any(late) || !status.failures().is_empty()
        };
        let in_time = tokio::time::timeout(self.plan.run.ready, status.wait_for(here)).await.is_ok();
        if !in_time {
            let status = self.board.status();
            let late: Vec<&str> = status
                .nodes
                .iter()
                .filter_map(|(name, node)| (node.required && !node.source && !node.ready).then_some(name.as_str()))
                .collect();
            bail!("not ready after {} s: {}", self.plan.run.ready.as_secs_f64(), late.join(", "));
        }
        status.wait_for(|status| status.all_ready() || !status.failures().is_empty()).await?;
        self.check()
    }

    /// Waits until every required node behind the sources has done its work on the scan. Fails when one has failed for
    /// good.
    pub async fn wait_ended(&self) -> Result<()> {
        let mut status = self.board.watch();
        let ended = |status: &Status| status.phase != Phase::Aim && status.all_finished();
        status.wait_for(|status| ended(status) || !status.failures().is_empty()).await?;
        self.check()
    }

    /// Waits until a required node has failed for good.
    pub async fn wait_failed(&self) -> Result<()> {
        self.board.watch().wait_for(|status| !status.failures().is_empty()).await?;
        self.check()
    }

    /// Waits until no node of this launcher lives.
    pub async fn wait_gone(&self) -> Result<()> {
        self.board.watch().wait_for(|status| !status.nodes.values().any(NodeStatus::is_alive)).await?;
        Ok(())
    }

    /// Fails when a required node has failed for good.
    pub fn check(&self) -> Result<()> {
        match self.board.status().failures().as_slice() {
            [] => Ok(()),
            [(node, reason)] => bail!("{node} failed: {reason}"),
            several => {
                bail!("failed: {}", several.iter().map(|(n, r)| format!("{n} ({r})")).collect::<Vec<_>>().join("; "))
            }
        }
    }

    /// Messages lost on all inputs of all nodes, as far as they have told; whole once [`Launcher::stop`] has returned.
    pub fn lost(&self) -> u64 {
        self.lost.load(Ordering::Relaxed)
    }

    /// Notified, it skips the rest of the time that the nodes have on the present rung of [`Launcher::stop`].
    pub fn hurry(&self) -> Arc<Notify> {
        self.hurry.clone()
    }

    /// Ends the scan and stops all nodes, by the ladder; returns the rung on which the last one went. Once it returns,
    /// [`Launcher::check`] tells how the rig has fared.
    pub async fn stop(&mut self) -> Rung {
        let status = self.board.status();
        self.order(Order::End);
        let unfinished = is_scanning(status.phase) || (status.phase == Phase::End && !status.all_finished());
        let finish = self.keeps_phase() && unfinished;
        let rung = stop::descend(&self.plan.run, &self.board, &self.rung, &self.hurry, finish).await;
        while self.supervisors.join_next().await.is_some() {}
        let (desk, router) = (self.desk.take(), self.router.take());
        let closing = spawn_blocking(move || {
            drop(desk);
            router.map(Router::stop)
        });
        if let Ok(Some(Err(error))) = closing.await {
            tracing::debug!("{error}");
        }
        rung
    }
}

async fn open_router(plan: &Plan) -> Result<(Option<Router>, BusConfig)> {
    let config = plan.bus.clone();
    let router = spawn_blocking(move || Router::start(&config)).await?.with_context(|| {
        format!("is {} in use already? [bus] endpoint = \"127.0.0.1:0\" takes any free port", plan.bus.endpoint)
    })?;
    let endpoint = plan.reach.clone().unwrap_or_else(|| router.endpoint().to_owned());
    Ok((Some(router), BusConfig { endpoint, ..plan.bus.clone() }))
}

/// The bus as a machine that does not hold the router sees it.
fn away(plan: &Plan, machine: Option<&str>) -> Result<BusConfig> {
    let own = machine.and_then(|name| plan.machines.get(name)?.endpoint.clone());
    let endpoint = own.or(plan.reach.clone()).unwrap_or_else(|| plan.bus.endpoint.clone());
    if endpoint.ends_with(":0") {
        bail!(
            "{endpoint} names no port that another machine could reach: say [bus] endpoint or [machines.NAME] endpoint"
        );
    }
    Ok(BusConfig { endpoint, ..plan.bus.clone() })
}

fn is_mine(plan: &Plan, node: &PlannedNode, machine: Option<&str>) -> bool {
    match (machine, node.machine.as_deref()) {
        (Some(machine), node_machine) => node_machine == Some(machine),
        (None, None) => true,
        (None, Some(other)) => plan.machines.get(other).is_some_and(|machine| machine.ssh.is_some()),
    }
}

fn first_status(plan: &Plan, machine: Option<&str>) -> Status {
    let nodes = plan.nodes.iter().map(|node| {
        let process = if is_mine(plan, node, machine) { Process::Waiting } else { Process::Elsewhere };
        let (required, source) = (node.required, node.source);
        (node.name.clone(), NodeStatus { required, source, process, ready: false, finished: None, restarts: 0 })
    });
    Status { nodes: nodes.collect(), scan: Operator::default().scan, phase: Phase::Aim }
}

fn calibrated(plan: &Plan) -> Result<Option<Calibrated>> {
    let Some(file) = &plan.rig_file else { return Ok(None) };
    let text = std::fs::read_to_string(file).with_context(|| format!("cannot read the rig {}", file.display()))?;
    let mut rig = geometry::Rig::parse(&text).with_context(|| format!("the rig {}", file.display()))?;
    if rig.name.is_empty() {
        rig.name = file.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
    }
    let calibration = rig.calibration().with_context(|| format!("the rig {}", file.display()))?;
    Ok(Some(Calibrated { instance: plan.rig_instance.clone(), calibration }))
}
