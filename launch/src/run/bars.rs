//! What the terminal shows while a scan passes: one line a phase.

use super::parts::{self, Part};
use crate::plan::Plan;
use indicatif::{MultiProgress, ProgressBar, ProgressStyle};
use std::io::IsTerminal as _;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Shared by the launcher, the listener and the log.
#[derive(Clone)]
pub struct Bars {
    all: MultiProgress,
    state: Arc<Mutex<State>>,
    sweep_s: Option<f64>,
    parts: Arc<[Part]>,
}

struct State {
    bar: ProgressBar,
    part: usize,
    began: Instant,
}

impl Bars {
    /// Nothing shown yet.
    pub fn new(sweep_s: Option<f64>, plan: &Plan) -> Self {
        let state = State { bar: ProgressBar::hidden(), part: 0, began: Instant::now() };
        let parts = parts::of(plan).collect();
        Self { all: MultiProgress::new(), state: Arc::new(Mutex::new(state)), sweep_s, parts }
    }

    fn with<T>(&self, change: impl FnOnce(&mut State) -> T) -> T {
        change(&mut self.state.lock().unwrap_or_else(PoisonError::into_inner))
    }

    fn spinner(&self, text: String) -> ProgressBar {
        let style =
            ProgressStyle::with_template("{spinner} {msg} {elapsed:>4}").unwrap_or(ProgressStyle::default_spinner());
        let bar = self.all.add(ProgressBar::new_spinner().with_style(style).with_message(text));
        bar.enable_steady_tick(Duration::from_millis(120));
        bar
    }

    /// The nodes are being started.
    pub fn starting(&self, nodes: usize) {
        let bar = self.spinner(format!("starting {nodes} nodes"));
        self.with(|state| state.bar = bar);
    }

    /// All nodes are ready, the hand moves.
    pub fn sweeping(&self) {
        let began = self.with(|state| {
            state.bar.finish_and_clear();
            std::mem::replace(&mut state.began, Instant::now())
        });
        self.say(&format!("nodes ready after {:.1} s", began.elapsed().as_secs_f64()));
        let bar = match self.sweep_s {
            None => self.spinner("sweep".to_owned()),
            Some(seconds) => {
                let style = ProgressStyle::with_template("  sweep {bar:40} {pos:>3}/{len} s {msg}");
                let style = style.unwrap_or(ProgressStyle::default_bar());
                self.all.add(ProgressBar::new(seconds.ceil() as u64).with_style(style))
            }
        };
        self.with(|state| state.bar = bar);
    }

    /// How far the sweep has come, and what it has brought.
    pub fn swept(&self, scan_s: f64, points: u64) {
        self.with(|state| {
            if state.part == 0 {
                state.bar.set_position(scan_s as u64);
                state.bar.set_message(format!("{points} points"));
            }
        });
    }

    /// A node has done its work: the part that ends with it is over.
    pub fn finished(&self, node: &str) {
        let Some(part) = self.parts.iter().position(|part| part.ends_with(node)) else { return };
        let lines: Vec<String> = self.with(|state| {
            let mut lines = Vec::new();
            while state.part <= part {
                let seconds = std::mem::replace(&mut state.began, Instant::now()).elapsed().as_secs_f64();
                lines.push(format!("{:<10} {seconds:>6.1} s", self.parts[state.part].name));
                state.bar.finish_and_clear();
                state.part += 1;
            }
            lines
        });
        lines.iter().for_each(|line| self.say(line));
        if let Some(next) = self.parts.get(part + 1) {
            let bar = self.spinner(next.name.to_owned());
            self.with(|state| state.bar = bar);
        }
    }

    /// A line above the bar.
    pub fn say(&self, text: &str) {
        if std::io::stderr().is_terminal() {
            // The terminal may be gone.
            let _ = self.all.println(text);
        } else {
            eprintln!("{text}");
        }
    }

    /// Nothing more to show.
    pub fn done(&self) {
        self.with(|state| state.bar.finish_and_clear());
    }
}
