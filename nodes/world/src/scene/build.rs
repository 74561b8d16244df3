//! From a scene file to surfaces.

use super::error::SceneError;
use super::file::{ALL, Kind, ObjectSection, SceneFile, TableSection, Up};
use super::table::table;
use super::{Scene, Surface, Texture};
use crate::shape::{cow, primitive};
use geometry::{METRES_PER_MM, TriangleMesh};
use nalgebra::{Point3, Rotation3, Vector3};
use std::path::Path;

/// Sizes that a hand scanner at 20 cm can make sense of.
const SIZES_MM: std::ops::RangeInclusive<f64> = 10.0..=2000.0;

/// All surfaces of a scene; the subject is the first.
pub fn build(file: &SceneFile, folder: &Path) -> Result<Scene, SceneError> {
    if !(0.0..=100.0).contains(&file.ambient) {
        return Err(value("scene", "ambient", &file.ambient, "0 (dark) to 100"));
    }
    file.hand.check()?;
    let objects = file.objects.iter().map(|section| object(section, folder)).collect::<Result<Vec<_>, _>>()?;
    let mut surfaces = subject_first(objects, &file.subject)?;
    let mut table_at = None;
    if let Some(section) = &file.table {
        check_table(section)?;
        table_at = Some(surfaces.len());
        surfaces.push(table(section));
    }
    Ok(Scene { surfaces, subject: 0, table: table_at, ambient: file.ambient, hand: file.hand })
}

fn value(object: &str, key: &'static str, value: &impl std::fmt::Debug, wanted: &'static str) -> SceneError {
    SceneError::Value { object: object.to_owned(), key, value: format!("{value:?}"), wanted }
}

fn check_table(section: &TableSection) -> Result<(), SceneError> {
    if section.size_mm.iter().all(|side| SIZES_MM.contains(side)) {
        return Ok(());
    }
    Err(value("table", "size_mm", &section.size_mm, "10 to 2000 mm along each side"))
}

fn subject_first(mut objects: Vec<Surface>, subject: &str) -> Result<Vec<Surface>, SceneError> {
    if objects.is_empty() {
        return Err(SceneError::Empty);
    }
    if let Some(at) = objects.iter().position(|object| object.name == subject) {
        objects.swap(0, at);
        return Ok(objects);
    }
    if subject != ALL {
        let names = objects.into_iter().map(|object| object.name).collect();
        return Err(SceneError::Subject { subject: subject.to_owned(), names });
    }
    let mut objects = objects.into_iter();
    let Some(mut merged) = objects.next() else { return Err(SceneError::Empty) };
    for object in objects {
        if let Some(textured) = [&merged, &object].into_iter().find(|surface| surface.texture.is_some()) {
            return Err(SceneError::Merge { object: textured.name.clone() });
        }
        ensure_colours(&mut merged.mesh);
        let mut mesh = object.mesh;
        ensure_colours(&mut mesh);
        merged.mesh.append(&mesh);
        merged.name = ALL.to_owned();
    }
    Ok(vec![merged])
}

/// What has no colour of its own.
const GREY: [u8; 3] = [188; 3];

fn ensure_colours(mesh: &mut TriangleMesh) {
    if mesh.colours.is_empty() {
        mesh.colours = vec![GREY; mesh.vertices.len()];
    }
    mesh.uv.clear();
}

