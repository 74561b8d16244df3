//! The machine with its one camera.

use anyhow::{Context as _, bail, ensure};
use camera_v4l::{Capture, Config, DriverFormat, Exposed, News, V4lOpener};
use std::path::PathBuf;
use std::process::Command;
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

/// Under emulation everything takes its time.
const LONG: Duration = Duration::from_secs(20);

/// Names by which the camera is known.
pub struct Bench {
    /// As udev would make it; there is no udev here.
    pub by_id: PathBuf,
    /// Where it leads.
    pub node: PathBuf,
}

impl Bench {
    pub fn new() -> anyhow::Result<Self> {
        let (by_id, node) = (PathBuf::from("/dev/v4l/by-id/platform-vivid-000"), PathBuf::from("/dev/video0"));
        let bench = Self { by_id, node };
        std::fs::create_dir_all("/dev/v4l/by-id")?;
        bench.link()?;
        bench.turn("osd_text_mode", 2)?;
        bench.turn("test_pattern", 0)?;
        Ok(bench)
    }

    /// Makes the name that lasts.
    pub fn link(&self) -> anyhow::Result<()> {
        Ok(std::os::unix::fs::symlink("../../video0", &self.by_id)?)
    }

    /// Turns a knob of the driver with another program.
    pub fn turn(&self, knob: &str, value: i64) -> anyhow::Result<()> {
        let setting = format!("{knob}={value}");
        let output = Command::new("v4l2-ctl").args(["-d", "/dev/video0", "-c", &setting]).output();
        let output = output.context("starting v4l2-ctl")?;
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        ensure!(output.status.success() && text.is_empty(), "v4l2-ctl {setting}: {text}");
        Ok(())
    }

    /// How a knob stands, by another program.
    pub fn read(&self, knob: &str) -> anyhow::Result<i64> {
        let output = Command::new("v4l2-ctl").args(["-d", "/dev/video0", "-C", knob]).output();
        let text = String::from_utf8(output.context("starting v4l2-ctl")?.stdout)?;
        let value = text.rsplit(':').next().map(str::trim).and_then(|value| value.parse().ok());
        value.with_context(|| format!("v4l2-ctl -C {knob}: {text:?}"))
    }

    /// A configuration that vivid can fulfil.
    pub fn config(&self, format: DriverFormat) -> Config {
        Config { device: self.by_id.clone(), format, rate_hz: 25.0, exposure_us: None, ..Config::default() }
    }

    pub fn stream(&self, config: Config) -> Stream {
        let (say, news) = channel();
        let capture = Capture::start(V4lOpener::new(config), move |n| {
            println!("    {n:?}");
            drop(say.send(n));
        });
        Stream { capture, news }
    }
}

/// A running capture.
pub struct Stream {
    pub capture: Capture,
    news: Receiver<News>,
}

impl Stream {
    pub fn next(&self) -> anyhow::Result<Exposed> {
        self.capture.next(LONG).context("no picture came")
    }

    /// Waits for a piece of news.
    pub fn hears(&self, what: &str, is_it: impl Fn(&News) -> bool) -> anyhow::Result<News> {
        let started = Instant::now();
        while started.elapsed() < LONG {
            match self.news.recv_timeout(Duration::from_millis(100)) {
                Ok(news) if is_it(&news) => return Ok(news),
                _ => {}
            }
        }
        bail!("{what} was not heard")
    }

    pub fn until(&self, what: &str, reached: impl Fn(&camera_v4l::Counts) -> bool) -> anyhow::Result<()> {
        let started = Instant::now();
        while !reached(&self.capture.counts()) {
            ensure!(started.elapsed() < LONG, "{what}: {:?}", self.capture.counts());
            std::thread::sleep(Duration::from_millis(10));
        }
        Ok(())
    }
}
