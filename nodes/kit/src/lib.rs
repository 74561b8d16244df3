//! How a node lives: it reads its configuration, opens its inputs and outputs, says that it is ready, works until it is
//! told to stop, and accounts for what it did.
//!
//! A node's `run` is a plain loop that reads top to bottom:
//!
//! ```no_run
//! # fn detect(_: &wire::Frame) -> wire::Stripe { unimplemented!() }
//! fn run(mut node: kit::Node) -> anyhow::Result<()> {
//!     let mut frames = node.input(&wire::topic::frame("head"), 16)?;
//!     let mut stripes = node.output(&wire::topic::stripe("head"))?;
//!     node.ready()?;
//!     while node.wait() {
//!         while let Some(frame) = frames.next() {
//!             stripes.send(detect(&frame))?;
//!             node.finished(&frame.header)?;
//!         }
//!     }
//!     Ok(())
//! }
//! ```
//!
//! The launcher writes a [`NodeSpec`] as one line of JSON on the node's stdin and keeps stdin open: a node that sees it
//! close stops, so no node outlives its launcher.

mod health;
mod lifeline;
mod log;
mod node;
mod pace;
mod ports;
mod source;
mod spec;
mod window;

pub use bus::{Bus, BusConfig, GATHERED_HISTORY, Presence, RawMessage, STREAM_HISTORY};
pub use lifeline::Stopper;
pub use node::Node;
pub use pace::{Go, Pace};
pub use ports::{Input, Output, Pictures, RawInput};
pub use spec::NodeSpec;
