//! Plays a recording or a scan folder
