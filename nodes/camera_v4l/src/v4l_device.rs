//! The camera itself. What the crate v4l does on its own account, and what is done here because of it, was seen on a real
//! driver: see `tests/vivid`.

use crate::config::Config;
use crate::controls::{self, Controls};
use crate::device::{Device, Exposed, Opener};
use crate::exposure::Setting;
use crate::found::{found, offers, sentence};
use crate::granted::{Difference, Granted, SIZE, allowance, differences, part};
use crate::host::monotonic_nanos;
use crate::inspect::modes;
use crate::mode::{read_back, set_mode};
use crate::pixels::{DriverFormat, Layout};
use crate::stamp::DriverStamp;
use crate::trouble::Trouble;
use std::io;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::time::Duration;
use v4l::buffer::{Flags, Type};
use v4l::capability::Flags as Ability;
use v4l::io::mmap::Stream;
use v4l::io::traits::{CaptureStream as _, Stream as _};

/// Something can be read.
const POLLIN: i16 = 0x001;
const ENODEV: i32 = 19;
/// So many pictures that do not come are no chance.
const SILENT_PICTURES: f64 = 8.0;
const LEAST_SILENCE_S: f64 = 1.0;

/// Opens a V4L2 camera as it is configured.
#[derive(Debug, Clone)]
pub struct V4lOpener {
    config: Config,
}

impl V4lOpener {
    /// For a configuration that was checked.
    pub fn new(config: Config) -> Self {
        Self { config }
    }

    fn camera(&self) -> Result<V4lCamera, Trouble> {
        let config = &self.config;
        let device = open(&config.device)?;
        set_mode(config, &device)?;
        let controls = Controls::of(&device);
        let refused = controls.apply(config, &device);
        let granted = Granted { refused, ..read_back(config, &device, &controls)? };
        let (allowed, refused) = part(config, differences(config, &granted));
        if !refused.is_empty() {
            let is_mode = |difference: &Difference| ["format", SIZE, "rate"].contains(&difference.name.as_str());
            let mode = refused.iter().any(is_mode);
            let offers = if mode { offers(&modes(&device), config.format.fourcc()) } else { String::new() };
            let (what, allow) = (sentence(&refused) + &offers, allowance(&refused));
            return Err(Trouble::Differs { device: config.device.clone(), what, allow });
        }
        let format = DriverFormat::of_fourcc(granted.fourcc).ok_or_else(|| Trouble::Format {
            device: config.device.clone(),
            fourcc: String::from_utf8_lossy(&granted.fourcc).into_owned(),
        })?;
        // Some drivers leave the stride to the reader.
        let tight = format.least_stride(granted.width).unwrap_or_default() as u32;
        let stride = if granted.stride == 0 { tight } else { granted.stride };
        let full_range = config.levels.are_full(granted.full_range);
        let layout = Layout { format, full_range, width: granted.width, height: granted.height, stride };
        let stream = guarded(config, "asking for buffers", || {
            Stream::with_buffers(&device, Type::VideoCapture, config.buffers)
        })?;
        let setting = controls::setting(config, &granted);
        Ok(V4lCamera {
            found: found(config, &layout, &granted, &allowed),
            config: config.clone(),
            stream: Some(stream),
            started: false,
            index_lost: false,
            device,
            layout,
            setting,
        })
    }
}

impl Opener for V4lOpener {
    fn open(&mut self) -> Result<Box<dyn Device>, Trouble> {
        Ok(Box::new(self.camera()?))
    }

    fn silence(&self) -> (Duration, Trouble) {
        let seconds = (SILENT_PICTURES / self.config.rate_hz).max(LEAST_SILENCE_S);
        let trouble = Trouble::Silent { device: self.config.device.clone(), seconds: seconds.round() as u32 };
        (Duration::from_secs_f64(seconds), trouble)
    }
}

