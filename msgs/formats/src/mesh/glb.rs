//! glTF 2.0, as one binary file or as JSON with its buffers beside it (Khronos, "glTF 2.0 Specification"), by the crate
//! gltf. Scenes are flattened: every node's transform is applied. Metres, y up, as in the file.

use super::gltf_buffers::{Buffers, indices};
use super::materials::{Part, join};
use super::{LoadedMesh, srgb};
use crate::Reason;
use crate::bytes::Cursor;
use ::gltf::json::{Image, Index, Root};
use ::gltf::{Document, Node, Primitive, Semantic};
use geometry::TriangleMesh;
use image::RgbImage;
use nalgebra::{Matrix4, Point3, Vector3};
use std::path::Path;

/// Nodes may hold nodes; a real file is nowhere near so deep, and a loop of nodes never ends.
const MAX_DEPTH: usize = 64;
/// The same mesh may stand in many nodes; more corners than this do not come from a file that can be shown.
const MAX_CORNERS: usize = 1 << 28;

pub(super) fn read(bytes: &[u8], folder: &Path) -> Result<LoadedMesh, Reason> {
    let (json, blob) = split(bytes)?;
    let document = document(json)?;
    let buffers = Buffers::load(&document, folder, blob)?;
    let scene = document.default_scene().or_else(|| document.scenes().next());
    let scene = scene.ok_or_else(|| Reason::syntax("has no scene"))?;
    let mut reader = SceneReader { buffers: &buffers, folder, parts: Vec::new(), corners: 0, textures: Vec::new() };
    for node in scene.nodes() {
        reader.node(&node, &Matrix4::identity(), 0)?;
    }
    let textures: Vec<RgbImage> = reader.textures.into_iter().map(|(_, picture)| picture).collect();
    join(reader.parts, &textures)
}

const CHUNK_JSON: &[u8; 4] = b"JSON";
const CHUNK_BIN: &[u8; 4] = b"BIN\0";

/// The JSON, and the binary chunk when there is one.
fn split(bytes: &[u8]) -> Result<(&[u8], Option<Vec<u8>>), Reason> {
    if !bytes.starts_with(b"glTF") {
        return Ok((bytes, None));
    }
    let mut cursor = Cursor::new(bytes);
    let _magic: [u8; 4] = cursor.array("the header")?;
    let version = u32::from_le_bytes(cursor.array("the header")?);
    if version != 2 {
        return Err(Reason::syntax(format!("glTF version {version}, where 2 is understood")));
    }
    let _length: [u8; 4] = cursor.array("the header")?;
    let mut chunk = |wanted: &[u8; 4], name| {
        let length = u32::from_le_bytes(cursor.array(name)?);
        let kind: [u8; 4] = cursor.array(name)?;
        if kind != *wanted {
            return Err(Reason::syntax(format!("no valid glTF: {name} is missing")));
        }
        cursor.take(length as usize, name)
    };
    let json = chunk(CHUNK_JSON, "the JSON chunk")?;
    let has_more = bytes.len() > 20 + json.len();
    let binary = has_more.then(|| chunk(CHUNK_BIN, "the binary chunk")).transpose()?;
    Ok((json, binary.map(<[u8]>::to_vec)))
}

/// The crate's validation leaves out two things that it relies on itself: the indices of attributes, which it uses to look at
/// the positions' bounds, and that a picture has a source.
fn document(json: &[u8]) -> Result<Document, Reason> {
    let invalid = |e: &dyn std::fmt::Display| Reason::syntax(format!("no valid glTF: {e}"));
    let root = Root::from_slice(json).map_err(|e| invalid(&e))?;
    let attributes = root.meshes.iter().flat_map(|mesh| &mesh.primitives).flat_map(|p| p.attributes.values());
    if let Some(bad) = attributes.map(Index::value).find(|&accessor| accessor >= root.accessors.len()) {
        return Err(invalid(&format!("accessor {bad} is named, but there are {}", root.accessors.len())));
    }
    let sourced = |image: &Image| match image.buffer_view {
        Some(_) => image.mime_type.is_some(),
        None => image.uri.is_some(),
    };
    if !root.images.iter().all(sourced) {
        return Err(invalid(&"a picture has no source, or no media type"));
    }
    Document::from_json(root).map_err(|e| invalid(&e))
}

struct SceneReader<'a> {
    buffers: &'a Buffers,
    folder: &'a Path,
    parts: Vec<Part>,
    corners: usize,
    /// Pictures by the index of the file.
    textures: Vec<(usize, RgbImage)>,
}

