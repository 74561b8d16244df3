//! A surface as one GLB file (Khronos, "glTF 2.0 Specification", sections 3.6, 3.9, 4.4): metres, y up.

use super::srgb;
use crate::image_file::encode_png;
use crate::{FormatError, Reason, write_whole};
use geometry::TriangleMesh;
use image::RgbImage;
use serde_json::{Value, json};
use std::io::Write as _;
use std::path::Path;

const FLOAT: u32 = 5126;
const UNSIGNED_SHORT: u32 = 5123;
const UNSIGNED_INT: u32 = 5125;
const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;
const LINEAR: u32 = 9729;
const LINEAR_MIPMAP_LINEAR: u32 = 9987;
const CLAMP_TO_EDGE: u32 = 33071;
const CHUNK_JSON: u32 = 0x4e4f_534a;
const CHUNK_BIN: u32 = 0x004e_4942;

/// Writes a surface with all that it has, the texture embedded as PNG. The world's z up becomes glTF's y up:
/// (x, y, z) is written as (x, z, -y); [`read_z_up`](super::read_z_up) turns
/// it back.
pub fn write_glb(path: &Path, mesh: &TriangleMesh, texture: Option<&RgbImage>) -> Result<(), FormatError> {
    mesh.check().map_err(|e| Reason::from(e).of(path))?;
    let glb = build(mesh, texture.filter(|_| !mesh.uv.is_empty())).map_err(|reason| reason.of(path))?;
    write_whole(path, |out| Ok(out.write_all(&glb)?))
}

/// The world's axes in glTF's.
fn y_up([x, y, z]: [f32; 3]) -> [f32; 3] {
    [x, z, -y]
}

/// Bytes, and what the JSON says of them.
#[derive(Default)]
struct Binary {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl Binary {
    /// Every view begins on four bytes, as the largest of its numbers does.
    fn view(&mut self, bytes: &[u8], target: Option<u32>) -> usize {
        let mut view = json!({"buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len()});
        if let Some(target) = target {
            view["target"] = json!(target);
        }
        self.bytes.extend_from_slice(bytes);
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        self.views.push(view);
        self.views.len() - 1
    }

    fn accessor<T: bytemuck::NoUninit>(&mut self, values: &[T], target: u32, mut accessor: Value) -> usize {
        accessor["bufferView"] = json!(self.view(bytemuck::cast_slice(values), Some(target)));
        accessor["count"] = json!(values.len());
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }
}

fn build(mesh: &TriangleMesh, texture: Option<&RgbImage>) -> Result<Vec<u8>, Reason> {
    let mut binary = Binary::default();
    let mut attributes = json!({"POSITION": positions(&mut binary, mesh)});
    if !mesh.normals.is_empty() {
        let normals: Vec<[f32; 3]> = mesh.normals.iter().map(|n| y_up(unit(*n).into())).collect();
        let accessor = json!({"componentType": FLOAT, "type": "VEC3"});
        attributes["NORMAL"] = json!(binary.accessor(&normals, ARRAY_BUFFER, accessor));
    }
    if texture.is_some() {
        let accessor = json!({"componentType": FLOAT, "type": "VEC2"});
        attributes["TEXCOORD_0"] = json!(binary.accessor(&mesh.uv, ARRAY_BUFFER, accessor));
    } else if !mesh.colours.is_empty() {
        // Vertex colours are light, not display values; eight bits of light would band in the dark.
        let light = |c| (srgb::linear(c) * 65535.0).round() as u16;
        let colours: Vec<[u16; 4]> =
            mesh.colours.iter().map(|&[r, g, b]| [light(r), light(g), light(b), 65535]).collect();
        let accessor = json!({"componentType": UNSIGNED_SHORT, "type": "VEC4", "normalized": true});
        attributes["COLOR_0"] = json!(binary.accessor(&colours, ARRAY_BUFFER, accessor));
    }
    let triangles: &[u32] = bytemuck::cast_slice(&mesh.triangles);
    let indices =
        binary.accessor(triangles, ELEMENT_ARRAY_BUFFER, json!({"componentType": UNSIGNED_INT, "type": "SCALAR"}));
    let mut root = json!({
        "asset": {"version": "2.0", "generator": concat!("limn ", env!("CARGO_PKG_VERSION"))},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, "name": "scan"}],
        "meshes": [{"primitives": [{"attributes": attributes, "indices": indices, "material": 0}]}],
        // A scanned surface is dull: what gloss there was is in its colours already.
        "materials": [{"pbrMetallicRoughness": {"metallicFactor": 0.0, "roughnessFactor": 1.0}}],
    });
    if let Some(texture) = texture {
        let mut png = Vec::new();
        encode_png(&mut png, texture)?;
        let view = binary.view(&png, None);
        root["images"] = json!([{"bufferView": view, "mimeType": "image/png"}]);
        let filters = json!({"magFilter": LINEAR, "minFilter": LINEAR_MIPMAP_LINEAR});
        root["samplers"] = json!([filters]);
        root["samplers"][0]["wrapS"] = json!(CLAMP_TO_EDGE);
        root["samplers"][0]["wrapT"] = json!(CLAMP_TO_EDGE);
        root["textures"] = json!([{"sampler": 0, "source": 0}]);
        root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = json!({"index": 0});
    }
    root["bufferViews"] = Value::from(binary.views);
    root["accessors"] = Value::from(binary.accessors);
    root["buffers"] = json!([{"byteLength": binary.bytes.len()}]);
    container(&root, &binary.bytes)
}

fn positions(binary: &mut Binary, mesh: &TriangleMesh) -> usize {
    let positions: Vec<[f32; 3]> = mesh.vertices.iter().map(|&p| y_up(p.into())).collect();
    let bound = |pick: fn(f32, f32) -> f32| -> [f32; 3] {
        let first = positions.first().copied().unwrap_or_default();
        positions.iter().fold(first, |bound, p| std::array::from_fn(|axis| pick(bound[axis], p[axis])))
    };
    let accessor = json!({"componentType": FLOAT, "type": "VEC3", "min": bound(f32::min), "max": bound(f32::max)});
    binary.accessor(&positions, ARRAY_BUFFER, accessor)
}

/// glTF insists on unit normals; one that has no direction points up.
fn unit(normal: nalgebra::Vector3<f32>) -> nalgebra::Vector3<f32> {
    normal.try_normalize(0.0).filter(|n| n.iter().all(|c| c.is_finite())).unwrap_or_else(nalgebra::Vector3::z)
}

/// Header, JSON padded with spaces, bytes.
fn container(root: &Value, binary: &[u8]) -> Result<Vec<u8>, Reason> {
    let mut json = root.to_string().into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let total = 12 + 8 + json.len() + 8 + binary.len();
    let length = |bytes: usize| {
        u32::try_from(bytes).map_err(|_| Reason::syntax("larger than the 4 GB that a GLB file can have"))
    };
    let mut glb = Vec::with_capacity(total);
    glb.extend_from_slice(b"glTF");
    for word in [2, length(total)?, length(json.len())?, CHUNK_JSON] {
        glb.extend_from_slice(&word.to_le_bytes());
    }
    glb.extend_from_slice(&json);
    for word in [length(binary.len())?, CHUNK_BIN] {
        glb.extend_from_slice(&word.to_le_bytes());
    }
    glb.extend_from_slice(binary);
    Ok(glb)
}
