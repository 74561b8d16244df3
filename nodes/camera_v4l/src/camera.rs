//! A picture of the driver in, a frame out.

use crate::clock::{ClockMap, ClockReading};
use crate::config::{Config, ConfigError};
use crate::device::Exposed;
use crate::judge::LightJudge;
use crate::look::look;
use crate::pixels::{PixelError, unpack};
use crate::stamp::{StampError, middle_of_exposure};
use wire::{Clock, Frame, FrameError, Header, LaserPlane, Light, Phase};

/// Makes frames of what the driver gives: pixels, stamp, and what lit them.
#[derive(Debug, Clone)]
pub struct CameraV4l {
    config: Config,
    laser: LaserPlane,
    clock: ClockMap,
    judge: LightJudge,
}

/// Why a picture is no frame.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Refused {
    /// Its pixels.
    #[error(transparent)]
    Pixels(#[from] PixelError),
    /// Its stamp.
    #[error(transparent)]
    Stamp(#[from] StampError),
    /// Its size.
    #[error(transparent)]
    Frame(#[from] FrameError),
    /// Nobody has read the clocks.
    #[error("no reading of the clocks has come yet")]
    Clock,
}

impl CameraV4l {
    /// Of the laser only its channel weights and the direction of its stripe are used.
    ///
    /// # Errors
    /// A configuration outside its ranges.
    pub fn new(config: Config, laser: LaserPlane) -> Result<Self, ConfigError> {
        config.check()?;
        Ok(Self { config, laser, clock: ClockMap::default(), judge: LightJudge::default() })
    }

    /// The frame of a picture, on the system clock. `readings` of the clocks are of just now; `phase` is what the operator
    /// is doing.
    ///
    /// # Errors
    /// Bytes that are no picture, or a stamp that tells nothing.
    pub fn process(&mut self, exposed: Exposed, readings: &[ClockReading], phase: Phase) -> Result<Frame, Refused> {
        self.clock.update(readings);
        let setting = exposed.setting;
        let exposure_nanos = (setting.exposure_us * 1e3) as i64;
        let delay_nanos = (self.config.stamp_delay_us * 1e3) as i64;
        let middle = middle_of_exposure(exposed.stamp, exposure_nanos, self.config.stamp_at, delay_nanos)?;
        let stamp_nanos = self.clock.system_nanos(middle).ok_or(Refused::Clock)?;
        let (width, height) = (exposed.layout.width, exposed.layout.height);
        let picture = unpack(exposed.bytes, &exposed.layout)?;
        let mut frame = Frame {
            header: Header { phase, stamp_nanos, clock: Clock::System, ..Header::default() },
            width,
            height,
            stride: picture.stride,
            format: picture.format,
            light: Light { laser: false, lamp: false },
            exposure_nanos,
            gain: setting.gain as f32,
            gamma: self.config.gamma,
            data: picture.data.into(),
        };
        let seen = look(&frame, &self.laser, &self.config.light)?;
        frame.light = self.judge.judge(phase, &seen, &self.config.light);
        Ok(frame)
    }

    /// How uncertain the clocks make a stamp.
    pub fn clock_uncertainty_nanos(&self) -> Option<i64> {
        self.clock.uncertainty_nanos()
    }
}
