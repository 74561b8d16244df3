//! What a camera of 1280x1024 at 60 pictures a second costs: the real node, with a stand-in for the driver's memory behind
//! the seam that the real driver stands behind, in a process of its own; a real bus; a reader in another process.
//!
//! A figure, and no bound on time: `cargo test --workspace --test camera`. This program is both: with `node` among its words
//! it is the camera's process, as the launch file starts it.

use anyhow::{Context as _, ensure};
use camera_v4l::{Device, DriverFormat, DriverStamp, Exposed, Layout, Opener, Setting, Trouble, monotonic_nanos};
use image::ImageEncoder as _;
use std::path::Path;
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};
use system_tests::rig::{Rig, wait_on};
use system_tests::{limn, repository};
use wire::topic;

const WIDTH: u32 = 1280;
const HEIGHT: u32 = 1024;
const RATE_HZ: u32 = 60;
const PERIOD_NANOS: i64 = 1_000_000_000 / RATE_HZ as i64;
/// As many as the node asks a driver for.
const BUFFERS: usize = 4;
/// So many pictures wait for a reader that others keep from the processor: more than a second's.
const WAITING: usize = 80;
const EXPOSED_US: f64 = 1000.0;
/// Before it is measured, everybody has woken up.
const WARM_UP: usize = 2 * RATE_HZ as usize;
const MEASURED: usize = 10 * RATE_HZ as usize;

fn main() -> anyhow::Result<()> {
    if std::env::args().any(|word| word == "node") {
        let node = kit::Node::open(kit::NodeSpec::from_stdin()?)?;
        return camera_v4l::node::run_with(node, |config| Memory { format: config.format });
    }
    for format in [DriverFormat::Yuyv, DriverFormat::Grey, DriverFormat::Mjpg] {
        measure(format)?;
    }
    Ok(())
}

/// Stands for the driver: buffers that it has filled by itself, without this processor, one after the other.
struct Memory {
    format: DriverFormat,
}

struct Filled {
    buffers: Vec<Vec<u8>>,
    layout: Layout,
    sequence: u32,
    began_nanos: i64,
}

impl Opener for Memory {
    fn open(&mut self) -> Result<Box<dyn Device>, Trouble> {
        let stride = self.format.least_stride(WIDTH).unwrap_or_default() as u32;
        let layout = Layout { format: self.format, full_range: false, width: WIDTH, height: HEIGHT, stride };
        let buffers = (0..BUFFERS).map(|number| picture(self.format, number)).collect();
        Ok(Box::new(Filled { buffers, layout, sequence: 0, began_nanos: monotonic_nanos() }))
    }

    fn silence(&self) -> (Duration, Trouble) {
        (Duration::from_secs(5), Trouble::Silent { device: "memory".into(), seconds: 5 })
    }
}

impl Device for Filled {
    fn found(&self) -> String {
        format!("memory as {}", self.layout.format)
    }

    fn expose(&mut self, wait: Duration) -> Result<Option<Exposed<&[u8]>>, Trouble> {
        let due_nanos = self.began_nanos + i64::from(self.sequence + 1) * PERIOD_NANOS;
        let left = Duration::from_nanos((due_nanos - monotonic_nanos()).max(0) as u64);
        std::thread::sleep(left.min(wait));
        if left > wait {
            return Ok(None);
        }
        self.sequence += 1;
        Ok(Some(Exposed {
            bytes: &self.buffers[self.sequence as usize % BUFFERS],
            layout: self.layout,
            // Monotonic, at the end of the exposure.
            stamp: DriverStamp { nanos: due_nanos, flags: 0x2000, arrival_nanos: monotonic_nanos() },
            sequence: self.sequence,
            damaged: false,
            setting: Setting { exposure_us: EXPOSED_US, gain: 1.0 },
        }))
    }

    fn set(&mut self, setting: Setting) -> Result<Setting, Trouble> {
        Ok(setting)
    }
}

