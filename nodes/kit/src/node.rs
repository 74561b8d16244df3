//! A running node.

use crate::health::Account;
use crate::lifeline::Stopper;
use crate::log::{self, Lines};
use crate::pace::{Pace, system_nanos};
use crate::ports::{Input, Output, Pictures, RawInput};
use crate::spec::NodeSpec;
use crate::window::Window;
use anyhow::{Context as _, bail};
use bus::{Bus, Token};
use std::time::{Duration, Instant};
use wire::topic::{self, Class, Topic};
use wire::{Calibration, Clock, Header, Health, LogLine, Message, Progress, RunPhase};

/// How long a node sleeps at most before it looks whether it was told to stop.
pub(crate) const NAP: Duration = Duration::from_millis(50);
const HEALTH_EVERY: Duration = Duration::from_secs(1);
const LONG: Duration = Duration::from_secs(10);

/// One node: its bus, its account, and whether it should stop.
pub struct Node {
    pub(crate) spec: NodeSpec,
    pub(crate) bus: Bus,
    pub(crate) stopper: Stopper,
    account: Account,
    lines: Lines,
    health: Output<Health>,
    progress: Output<Progress>,
    log: Output<LogLine>,
    phases: Input<RunPhase>,
    pub(crate) phase: Option<RunPhase>,
    pub(crate) window: Option<Window>,
    token: Option<Token>,
}

impl Node {
    /// Opens the bus for a process that the launcher started: it stops when stdin closes.
    pub fn open(spec: NodeSpec) -> anyhow::Result<Self> {
        let node = Self::open_unattended(spec)?;
        node.stopper.hold_stdin();
        Ok(node)
    }

    /// Opens the bus for a node inside another process, which stops it by its [`Stopper`].
    pub fn open_unattended(spec: NodeSpec) -> anyhow::Result<Self> {
        topic::check_name(&spec.instance)?;
        let lines = log::start(&spec.log);
        let bus = Bus::open(&spec.bus)?;
        let name = spec.name();
        let mut account = Account::new();
        // What a node says of itself is not what it gives: it has its own count.
        let aside = || std::sync::Arc::default();
        let window = match spec.pace {
            Pace::Fast if !spec.consumers.is_empty() => {
                let progress = Input::new(bus.subscribe(&topic::progress("**"), 4096)?);
                Some(Window::new(progress, bus.presence()?, &spec.consumers, spec.window_ms))
            }
            _ => None,
        };
        let phases = Input::new(bus.subscribe(&topic::run_phase(), 16)?);
        account.inputs.push((topic::run_phase().key, phases.counts()));
        account.wakes();
        Ok(Self {
            stopper: Stopper::new(bus.ringer()),
            health: Output::new(bus.publisher(&topic::health(&name))?, aside()),
            progress: Output::new(bus.publisher(&topic::progress(&name))?, aside()),
            log: Output::new(bus.publisher(&topic::log(&name))?, aside()),
            phases,
            phase: None,
            window,
            token: None,
            account,
            lines,
            bus,
            spec,
        })
    }

    /// What the launcher told it.
    pub fn spec(&self) -> &NodeSpec {
        &self.spec
    }

    /// Which one of its kind it is.
    pub fn instance(&self) -> &str {
        &self.spec.instance
    }

    /// Tells this node to stop.
    pub fn stopper(&self) -> Stopper {
        self.stopper.clone()
    }

    /// Opens an input that holds the newest `depth` messages.
    pub fn input<M: Message>(&mut self, topic: &Topic<M>, depth: usize) -> anyhow::Result<Input<M>> {
        let input = Input::new(self.bus.subscribe(topic, depth)?);
        self.account.inputs.push((topic.key.clone(), input.counts()));
        Ok(input)
    }

    /// Opens an input of measurements, which come once each: a restarted sender's history is not handed on again. When
    /// this node itself is started again, it gets all that is kept, and counts as lost what is not.
    pub fn stream<M: Message>(&mut self, topic: &Topic<M>, depth: usize) -> anyhow::Result<Input<M>> {
        let mut subscriber = self.bus.subscribe(topic, depth)?.fresh_only();
        if let Some(next) = self.spec.next_seq {
            subscriber = subscriber.expecting(if topic.class == Class::Frame { next } else { 0 });
        }
        let input = Input::new(subscriber);
        self.account.inputs.push((topic.key.clone(), input.counts()));
        Ok(input)
    }

    /// Opens an input that holds only the newest message: for whoever looks now and then. What it lets go is no loss.
    pub fn glimpse<M: Message>(&mut self, topic: &Topic<M>) -> anyhow::Result<Input<M>> {
        let input = Input::new(self.bus.subscribe(topic, 1)?.glimpses());
        self.account.inputs.push((topic.key.clone(), input.counts()));
        Ok(input)
    }

