//! Subpixel peaks of the laser line
