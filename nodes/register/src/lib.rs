//! Profiles and poses to points in the world, live
