//! Bytes to values and back: no port, no clock, nothing allocated for a record.
//!
//! Sources: VRPN's Fastrak and Liberty drivers and VR Juggler's, read for what the devices say; the Liberty user manual
//! URM03PH156.

pub mod commands;
pub mod decoder;
pub mod errors;
pub mod records;
pub mod status;
