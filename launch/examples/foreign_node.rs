//! A node that is not built into `limn`: a launch file starts it by `exec = "path"`.
//!
//! It is started as `foreign_node node KIND --instance NAME`, reads its configuration as one line of JSON on standard
//! input, declares itself ready, and stops when standard input closes. In Rust, `kit` does all that; in any other
//! language it is a JSON parser and a Zenoh client. This one counts pictures. With `fail = true` in its configuration it
//! fails at once, and with `deaf = true` it does not stop when it is told to: the launcher's tests need both.

use serde::{Deserialize, Serialize};

#[derive(Debug, Clone, Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
struct Config {
    /// Fail at once.
    fail: bool,
    /// Stay when told to stop.
    deaf: bool,
    /// Fail on the first picture.
    fail_later: bool,
}

fn main() -> anyhow::Result<()> {
    let spec = kit::NodeSpec::from_stdin()?;
    let config: Config = spec.config()?;
    if config.fail {
        eprintln!("ERROR told to fail");
        std::process::exit(3);
    }
    let camera = spec.source_of("camera").to_owned();
    let mut node = if config.deaf { kit::Node::open_unattended(spec)? } else { kit::Node::open(spec)? };
    let mut frames = node.input(&wire::topic::frame(&camera), 16)?;
    node.ready()?;
    let mut count = 0;
    while node.wait() {
        while let Some(frame) = frames.next() {
            count += 1;
            if config.fail_later {
                anyhow::bail!("told to fail on picture {count}");
            }
            node.finished(&frame.header)?;
        }
        // Without a source there is no end in a stream: the operator's word stands for it.
        if let Some(phase) = node.phase().filter(|phase| phase.header.is_end()).cloned() {
            node.finished(&phase.header)?;
        }
    }
    println!("counted {count} pictures");
    node.close()
}
