//! Bytes to values and back: no port, no clock, nothing allocated for a record.
//!
//! Sources: Ascension, "Flock of Birds Installation and Operation Guide", 910141 Rev B, 2002 ("the manual"), chapters 5,
//! 7 and 9. Its pages 44-47 swap the codes of EXAMINE and CHANGE; chapter 7 is right.

pub mod address;
pub mod commands;
pub mod decoder;
pub mod errors;
pub mod examine;
pub mod modem;
pub mod reading;
pub mod records;
pub mod test_mode;
