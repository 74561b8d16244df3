//! From the estimates to the model: average, blur, fill, one gain, sRGB.

use crate::atlas::NO_TEXEL;
use crate::look::CellRefusal;
use crate::painter::{Painter, Surface, refusals};
use crate::texture::{FILLED, GREY, NOTHING, SEEN, encode, srgb_byte, white_gain};
use crate::{ambient, sample, spread};
use rayon::prelude::*;
use wire::{Header, Mesh, Model, Refusal};

/// How a model came by its colours.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Evidence {
    /// Pictures that were painted onto this surface.
    pub pictures: u64,
    /// Charts of the texture.
    pub charts: u64,
    /// Cells of the texture.
    pub cells: u64,
    /// Cells that at least one picture coloured.
    pub seen: u64,
    /// Cells that took their colour from their neighbours.
    pub filled: u64,
    /// Cells without colour: grey. All of them, when there was no picture.
    pub grey: u64,
    /// Ambient light of red, green and blue, as a share of the lamp's on a surface that faces it at 0.2 m: as configured,
    /// or as estimated.
    pub ambient: [f32; 3],
    /// Gain from light by lamp light to albedo, the same for all channels (see `white_percentile`).
    pub white_gain: f32,
    /// Cells that a picture did not colour, by reason, over all pictures.
    pub refused: Vec<Refusal>,
}

impl Painter {
    /// The surface with its colours so far: averaged, blurred, spread into what was not seen, as sRGB with one gain for
    /// all channels. Without a surface the model is empty; without a picture it is grey.
    pub fn model(&self) -> (Model, Evidence) {
        let Some(surface) = &self.surface else { return (empty(), Evidence::default()) };
        let (mut colours, ambient) = self.albedo(surface);
        for _ in 0..self.config.blur_passes {
            colours = spread::blur(&colours, &surface.atlas);
        }
        let white_gain = white_gain(&colours, self.config.white_percentile, self.config.white_albedo);
        let seen: Vec<bool> = colours.iter().map(Option::is_some).collect();
        let filled = spread::fill(&mut colours, &surface.atlas);
        let cells: Vec<[u8; 4]> = colours
            .par_iter()
            .zip(&seen)
            .map(|(colour, seen)| byte_colour(colour, white_gain, if *seen { SEEN } else { FILLED }))
            .collect();
        let seen = seen.into_iter().filter(|seen| *seen).count() as u64;
        let evidence = Evidence {
            pictures: surface.pictures,
            charts: surface.atlas.charts as u64,
            cells: cells.len() as u64,
            seen,
            filled,
            grey: cells.len() as u64 - seen - filled,
            ambient,
            white_gain,
            refused: refusals(&CellRefusal::ALL, &surface.refused_cells),
        };
        (self.assemble(surface, &cells), evidence)
    }

    /// The colour of each vertex of the surface as it stands, neither blurred nor filled: red, green, blue, and 255 where
    /// it was seen or 0. For the live picture.
    pub fn preview_colours(&self) -> Vec<[u8; 4]> {
        let Some(surface) = &self.surface else { return Vec::new() };
        let (colours, _) = self.albedo(surface);
        let white_gain = white_gain(&colours, self.config.white_percentile, self.config.white_albedo);
        let mut preview = vec![[GREY[0], GREY[1], GREY[2], NOTHING]; surface.mesh.vertices_m.len()];
        let atlas = &surface.atlas;
        for (&vertex, uv) in atlas.vertices.iter().zip(&atlas.uv) {
            let [column, row] = [uv[0] * atlas.width as f32, uv[1] * atlas.height as f32].map(|c| c as usize);
            let number = atlas.number_at[row * atlas.width as usize + column];
            if number != NO_TEXEL && colours[number as usize].is_some() {
                preview[vertex as usize] = byte_colour(&colours[number as usize], white_gain, SEEN);
            }
        }
        preview
    }

    /// Linear albedo of each cell up to a gain, and the ambient light that was taken off.
    fn albedo(&self, surface: &Surface) -> (Vec<Option<[f32; 3]>>, [f32; 3]) {
        let per_cell = self.config.samples_per_cell;
        let ambient = match self.config.ambient {
            Some(known) => known.map(|a| a as f32),
            None => ambient::estimate(&surface.samples, per_cell),
        };
        let albedo = |kept: &[sample::Sample]| sample::albedo(kept, &ambient);
        (surface.samples.par_chunks(per_cell).map(albedo).collect(), ambient)
    }

    fn assemble(&self, surface: &Surface, cells: &[[u8; 4]]) -> Model {
        let (source, atlas) = (&surface.mesh, &surface.atlas);
        let from_source = |i: &u32| source.vertices_m[*i as usize];
        let mesh = Mesh {
            header: source.header,
            vertices_m: atlas.vertices.iter().map(from_source).collect(),
            normals: atlas.vertices.iter().map(|&i| source.normals[i as usize]).collect(),
            sigma_m: atlas.vertices.iter().filter_map(|&i| source.sigma_m.get(i as usize).copied()).collect(),
            triangles: atlas.triangles.clone().into(),
            // The atlas keeps the order of the triangles.
            measured: source.measured,
        };
        let stamp_nanos = surface.latest_stamp_nanos.unwrap_or(source.header.stamp_nanos);
        Model {
            header: Header { stamp_nanos, ..source.header.derived() },
            mesh,
            uv: atlas.uv.clone().into(),
            texture_width: atlas.width,
            texture_height: atlas.height,
            texture: encode(atlas, cells).into(),
            cell_m: self.config.cell_m() as f32,
        }
    }
}

fn byte_colour(colour: &Option<[f32; 3]>, gain: f32, how: u8) -> [u8; 4] {
    let ([r, g, b], how) = match colour {
        Some(colour) => (colour.map(|c| srgb_byte(c * gain)), how),
        None => (GREY, NOTHING),
    };
    [r, g, b, how]
}

fn empty() -> Model {
    Model {
        header: Header::default(),
        mesh: Mesh {
            header: Header::default(),
            vertices_m: Vec::new().into(),
            normals: Vec::new().into(),
            sigma_m: Vec::new().into(),
            triangles: Vec::new().into(),
            measured: 0,
        },
        uv: Vec::new().into(),
        texture_width: 0,
        texture_height: 0,
        texture: Vec::new().into(),
        cell_m: 0.0,
    }
}
