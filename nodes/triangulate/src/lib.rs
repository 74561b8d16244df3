//! Camera ray with laser sheet: points in the frame of the camera
