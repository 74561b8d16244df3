//! A thread that gathers and refines, so that the node never keeps the bus waiting.

use crate::{Config, RefineError, Refinement, Refiner};
use anyhow::anyhow;
use std::sync::mpsc::{Receiver, Sender, TryRecvError, channel};
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
}

impl Worker {
    pub fn start(config: &Config, calibration: &Calibration) -> anyhow::Result<Self> {
        let mut refiner = Refiner::new(config.clone(), calibration)?;
        let ((orders, ordered), (answer, answers)) = (channel(), channel());
        std::thread::Builder::new().name("refiner".to_owned()).spawn(move || {
            for order in ordered {
                let said = match order {
                    Order::Pose(pose) => {
                        refiner.pose(&pose);
                        continue;
                    }
                    Order::Profile(profile) => {
                        refiner.profile(&profile);
                        continue;
                    }
                    Order::Tick => Answer::Live(refiner.tick()),
                    Order::Finish => Answer::Final(refiner.finish()),
                };
                if answer.send(said).is_err() {
                    return;
                }
            }
        })?;
        Ok(Self { orders, answers })
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

    fn give(&self, order: Order) -> anyhow::Result<()> {
        self.orders.send(order).map_err(|_| died())
    }
}

fn died() -> anyhow::Error {
    anyhow!("the refining thread has died")
}
