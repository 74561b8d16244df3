//! The only place where a key is spelled.
//!
//! A key is `<kind>/<instance>/<stream>` under the rig's namespace. Housekeeping lives under `@`, which the wildcard
//! `**` does not see; a latched topic never has an `@` (Zenoh's history cannot find it there).

use crate::{
    Calibration, Cloud, Frame, Health, LogLine, Mesh, Message, Model, Pose, Profile, Progress, Refinement, RunPhase,
    Scan, Stripe, Trajectory,
};
use std::marker::PhantomData;

/// How a topic is delivered.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Class {
    /// Pictures: reliable, the sender waits; no history (they are large).
    Frame,
    /// Pictures that a reader gathers until the end of the scan: as `Frame`, and the publisher keeps the newest few for
    /// one that is started again.
    Gathered,
    /// Measurements: reliable, the sender waits, and the publisher keeps them for a node that starts late.
    Stream,
    /// The latest state, kept for late comers.
    Latched,
    /// Dropped first when the line is full.
    Trace,
}

/// A typed key.
#[derive(Debug)]
pub struct Topic<M> {
    /// The key, without the rig's namespace.
    pub key: String,
    /// How it is delivered.
    pub class: Class,
    message: PhantomData<fn() -> M>,
}

impl<M> Clone for Topic<M> {
    fn clone(&self) -> Self {
        Self { key: self.key.clone(), class: self.class, message: PhantomData }
    }
}

impl<M: Message> Topic<M> {
    fn new(key: String, class: Class) -> Self {
        Self { key, class, message: PhantomData }
    }
}

/// Names what an instance may be called.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{0:?} cannot name an instance: use 1 to 40 of a-z, 0-9 and _")]
pub struct BadName(pub String);

/// Checks the name of an instance, so that it cannot be read as a wildcard or a deeper key.
pub fn check_name(name: &str) -> Result<(), BadName> {
    let good = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
    if (1..=40).contains(&name.len()) && name.chars().all(good) { Ok(()) } else { Err(BadName(name.to_owned())) }
}

macro_rules! topics {
    ($($(#[$meta:meta])* $name:ident($($instance:ident)?) -> $message:ty = $key:literal, $class:ident;)*) => {
        $($(#[$meta])*
        pub fn $name($($instance: &str)?) -> Topic<$message> {
            Topic::new(format!($key), Class::$class)
        })*
        /// Every topic: key with `*` for the instance, name of its message, class.
        pub fn all() -> Vec<(String, &'static str, Class)> {
            vec![$({
                $(let $instance = "*";)?
                (format!($key), <$message as Message>::NAME, Class::$class)
            }),*]
        }
    };
}

topics! {
    /// The exposures of one camera; one that is for colour comes without its pixels ([`Frame::by_topic`]).
    frame(camera) -> Frame = "camera/{camera}/frame", Frame;
    /// Pictures of one camera that the lamp alone has lit: a reader of these is spared all others.
    colour(camera) -> Frame = "camera/{camera}/colour", Gathered;
    /// Readings of one tracker.
    pose(tracker) -> Pose = "tracker/{tracker}/pose", Stream;
    /// Laser lines found in the pictures of one camera.
    stripe(camera) -> Stripe = "stripe/{camera}/stripe", Stream;
    /// Lit points in the frame of one camera.
    profile(camera) -> Profile = "profile/{camera}/profile", Stream;
    /// Lit points of one camera in the world.
    scan(camera) -> Scan = "world/{camera}/scan", Stream;
    /// The way of one camera in the world.
    trajectory(camera) -> Trajectory = "world/{camera}/trajectory", Stream;
    /// What the latest revision of a refined world rests on.
    refinement(world) -> Refinement = "world/{world}/refinement", Latched;
    /// The thinned cloud.
    cloud() -> Cloud = "model/cloud", Stream;
    /// The surface.
    mesh() -> Mesh = "model/mesh", Latched;
    /// The painted surface.
    textured() -> Model = "model/textured", Latched;
    /// The calibration of one handset.
    calibration(rig) -> Calibration = "rig/{rig}/calibration", Latched;
    /// What the operator is doing.
    run_phase() -> RunPhase = "run/phase", Latched;
    /// The true way of a simulated camera: for the report alone.
    truth_trajectory(camera) -> Trajectory = "truth/{camera}/trajectory", Stream;
    /// What a node says of itself.
    health(node) -> Health = "@health/{node}", Trace;
    /// How far a node has come.
    progress(node) -> Progress = "@progress/{node}", Frame;
    /// What an operator asks for; the launcher answers on [`run_phase`], which it alone publishes.
    order() -> RunPhase = "@order/phase", Frame;
    /// What a node logs.
    log(node) -> LogLine = "@log/{node}", Trace;
}

/// The key under which a node declares that it is ready.
pub fn ready_key(node: &str) -> String {
    format!("@ready/{node}")
}
