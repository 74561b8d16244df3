//! `limn top`: a table of the nodes of a rig that is up, from what they say of themselves.

use crate::live::WhichRig;
use anyhow::Result;
use bus::Bus;
use ratatui::crossterm::event::{self, Event, KeyCode, KeyModifiers};
use ratatui::layout::{Constraint, Layout};
use ratatui::style::{Color, Modifier, Style};
use ratatui::text::Line;
use ratatui::widgets::{Cell, Row, Table};
use ratatui::{DefaultTerminal, Frame};
use std::collections::BTreeMap;
use std::time::{Duration, Instant};
use wire::{Health, RunPhase, topic};

/// Two accounts of one node, so that there are rates.
struct Known {
    latest: Health,
    came: Instant,
    rates: Rates,
}

/// Per second, between the latest two accounts.
#[derive(Default, Clone, Copy)]
struct Rates {
    received: f64,
    published: f64,
    /// Share of one core.
    processor: f64,
    /// Share of the time that was not spent waiting.
    busy: f64,
}

const FRAME: Duration = Duration::from_millis(200);
/// Accounts come once a second; one that is so late is shown as silent.
const SILENT: Duration = Duration::from_secs(4);

/// Shows the table until q, Esc or Ctrl-C.
pub fn run(rig: &WhichRig) -> Result<()> {
    let (running, bus) = rig.open()?;
    let mut terminal = ratatui::try_init()?;
    let outcome = show(&mut terminal, &running.name, &bus);
    ratatui::restore();
    outcome
}

fn show(terminal: &mut DefaultTerminal, name: &str, bus: &Bus) -> Result<()> {
    let mut accounts = bus.subscribe(&topic::health("**"), 1024)?;
    let mut phases = bus.subscribe(&topic::run_phase(), 16)?;
    let (mut nodes, mut phase) = (BTreeMap::new(), None);
    loop {
        while let Some(account) = accounts.next() {
            note(&mut nodes, account);
        }
        phase = phases.newest().or(phase);
        terminal.draw(|frame| draw(frame, name, phase.as_ref(), &nodes))?;
        if event::poll(FRAME)?
            && let Event::Key(key) = event::read()?
        {
            let interrupt = key.code == KeyCode::Char('c') && key.modifiers.contains(KeyModifiers::CONTROL);
            if interrupt || matches!(key.code, KeyCode::Char('q') | KeyCode::Esc) {
                return Ok(());
            }
        }
    }
}

fn note(nodes: &mut BTreeMap<String, Known>, latest: Health) {
    let now = Instant::now();
    let rates = nodes.get(&latest.node).map(|before| rates(before, &latest, now)).unwrap_or_default();
    nodes.insert(latest.node.clone(), Known { latest, came: now, rates });
}

fn received(account: &Health) -> u64 {
    account.inputs.iter().map(|input| input.received).sum()
}

fn rates(before: &Known, latest: &Health, now: Instant) -> Rates {
    let seconds = now.duration_since(before.came).as_secs_f64().max(1e-3);
    let per_second = |new: u64, old: u64| new.saturating_sub(old) as f64 / seconds;
    let share = |new: i64, old: i64| ((new - old) as f64 * 1e-9 / seconds).max(0.0);
    Rates {
        received: per_second(received(latest), received(&before.latest)),
        published: per_second(latest.published, before.latest.published),
        processor: share(latest.cpu_nanos, before.latest.cpu_nanos),
        busy: share(latest.busy_nanos, before.latest.busy_nanos),
    }
}

fn draw(frame: &mut Frame<'_>, name: &str, phase: Option<&RunPhase>, nodes: &BTreeMap<String, Known>) {
    let phase = phase.map_or("no phase yet".into(), |run| format!("scan {}: {:?}", run.header.scan, run.header.phase));
    let [title, body, foot] =
        Layout::vertical([Constraint::Length(1), Constraint::Min(0), Constraint::Length(1)]).areas(frame.area());
    frame.render_widget(Line::from(format!("rig {name}   {phase}")).style(Modifier::BOLD), title);
    frame.render_widget(Line::from("q ends").style(Style::new().fg(Color::DarkGray)), foot);
    let head = ["node", "in/s", "out/s", "p50 ms", "p99 ms", "cpu %", "busy %", "lost", "refused"];
    let widths = [Constraint::Min(20)].into_iter().chain([Constraint::Length(9); 8]);
    let table = Table::new(nodes.values().map(row), widths).header(Row::new(head).style(Modifier::UNDERLINED));
    frame.render_widget(table, body);
}

fn row(known: &Known) -> Row<'_> {
    let Known { latest, rates, came } = known;
    let lost: u64 = latest.inputs.iter().map(|input| input.lost).sum();
    let refused =
        latest.inputs.iter().map(|i| i.refused).sum::<u64>() + latest.refused.iter().map(|r| r.count).sum::<u64>();
    let millis = |nanos: i64| if nanos == 0 { "-".to_owned() } else { format!("{:.1}", nanos as f64 * 1e-6) };
    let alarm = |count: u64, colour| {
        Cell::from(count.to_string()).style(if count > 0 { Style::new().fg(colour) } else { Style::new() })
    };
    let row = Row::new([
        Cell::from(latest.node.as_str()),
        Cell::from(format!("{:.1}", rates.received)),
        Cell::from(format!("{:.1}", rates.published)),
        Cell::from(millis(latest.latency_p50_nanos)),
        Cell::from(millis(latest.latency_p99_nanos)),
        Cell::from(format!("{:.0}", 100.0 * rates.processor)),
        Cell::from(format!("{:.0}", 100.0 * rates.busy)),
        alarm(lost, Color::Red),
        alarm(refused, Color::Yellow),
    ]);
    if came.elapsed() > SILENT { row.style(Modifier::DIM) } else { row }
}
