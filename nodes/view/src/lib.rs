//! The eyes of the operator: every stream of a rig, live, in Rerun's web page, which is served from within.
//!
//! In: frame, stripe, trajectory (the tracker's and the refined one), what refinement rests on, scan, cloud, mesh, model,
//! health and log. Out: nothing on the bus; two servers on loopback, one for the page and one for its data. The handset and
//! its sheet of light ([`handset`]) follow the live pose. Nobody waits for this node: it takes the newest picture, thins what
//! comes too often ([`Config`]), and its end changes nothing for the others.
//!
//! What grows is logged in parts: the cloud in chunks of [`cloud::CHUNK`] balls, of which only those that changed are
//! sent again, because the page keeps all that it ever got, up to [`Config::memory_mib`].

pub mod cloud;
pub mod config;
pub mod evidence;
pub mod handset;
#[cfg(feature = "node")]
mod layout;
#[cfg(feature = "node")]
pub mod node;
pub mod picture;
#[cfg(feature = "node")]
mod refined;
#[cfg(feature = "node")]
mod serve;
#[cfg(feature = "node")]
mod show;
pub mod ways;

pub use config::{Config, ConfigError};