/// Opens what is a camera.
pub(crate) fn open(path: &Path) -> Result<v4l::Device, Trouble> {
    let no_camera = |reason: &str| Trouble::NoCamera { device: path.to_owned(), reason: reason.to_owned() };
    if path.as_os_str().as_encoded_bytes().contains(&0) {
        return Err(no_camera("a name has no zero byte"));
    }
    let device = v4l::Device::with_path(path).map_err(|error| Trouble::opening(path, "opening", &error))?;
    let caps = calmly(|| device.query_caps()).map_err(|error| Trouble::opening(path, "asking what it is", &error))?;
    if !caps.capabilities.contains(Ability::VIDEO_CAPTURE) {
        return Err(no_camera("it takes no pictures, or only in several planes"));
    }
    if !caps.capabilities.contains(Ability::STREAMING) {
        return Err(no_camera("it does not stream"));
    }
    Ok(device)
}

/// The crate panics on what a newer kernel, or a careless driver, says. That is no reason to die.
pub(crate) fn calmly<T>(ask: impl FnOnce() -> io::Result<T>) -> io::Result<T> {
    let says = "the driver says what the library v4l does not understand";
    catch_unwind(AssertUnwindSafe(ask)).unwrap_or_else(|_| Err(io::Error::other(says)))
}

pub(crate) fn guarded<T>(
    config: &Config,
    doing: &'static str,
    ask: impl FnOnce() -> io::Result<T>,
) -> Result<T, Trouble> {
    calmly(ask).map_err(|error| Trouble::opening(&config.device, doing, &error))
}

struct V4lCamera {
    config: Config,
    device: v4l::Device,
    stream: Option<Stream<'static>>,
    layout: Layout,
    setting: Setting,
    found: String,
    /// The first picture starts the stream.
    started: bool,
    /// The stream does not know which buffer it holds.
    index_lost: bool,
}

impl V4lCamera {
    fn fetch(&mut self, wait: Duration) -> io::Result<Option<Exposed<&[u8]>>> {
        let Self { stream, started, index_lost, layout, setting, .. } = self;
        let Some(stream) = stream else { return Ok(None) };
        // Asked before `next`, which hands a buffer back first: when it then fails, it has none to hand back.
        let millis = i32::try_from(wait.as_millis()).unwrap_or(i32::MAX);
        if *started && stream.handle().poll(POLLIN, millis)? == 0 {
            return Ok(None);
        }
        if *index_lost {
            // Its pixels cannot be had, but the next ones can.
            stream.dequeue()?;
            *index_lost = false;
            return Ok(None);
        }
        if !*started {
            *started = true;
            stream.set_timeout(wait);
        }
        *index_lost = true;
        let (buffer, meta) = stream.next()?;
        *index_lost = false;
        let nanos = meta.timestamp.sec * 1_000_000_000 + meta.timestamp.usec * 1000;
        Ok(Some(Exposed {
            bytes: buffer.get(..meta.bytesused as usize).unwrap_or(buffer),
            layout: *layout,
            stamp: DriverStamp { nanos, flags: u32::from(meta.flags), arrival_nanos: monotonic_nanos() },
            sequence: meta.sequence,
            damaged: meta.flags.contains(Flags::ERROR),
            setting: *setting,
        }))
    }
}

impl Device for V4lCamera {
    fn found(&self) -> String {
        self.found.clone()
    }

    fn expose(&mut self, wait: Duration) -> Result<Option<Exposed<&[u8]>>, Trouble> {
        use io::ErrorKind::{Interrupted, TimedOut, WouldBlock};
        let path = self.config.device.clone();
        match calmly(|| self.fetch(wait)) {
            Err(error) if matches!(error.kind(), Interrupted | TimedOut | WouldBlock) => Ok(None),
            fetched => fetched.map_err(|error| Trouble::streaming(&path, &error)),
        }
    }

    fn set(&mut self, setting: Setting) -> Result<Setting, Trouble> {
        self.setting = controls::set(&self.config, &self.device, setting, self.setting)?;
        Ok(self.setting)
    }
}

impl Drop for V4lCamera {
    fn drop(&mut self) {
        let Some(mut stream) = self.stream.take() else { return };
        // The crate stops the stream when it is dropped, and panics when that fails: a panic within a panic would end
        // the process, so a stream that cannot be stopped is given up with its memory.
        match stream.stop() {
            Err(error) if error.raw_os_error() != Some(ENODEV) => std::mem::forget(stream),
            _ => {
                let _ = calmly(move || {
                    drop(stream);
                    Ok(())
                });
            }
        }
    }
}
