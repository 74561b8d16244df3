//! Files: meshes, clouds and scan folders, read and written.
//!
//! | what | formats | module |
//! |---|---|---|
//! | surfaces, with colours or a texture | OBJ (+ MTL + picture), PLY, STL, GLB, glTF | [`mesh`] |
//! | points | PLY, XYZ, CSV | [`cloud`] |
//! | scans as pictures and poses | a folder of rig.toml, frames.csv, poses.csv and frames/ | [`scan_folder`] |
//! | pictures | PNG, JPEG | [`image_file`] |
//! | recordings | the names of their parts; crates `record` and `replay` know the rest | [`recording_part`] |
//!
//! Every reader takes hostile bytes: it answers with a [`FormatError`] that names file and reason, never panics, and
//! allocates no more than a small multiple of what the file really holds, whatever its header promises.
//!
//! Units: numbers are read as they stand in the file, since most formats do not say. What is written is in metres, in
//! every format, so that a file that is read back can be compared with the scan it came from; PLY, OBJ and STL say so in a comment,
//! glTF prescribes metres. (Slicers take STL for millimetres: scale by 1000 there.) What is written has z up, as the world
//! has, but for glTF, which prescribes y up.
//!
//! ```
//! use geometry::TriangleMesh;
//! use nalgebra::Point3;
//! let folder = tempfile::tempdir().unwrap();
//! let path = folder.path().join("triangle.ply");
//! let corners = [[0.0, 0.0, 0.0], [0.1, 0.0, 0.0], [0.0, 0.1, 0.0]];
//! let triangle = TriangleMesh { vertices: corners.map(Point3::from).to_vec(), triangles: vec![[0, 1, 2]], ..Default::default() };
//! formats::mesh::write_ply(&path, &triangle).unwrap();
//! assert_eq!(formats::mesh::read(&path).unwrap().mesh, triangle);
//! ```

mod bytes;
pub mod cloud;
mod error;
pub mod image_file;
pub mod mesh;
mod parts;
mod ply;
pub mod scan_folder;
mod table;
mod whole;

pub use error::{FormatError, Reason};
pub use parts::{RECORDING_PART, recording_part, recording_parts};
pub use whole::write_whole;
