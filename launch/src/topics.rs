//! `limn topics`.

use crate::graph::matches;
use crate::live::{WhichRig, print};
use crate::running;
use crate::tally::Tallies;
use anyhow::Result;
use std::fmt::Write as _;
use std::time::{Duration, Instant};
use wire::topic::{self, Class};

/// How long to listen.
const LISTEN: Duration = Duration::from_secs(2);

/// Prints every topic that there can be, and below it what comes on it in a rig that is up.
pub fn run(rig: &WhichRig) -> Result<()> {
    let up = running::all(&running::folder()?)?;
    let tallies = if up.is_empty() && rig.name.is_none() { Tallies::default() } else { listen(rig)? };
    let mut text = String::new();
    for (key, message, class) in topic::all() {
        let class = match class {
            Class::Frame => "reliable",
            Class::Gathered => "reliable, newest kept",
            Class::Stream => "reliable, history kept",
            Class::Latched => "latest kept",
            Class::Trace => "dropped first",
        };
        let _ = writeln!(text, "{key:<26} {message:<12} {class}");
        let expression = key.strip_suffix('*').map_or(key.clone(), |stem| format!("{stem}**"));
        for (live, tally) in tallies.0.iter().filter(|(live, _)| matches(&expression, live)) {
            let unreadable = if tally.unreadable > 0 {
                format!(", {} unreadable ({})", tally.unreadable, tally.schema)
            } else {
                String::new()
            };
            let _ = writeln!(text, "    {live:<34} {} messages, {} bytes{unreadable}", tally.messages, tally.bytes);
        }
    }
    print(&text)
}

fn listen(rig: &WhichRig) -> Result<Tallies> {
    let (_, bus) = rig.open()?;
    let mut tallies = Tallies::default();
    // `**` does not see what stands under `@`.
    let mut lines = ["**", "@health/**", "@progress/**", "@log/**"]
        .map(|key| bus.subscribe_raw(key, 65_536))
        .into_iter()
        .collect::<Result<Vec<_>, _>>()?;
    let until = Instant::now() + LISTEN;
    while Instant::now() < until {
        bus.wait(until.saturating_duration_since(Instant::now()));
        for line in &mut lines {
            while let Some(message) = line.next() {
                tallies.note(&message);
            }
        }
    }
    Ok(tallies)
}
