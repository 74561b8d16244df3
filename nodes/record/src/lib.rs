//! Keeps everything that reached the bus
