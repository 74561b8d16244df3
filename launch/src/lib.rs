//! Starts, watches and stops nodes; the operator's commands.
//!
//! A launch file (TOML) says which nodes a rig has. [`plan::Plan::load`] reads it with its includes and `--set`
//! arguments, refuses what nobody knows (naming the nearest that somebody does, with file and line), and keeps for each
//! value where it was said. [`launcher::Launcher::start`] embeds the bus's router on loopback and starts each node as a
//! process of its own: its configuration is one line of JSON on its standard input, which stays open as a lifeline.
//! Sources begin when all others are ready; a node that fails is started again, with growing pauses and not for ever;
//! [`launcher::Launcher::stop`] ends the scan, closes the lifelines, and only then sends signals.
//!
//! ```
//! use limn::{nodes::KINDS, plan::Plan};
//! let folder = tempfile::tempdir().unwrap();
//! let file = folder.path().join("rig.toml");
//! std::fs::write(&file, "[nodes.hello]\nexec = '/bin/true'\n[run]\npace = 'fsat'").unwrap();
//! let error = Plan::load(&file, &[], KINDS).unwrap_err().to_string();
//! assert!(error.ends_with(r#"rig.toml:4: run.pace = "fsat", did you mean "fast"?"#), "{error}");
//! ```
//!
//! Who wants to run a rig from code (the demo does) takes [`launcher::Launcher`] and its events; who wants another node
//! in the program adds a line to [`nodes::KINDS`].

pub mod accounts;
pub mod backoff;
pub mod board;
pub mod cli;
mod clocks;
mod cluster_cmd;
mod compare_cmd;
pub mod config;
pub mod decode;
pub mod demo;
mod desk;
mod echo;
mod emulate;
pub mod file;
pub mod graph;
mod hz;
pub mod include;
mod keys;
pub mod kind;
pub mod launcher;
mod live;
pub mod log;
mod model_cmd;
pub mod nearest;
mod node_cmd;
pub mod nodes;
pub mod operator;
pub mod plan;
pub mod planned;
mod process;
mod record_cmd;
mod recorded;
mod refine_cmd;
mod replay_cmd;
pub mod run;
pub mod running;
mod scan;
pub mod scan_folder;
pub mod section;
pub mod set;
pub mod setting;
mod skipped;
mod spec;
pub mod stop;
pub mod story;
mod stripe_cmd;
mod supervise;
mod surface_cmd;
mod tally;
mod top;
mod topics;
mod units;
pub mod up;
