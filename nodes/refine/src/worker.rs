//! A thread that gathers and refines, so that the node never keeps the bus waiting.

use crate::{Config, RefineError, Refinement, Refiner};
use anyhow::anyhow;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, Sender, TryRecvError, channel};
use std::time::{Duration, Instant};
use wire::{Calibration, Pose, Profile};

enum Order {
    Pose(Pose),
    Profile(Profile),
    Tick,
    Finish,
}

/// What it has come to.
pub(crate) enum Answer {
    /// The scan so far; `None` while there is too little of it.
    Live(Option<Refinement>),
    /// All of it.
    Final(Result<Refinement, RefineError>),
}

/// The thread of one scan. It ends when it is dropped.
pub(crate) struct Worker {
    orders: Sender<Order>,
    answers: Receiver<Answer>,
    /// What it has worked since somebody asked, in nanoseconds.
    worked: Arc<AtomicU64>,
}

impl Worker {
    pub fn start(config: &Config, calibration: &Calibration) -> anyhow::Result<Self> {
        let mut refiner = Refiner::new(config.clone(), calibration)?;
        let ((orders, ordered), (answer, answers)) = (channel(), channel());
        let worked = Arc::<AtomicU64>::default();
        let spent = worked.clone();
        std::thread::Builder::new().name("refiner".to_owned()).spawn(move || {
            for order in ordered {
                let began = Instant::now();
                let said = obey(&mut refiner, order);
                spent.fetch_add(began.elapsed().as_nanos() as u64, Ordering::Relaxed);
                if said.is_some_and(|said| answer.send(said).is_err()) {
                    return;
                }
            }
        })?;
        Ok(Self { orders, answers, worked })
    }

    pub fn pose(&self, pose: Pose) -> anyhow::Result<()> {
        self.give(Order::Pose(pose))
    }

    pub fn profile(&self, profile: Profile) -> anyhow::Result<()> {
        self.give(Order::Profile(profile))
    }

    pub fn tick(&self) -> anyhow::Result<()> {
        self.give(Order::Tick)
    }

    pub fn finish(&self) -> anyhow::Result<()> {
        self.give(Order::Finish)
    }

    /// What has been done since the last call.
    pub fn answer(&self) -> anyhow::Result<Option<Answer>> {
        match self.answers.try_recv() {
            Ok(answer) => Ok(Some(answer)),
            Err(TryRecvError::Empty) => Ok(None),
            Err(TryRecvError::Disconnected) => Err(died()),
        }
    }

    /// How long it has worked since the last call.
    pub fn worked(&self) -> Duration {
        Duration::from_nanos(self.worked.swap(0, Ordering::Relaxed))
    }

    fn give(&self, order: Order) -> anyhow::Result<()> {
        self.orders.send(order).map_err(|_| died())
    }
}

fn obey(refiner: &mut Refiner, order: Order) -> Option<Answer> {
    match order {
        Order::Pose(pose) => refiner.pose(&pose),
        Order::Profile(profile) => refiner.profile(&profile),
        Order::Tick => return Some(Answer::Live(refiner.tick())),
        Order::Finish => return Some(Answer::Final(refiner.finish())),
    }
    None
}

fn died() -> anyhow::Error {
    anyhow!("the refining thread has died")
}
