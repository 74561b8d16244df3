//! Poses from a Polhemus Fastrak, Liberty or Patriot on a serial port.
//!
//! In: bytes of the tracker, with the moments at which they arrived. Out: [`wire::Pose`], world_from_body = source from
//! sensor, in the source's frame (z down when it hangs as the maker draws it); metres; with its stamp, sigma, and a reason
//! when the quality is not good. Each station gives a pose of its own.
//!
//! - [`protocol`]: binary records by output list, to values and back.
//! - [`PolhemusTracker`]: records to poses. Liberty and Patriot send the time of their own clock, which is mapped to ours
//!   (`serial_line::DeviceClock`); the Fastrak has none, so the arrivals are freed of their jitter
//!   (`serial_line::RateLock`). Then wire time and the device's latency are taken off.
//! - `port` (feature `serial`): opens, sets up and listens; whatever goes wrong is a sentence with what to do.
//! - [`emulator`]: the three devices, played byte for byte.
//!
//! Limits. Over RS-232 only, which the devices speak beside USB. Time stamps are whole milliseconds; they count the even
//! frames, which are known better. A Liberty with three stations or more loses frames on a line of 115200 baud. The level of distortion has the device's own scale.
//!
//! ```
//! use tracker_polhemus::protocol::{decoder::Decoder, records::{Family, Layout, Record, encode}};
//! use serial_line::PoseTracker as _;
//! use tracker_polhemus::{Config, PolhemusTracker};
//! let layout = Layout::of(Family::Liberty);
//! let record = Record { position_inches: [12.0, -6.0, 3.0], time_stamp_ms: 40, ..Record::default() };
//! let bytes = encode(&record, &layout);
//! let mut decoder = Decoder::new(layout);
//! let record = bytes.iter().find_map(|&byte| decoder.push(byte)).ok_or("no record")?;
//! let mut tracker = PolhemusTracker::new(Config::default())?;
//! let pose = tracker.process(&record, 1_000_000_000, 0).ok_or("another station's")?.pose;
//! assert!((pose.world_from_body.translation_m[0] - 0.3048).abs() < 1e-6);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod config;
pub mod emulator;
#[cfg(feature = "node")]
pub mod node;
#[cfg(feature = "serial")]
pub mod port;
pub mod protocol;
mod tracker;

pub use config::{Config, DataSheet};
pub use serial_line::ConfigError;
pub use tracker::PolhemusTracker;