impl SceneReader<'_> {
    fn node(&mut self, node: &Node<'_>, scene_from_parent: &Matrix4<f32>, depth: usize) -> Result<(), Reason> {
        if depth > MAX_DEPTH {
            return Err(Reason::syntax(format!("its nodes are more than {MAX_DEPTH} deep, or hold themselves")));
        }
        let scene_from_node = scene_from_parent * Matrix4::from(node.transform().matrix());
        for primitive in node.mesh().iter().flat_map(|mesh| mesh.primitives()) {
            self.primitive(&primitive, &scene_from_node)?;
        }
        node.children().try_for_each(|child| self.node(&child, &scene_from_node, depth + 1))
    }

    fn primitive(&mut self, primitive: &Primitive<'_>, scene_from_node: &Matrix4<f32>) -> Result<(), Reason> {
        let material = primitive.material();
        let colour = material.pbr_metallic_roughness();
        let picture = colour.base_color_texture();
        let uv_set = picture.as_ref().map_or(0, |info| info.tex_coord());
        let mut mesh = self.attributes(primitive, uv_set)?;
        self.corners += mesh.triangles.len() * 3 + mesh.vertices.len();
        if self.corners > MAX_CORNERS {
            return Err(Reason::syntax(format!("more than {MAX_CORNERS} corners")));
        }
        transform(&mut mesh, scene_from_node);
        let [r, g, b, _] = colour.base_color_factor();
        let mut part = Part { mesh, base: Some([r, g, b].map(srgb::byte)), texture: None };
        if let Some(info) = picture {
            part.texture = Some(self.texture(&info.texture().source())?);
            if let Some(change) = info.texture_transform() {
                let (offset, scale, (sin, cos)) = (change.offset(), change.scale(), change.rotation().sin_cos());
                for uv in &mut part.mesh.uv {
                    let [u, v] = [uv[0] * scale[0], uv[1] * scale[1]];
                    *uv = [cos * u + sin * v + offset[0], cos * v - sin * u + offset[1]];
                }
            }
        }
        self.parts.push(part);
        Ok(())
    }

    fn attributes(&self, primitive: &Primitive<'_>, uv_set: u32) -> Result<TriangleMesh, Reason> {
        let floats = |semantic| primitive.get(&semantic).map(|a| self.buffers.floats(&a)).transpose();
        let positions = floats(Semantic::Positions)?.ok_or_else(|| Reason::syntax("a primitive has no POSITION"))?;
        let vertices: Vec<Point3<f32>> = positions.rows(3).map(|p| Point3::new(p[0], p[1], p[2])).collect();
        let normals = floats(Semantic::Normals)?;
        let colours = floats(Semantic::Colors(0))?;
        let uv = floats(Semantic::TexCoords(uv_set))?;
        let order: Vec<u32> = match primitive.indices() {
            Some(accessor) => self.buffers.integers(&accessor)?,
            None => (0..vertices.len() as u32).collect(),
        };
        Ok(TriangleMesh {
            normals: normals.map_or(Vec::new(), |n| n.rows(3).map(|n| Vector3::new(n[0], n[1], n[2])).collect()),
            colours: colours.map_or(Vec::new(), |c| c.rows(3).map(|c| [c[0], c[1], c[2]].map(srgb::byte)).collect()),
            uv: uv.map_or(Vec::new(), |t| t.rows(2).map(|t| [t[0], t[1]]).collect()),
            triangles: indices(primitive.mode(), &order),
            vertices,
        })
    }

    /// The number of a picture among those that were decoded.
    fn texture(&mut self, image: &::gltf::Image<'_>) -> Result<usize, Reason> {
        if let Some(number) = self.textures.iter().position(|(index, _)| *index == image.index()) {
            return Ok(number);
        }
        let picture = self.buffers.picture(image, self.folder)?;
        self.textures.push((image.index(), picture));
        Ok(self.textures.len() - 1)
    }
}

/// Into the scene; a mirroring node turns the triangles, so that they stay counter-clockwise seen from outside.
fn transform(mesh: &mut TriangleMesh, scene_from_node: &Matrix4<f32>) {
    let linear = scene_from_node.fixed_view::<3, 3>(0, 0).into_owned();
    let translation: Vector3<f32> = scene_from_node.fixed_view::<3, 1>(0, 3).into_owned();
    for vertex in &mut mesh.vertices {
        vertex.coords = linear * vertex.coords + translation;
    }
    match linear.try_inverse() {
        Some(inverse) => mesh.normals.iter_mut().for_each(|n| {
            let turned = inverse.transpose() * *n;
            *n = turned.try_normalize(0.0).unwrap_or(turned);
        }),
        None => mesh.normals.clear(),
    }
    if linear.determinant() < 0.0 {
        mesh.triangles.iter_mut().for_each(|t| t.swap(1, 2));
    }
}
