//! Colour onto the surface
