//! The laser line in a picture, to a fraction of a pixel (paper, section 2.2: the image points of the lit stripe).
//!
//! In: [`wire::Frame`], RGB8, GREY8 or YUYV, read where it lies. Out: [`wire::Stripe`], for each row (or column, as the
//! rig says) all peaks of the laser channel above the background, each with position, one standard deviation, height and
//! width; one of them marked as the best. Pixels have u to the right and v down, and (0, 0) is the centre of the top-left
//! one. A frame without the laser gives no peaks.
//!
//! How, in the order of the files:
//! 1. `channel`: red, green and blue are summed with the rig's weights, which may be negative (red less the mean of green
//!    and blue cancels white light). YUYV goes by way of [`wire::YCbCr`]; GREY8 is taken as it is.
//! 2. `noise`: the standard deviation of a pixel, from the picture itself.
//! 3. `search`: one pass over all bytes, in vectors. What rises above *both* sides stands out: steps of ambient light do not.
//! 4. `batch`, `measure`: there, the background of both sides is subtracted as a straight line (`window`), and a Gaussian
//!    fitted (`gaussian`: Baker and Moallem 2007); of a clipped one the middle between its `flanks` is taken. What is too
//!    wide, too narrow or too faint is refused and counted.
//! 5. `support`: where the line is not seen, grains of noise and texture still stand out. No line goes on from them to the
//!    rows (or columns) around: they are refused and counted.
//! 6. `choice`: the largest of each line are kept, and the best is the one with the largest amplitude; of a tie (all clipped
//!    ones tie), the first from the left (from the top).
//! 7. `lateral`: positions that follow one another in neighbouring lines are averaged by a short straight fit, unless they
//!    depart from it by more than noise: corners and steps of the surface stay.
//! 8. `scatter`: what scatter along the stripe the pixels' noise does not explain is speckle, and goes into the sigma.
//!
//! Limits: two lines closer than about four of their widths are one. Every bump of the background that looks like a line
//! costs as much time as a line, about 0.6 microseconds; weights that cancel white light spare that. The sigma knows noise and speckle, but not a bias
//! that neighbouring lines share: an edge of the albedo under the line, a lopsided bloom.
//!
//! ```
//! use stripe::{Config, StripeDetector};
//! use wire::{Frame, Header, LaserPlane, Light, PeaksPer, PixelFormat};
//! // A vertical line, brightest halfway between the columns 30 and 31.
//! let row = (0..64).map(|u| (10.0 + 100.0 * (-(u as f32 - 30.5).powi(2) / 8.0).exp()) as u8);
//! let frame = Frame {
//!     header: Header::default(),
//!     width: 64,
//!     height: 16,
//!     stride: 64,
//!     format: PixelFormat::Grey8,
//!     light: Light { laser: true, lamp: false },
//!     exposure_nanos: 1_000_000,
//!     gain: 1.0,
//!     gamma: 1.0,
//!     data: row.cycle().take(64 * 16).collect(),
//! };
//! let laser = LaserPlane {
//!     normal: [1.0, 0.0, 0.0],
//!     distance_m: 0.1,
//!     channel_weights: [1.0, -0.5, -0.5],
//!     peaks_per: PeaksPer::Row,
//! };
//! let stripe = StripeDetector::new(Config::default(), &laser)?.process(&frame)?;
//! assert_eq!(stripe.peaks.len(), 16);
//! assert!(stripe.peaks.iter().all(|p| p.is_best() && (p.u_px - 30.5).abs() < 0.02));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod batch;
mod channel;
mod choice;
mod config;
mod detect;
mod flanks;
mod gaussian;
mod lateral;
mod lonely;
mod measure;
mod noise;
mod refusal;
mod scatter;
mod search;
mod support;
mod window;

pub use config::{Config, ConfigError};
pub use detect::StripeDetector;

#[cfg(feature = "node")]
pub mod node;
