//! The painter: a surface, pictures of it, and the textured model.

use crate::atlas::{Atlas, AtlasError};
use crate::config::ConfigError;
use crate::edge::Edge;
use crate::look::{CellRefusal, Look, Rules};
use crate::occlusion::Occlusion;
use crate::picture::FrameRefusal;
use crate::region::{NoRegion, Region};
use crate::sample::{Sample, offer};
use crate::{Config, Picture};
use geometry::{Camera, CameraError, MeshError, TriangleMesh};
use nalgebra::Isometry3;
use rayon::prelude::*;
use wire::{Calibration, Frame, Mesh, Refusal};

/// Why there is no painter.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PainterError {
    /// The configuration.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// The camera.
    #[error(transparent)]
    Camera(#[from] CameraError),
    /// The camera and the working angle together.
    #[error(transparent)]
    Region(#[from] NoRegion),
}

/// Why a surface cannot be painted.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SurfaceError {
    /// No faces, or broken ones.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// Coordinates beyond any scanner's reach.
    #[error("vertex {index} is farther than {limit_m} m from the origin: is the mesh in metres?")]
    Far {
        /// The first such vertex.
        index: usize,
        /// The largest distance.
        limit_m: f32,
    },
    /// The texture.
    #[error(transparent)]
    Atlas(#[from] AtlasError),
}

/// What became of one picture.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct FrameReport {
    /// Cells that got an estimate.
    pub coloured: u64,
    /// Cells that got none, by reason.
    pub refused: Vec<Refusal>,
}

/// Puts colour onto a surface. Same input, same bytes, on any number of threads and in any order of the pictures.
#[derive(Debug)]
pub struct Painter {
    pub(crate) config: Config,
    pub(crate) region: Region,
    pub(crate) rules: Rules,
    pub(crate) surface: Option<Surface>,
    refused_frames: [u64; FrameRefusal::ALL.len()],
}

/// A surface, with what is known of its colour.
#[derive(Debug)]
pub(crate) struct Surface {
    /// As it came, with a normal for each vertex.
    pub mesh: Mesh,
    pub atlas: Atlas,
    pub occlusion: Occlusion,
    /// So many for each texel, in the order of their numbers.
    pub samples: Vec<Sample>,
    pub pictures: u64,
    pub latest_stamp_nanos: Option<i64>,
    pub refused_cells: [u64; CellRefusal::ALL.len()],
}

/// Vertices farther from the origin are no scanner's.
const FARTHEST_M: f32 = 1e3;
/// Texels that one task looks at.
const CHUNK: usize = 4096;

impl Painter {
    /// A painter without a surface.
    pub fn new(config: Config, calibration: &Calibration) -> Result<Self, PainterError> {
        config.check()?;
        let camera = Camera::from(&calibration.camera);
        camera.check()?;
        let region = Region::of(&camera, &config)?;
        let rules = Rules::new(&config);
        Ok(Self { config, region, rules, surface: None, refused_frames: [0; FrameRefusal::ALL.len()] })
    }

    /// Sets the surface and lays out its texture. Colours of an earlier surface are forgotten: give the pictures again
    /// (a [`crate::FrameStore`] keeps them). On an error the earlier surface stays.
    pub fn mesh(&mut self, mesh: &Mesh) -> Result<(), SurfaceError> {
        let mut surface = TriangleMesh::from(mesh);
        let normals_hold = surface.normals.len() == surface.vertices.len()
            && surface.normals.iter().all(|n| (0.5..2.0).contains(&n.norm()));
        if !normals_hold {
            surface.normals.clear();
        }
        surface.check()?;
        let far = |p: &nalgebra::Point3<f32>| p.coords.amax() > FARTHEST_M;
        if let Some(index) = surface.vertices.iter().position(far) {
            return Err(SurfaceError::Far { index, limit_m: FARTHEST_M });
        }
        if !normals_hold {
            surface.normals = surface.vertex_normals();
        }
        let Config { chart_degrees, texture_side_max, samples_per_cell, .. } = self.config;
        let atlas = Atlas::build(&surface, self.config.cell_m(), chart_degrees, texture_side_max)?;
        let samples = vec![Sample::EMPTY; atlas.texels.len() * samples_per_cell];
        let mesh = Mesh { normals: surface.normals.iter().map(|&n| n.into()).collect(), ..mesh.clone() };
        self.surface = Some(Surface {
            // A guess hides nothing.
            occlusion: Occlusion::new(&TriangleMesh::from(&mesh.without_caps())),
            mesh,
            atlas,
            samples,
            pictures: 0,
            latest_stamp_nanos: None,
            refused_cells: [0; CellRefusal::ALL.len()],
        });
        Ok(())
    }