/// A bright line over a faint texture, as a scan shows it.
fn picture(format: DriverFormat, number: usize) -> Vec<u8> {
    let level = |u: usize, v: usize| {
        let off = u as f64 - 500.0 - 60.0 * ((v + 40 * number) as f64 / 150.0).sin();
        (25.0 + 10.0 * (u as f64 / 31.0).sin() * (v as f64 / 23.0).cos() + 200.0 * (-off * off / 4.5).exp()) as u8
    };
    let pixels = (0..HEIGHT as usize).flat_map(|v| (0..WIDTH as usize).map(move |u| level(u, v)));
    match format {
        DriverFormat::Grey => pixels.collect(),
        DriverFormat::Yuyv => pixels.flat_map(|level| [level, 128]).collect(),
        DriverFormat::Rgb3 | DriverFormat::Bgr3 => pixels.flat_map(|level| [level; 3]).collect(),
        DriverFormat::Mjpg => {
            let (rgb, mut jpeg): (Vec<u8>, _) = (pixels.flat_map(|level| [level; 3]).collect(), Vec::new());
            let encoder = image::codecs::jpeg::JpegEncoder::new_with_quality(&mut jpeg, 85);
            // A picture that could not be made is refused by the node, and so seen.
            let _ = encoder.write_image(&rgb, WIDTH, HEIGHT, image::ExtendedColorType::Rgb8);
            jpeg
        }
    }
}

/// A rig of a camera alone, read here.
fn measure(format: DriverFormat) -> anyhow::Result<()> {
    let folder = tempfile::tempdir()?;
    let launch = folder.path().join("camera.toml");
    std::fs::write(&launch, launch_file(format)?)?;
    let mut rig = Rig::start(limn().arg("up").arg(&launch));
    let bus = rig.bus();
    let mut frames = bus.subscribe(&topic::frame("head"), WAITING)?;
    let (mut seen, mut began, mut delays_ms) = (0, None, Vec::new());
    let processes = |rig: &Rig| -> anyhow::Result<[f64; 3]> {
        let camera = rig.node("camera_v4l").with_context(|| format!("no camera runs:\n{}", rig.said()))?;
        Ok([seconds_of(camera)?, seconds_of(rig.pid())?, seconds_of(std::process::id())?])
    };
    wait_on(&bus, "too few pictures", || {
        while let Some(frame) = frames.next() {
            let now = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_nanos() as i64);
            // From the end of the exposure, when the driver has the picture.
            delays_ms.push((now - frame.header.stamp_nanos) as f64 * 1e-6 - EXPOSED_US * 0.5e-3);
            assert_eq!((frame.width, frame.height, frame.check()), (WIDTH, HEIGHT, Ok(())));
            seen += 1;
            if seen == WARM_UP {
                began = Some((Instant::now(), processes(&rig)));
                delays_ms.clear();
            }
        }
        (seen >= WARM_UP + MEASURED).then_some(())
    });
    let (began, before) = began.context("nothing was seen")?;
    let (elapsed, after, before) = (began.elapsed().as_secs_f64(), processes(&rig)?, before?);
    let count = delays_ms.len();
    delays_ms.sort_by(f64::total_cmp);
    let share = |process: usize| 100.0 * (after[process] - before[process]) / elapsed;
    println!(
        "{WIDTH}x{HEIGHT} {format}: {:.1} pictures/s; of one core the camera's process takes {:.0} %, the router's {:.0} %, \
         the reader's {:.0} %; from driver to reader {:.1} ms median, {:.1} ms 99 %; {} lost",
        count as f64 / elapsed,
        share(0),
        share(1),
        share(2),
        delays_ms[count / 2],
        delays_ms[count * 99 / 100],
        frames.counts().lost
    );
    let said = rig.said();
    ensure!(!said.contains("is refused"), "{said}");
    ensure!(frames.counts().lost == 0, "{} pictures were lost on the bus", frames.counts().lost);
    Ok(())
}

fn launch_file(format: DriverFormat) -> anyhow::Result<String> {
    Ok(format!(
        "[run]\nbegin = 'shape'\n[rig]\nfile = {:?}\n[nodes.camera]\nkind = 'camera_v4l'\ninstance = 'head'\nexec = {:?}\n\
         [nodes.camera.config]\nformat = '{format}'\nwidth = {WIDTH}\nheight = {HEIGHT}\nrate_hz = {RATE_HZ}\ngamma = 1.0\n",
        repository("config/rigs/fine.toml"),
        std::env::current_exe()?
    ))
}

/// Processor time of a process and all its threads so far: fields 14 and 15 of /proc/PID/stat (proc(5)), in hundredths.
fn seconds_of(pid: u32) -> anyhow::Result<f64> {
    let stat = std::fs::read_to_string(Path::new("/proc").join(pid.to_string()).join("stat"))?;
    let behind_name = stat.rsplit_once(") ").context("no name")?.1;
    let times: Vec<u64> = behind_name.split(' ').skip(11).take(2).map(str::parse).collect::<Result<_, _>>()?;
    Ok(times.iter().sum::<u64>() as f64 / 100.0)
}
