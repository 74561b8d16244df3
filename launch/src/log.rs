//! One log of all nodes, with the node's name on each line.

use std::io::{IsTerminal as _, Write as _};
use std::sync::Arc;
use tokio::io::{AsyncBufRead, AsyncBufReadExt as _};
use wire::LogLevel;

/// One line of one node.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Line {
    /// The node's name in the launch file, or `limn` for the launcher itself.
    pub node: String,
    /// For whom.
    pub level: LogLevel,
    /// Without level and line end.
    pub text: String,
}

/// Where lines go.
pub type Sink = Arc<dyn Fn(&Line) + Send + Sync>;

/// Longer lines are cut: a node that writes no line end must not fill the memory.
const LONGEST: usize = 16 * 1024;

/// A sink that writes to standard error, in colour when that is a terminal.
pub fn to_stderr(width: usize) -> Sink {
    let coloured = std::io::stderr().is_terminal();
    Arc::new(move |line| {
        // When standard error is gone there is nobody left to tell.
        let _ = writeln!(std::io::stderr().lock(), "{}", format(line, width, coloured));
    })
}

/// `stripe | text`, with the level in front of the text when it is not information.
pub fn format(line: &Line, width: usize, coloured: bool) -> String {
    let (level, colour) = match line.level {
        LogLevel::Error => ("ERROR ", "\x1b[31m"),
        LogLevel::Warn => ("WARN ", "\x1b[33m"),
        LogLevel::Info => ("", ""),
        LogLevel::Debug => ("debug ", "\x1b[2m"),
    };
    let Line { node, text, .. } = line;
    match coloured {
        true => format!("\x1b[36m{node:>width$}\x1b[0m | {colour}{level}{text}\x1b[0m"),
        false => format!("{node:>width$} | {level}{text}"),
    }
}

/// A line as a node wrote it: ` INFO text` of `tracing`, or anything that a node of others writes.
pub fn parse(node: &str, written: &str) -> Line {
    let text = written.trim_end();
    let levels = [
        ("ERROR", LogLevel::Error),
        ("WARN", LogLevel::Warn),
        ("INFO", LogLevel::Info),
        ("DEBUG", LogLevel::Debug),
        ("TRACE", LogLevel::Debug),
    ];
    let trimmed = text.trim_start();
    let found = levels.iter().find_map(|(word, level)| Some((*level, trimmed.strip_prefix(word)?.strip_prefix(' ')?)));
    let (level, text) = found.unwrap_or((LogLevel::Info, text));
    Line { node: node.to_owned(), level, text: text.chars().filter(|c| !c.is_control() || *c == '\t').collect() }
}

/// Hands on the lines of a node's output until it closes.
pub(crate) async fn follow(node: &str, mut output: impl AsyncBufRead + Unpin, each: impl Fn(Line)) {
    let mut held = Vec::new();
    // A line that breaks ends the log of this process; its end is told by others.
    while let Ok(more) = output.fill_buf().await {
        if more.is_empty() {
            break;
        }
        let end = more.iter().position(|&byte| byte == b'\n');
        let taken = end.map_or(more.len(), |end| end + 1);
        let room = LONGEST.saturating_sub(held.len()).min(taken);
        held.extend_from_slice(&more[..room]);
        output.consume(taken);
        if end.is_some() {
            each(parse(node, &String::from_utf8_lossy(&held)));
            held.clear();
        }
    }
    if !held.is_empty() {
        each(parse(node, &String::from_utf8_lossy(&held)));
    }
}
