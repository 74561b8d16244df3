//! Pixels and stamps.

use crate::bench::Bench;
use anyhow::{Context as _, ensure};
use camera_v4l::{CameraV4l, DriverFormat, StampAt, clock_readings, monotonic_nanos};
use std::time::{Duration, SystemTime, UNIX_EPOCH};
use wire::{Frame, LaserPlane, PeaksPer, Phase};

const PICTURES: usize = 5;

/// Whether red, green and blue are in the bars of the test picture, from left to right.
const BARS: [[bool; 3]; 8] = [
    [true, true, true],
    [true, true, false],
    [false, true, true],
    [false, true, false],
    [true, false, true],
    [true, false, false],
    [false, false, true],
    [false, false, false],
];

fn laser() -> LaserPlane {
    LaserPlane {
        normal: [1.0, 0.0, 0.0],
        distance_m: 0.1,
        channel_weights: [1.0, -0.5, -0.5],
        peaks_per: PeaksPer::Row,
    }
}

fn frames(bench: &Bench, format: DriverFormat) -> anyhow::Result<Vec<Frame>> {
    let config = bench.config(format);
    let mut camera = CameraV4l::new(config.clone(), laser())?;
    let stream = bench.stream(config);
    (0..PICTURES).map(|_| Ok(camera.process(stream.next()?, &clock_readings(), Phase::Shape)?)).collect()
}

pub fn are_the_pattern(bench: &Bench) -> anyhow::Result<()> {
    let mut red_first = None;
    for format in [DriverFormat::Rgb3, DriverFormat::Bgr3, DriverFormat::Yuyv, DriverFormat::Grey] {
        let frames = frames(bench, format)?;
        let first = &frames[0];
        ensure!(frames.iter().all(|frame| frame.data == first.data), "{format}: the picture changes");
        let hash = first
            .data
            .iter()
            .fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3));
        println!("    {format} {}x{} stride {} FNV-1a {hash:016x}", first.width, first.height, first.stride);
        match format {
            DriverFormat::Rgb3 => {
                bars(first)?;
                red_first = Some(first.data.clone());
            }
            DriverFormat::Bgr3 => ensure!(Some(&first.data) == red_first.as_ref(), "BGR3 and RGB3 differ"),
            DriverFormat::Yuyv | DriverFormat::Grey | DriverFormat::Mjpg => luminances(first, format)?,
        }
    }
    Ok(())
}

/// The middle of each bar has the colours that it should.
fn bars(frame: &Frame) -> anyhow::Result<()> {
    for (bar, wanted) in BARS.iter().enumerate() {
        let (u, v) = ((2 * bar + 1) * frame.width as usize / 16, frame.height as usize / 2);
        let at = v * frame.stride as usize + 3 * u;
        let seen = [0, 1, 2].map(|channel| frame.data[at + channel] > 96);
        ensure!(seen == *wanted, "bar {bar}: {:?}", &frame.data[at..at + 3]);
    }
    Ok(())
}

/// From white on, each bar is darker than the one before: so the colours of the test picture are ordered.
fn luminances(frame: &Frame, format: DriverFormat) -> anyhow::Result<()> {
    let bytes_a_pixel = if format == DriverFormat::Yuyv { 2 } else { 1 };
    let row = frame.height as usize / 2 * frame.stride as usize;
    let seen: Vec<u8> = (0..BARS.len())
        .map(|bar| frame.data[row + (2 * bar + 1) * frame.width as usize / 16 * bytes_a_pixel])
        .collect();
    ensure!(seen.windows(2).all(|pair| pair[0] > pair[1]), "{format}: {seen:?}");
    Ok(())
}

pub fn are_stamped(bench: &Bench) -> anyhow::Result<()> {
    // vivid's stamps at the end of a frame lie 0.9 periods ahead, those at its start are honest.
    bench.turn("timestamp_source", 1)?;
    let config = bench.config(DriverFormat::Grey);
    let mut camera = CameraV4l::new(config.clone(), laser())?;
    let stream = bench.stream(config);
    let (mut stamps, mut ages_ms) = (Vec::new(), Vec::new());
    for _ in 0..20 {
        let exposed = stream.next()?;
        ensure!(exposed.stamp.flags & 0x1_e000 == 0x1_2000, "flags {:#x}", exposed.stamp.flags);
        let frame = camera.process(exposed, &clock_readings(), Phase::Shape)?;
        let now = SystemTime::now().duration_since(UNIX_EPOCH)?.as_nanos() as i64;
        ages_ms.push((now - frame.header.stamp_nanos) as f64 * 1e-6);
        stamps.push(frame.header.stamp_nanos);
    }
    bench.turn("timestamp_source", 0)?;
    let uncertainty = camera.clock_uncertainty_nanos().context("no clock")?;
    println!("    ages {:.0?} ms, clocks known within {uncertainty} ns", ages_ms);
    ensure!(stamps.windows(2).all(|pair| pair[0] < pair[1]), "stamps {stamps:?}");
    ensure!(ages_ms.iter().all(|age| (0.0..500.0).contains(age)), "ages {ages_ms:?} ms");
    Ok(())
}

pub fn are_fresh(bench: &Bench) -> anyhow::Result<()> {
    bench.turn("timestamp_source", 1)?;
    let config = camera_v4l::Config { stamp_at: StampAt::Start, ..bench.config(DriverFormat::Yuyv) };
    let stream = bench.stream(config);
    stream.next()?;
    let mut oldest_ms = 0.0_f64;
    for _ in 0..10 {
        std::thread::sleep(Duration::from_millis(200));
        let exposed = stream.next()?;
        oldest_ms = oldest_ms.max((monotonic_nanos() - exposed.stamp.nanos) as f64 * 1e-6);
    }
    bench.turn("timestamp_source", 0)?;
    let counts = stream.capture.counts();
    println!("    with 200 ms of work a picture the oldest was {oldest_ms:.0} ms old; {counts:?}");
    // With the crate's own queue of four it is 620 ms.
    ensure!(oldest_ms < 250.0, "{oldest_ms} ms");
    ensure!(counts.skipped > 10, "{counts:?}");
    Ok(())
}