    /// Opens an input of everything whose key matches, undecoded.
    pub fn raw(&mut self, key_expression: &str, depth: usize) -> anyhow::Result<RawInput> {
        let input = RawInput::new(self.bus.subscribe_raw(key_expression, depth)?);
        self.account.inputs.push((key_expression.to_owned(), input.counts()));
        Ok(input)
    }

    /// Sends bytes as they are: for replaying.
    pub fn forward(&self, key: &str, schema: &str, bytes: Vec<u8>) -> anyhow::Result<()> {
        Ok(self.bus.forward(key, schema, bytes)?)
    }

    /// Opens an output.
    pub fn output<M: Message>(&mut self, topic: &Topic<M>) -> anyhow::Result<Output<M>> {
        Ok(Output::new(self.bus.publisher(topic)?, self.account.sent.clone()))
    }

    /// Opens the outputs of a camera.
    pub fn pictures(&mut self, camera: &str) -> anyhow::Result<Pictures> {
        let (frames, colours) = (self.output(&topic::frame(camera))?, self.output(&topic::colour(camera))?);
        Ok(Pictures { frames, colours })
    }

    /// Waits for the calibration of a handset; fails when the node is told to stop first.
    pub fn calibration(&mut self, rig: &str) -> anyhow::Result<Calibration> {
        let topic = topic::calibration(rig);
        let mut calibrations = self.input(&topic, 4)?;
        let started = Instant::now();
        let mut warned = false;
        loop {
            if let Some(calibration) = calibrations.newest() {
                return Ok(calibration);
            }
            if !self.wait() {
                bail!("stopped while waiting for {}", topic.key);
            }
            if !warned && started.elapsed() > LONG {
                warned = true;
                tracing::warn!("still waiting for {}: does the launch file name a rig?", topic.key);
            }
        }
    }

    /// Declares that all inputs are open: sources may start.
    pub fn ready(&mut self) -> anyhow::Result<()> {
        self.token = Some(self.bus.declare_ready(&self.spec.name())?);
        tracing::debug!("ready");
        Ok(())
    }

    /// Rests until something has come, or a moment has passed; false when the node was told to stop.
    pub fn wait(&mut self) -> bool {
        self.rest(NAP)
    }

    pub(crate) fn rest(&mut self, nap: Duration) -> bool {
        self.account.rests();
        self.bus.wait(nap);
        self.account.wakes();
        self.hear();
        self.say();
        !self.stopper.is_stopping()
    }

    pub(crate) fn hear(&mut self) {
        while let Some(phase) = self.phases.next() {
            self.phase = Some(phase);
        }
    }

    /// What the operator said last.
    pub fn phase(&self) -> Option<&RunPhase> {
        self.phase.as_ref()
    }

    /// Counts what was refused.
    pub fn refuse(&mut self, reason: &str, count: u64) {
        self.account.refuse(reason, count);
    }

    /// Counts what another thread of this node has worked, beside the time between two waits.
    pub fn worked(&mut self, time: Duration) {
        self.account.works(time);
    }

    /// Notes that everything up to this message is done: sources at a fast pace wait for it.
    pub fn finished(&mut self, header: &Header) -> anyhow::Result<()> {
        self.account.finished = *header;
        let epoch = match (header.clock, self.phase.as_ref()) {
            (Clock::System, _) => Some(0),
            (Clock::Scan, Some(phase)) if self.spec.pace == Pace::Real => Some(phase.header.stamp_nanos),
            (Clock::Scan, _) => None,
        };
        if let Some(epoch) = epoch
            && !header.is_end()
        {
            self.account.took(system_nanos().saturating_sub(epoch).saturating_sub(header.stamp_nanos));
        }
        let mut reached = header.derived();
        if header.is_end() {
            reached.stamp_nanos = i64::MAX / 2;
            // Whoever waits for the end need not wait for the account as well.
            let report = self.account.report(&self.spec.name());
            self.send_health(report);
        }
        self.progress.send(Progress { header: reached, node: self.spec.name(), finished_seq: header.seq })?;
        self.say();
        Ok(())
    }

    /// Sends health when it is due, and the lines of the log. Neither may ever stop the work.
    pub(crate) fn say(&mut self) {
        let name = self.spec.name();
        if let Some(report) = self.account.due(&name, HEALTH_EVERY) {
            self.send_health(report);
        }
        for (level, text) in self.lines.take() {
            let header = Header { stamp_nanos: system_nanos(), clock: Clock::System, ..Header::default() };
            let _ = self.log.send(LogLine { header, node: name.clone(), level, text });
        }
    }

    fn send_health(&mut self, report: Health) {
        if let Err(error) = self.health.send(report) {
            tracing::debug!("health: {error}");
        }
    }

    /// The last account, and leaves the bus.
    pub fn close(mut self) -> anyhow::Result<()> {
        let report = self.account.report(&self.spec.name());
        self.send_health(report);
        self.say();
        drop(self.token.take());
        self.bus.close().context("closing")
    }
}
