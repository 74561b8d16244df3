//! Poses from an Ascension Flock of Birds on a serial port.
//!
//! In: bytes of the flock, with the moments at which they arrived. Out: [`wire::Pose`], world_from_body = transmitter from
//! sensor: x away from the transmitter's cable, y to the right, z down; metres; with the stamp of the position, how much
//! older the orientation is, sigma, and a reason when the quality is not good. Several sensors answer in group mode and
//! give a pose each.
//!
//! - [`protocol`]: bytes to values and back, for every format, with and without metal, button and group address.
//! - [`FlockTracker`]: records to poses. The bird has no clock: the arrival is freed of its jitter
//!   (`serial_line::RateLock`), then wire time and the bird's own latency are taken off.
//! - `port` (feature `serial`): opens, resets, configures and examines the flock, settles which way its quaternions turn,
//!   and listens; whatever goes wrong is a sentence with what to do.
//! - [`emulator`]: the flock, played byte for byte.
//!
//! Limits. All sensors send the same format. The adaptive filter's lag in motion depends on the motion and is not undone.
//! The field is bent by metal; sigma is the data sheet's, with the fourth power of the distance beyond it and with the
//! measure of metal, when that is asked for.
//!
//! ```
//! use tracker_flock::protocol::{decoder::Decoder, records::{Format, Layout}};
//! use serial_line::PoseTracker as _;
//! use tracker_flock::{Config, FlockTracker, Heard};
//! let config = Config { output: Format::PositionAngles, ..Config::default() };
//! let mut tracker = FlockTracker::new(config)?;
//! let layout = Layout::plain(Format::PositionAngles);
//! let mut decoder = Decoder::new(layout);
//! // 12, -6, 3 inches; azimuth 30, elevation -10, roll 90 degrees.
//! let bytes = [0xAA, 0x15, 0x2A, 0x75, 0x2A, 0x05, 0x55, 0x0A, 0x39, 0x7C, 0x00, 0x20];
//! let record = bytes.iter().find_map(|&byte| decoder.push(byte)).ok_or("no record")?;
//! let sense = Default::default(); // which way quaternions turn: there is none in this format
//! let arrival_nanos = 1_000_000_000;
//! let pose = tracker.process(&Heard { record, layout, sense }, arrival_nanos, 0).ok_or("another unit's")?.pose;
//! assert!((pose.world_from_body.translation_m[0] - 12.0 * 0.0254).abs() < 2e-4);
//! assert!(pose.header.stamp_nanos < arrival_nanos - 8_000_000, "wire time and latency are taken off");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod config;
pub mod emulator;
mod hemisphere;
#[cfg(feature = "node")]
pub mod node;
#[cfg(feature = "serial")]
pub mod port;
pub mod protocol;
mod tracker;

pub use config::Config;
pub use hemisphere::Hemisphere;
pub use serial_line::ConfigError;
pub use tracker::{FlockTracker, Heard};