    /// Takes the working region out of a frame, to be painted now or later. What is refused is counted.
    pub fn crop(&mut self, frame: &Frame) -> Result<Picture, FrameRefusal> {
        let cropped = Picture::crop(frame, &self.region);
        cropped.map_err(|refusal| self.count(refusal))
    }

    /// Paints a frame onto the surface.
    pub fn frame(&mut self, frame: &Frame, world_from_camera: &Isometry3<f64>) -> Result<FrameReport, FrameRefusal> {
        let picture = self.crop(frame)?;
        self.picture(&picture, world_from_camera)
    }

    /// Paints a picture onto the surface.
    pub fn picture(
        &mut self,
        picture: &Picture,
        world_from_camera: &Isometry3<f64>,
    ) -> Result<FrameReport, FrameRefusal> {
        if let Some(refusal) = self.refusal(picture, world_from_camera) {
            return Err(self.count(refusal));
        }
        if self.surface.is_none() {
            return Err(self.count(FrameRefusal::NoSurface));
        }
        Ok(self.paint(picture, &world_from_camera.inverse()))
    }

    /// Why a picture cannot be seen from there.
    pub(crate) fn refusal(&self, picture: &Picture, world_from_camera: &Isometry3<f64>) -> Option<FrameRefusal> {
        let camera = &self.region.camera;
        let fits = (picture.width, picture.height) == (camera.width, camera.height)
            && picture.pixels.len() == camera.width as usize * camera.height as usize;
        let finite = world_from_camera.inverse().to_homogeneous().iter().all(|value| value.is_finite());
        match (fits, finite) {
            (false, _) => Some(FrameRefusal::Size),
            (_, false) => Some(FrameRefusal::Pose),
            _ => None,
        }
    }

    /// What counts as an edge in depth.
    pub(crate) fn edge(&self) -> Edge {
        Edge {
            jump_m: (self.config.edge_jump_mm * geometry::METRES_PER_MM) as f32,
            margin_px: self.config.edge_margin_px as usize,
        }
    }

    fn paint(&mut self, picture: &Picture, camera_from_world: &Isometry3<f64>) -> FrameReport {
        let edge = self.edge();
        let Some(surface) = &mut self.surface else { return FrameReport::default() };
        surface.occlusion.see(&self.region.camera, camera_from_world, self.region.corner_rad, &edge);
        let look = Look::new(&self.rules, &self.region, picture, &surface.occlusion, camera_from_world);
        let (per_cell, measured) = (self.config.samples_per_cell, surface.mesh.measured);
        let chunks = surface.samples.par_chunks_mut(CHUNK * per_cell).zip(surface.atlas.texels.par_chunks(CHUNK));
        let counts = chunks.enumerate().map(|(chunk, (samples, texels))| {
            let mut coloured = 0;
            let mut refused = [0; CellRefusal::ALL.len()];
            for (at, (kept, texel)) in samples.chunks_exact_mut(per_cell).zip(texels).enumerate() {
                let is_guess = texel.triangle >= measured;
                match if is_guess { Err(CellRefusal::Guessed) } else { look.at((chunk * CHUNK + at) as u32, texel) } {
                    Ok(sample) => {
                        offer(kept, sample);
                        coloured += 1;
                    }
                    Err(refusal) => refused[refusal as usize] += 1,
                }
            }
            (coloured, refused)
        });
        let add = |(a, b): (u64, [u64; CellRefusal::ALL.len()]), (c, d): (u64, [u64; CellRefusal::ALL.len()])| {
            (a + c, std::array::from_fn(|i| b[i] + d[i]))
        };
        let (coloured, refused) = counts.reduce(Default::default, add);
        surface.pictures += 1;
        surface.refused_cells = std::array::from_fn(|i| surface.refused_cells[i] + refused[i]);
        let stamp = picture.header.stamp_nanos;
        surface.latest_stamp_nanos = Some(surface.latest_stamp_nanos.map_or(stamp, |latest| latest.max(stamp)));
        FrameReport { coloured, refused: refusals(&CellRefusal::ALL, &refused) }
    }

    /// Frames that were refused so far, by reason.
    pub fn refused_frames(&self) -> Vec<Refusal> {
        refusals(&FrameRefusal::ALL, &self.refused_frames)
    }

    fn count(&mut self, refusal: FrameRefusal) -> FrameRefusal {
        self.refused_frames[refusal as usize] += 1;
        refusal
    }
}

/// Reasons with their counts, those without any left out.
pub(crate) fn refusals<R: std::fmt::Display>(reasons: &[R], counts: &[u64]) -> Vec<Refusal> {
    let some = reasons.iter().zip(counts).filter(|(_, count)| **count > 0);
    some.map(|(reason, &count)| Refusal { reason: reason.to_string(), count }).collect()
}
