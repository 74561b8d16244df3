//! The wiring: pictures as the camera takes them.

use crate::{CameraV4l, Capture, Config, Counts, ExposureLoop, News, Opener, clock_readings};
use anyhow::ensure;
use kit::{Go, Input, Node, Pictures};
use std::time::Duration;
use wire::{Bulk, CameraIntrinsics, Clock, Frame, Header, Light, Phase, PixelFormat, Stripe, topic};

/// How long a picture is waited for before the operator is listened to.
const NAP: Duration = Duration::from_millis(20);

/// Sends the pictures of one scan after the other until it is told to stop.
#[cfg(feature = "v4l")]
pub fn run(node: Node) -> anyhow::Result<()> {
    run_with(node, crate::V4lOpener::new)
}

/// Says that there is no code for cameras.
#[cfg(not(feature = "v4l"))]
pub fn run(_: Node) -> anyhow::Result<()> {
    anyhow::bail!("this limn was built without cameras: `cargo build --release --features v4l` (needs libclang)")
}

/// The same with any camera: for tests.
pub fn run_with<O: Opener>(mut node: Node, opener: impl FnOnce(Config) -> O) -> anyhow::Result<()> {
    let config: Config = node.spec().config()?;
    config.check()?;
    let camera = node.instance().to_owned();
    let mut pictures = node.pictures(&camera)?;
    let stripe = node.spec().source_of("stripe").to_owned();
    let stripes = node.glimpse(&topic::stripe(&stripe))?;
    let rig = node.spec().source_of("rig").to_owned();
    let calibration = node.calibration(&rig)?;
    check_size(&config, &calibration.camera)?;
    let mut source = Source {
        follow: ExposureLoop::new(config.exposure, config.gamma, config.rate_hz),
        science: CameraV4l::new(config.clone(), calibration.laser)?,
        capture: Capture::start(opener(config), tell),
        stripes,
        told: Counts::default(),
    };
    if !node.wait_for_device(|| source.capture.counts().pictures > 0) {
        return node.close();
    }
    node.ready()?;
    let mut scanned = None;
    while let Some(go) = node.wait_for_go(scanned)? {
        scanned = Some(go.scan);
        source.scan(&mut node, &go, &mut pictures)?;
    }
    node.close()
}

struct Source {
    capture: Capture,
    science: CameraV4l,
    follow: ExposureLoop,
    stripes: Input<Stripe>,
    told: Counts,
}

impl Source {
    fn scan(&mut self, node: &mut Node, go: &Go, pictures: &mut Pictures) -> anyhow::Result<()> {
        // What the thread held before the go, and lost before it, is no part of the scan.
        self.capture.next(Duration::ZERO);
        self.told = self.capture.counts();
        let mut last = go.epoch_nanos;
        // The camera itself paces this source: its turn has always come.
        while node.wait_for_turn(go, -go.epoch_nanos) {
            let exposed = self.capture.next(NAP);
            self.account(node);
            let Some(exposed) = exposed else { continue };
            if let Some(stripe) = self.stripes.newest()
                && let Some(setting) = self.follow.see(&stripe, exposed.setting)
            {
                self.capture.set(setting);
            }
            let phase = node.phase().map_or(go.phase, |run| run.header.phase);
            match self.science.process(exposed, &clock_readings(), phase) {
                Ok(mut frame) => {
                    frame.header.scan = go.scan;
                    if phase == Phase::Both && !(frame.light.laser || frame.light.lamp) {
                        node.refuse("picture that shows neither light for certain", 1);
                    }
                    let header = frame.header;
                    last = last.max(header.stamp_nanos);
                    pictures.send(frame)?;
                    node.finished(&header)?;
                }
                Err(refused) => {
                    tracing::warn!("a picture is refused: {refused}");
                    node.refuse("picture that cannot be read", 1);
                }
            }
        }
        let end = Header {
            scan: go.scan,
            phase: Phase::End,
            stamp_nanos: last + 1,
            clock: Clock::System,
            ..Header::default()
        };
        pictures.send(blank(end))?;
        node.finished(&end)
    }

    /// Tells what was lost since it was told last.
    fn account(&mut self, node: &mut Node) {
        let (now, told) = (self.capture.counts(), self.told);
        self.told = now;
        for (reason, count) in [
            ("picture that the driver lost", now.lost - told.lost),
            ("picture that the driver marks as damaged", now.damaged - told.damaged),
            ("picture that came while the one before was still worked on", now.skipped - told.skipped),
        ] {
            if count > 0 {
                tracing::error!("{count} x {reason}");
                node.refuse(reason, count);
            }
        }
        if now.repeated > told.repeated {
            tracing::warn!("{} pictures came under the number of the one before", now.repeated - told.repeated);
        }
    }
}

fn check_size(config: &Config, camera: &CameraIntrinsics) -> anyhow::Result<()> {
    let (width, height) = (config.width, config.height);
    ensure!(
        (width, height) == (camera.width, camera.height),
        "the rig was calibrated at {}x{}, the camera is set to {width}x{height}: set width and height to the rig's, or \
         calibrate at this size",
        camera.width,
        camera.height
    );
    Ok(())
}

fn tell(news: News) {
    match news {
        News::Streaming(found) => tracing::info!("{found}"),
        News::Trouble(trouble) => tracing::error!("{trouble}"),
    }
}

/// A frame without pixels, as goes behind the last.
fn blank(header: Header) -> Frame {
    Frame {
        header,
        width: 0,
        height: 0,
        stride: 0,
        format: PixelFormat::Grey8,
        light: Light { laser: false, lamp: false },
        exposure_nanos: 0,
        gain: 1.0,
        gamma: 1.0,
        data: Bulk::default(),
    }
}
