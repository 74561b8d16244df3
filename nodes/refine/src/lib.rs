//! x
#![allow(missing_docs, dead_code)]
mod banded;
mod clock;
mod cloud;
mod config;
mod evidence;
mod finish;
mod gather;
mod gauge;
mod guard;
mod judge;
mod live;
#[cfg(feature = "node")]
pub mod node;
mod notices;
mod outcome;
mod pcg;
mod precondition;
mod prior;
mod quadric;
mod random;
mod refinement;
mod refiner;
mod scene;
mod schedule;
mod schur;
mod solver;
mod spline;
mod step;
mod surfel;
mod testimony;
mod tracker;
mod unknowns;
#[cfg(feature = "node")]
mod worker;

pub use config::{Config, ConfigError};
pub use evidence::{
    ClockEvidence, DropReason, DroppedFrame, Evidence, FrameEvidence, HandEyeEvidence, Notice, Observed, RefusedInput,
    Residual, TrackerEvidence,
};
pub use refinement::Refinement;
pub use refiner::{RefineError, Refiner};
