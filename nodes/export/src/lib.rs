//! The finished model, as files.
//!
//! | in | out, in one folder |
//! |---|---|
//! | cloud | cloud.ply: position, normal, colour, count, sigma, spread of every ball |
//! | mesh | mesh.ply: what was measured, with its sigma; mesh.stl: closed, with the caps over what nobody saw, if it has any |
//! | model | model.glb; model.obj with model.mtl and model.png; cloud.ply again, with its colours |
//!
//! Messages are held until the last one of a stream has come (phase `End`); then its files are written, each under another
//! name first, so that no half file is ever seen. A higher scan or revision starts afresh. Metres throughout, z up (glTF: y
//! up): see [`formats`]. An empty scan is an error that says so, and leaves what was there.
//!
//! ```
//! use export::{Config, Exporter};
//! use wire::{Header, Mesh, Phase};
//! let folder = tempfile::tempdir().unwrap();
//! let mut exporter = Exporter::new(Config { folder: folder.path().join("out") }).unwrap();
//! let mesh = Mesh {
//!     header: Header { phase: Phase::End, ..Header::default() },
//!     vertices_m: vec![[0.0, 0.0, 0.0], [0.1, 0.0, 0.0], [0.0, 0.1, 0.0]].into(),
//!     normals: vec![].into(),
//!     sigma_m: vec![].into(),
//!     triangles: vec![[0, 1, 2]].into(),
//!     measured: 1,
//! };
//! let written = exporter.mesh(&mesh).unwrap();
//! assert!(written[0].to_string().contains("mesh.ply: 1 triangles"));
//! ```

mod config;
mod exporter;
mod held;
#[cfg(feature = "node")]
pub mod node;
mod tint;

pub use config::{Config, ConfigError};
pub use exporter::{ExportError, Exporter, Written};
