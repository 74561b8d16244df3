//! The surface of the cloud (paper, section 2.4): the zero set of a signed distance, as triangles, live and at the end.
//!
//! **In**: [`wire::Cloud`], whole or by its changes: points in metres in the world, each with a number, the side from which
//! it was seen (any direction within 90 degrees of the normal; zero when nobody knows) and its sigma (zero when nobody
//! knows). **Out**: [`wire::Mesh`], with a normal and a sigma for each vertex. [`surface_from_points`] is the same for a cloud that is all there.
//!
//! # Method
//!
//! Hoppe, DeRose, Duchamp, McDonald and Stuetzle (SIGGRAPH 1992), as in the paper, with four departures that accuracy asks for:
//!
//! 1. Samples are gathered into voxels of a sparse grid, apart for opposite sides.
//! 2. Each voxel's tangent plane comes from principal components (Hoppe, 3.1), and its side from where it was seen; a cloud
//!    without sides gets them along Hoppe's spanning tree of the Riemannian graph (3.3). *Departure*: a quadric is
//!    fitted over the plane (moving least squares, Levin 1998), since a plane fitted over a curved neighbourhood lies inside the curve.
//! 3. The signed distance (3.4) is undefined where no sample is near, by Hoppe's own rule, so that no phantom sheets grow in
//!    empty space. *Departures*: near quadrics are averaged (implicit moving least squares, Kolluri 2005) instead of taking the
//!    nearest plane alone; only those whose normals agree with the nearest one's, so that the two sides of a thin sheet stay
//!    apart; and it ends where the samples lie to one side.
//! 4. Marching cubes (Lorensen and Cline 1987) with a derived table whose cells always agree; each vertex is moved onto the
//!    zero set by one Newton step. Between sheets that were seen from the same side the distance has a step, not a zero: cells where
//!    it changes faster than distance can have no triangles.
//! 5. The final mesh is cleaned: bow-ties cut, islands dropped, holes filled by a membrane, slivers collapsed or flipped, and
//!    saws along sharp rims smoothed. No edge has more than two triangles, and each vertex one fan.
//! 6. If it is wanted so ([`Config::close`]), what is left open is closed, and told apart from what was measured
//!    ([`wire::Mesh::measured`]): the triangulation of the rim with the least area (Barequet and Sharir 1995), refined as Liepa
//!    (2003) does and drawn tight. No cap goes below the table that the cloud tells of, and what nobody saw within
//!    `standing_mm` of it stands on it: soles are flat. A cap larger than a third of all that was measured is refused
//!    and counted, unless the thing stands on the table with it: a wall has no back, and a half no other half, that anyone knows.
//!
//! # Scales
//!
//! All follow from the radius of the neighbourhood, R: voxels and cells are 3R/8 and blocks 8R/3. R is 8 sqrt(noise
//! spacing), between 3 and 12 spacings; noise and spacing are measured in the cloud. Where samples are sparse a neighbourhood grows up to 2R.
//!
//! # Limits
//!
//! * Edges sharper than R are rounded. Sheets back to back may be as near as two cells; seen from the same side, as three.
//! * The surface ends about 0.3 R past the last samples. A point of the cloud that has fewer than five neighbours is not used.
//! * The sigma holds what the residuals and the samples' own sigmas say; what samples of one voxel share is averaged as if
//!   they did not. Caps have the radius of the hole for their sigma, since nothing was measured there; where they run through
//!   a ragged rim they may cut the surface.
//! * [`Surfer::live_mesh`] is not cleaned, and its cell follows the cloud as it grows; the final mesh depends on the points
//!   alone, bit for bit, however they came and on however many threads.
//!
//! Accuracy and times: `cargo run --release -p surface --no-default-features --example accuracy` and `cargo bench -p surface
//! --no-default-features`.
//!
//! ```
//! use surface::{Config, surface_from_points};
//! // A dome of 20 mm, seen from outside: a spiral that covers it evenly.
//! let normal = |k: usize| {
//!     let (z, turn) = (k as f32 / 5000.0, 2.4 * k as f32);
//!     let across = (1.0 - z * z).sqrt();
//!     [across * turn.cos(), across * turn.sin(), z]
//! };
//! let normals: Vec<[f32; 3]> = (0..5000).map(normal).collect();
//! let points: Vec<[f32; 3]> = normals.iter().map(|n| n.map(|x| 0.02 * x)).collect();
//! let (mesh, refused) = surface_from_points(&points, Some(&normals), Config::default()).unwrap();
//! assert!(mesh.triangles.len() > 5000 && refused.is_empty());
//! let radius = |p: &[f32; 3]| p.iter().map(|x| x * x).sum::<f32>().sqrt();
//! assert!(mesh.vertices_m.iter().all(|p| (radius(p) - 0.02).abs() < 0.1e-3));
//! // Its underside was not seen, so nothing is there.
//! assert!(mesh.vertices_m.iter().all(|p| p[2] > -1e-3));
//! ```

mod calm;
mod cap;
mod cases;
mod clean;
mod config;
mod field;
mod flips;
mod grid;
mod ground;
mod holes;
mod least_area;
mod marching;
mod model;
#[cfg(feature = "node")]
pub mod node;
mod orient;
mod plane;
mod quadric;
mod refine;
mod sample;
mod scale;
mod sheet;
mod slivers;
mod stars;
mod surfel;
mod surfer;
mod topology;

pub use config::{Config, ConfigError};
pub use surfer::{Surfer, surface_from_points};
