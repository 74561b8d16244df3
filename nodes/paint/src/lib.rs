//! Colour onto the surface.
//!
//! In come the surface ([`wire::Mesh`], world, metres), pictures lit by the lamp ([`wire::Frame`]) and where the camera
//! was for each (`world_from_camera`). Out goes the surface with a texture ([`wire::Model`]): sRGB albedo in charts of
//! cells of exactly `cell_mm` (1 mm at first), and how each cell came by its colour.
//!
//! The rules are the paper's (sections 2.5 and 2.6):
//!
//! 1. Only the working region is used, within 15 degrees of the optical axis ([`Region`], [`Picture`]), and only frames
//!    lit by the lamp, or of the colour phase, without the laser.
//! 2. The surface is cut into nearly flat charts, each projected onto cells of the asked size ([`Atlas`]). Nothing is
//!    solved. On the surface a cell is longer by at most 1.22 (`chart_degrees`; the grain of a rough surface and small
//!    fragments may be stretched more).
//! 3. Each cell looks where it lies in the picture. It must face the camera within 45 degrees, be the nearest thing there
//!    (z-buffer, to a tolerance), lie clear of edges in depth, and be unsaturated in every pixel that it covers. Its light
//!    is the mean over those pixels.
//! 4. The light is made linear (gamma, gain, exposure), freed of the lens's fall-off (cos^4) and divided by what the lamp
//!    and the ambient light send there (inverse square, Lambert). That is where we leave the paper, which attaches the
//!    colour as it comes: here the albedo comes out, up to one gain for each channel. Ambient light need not be known: it
//!    is the one under which the views of each cell agree best ([`Evidence::ambient`]).
//! 5. Of all estimates of a cell a fair draw of `samples_per_cell` is kept (weighted by facing and nearness), and their
//!    robust mean taken: gleams, shadows and what strayed there by an error of the pose do not count.
//! 6. The 1-2-1 / 2-4-2 / 1-2-1 blur, within charts; then colour spreads into cells that were not seen, across seams too.
//!    The fourth byte of a texel says it: 255 seen, 85 filled, 0 no colour (grey) or no cell.
//!    So it does into the caps that close the surface ([`wire::Mesh::measured`]): no picture colours those, and they hide nothing.
//! 7. One gain for all channels puts `white_percentile` of the seen cells at `white_albedo`.
//!
//! Before they are painted, the pictures are moved a little until they agree on the colours ([`Painter::settle`]; Zhou &
//! Koltun 2014): the hand trembles between the laser-lit pictures that tell its way, and several pixels' error would blur
//! the borders of colours. In the end all pictures are corrected at once, which their paper does not do: colours that lie
//! elsewhere on one side of the thing are so in all pictures of it, and each alone would be held there by the others. A
//! picture moves only where that makes it agree better; on a thing of one colour none does.
//!
//! Frames that come before the final mesh wait in a [`FrameStore`] of bounded memory, cropped, and are painted at the end
//! with the final trajectory. Same input, same bytes, on any number of threads and in any order of the pictures.
//!
//! Limits: surfaces are taken as Lambertian; the lamp's own shadows are left to the robust mean; mutual reflections are
//! not undone; a cell that no picture saw has its neighbours' colour; with the blur a border between colours is about two
//! cells wide.
//!
//! ```
//! use nalgebra::{Isometry3, UnitQuaternion, Vector3};
//! use paint::{Config, Painter};
//! use wire::*;
//! let camera = CameraIntrinsics { width: 64, height: 48, fx: 80.0, fy: 80.0, cx: 31.5, cy: 23.5, distortion: [0.0; 5] };
//! let laser = LaserPlane { normal: [0.0, 0.0, 1.0], distance_m: 0.2, channel_weights: [1.0; 3], peaks_per: PeaksPer::Row };
//! let calibration = Calibration {
//!     header: Header::default(), camera, laser, body_from_camera: RigidPose::IDENTITY, pose_offset_nanos: 0, name: "rig".into(),
//! };
//! let mut painter = Painter::new(Config { cell_mm: 5.0, ..Config::default() }, &calibration).unwrap();
//!
//! // A square that faces up, and a camera 0.2 m above that looks down on it.
//! let square = vec![[-0.1, -0.1, 0.0], [0.1, -0.1, 0.0], [0.1, 0.1, 0.0], [-0.1, 0.1, 0.0]];
//! let mesh = Mesh {
//!     header: Header::default(), vertices_m: square.into(), normals: vec![].into(), sigma_m: vec![].into(),
//!     triangles: vec![[0, 1, 2], [0, 2, 3]].into(), measured: 2,
//! };
//! painter.mesh(&mesh).unwrap();
//! let down = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), std::f64::consts::PI);
//! let world_from_camera = Isometry3::from_parts(Vector3::new(0.0, 0.0, 0.2).into(), down);
//! let frame = Frame {
//!     header: Header { phase: Phase::Colour, ..Header::default() },
//!     width: 64, height: 48, stride: 192, format: PixelFormat::Rgb8, light: Light { laser: false, lamp: true },
//!     exposure_nanos: 10_000_000, gain: 1.0, gamma: 2.2, data: [200, 100, 50].repeat(64 * 48).into(),
//! };
//! let report = painter.frame(&frame, &world_from_camera).unwrap();
//! assert!(report.coloured > 100);
//! let (model, evidence) = painter.model();
//! assert_eq!(evidence.seen, report.coloured);
//! assert_eq!(model.texture.iter().filter(|texel| texel[3] == 255).count() as u64, evidence.seen);
//! ```

mod ambient;
mod atlas;
mod config;
mod edge;
mod finish;
mod light;
mod look;
#[cfg(feature = "node")]
pub mod node;
mod occlusion;
mod painter;
mod picture;
#[cfg(feature = "node")]
mod preview;
mod region;
mod sample;
mod settle;
mod spread;
mod store;
mod texture;

pub use atlas::{Atlas, AtlasError, NO_TEXEL, Texel};
pub use config::{Config, ConfigError};
pub use finish::Evidence;
pub use look::CellRefusal;
pub use painter::{FrameReport, Painter, PainterError, SurfaceError};
pub use picture::{FrameRefusal, Picture};
pub use region::{NoRegion, Region};
pub use settle::{SettleRefusal, Settling, Shot};
pub use store::FrameStore;
