//! Pixels and stamps.

use crate::bench::Bench;
use anyhow::{Context as _, ensure};
use camera_v4l::{CameraV4l, DriverFormat, StampAt, clock_readings, monotonic_nanos};
use std::time::{Duration, SystemTime, UNIX_EPOCH};
use wire::{Frame, LaserPlane, PeaksPer, Phase, PixelFormat};

const PICTURES: usize = 5;

/// Bars of the test picture, from left to right: red, green, blue.
const BARS: [[u8; 3]; 8] = [
    [ON, ON, ON],
    [ON, ON, OFF],
    [OFF, ON, ON],
    [OFF, ON, OFF],
    [ON, OFF, ON],
    [ON, OFF, OFF],
    [OFF, OFF, ON],
    [OFF, OFF, OFF],
];
/// Of full scale: 75 %.
const ON: u8 = 191;
const OFF: u8 = 0;

pub fn laser() -> LaserPlane {
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
    for format in [DriverFormat::Rgb3, DriverFormat::Bgr3, DriverFormat::Yuyv, DriverFormat::Grey] {
        let frames = frames(bench, format)?;
        let row = row_of_bars(frames[0].format, frames[0].width as usize);
        let stride = frames[0].stride;
        println!("    {format} {}x{} stride {stride}", frames[0].width, frames[0].height);
        for frame in &frames {
            is_the_pattern(frame, &row)?;
            ensure!(frame.data == frames[0].data, "{format}: the picture changes");
        }
        has_the_colours(&frames[0])?;
    }
    Ok(())
}

/// Full range, limited range, and no word of the driver's.
pub fn are_of_the_drivers_range(bench: &Bench) -> anyhow::Result<()> {
    for (quantization, format) in [(1, PixelFormat::YuyvFull), (2, PixelFormat::Yuyv), (0, PixelFormat::Yuyv)] {
        bench.turn("quantization", quantization)?;
        let frames = frames(bench, DriverFormat::Yuyv)?;
        ensure!(frames[0].format == format, "{:?} at quantization {quantization}", frames[0].format);
        is_the_pattern(&frames[0], &row_of_bars(format, frames[0].width as usize))?;
        has_the_colours(&frames[0])?;
    }
    Ok(())
}

/// What its bytes stand for is what the driver has drawn.
fn has_the_colours(frame: &Frame) -> anyhow::Result<()> {
    if frame.format == PixelFormat::Grey8 {
        return Ok(());
    }
    for (k, bar) in BARS.iter().enumerate() {
        let seen = frame.format.rgb(&frame.data, (2 * k + 1) * frame.width as usize / 16);
        let same = seen.iter().zip(bar).all(|(seen, drawn)| seen.abs_diff(*drawn) <= 3);
        ensure!(same, "{:?}: {seen:?} instead of {bar:?}", frame.format);
    }
    Ok(())
}

/// Every pixel of every row. vivid computes Y, Cb and Cr in whole numbers, and is one level off here and there.
pub fn is_the_pattern(frame: &Frame, row: &[u8]) -> anyhow::Result<()> {
    ensure!(frame.data.len() == frame.height as usize * frame.stride as usize, "{} bytes", frame.data.len());
    let rounding = if frame.format == PixelFormat::Rgb8 { 0 } else { 1 };
    for (v, line) in frame.data.chunks(frame.stride as usize).enumerate() {
        let differs = line.iter().zip(row).position(|(seen, wanted)| seen.abs_diff(*wanted) > rounding);
        if let Some(at) = differs {
            let until = (at + 6).min(row.len());
            anyhow::bail!("row {v}, byte {at}: {:?} instead of {:?}", &line[at..until], &row[at..until]);
        }
    }
    Ok(())
}

/// A row of the bars, as it travels.
pub fn row_of_bars(format: PixelFormat, width: usize) -> Vec<u8> {
    let bar = |u: usize| BARS[8 * u / width];
    match format {
        PixelFormat::Rgb8 => (0..width).flat_map(bar).collect(),
        PixelFormat::Grey8 => (0..width).map(|u| grey(bar(u))).collect(),
        PixelFormat::Yuyv => row_of_pairs(width, |u| ycbcr(bar(u), [16.0, 219.0, 224.0])),
        PixelFormat::YuyvFull => row_of_pairs(width, |u| ycbcr(bar(u), [0.0, 255.0, 255.0])),
    }
}

fn row_of_pairs(width: usize, ycbcr: impl Fn(usize) -> [u8; 3]) -> Vec<u8> {
    (0..width).flat_map(|u| [ycbcr(u)[0], ycbcr(u)[1 + u % 2]]).collect()
}

/// BT.709 in its full range: so vivid has it.
fn grey(rgb: [u8; 3]) -> u8 {
    let [r, g, b] = rgb.map(f64::from);
    (0.2126 * r + 0.7152 * g + 0.0722 * b).round() as u8
}

/// BT.601 over a range: the level of black, the levels up to white, the levels of the colours.
fn ycbcr(rgb: [u8; 3], [black, luma, chroma]: [f64; 3]) -> [u8; 3] {
    let [r, g, b] = rgb.map(|level| f64::from(level) / 255.0);
    let y = 0.299 * r + 0.587 * g + 0.114 * b;
    let difference = |colour: f64, weight: f64| 128.0 + chroma * (colour - y) / (2.0 * (1.0 - weight));
    [black + luma * y, difference(b, 0.114), difference(r, 0.299)].map(|level| level.round() as u8)
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
