//! `limn hz TOPIC`.

use crate::live::{WhichRig, print};
use crate::tally::Tallies;
use anyhow::Result;
use std::time::{Duration, Instant};

/// The arguments.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// A topic; `*` stands for one chunk, `**` for any number.
    pub topic: String,
    /// Stop after so many reports.
    #[arg(long, short = 'n', value_name = "N")]
    pub count: Option<u64>,
    #[command(flatten)]
    rig: WhichRig,
}

const EVERY: Duration = Duration::from_secs(1);
const DEPTH: usize = 4096;

/// Prints a report each second.
pub fn run(args: &Args) -> Result<()> {
    let (_, bus) = args.rig.open()?;
    let mut messages = bus.subscribe_raw(&args.topic, DEPTH)?;
    let (mut before, mut now) = (Tallies::default(), Tallies::default());
    let (mut reports, mut reported) = (0, Instant::now());
    while args.count.is_none_or(|count| reports < count) {
        bus.wait(EVERY.saturating_sub(reported.elapsed()));
        while let Some(message) = messages.next() {
            now.note(&message);
        }
        let seconds = reported.elapsed().as_secs_f64();
        if seconds < EVERY.as_secs_f64() {
            continue;
        }
        print(&report(&before, &now, seconds))?;
        (reports, reported) = (reports + 1, Instant::now());
        before = now.clone();
    }
    Ok(())
}

fn report(before: &Tallies, now: &Tallies, seconds: f64) -> String {
    if now.0.is_empty() {
        return "nothing yet\n".to_owned();
    }
    let line = |(key, tally): (&String, &crate::tally::Tally)| {
        let (messages, bytes) = before.0.get(key).map_or((0, 0), |tally| (tally.messages, tally.bytes));
        let rate = (tally.messages - messages) as f64 / seconds;
        let megabytes = (tally.bytes - bytes) as f64 / seconds / 1e6;
        format!("{key:<32} {rate:>8.1}/s {megabytes:>9.3} MB/s {:>6} lost\n", tally.lost)
    };
    now.0.iter().map(line).collect()
}
