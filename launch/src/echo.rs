//! `limn echo TOPIC`.

use crate::decode;
use crate::live::{WhichRig, print};
use anyhow::Result;
use std::time::Duration;

/// Examples for `--help`.
pub const HELP: &str = "Examples:
  limn echo stripe/head/stripe
  limn echo 'tracker/*/pose' --count 3
  limn echo '@health/**'           what the nodes say of themselves";

/// The arguments.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// A topic; `*` stands for one chunk, `**` for any number.
    pub topic: String,
    /// Stop after so many messages.
    #[arg(long, short = 'n', value_name = "N")]
    pub count: Option<u64>,
    #[command(flatten)]
    rig: WhichRig,
}

/// Waiting messages; older ones are let go when printing is slower than they come.
const DEPTH: usize = 256;

/// Prints messages until it has printed enough.
pub fn run(args: &Args) -> Result<()> {
    let (_, bus) = args.rig.open()?;
    let mut messages = bus.subscribe_raw(&args.topic, DEPTH)?;
    let mut printed = 0;
    while args.count.is_none_or(|count| printed < count) {
        let Some(message) = messages.next() else {
            bus.wait(Duration::from_millis(200));
            continue;
        };
        printed += 1;
        match decode::text(&message.schema, &message.bytes) {
            Ok(text) => print(&format!("{}: {text}\n", message.key))?,
            Err(error) => print(&format!("{}: {} bytes: {error}\n", message.key, message.bytes.len()))?,
        }
    }
    Ok(())
}