fn object(section: &ObjectSection, folder: &Path) -> Result<Surface, SceneError> {
    let name = section.name.clone().unwrap_or_else(|| format!("{:?}", section.kind).to_lowercase());
    let on_table = section.at_mm.iter().chain([&section.lift_mm]).all(|place| place.abs() <= *SIZES_MM.end());
    if !on_table || section.lift_mm < 0.0 || !(-360.0..=360.0).contains(&section.yaw_deg) {
        let place = (section.at_mm, section.lift_mm, section.yaw_deg);
        let wanted = "within 2000 mm of the table's middle, not below it, -360 to 360 degrees";
        return Err(value(&name, "at_mm, lift_mm, yaw_deg", &place, wanted));
    }
    if section.size_mm != 0.0 && !SIZES_MM.contains(&section.size_mm) {
        return Err(value(&name, "size_mm", &section.size_mm, "10 to 2000 mm"));
    }
    if !section.sides_mm.iter().all(|side| SIZES_MM.contains(side)) {
        return Err(value(&name, "sides_mm", &section.sides_mm, "10 to 2000 mm along each side"));
    }
    if !(1.0..=*SIZES_MM.end()).contains(&section.pattern_mm) {
        return Err(value(&name, "pattern_mm", &section.pattern_mm, "1 to 2000 mm"));
    }
    let shine = [section.specular, section.shininess];
    if !shine.iter().all(|x| (0.0..=1000.0).contains(x)) {
        return Err(value(&name, "specular, shininess", &shine, "0 to 1000"));
    }
    let (mesh, texture) = model(section, &name, folder)?;
    let mesh = stand(mesh, section, &name)?;
    Ok(Surface { name, mesh, texture, specular: section.specular, shininess: section.shininess })
}

/// The object in its own frame, in any unit.
fn model(section: &ObjectSection, name: &str, folder: &Path) -> Result<(TriangleMesh, Option<Texture>), SceneError> {
    let wrong_file = || SceneError::File { object: name.to_owned() };
    let ObjectSection { sides_mm, pattern, pattern_mm, colours, .. } = *section;
    match (section.kind, &section.file) {
        (Kind::Mesh, None) => Err(wrong_file()),
        (Kind::Mesh, Some(file)) => load(&folder.join(file)),
        (_, Some(_)) => Err(wrong_file()),
        (Kind::Cow, None) => Ok((cow(), None)),
        (Kind::Primitive(kind), None) => Ok((primitive(kind, sides_mm, pattern, pattern_mm, colours), None)),
    }
}

fn load(path: &Path) -> Result<(TriangleMesh, Option<Texture>), SceneError> {
    let formats::mesh::LoadedMesh { mesh, texture } = formats::mesh::read(path)?;
    if mesh.bounds().is_none_or(|[low, high]| (high - low).max() <= 0.0) {
        return Err(SceneError::Point { path: path.to_owned() });
    }
    let texture = texture.map(|picture| Texture {
        width: picture.width() as usize,
        height: picture.height() as usize,
        rgb: picture.pixels().map(|pixel| pixel.0).collect(),
    });
    Ok((mesh, texture))
}

/// As the section says; else glTF prescribes y up, and what comes from scanners and printers has z up.
fn y_is_up(section: &ObjectSection) -> bool {
    let ending = section.file.as_deref().and_then(Path::extension).unwrap_or_default().to_ascii_lowercase();
    section.up.map_or(ending == "glb" || ending == "gltf", |up| up == Up::Y)
}

/// Scaled, turned, and set on the table, the middle of its box at its place.
fn stand(mut mesh: TriangleMesh, section: &ObjectSection, name: &str) -> Result<TriangleMesh, SceneError> {
    let upright = if y_is_up(section) { std::f64::consts::FRAC_PI_2 } else { 0.0 };
    let turn = Rotation3::from_euler_angles(upright, 0.0, section.yaw_deg.to_radians()).cast::<f32>();
    let largest = mesh.bounds().map_or(0.0, |[low, high]| f64::from((high - low).max()));
    let modelled = section.kind != Kind::Mesh;
    let scale = match section.size_mm {
        0.0 if modelled => METRES_PER_MM,
        0.0 => return Err(value(name, "size_mm", &0.0, "a mesh from a file must say how large it is")),
        size_mm => size_mm * METRES_PER_MM / largest,
    };
    mesh.vertices.iter_mut().for_each(|p| *p = turn * Point3::from(p.coords.scale(scale as f32)));
    mesh.normals.iter_mut().for_each(|n| *n = turn * *n);
    let Some([low, high]) = mesh.bounds() else { return Err(SceneError::Empty) };
    let [x, y] = section.at_mm.map(|mm| (mm * METRES_PER_MM) as f32);
    let lift = (section.lift_mm * METRES_PER_MM) as f32;
    let shift = Vector3::new(x - 0.5 * (low.x + high.x), y - 0.5 * (low.y + high.y), lift - low.z);
    mesh.vertices.iter_mut().for_each(|p| *p += shift);
    Ok(mesh)
}
