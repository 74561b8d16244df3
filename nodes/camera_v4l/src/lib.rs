//! Pictures from a V4L2 camera, with the time of their exposure (paper, section 3).
//!
//! In: the buffers of a driver, with its stamps and numbers. Out: [`wire::Frame`], stamped in the middle of its exposure on
//! the system clock, tagged with what lit it. What the driver was asked for is read back, and what it replaced in silence
//! is an error unless the configuration says that it may differ.
//!
//! - [`unpack`]: YUYV, GREY, RGB3, BGR3 and MJPG into what travels. A picture is copied once, out of the driver's memory
//!   ([`Exposed::copied`]), and handed to the bus as it lies there.
//! - [`middle_of_exposure`], [`ClockMap`]: the driver's monotonic stamp, at the start or the end of the exposure, on the
//!   system clock, which is compared again with every picture.
//! - [`look`], [`LightJudge`]: laser and lamp in turn are told by the picture itself.
//! - [`next_setting`], [`ExposureLoop`]: the exposure that the stripe wants.
//! - [`writes`]: what is written into a camera, in its order. [`differences`]: asked for and set. [`found`]: both in words.
//! - [`Capture`]: a thread that keeps the newest picture; a camera that is silent, broken or unplugged is named, and opened
//!   again by its name, for ever.
//!
//! With the feature `v4l` (its build needs libclang) there is the device itself: `V4lOpener`, and `inspect`, which lists
//! what a camera can do. Nothing else in the workspace names the crate v4l.
//!
//! Limits. One stamp for a whole picture: take a camera with a global shutter, or move slowly (a rolling shutter's last row
//! is some 20 ms later than its first). Exposure is set by the control of webcams, in steps of 100 us. Multi-planar drivers
//! are not understood. Laser and lamp in turn want a lamp that at least doubles the daylight, and a `gain_unit` where the
//! gain is changed: light is compared, not grey levels. In the simulator's daylight (6,840 pictures of the cow in five scans,
//! rigs `paper` and `fine`) none was taken for the other light; 0.5 % of the laser's and 7 % of the lamp's were not certain,
//! and are not used for colour. While a camera is set anew, a picture or two carry the new exposure and were made with the
//! old.
//!
//! ```
//! use camera_v4l::{CameraV4l, ClockReading, Config, DriverFormat, DriverStamp, Exposed, Layout, Setting};
//! use wire::{LaserPlane, PeaksPer, Phase};
//! let laser = LaserPlane { normal: [1.0, 0.0, 0.0], distance_m: 0.1, channel_weights: [1.0, 0.0, 0.0], peaks_per: PeaksPer::Row };
//! let mut camera = CameraV4l::new(Config::default(), laser)?;
//! let frame = camera.process(
//!     Exposed {
//!         bytes: vec![128; 640 * 480 * 2],
//!         layout: Layout { format: DriverFormat::Yuyv, full_range: false, width: 640, height: 480, stride: 1280 },
//!         // Monotonic, at the end of the exposure.
//!         stamp: DriverStamp { nanos: 8_000_000, flags: 0x2000, arrival_nanos: 9_000_000 },
//!         sequence: 7,
//!         damaged: false,
//!         setting: Setting { exposure_us: 2000.0, gain: 1.0 },
//!     },
//!     &[ClockReading { before: 9_000_000, system: 1_009_000_000, after: 9_000_000 }],
//!     Phase::Shape,
//! )?;
//! assert_eq!(frame.header.stamp_nanos, 1_007_000_000);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod camera;
mod capture;
mod clock;
mod config;
#[cfg(feature = "v4l")]
mod controls;
mod device;
mod exposure;
mod follow;
mod found;
mod granted;
mod host;
#[cfg(feature = "v4l")]
mod inspect;
mod judge;
mod look;
mod mjpeg;
#[cfg(feature = "v4l")]
mod mode;
#[cfg(feature = "node")]
pub mod node;
mod pixels;
mod sequence;
mod stamp;
mod trouble;
#[cfg(feature = "v4l")]
mod v4l_device;
mod writes;

pub use camera::{CameraV4l, Refused};
pub use capture::{Capture, Counts, News};
pub use clock::{ClockMap, ClockReading};
pub use config::{Config, ConfigError};
pub use device::{Device, Exposed, Opener};
pub use exposure::{ExposureConfig, Setting, StripeStatistics, next_setting};
pub use follow::ExposureLoop;
pub use found::{found, offers, sentence};
pub use granted::{Difference, Granted, allowance, differences, part};
pub use host::{clock_readings, monotonic_nanos};
#[cfg(feature = "v4l")]
pub use inspect::inspect;
pub use judge::LightJudge;
pub use look::{BANDS, LightConfig, Look, look};
pub use pixels::{DriverFormat, Layout, Levels, Picture, PixelError, unpack};
pub use sequence::{SequenceCount, Step};
pub use stamp::{DriverStamp, StampAt, StampError, middle_of_exposure};
pub use trouble::Trouble;
#[cfg(feature = "v4l")]
pub use v4l_device::V4lOpener;
pub use writes::{Write, automatics, writes, writes_of};
