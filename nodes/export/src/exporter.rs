//! Streams to files.

use crate::held::HeldCloud;
use crate::tint::tint;
use crate::{Config, ConfigError};
use formats::mesh::LoadedMesh;
use formats::{FormatError, Reason};
use geometry::TriangleMesh;
use std::path::{Path, PathBuf};
use std::{fmt, fs, io};
use wire::{Cloud, CloudPoint, Mesh, Model};

/// Why nothing was written.
#[derive(Debug, thiserror::Error)]
pub enum ExportError {
    /// Bad choices.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// The folder cannot be made.
    #[error("{}: cannot be made: {source}", path.display())]
    Folder {
        /// The folder.
        path: PathBuf,
        /// Why not.
        source: io::Error,
    },
    /// A file cannot be written, or there is nothing to write.
    #[error(transparent)]
    File(#[from] FormatError),
}

/// A file that has been written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Written {
    /// The file.
    pub path: PathBuf,
    /// What is in it, in words.
    pub holds: String,
    /// Its size.
    pub bytes: u64,
}

impl fmt::Display for Written {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}, {} bytes", self.path.display(), self.holds, self.bytes)
    }
}

/// Holds what comes until it is final, then writes it.
#[derive(Debug)]
pub struct Exporter {
    folder: PathBuf,
    cloud: HeldCloud,
}

impl Exporter {
    /// Makes the folder.
    pub fn new(config: Config) -> Result<Self, ExportError> {
        config.check()?;
        let folder = config.folder;
        fs::create_dir_all(&folder).map_err(|source| ExportError::Folder { path: folder.clone(), source })?;
        Ok(Self { folder, cloud: HeldCloud::default() })
    }

    /// Takes the cloud or what of it changed; writes cloud.ply when it was the last message. Otherwise nothing is written.
    pub fn cloud(&mut self, cloud: &Cloud) -> Result<Vec<Written>, ExportError> {
        self.cloud.take(cloud);
        if cloud.header.is_end() { self.save_cloud() } else { Ok(Vec::new()) }
    }

    /// Writes the cloud as it stands, for a scan that was stopped before its end.
    pub fn save_cloud(&self) -> Result<Vec<Written>, ExportError> {
        Ok(vec![self.write_cloud(&self.cloud.points())?])
    }

    fn write_cloud(&self, points: &[CloudPoint]) -> Result<Written, ExportError> {
        let path = self.folder.join("cloud.ply");
        formats::cloud::write_ply(&path, points)?;
        Ok(written(path, format!("{} points", points.len()))?)
    }

    /// Takes the surface; when it is the final one, writes mesh.ply, what was measured, and mesh.stl, closed where it came closed.
    pub fn mesh(&self, mesh: &Mesh) -> Result<Vec<Written>, ExportError> {
        if !mesh.header.is_end() {
            return Ok(Vec::new());
        }
        let measured = mesh.without_caps();
        let (open, whole) = (TriangleMesh::from(&measured), TriangleMesh::from(mesh));
        let (ply, stl) = (self.folder.join("mesh.ply"), self.folder.join("mesh.stl"));
        refuse_empty(&open, &ply)?;
        formats::mesh::write_measured_ply(&ply, &open, &measured.sigma_m)?;
        formats::mesh::write_stl(&stl, &whole)?;
        let holds = |mesh: &TriangleMesh| format!("{} triangles", mesh.triangles.len());
        Ok(vec![written(ply, holds(&open))?, written(stl, holds(&whole))?])
    }

    /// Takes the painted surface; writes model.glb and model.obj (with model.mtl and model.png) when it is the final one, and
    /// cloud.ply again when the cloud that is held is that of the same scan: with the colours of the surface beside it.
    pub fn model(&self, model: &Model) -> Result<Vec<Written>, ExportError> {
        if !model.header.is_end() {
            return Ok(Vec::new());
        }
        let (glb, obj) = (self.folder.join("model.glb"), self.folder.join("model.obj"));
        refuse_empty(&TriangleMesh::from(&model.mesh), &glb)?;
        let LoadedMesh { mesh, texture } = LoadedMesh::try_from(model).map_err(|reason: Reason| reason.of(&glb))?;
        formats::mesh::write_glb(&glb, &mesh, texture.as_ref())?;
        formats::mesh::write_obj(&obj, &mesh, texture.as_ref())?;
        let holds = format!("{} triangles", mesh.triangles.len());
        let mut files = vec![written(glb, holds.clone())?, written(obj.clone(), holds)?];
        if texture.is_some() {
            files.push(written(obj.with_extension("mtl"), "the material".into())?);
            let texels = format!("{}x{} texels", model.texture_width, model.texture_height);
            files.push(written(obj.with_extension("png"), texels)?);
            let mut balls = self.cloud.points_of(model.header.scan);
            if !balls.is_empty() {
                tint(&mut balls, model).map_err(|reason| Reason::from(reason).of(&self.folder.join("cloud.ply")))?;
                files.push(self.write_cloud(&balls)?);
            }
        }
        Ok(files)
    }
}

/// An empty scan is told as what it is, not as a mesh without faces.
fn refuse_empty(mesh: &TriangleMesh, path: &Path) -> Result<(), FormatError> {
    if mesh.triangles.is_empty() { Err(Reason::Empty("the scan has no surface").of(path)) } else { Ok(()) }
}

fn written(path: PathBuf, holds: String) -> Result<Written, FormatError> {
    match fs::metadata(&path) {
        Ok(metadata) => Ok(Written { path, holds, bytes: metadata.len() }),
        Err(e) => Err(Reason::from(e).of(&path)),
    }
}
