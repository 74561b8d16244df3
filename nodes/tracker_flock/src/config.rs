//! Where the flock is, how it is set, and what is known of its errors.

mod birds;
mod check;
mod filters;

use crate::hemisphere::Hemisphere;
use crate::protocol::address::Addressing;
use crate::protocol::reading::Scale;
use crate::protocol::records::Format;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// Settings of the line, of the flock, and of its poses.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Config {
    /// The serial port. Names under /dev/serial/by-id stay the same when it is plugged in again.
    pub port: PathBuf,
    /// As the unit's switches 1 to 3 have it.
    pub baud: u32,
    /// Raise RTS. With a fully wired cable RTS holds the bird in standby, so: false.
    pub raise_rts: bool,
    /// Reset the bird by RTS at the start (needs a fully wired cable; takes 3 s).
    pub reset: bool,
    /// Addresses of the units with a sensor, ascending; none for a bird alone (address 0). They answer in
    /// group mode.
    pub sensors: Vec<u8>,
    /// How many boxes the flock has, an extended range controller included; 0: as many as the highest address.
    pub units: u8,
    /// As the switches have it.
    pub addressing: Addressing,
    /// What is sent: `position_matrix`, `position_angles` or `position_quaternion`.
    pub output: Format,
    /// Full scale in inches: 36 or 72; 144 with the extended range transmitter, which has no other.
    pub scale_inches: Scale,
    /// The half of space in which the sensor is when the node starts, seen from the transmitter.
    pub hemisphere: Hemisphere,
    /// Follow the sensor into the other half of space, by continuity.
    pub follow_hemisphere: bool,
    /// Of the mains: 50 in Europe, 60 in America.
    pub line_frequency_hz: u8,
    /// Measurements a second, 20 to 144.
    pub rate_hz: f64,
    /// Send every 1st, 2nd, 8th or 32nd measurement.
    pub report_every: u8,
    /// Beside a simulated camera: stamps count from the beginning of the scan, as that camera's do.
    pub scan_clock: bool,
    /// The six-tap filter against the mains: quieter, and older by two and a half measurements.
    pub ac_wide_filter: bool,
    /// The two-tap filter against the mains: older by half a measurement.
    pub ac_narrow_filter: bool,
    /// The adaptive filter: quiet at rest (time constant 0.5 s), quick in motion.
    pub dc_filter: bool,
    /// Its smallest gain in each of the seven ranges; none: as the bird has it (0.02).
    pub dc_alpha_min: Option<[f64; 7]>,
    /// Its largest gain in each of the seven ranges; none: as the bird has it (0.9).
    pub dc_alpha_max: Option<[f64; 7]>,
    /// The motion from which its gain rises, in each of the seven ranges; none: as the bird has it (2 to 512). The
    /// default is the maker's set for quick hands.
    pub dc_motion: Option<[u16; 7]>,
    /// Hold the last pose when it jumps.
    pub sudden_change_lock: bool,
    /// Ask for the measure of metal with every record.
    pub metal: bool,
    /// From this measure of metal on (0 to 127) a pose counts as degraded, and its sigma grows in proportion.
    pub most_metal: u8,
    /// How old a position is when its record leaves; none: 7.5 ms (Adelstein et al. 1996) and what the AC filters add.
    pub position_latency_ms: Option<f64>,
    /// How old an orientation is when its record leaves; none: 2 ms and what the AC filters add.
    pub rotation_latency_ms: Option<f64>,
    /// One standard deviation of a position near the transmitter, along each axis (data sheet: 1.8 mm rms).
    pub position_sigma_mm: f64,
    /// One standard deviation of an orientation near the transmitter, about each axis (data sheet: 0.5 degrees rms).
    pub rotation_sigma_deg: f64,
    /// Up to this distance the data sheet holds (30 inches);
    /// farther away the signal falls with the cube of the distance: sigma grows with the fourth power, and a pose counts
    /// as degraded.
    pub good_to_m: f64,
}

impl Default for Config {
    fn default() -> Self {
        Self {
            port: PathBuf::from("/dev/ttyUSB0"),
            baud: 115_200,
            raise_rts: false,
            reset: false,
            sensors: Vec::new(),
            units: 0,
            addressing: Addressing::Normal,
            output: Format::PositionMatrix,
            scale_inches: Scale::Inches36,
            hemisphere: Hemisphere::Forward,
            follow_hemisphere: true,
            line_frequency_hz: 50,
            rate_hz: 103.0,
            report_every: 1,
            scan_clock: false,
            ac_wide_filter: false,
            ac_narrow_filter: true,
            dc_filter: true,
            dc_alpha_min: None,
            dc_alpha_max: None,
            dc_motion: Some([2, 2, 2, 10, 10, 40, 200]),
            sudden_change_lock: false,
            metal: false,
            most_metal: 20,
            position_latency_ms: None,
            rotation_latency_ms: None,
            position_sigma_mm: 1.8,
            rotation_sigma_deg: 0.5,
            good_to_m: 0.762,
        }
    }
}
