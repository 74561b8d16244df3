//! What is listed, asked for, and refused.

use crate::bench::Bench;
use anyhow::{Context as _, ensure};
use camera_v4l::{Config, DriverFormat, Opener as _, Trouble, V4lOpener, inspect};
use devices::Size;
use std::path::{Path, PathBuf};

pub fn is_listed(bench: &Bench) -> anyhow::Result<()> {
    let listing = devices::list(Path::new("/"), inspect);
    println!("{}", listing.to_string().lines().filter(|line| !line.contains("Hz")).collect::<Vec<_>>().join("\n"));
    let [camera] = &listing.cameras[..] else { anyhow::bail!("{} cameras", listing.cameras.len()) };
    ensure!(camera.path == bench.by_id && camera.node == bench.node, "{camera:?}");
    let details = camera.details.as_ref().map_err(|reason| anyhow::anyhow!(reason.clone()))?;
    ensure!(details.driver == "vivid", "{}", details.driver);
    let mode = details.modes.iter().find(|mode| mode.format == "YUYV" && mode.size == Size::Fixed(640, 480));
    let mode = mode.context("no YUYV 640x480")?;
    ensure!(mode.rates_hz.contains(&25.0), "{:?}", mode.rates_hz);
    let brightness = details.controls.iter().find(|control| control.key == "brightness").context("no brightness")?;
    ensure!((brightness.least, brightness.most, brightness.value) == (0, 255, Some(128)), "{brightness:?}");
    let pattern = details.controls.iter().find(|control| control.key == "test_pattern").context("no test_pattern")?;
    ensure!(pattern.items.len() > 10, "{pattern:?}");
    Ok(())
}

fn refusal(config: Config) -> anyhow::Result<Trouble> {
    V4lOpener::new(config).open().err().context("it was opened")
}

pub fn substitutes_are_refused(bench: &Bench) -> anyhow::Result<()> {
    let good = bench.config(DriverFormat::Yuyv);
    let odd = Config { format: DriverFormat::Mjpg, width: 641, height: 479, rate_hz: 120.0, ..good.clone() };
    let text = refusal(odd)?.to_string();
    println!("    {text}");
    for part in ["MJPG was asked for, the driver has set YUYV", "641x479", "640x480", "120 Hz", "may_differ"] {
        ensure!(text.contains(part), "{part} is missing");
    }
    for (controls, part) in [
        ([("brightness", 300)], "brightness: 300 was asked for, the driver has set 255"),
        ([("no_such_thing", 1)], "no such setting"),
    ] {
        let controls = controls.map(|(name, value)| (name.to_owned(), value)).into();
        let text = refusal(Config { controls, ..good.clone() })?.to_string();
        ensure!(text.contains(part), "{text}");
    }
    // vivid has no exposure; that is refused as well, unless it may differ.
    let exposed = Config { exposure_us: Some(2000.0), ..good.clone() };
    ensure!(refusal(exposed.clone())?.to_string().contains("exposure"));
    let camera = V4lOpener::new(Config { may_differ: vec!["exposure".to_owned()], ..exposed }).open()?;
    println!("    {}", camera.found());
    drop(camera);
    let controls = [("brightness".to_owned(), 128)].into();
    V4lOpener::new(Config { controls, gain: Some(40), ..good }).open()?;
    Ok(())
}

pub fn what_is_no_camera(_: &Bench) -> anyhow::Result<()> {
    for (device, wanted) in [("/dev/null", "is no camera"), ("/dev/video7", "there is no"), ("/dev", "/dev")] {
        let text = refusal(Config { device: PathBuf::from(device), ..Config::default() })?.to_string();
        println!("    {text}");
        ensure!(text.contains(wanted), "{text}");
    }
    Ok(())
}

pub fn is_busy(bench: &Bench) -> anyhow::Result<()> {
    let config = bench.config(DriverFormat::Yuyv);
    let stream = bench.stream(config.clone());
    stream.next()?;
    let trouble = refusal(config)?;
    ensure!(matches!(trouble, Trouble::Busy { .. }), "{trouble}");
    ensure!(inspect(&bench.node).is_some_and(|details| details.is_ok()), "a busy camera can be listed");
    Ok(())
}
