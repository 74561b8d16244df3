//! When a picture was exposed, from what the driver says of it.

use serde::{Deserialize, Serialize};

/// V4L2_BUF_FLAG_TIMESTAMP_MASK and V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC.
const CLOCK_MASK: u32 = 0xE000;
const MONOTONIC: u32 = 0x2000;
/// V4L2_BUF_FLAG_TSTAMP_SRC_MASK and V4L2_BUF_FLAG_TSTAMP_SRC_SOE.
const SOURCE_MASK: u32 = 0x7_0000;
const START_OF_EXPOSURE: u32 = 0x1_0000;

/// What a driver's stamp tells.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum StampAt {
    /// What its flag says: the start of the exposure, or else its end.
    #[default]
    Driver,
    /// The start of the exposure, whatever the flag says.
    Start,
    /// The end of the exposure, whatever the flag says. Webcams (uvcvideo) flag the start, but stamp the first bytes that
    /// come, which is behind the end: take this, and `stamp_delay_us`.
    End,
    /// The stamp is of no use: the moment when the picture came is taken for the end.
    Arrival,
}

/// What came with a picture; monotonic clock, nanoseconds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct DriverStamp {
    /// The driver's.
    pub nanos: i64,
    /// The driver's flags of the buffer.
    pub flags: u32,
    /// When the picture was fetched.
    pub arrival_nanos: i64,
}

/// A stamp that tells nothing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error(
    "the driver does not stamp by the monotonic clock (flags {0:#x}): set stamp_at = \"arrival\", and expect stamps that jitter by milliseconds"
)]
pub struct StampError(pub u32);

/// The middle of the exposure on the monotonic clock. `delay_nanos` is how much later than what it tells the stamp is.
///
/// # Errors
/// A stamp by another clock than the monotonic one.
///
/// ```
/// use camera_v4l::{DriverStamp, StampAt, middle_of_exposure};
/// let stamp = DriverStamp { nanos: 50_000_000, flags: 0x2000, arrival_nanos: 52_000_000 };
/// assert_eq!(middle_of_exposure(stamp, 4_000_000, StampAt::Driver, 0), Ok(48_000_000)); // end of exposure
/// let stamp = DriverStamp { flags: 0x1_2000, ..stamp };
/// assert_eq!(middle_of_exposure(stamp, 4_000_000, StampAt::Driver, 0), Ok(52_000_000)); // start of exposure
/// ```
pub fn middle_of_exposure(
    stamp: DriverStamp,
    exposure_nanos: i64,
    at: StampAt,
    delay_nanos: i64,
) -> Result<i64, StampError> {
    let half = exposure_nanos / 2;
    if at == StampAt::Arrival {
        return Ok(stamp.arrival_nanos - half - delay_nanos);
    }
    if stamp.flags & CLOCK_MASK != MONOTONIC {
        return Err(StampError(stamp.flags));
    }
    let start = match at {
        StampAt::Start => true,
        StampAt::End | StampAt::Arrival => false,
        StampAt::Driver => stamp.flags & SOURCE_MASK == START_OF_EXPOSURE,
    };
    Ok(stamp.nanos + if start { half } else { -half } - delay_nanos)
}
