//! The node itself, as a launcher starts it: a process that reads its configuration from stdin and sends its pictures on a bus.

use crate::bench::Bench;
use crate::pictures::{is_the_pattern, row_of_bars};
use crate::rig::{Rig, now_nanos};
use anyhow::{Context as _, ensure};
use camera_v4l::DriverFormat;
use kit::{Node, NodeSpec};
use signal_hook::consts::SIGUSR1;
use std::process::Command;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use wire::{Clock, Frame, PixelFormat};

const PICTURES: usize = 10;
/// So often each thread of the node is interrupted.
const SIGNALS: usize = 20;

/// This program as that node. It minds a signal, so that one which comes interrupts what it waits in.
pub fn run() -> anyhow::Result<()> {
    signal_hook::flag::register(SIGUSR1, Arc::<AtomicBool>::default())?;
    camera_v4l::node::run(Node::open(NodeSpec::from_stdin()?)?)
}

pub fn sends_its_pictures(bench: &Bench) -> anyhow::Result<()> {
    // vivid's stamps at the end of a frame lie ahead, those at its start are honest.
    bench.turn("timestamp_source", 1)?;
    let mut rig = Rig::start(&bench.config(DriverFormat::Rgb3))?;
    let began = rig.begin()?;
    let mut seen = Vec::new();
    rig.see(PICTURES, &mut seen)?;

    std::fs::remove_file(&bench.by_id)?;
    bench.turn("disconnect", 1)?;
    rig.logs("was unplugged")?;
    bench.link()?;
    rig.logs("RGB3 640x480")?;
    rig.see(PICTURES, &mut seen)?;

    let end = rig.end(&mut seen)?;
    are_of_the_scan(&seen)?;
    let stamps: Vec<i64> = seen.iter().map(|frame| frame.header.stamp_nanos).collect();
    ensure!(stamps.windows(2).all(|pair| pair[0] < pair[1]), "{stamps:?}");
    ensure!(stamps[0] > began - 1_000_000_000 && end.stamp_nanos < now_nanos()?, "{began} {stamps:?}");
    rig.close()?;
    bench.turn("timestamp_source", 0)
}

pub fn goes_on_whatever_happens(bench: &Bench) -> anyhow::Result<()> {
    let mut rig = Rig::start(&bench.config(DriverFormat::Rgb3))?;
    rig.begin()?;
    let mut seen = Vec::new();
    rig.see(PICTURES, &mut seen)?;

    bench.turn("percentage_of_dropped_buffers", 50)?;
    let lost = rig.counts("picture that the driver lost", 8)?;
    bench.turn("percentage_of_dropped_buffers", 0)?;
    rig.logs("picture that the driver lost")?;
    rig.see(PICTURES, &mut seen)?;

    bench.turn("inject_v4l2_buf_flag_error", 1)?;
    let damaged = rig.counts("picture that the driver marks as damaged", 1)?;
    rig.see(PICTURES, &mut seen)?;
    println!("    {} pictures; the node counts {lost} lost, {damaged} damaged", seen.len());

    bench.turn("inject_fatal_streaming_error", 1)?;
    rig.logs("broke")?;
    rig.logs("RGB3 640x480")?;
    rig.see(PICTURES, &mut seen)?;

    for _ in 0..SIGNALS {
        interrupt_every_thread(rig.process())?;
        rig.see(1, &mut seen)?;
    }
    rig.end(&mut seen)?;
    are_of_the_scan(&seen)?;
    rig.close()
}

/// Sends a signal to each thread by its own number: the kernel wakes that one.
fn interrupt_every_thread(process: u32) -> anyhow::Result<()> {
    for thread in std::fs::read_dir(format!("/proc/{process}/task"))? {
        let thread = thread?;
        let status = Command::new("kill").arg("-USR1").arg(thread.file_name()).status().context("starting kill")?;
        // One may end meanwhile.
        ensure!(status.success() || !thread.path().exists(), "kill -USR1 {}: {status}", thread.path().display());
    }
    Ok(())
}

fn are_of_the_scan(seen: &[Frame]) -> anyhow::Result<()> {
    let row = row_of_bars(PixelFormat::Rgb8, seen.first().context("no picture")?.width as usize);
    for frame in seen {
        ensure!((frame.header.scan, frame.header.clock) == (1, Clock::System), "{:?}", frame.header);
        ensure!(frame.light.laser && !frame.light.lamp, "{:?}", frame.light);
        is_the_pattern(frame, &row)?;
    }
    Ok(())
}
