//! A node's log: plain lines on stderr, where the launcher puts the node's name before them, and messages on the bus.

use std::collections::VecDeque;
use std::fmt::{self, Write as _};
use std::io::IsTerminal as _;
use std::sync::{Arc, Mutex, PoisonError};
use tracing::field::{Field, Visit};
use tracing::{Event, Level, Subscriber};
use tracing_subscriber::layer::{Context, SubscriberExt as _};
use tracing_subscriber::util::SubscriberInitExt as _;
use tracing_subscriber::{EnvFilter, Layer};
use wire::LogLevel;

/// Lines on their way to the bus; the oldest go when nobody fetches them.
const HELD: usize = 256;

/// Lines that have not been sent yet.
#[derive(Clone, Default)]
pub(crate) struct Lines(Arc<Mutex<VecDeque<(LogLevel, String)>>>);

impl Lines {
    pub(crate) fn take(&self) -> Vec<(LogLevel, String)> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).drain(..).collect()
    }

    fn push(&self, level: LogLevel, text: String) {
        let mut lines = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if lines.len() == HELD {
            lines.pop_front();
        }
        lines.push_back((level, text));
    }
}

/// Starts the log of this process; in a test, where there is one already, only the bus is left out.
pub(crate) fn start(filter: &str) -> Lines {
    let lines = Lines::default();
    // Zenoh tells its own story in great detail; its errors are enough. A session that closes calls each message that
    // still comes an error.
    let filter = EnvFilter::try_new(format!("warn,zenoh=error,zenoh::api::session=off,{filter}"))
        .unwrap_or_else(|_| EnvFilter::new("info"));
    let stderr = tracing_subscriber::fmt::layer()
        .with_writer(std::io::stderr)
        .with_ansi(std::io::stderr().is_terminal())
        .without_time()
        .with_target(false);
    let _ = tracing_subscriber::registry().with(filter).with(stderr).with(ToLines(lines.clone())).try_init();
    lines
}

struct ToLines(Lines);

impl<S: Subscriber> Layer<S> for ToLines {
    fn on_event(&self, event: &Event<'_>, _: Context<'_, S>) {
        let level = match *event.metadata().level() {
            Level::ERROR => LogLevel::Error,
            Level::WARN => LogLevel::Warn,
            Level::INFO => LogLevel::Info,
            Level::DEBUG | Level::TRACE => LogLevel::Debug,
        };
        let mut text = Text::default();
        event.record(&mut text);
        self.0.push(level, text.0);
    }
}

#[derive(Default)]
struct Text(String);

impl Visit for Text {
    fn record_debug(&mut self, field: &Field, value: &dyn fmt::Debug) {
        let written = match field.name() {
            "message" => write!(self.0, "{value:?}"),
            name => write!(self.0, " {name}={value:?}"),
        };
        debug_assert!(written.is_ok(), "a String takes all text");
    }
}
