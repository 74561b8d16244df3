//! The model beside the truth, from four sides, and where it errs.

use super::chart;
use crate::albedo::albedo;
use crate::data_uri::png_uri;
use crate::{Exhibits, PageError, View, error_map, four_views, four_views_from_below, render};
use formats::mesh::LoadedMesh;
use geometry::{METRES_PER_MM, TriangleMesh};
use image::RgbaImage;
use std::borrow::Cow;

const WIDTH: u32 = 420;
const HEIGHT: u32 = 340;
/// Albedo of a surface without colours.
const PLASTER: [f32; 3] = [0.62, 0.60, 0.56];
/// Albedo of what nobody measured.
const ORANGE: [f32; 3] = [0.80, 0.33, 0.06];

/// The pictures, row by row: truth, before refinement, model, shape alone, what of it was guessed, error map, residuals,
/// expected error; what is missing is left out. The views are chosen by the truth, or by the model when there is none.
pub fn gallery(exhibits: &Exhibits<'_>, end_mm: f64) -> Result<String, PageError> {
    let Some(framing) = exhibits.truth.or(exhibits.model) else { return Ok(String::new()) };
    let views = four_views(&framing.mesh, WIDTH, HEIGHT);
    let mut rows = String::new();
    if let Some(truth) = exhibits.truth {
        rows.push_str(&row("Truth", "", &painted(truth, &views))?);
    }
    if let Some(before) = exhibits.before {
        let caption = "What the tracker alone would have given.";
        rows.push_str(&row("Before refinement", caption, &plaster(&before.mesh, &views))?);
    }
    if let Some(model) = exhibits.model {
        rows.push_str(&row("Model", "", &painted(model, &views))?);
        rows.push_str(&row("Shape", "The model without its colours.", &plaster(&model.mesh, &views))?);
        if let Some(measured) = exhibits.measured.filter(|&measured| measured < model.mesh.triangles.len()) {
            let caption = "The shape from below: over what is orange nobody measured anything; it closes the model.";
            rows.push_str(&row("Guessed", caption, &guessed(&model.mesh, measured))?);
        }
    }
    rows.push_str(&maps(exhibits, &views, end_mm)?);
    Ok(format!("<section class=\"gallery\">{rows}</section>"))
}

/// What is shown as colours of one scale, which stands beside the first of them.
fn maps(exhibits: &Exhibits<'_>, views: &[View], end_mm: f64) -> Result<String, PageError> {
    let mut maps: Vec<(&str, &str, Vec<RgbaImage>)> = Vec::new();
    if let (Some(surface), Some(truth)) = (measured_surface(exhibits), exhibits.truth) {
        let pictures = error_pictures(&surface, &truth.mesh, views, end_mm)?;
        let caption = "Distance of what was measured from the truth: blue is inside, red outside.";
        maps.push(("Error", caption, pictures));
    }
    if let Some((mesh, residual_m)) = exhibits.residual {
        let caption =
            "How far the measured points lie off the surface, about each place: rms, on the red half of the scale.";
        maps.push(("Residuals", caption, size_pictures(mesh, residual_m, views, end_mm)));
    }
    if let Some((mesh, sigma_m)) = exhibits.stated {
        let caption =
            "What the scan itself says of its error: one standard deviation, on the red half of the same scale.";
        maps.push(("Expected error", caption, size_pictures(mesh, sigma_m, views, end_mm)));
    }
    let mut rows = String::new();
    for (i, (name, caption, pictures)) in maps.iter().enumerate() {
        let scale = if i == 0 { chart::legend(end_mm) } else { String::new() };
        rows.push_str(&row(name, &format!("{caption}{scale}"), pictures)?);
    }
    Ok(rows)
}

/// What was measured of the model, without what closes it: the error beside the expected one is that of the same surface.
fn measured_surface<'a>(exhibits: &Exhibits<'a>) -> Option<Cow<'a, TriangleMesh>> {
    if let Some((surface, _)) = exhibits.stated.or(exhibits.residual) {
        return Some(Cow::Borrowed(surface));
    }
    let mesh = &exhibits.model?.mesh;
    let measured = exhibits.measured.unwrap_or(mesh.triangles.len()).min(mesh.triangles.len());
    if measured == mesh.triangles.len() {
        return Some(Cow::Borrowed(mesh));
    }
    let triangles = mesh.triangles[..measured].to_vec();
    Some(Cow::Owned(TriangleMesh { triangles, ..mesh.clone() }))
}

fn row(name: &str, caption: &str, pictures: &[RgbaImage]) -> Result<String, PageError> {
    let mut images = String::new();
    for (i, picture) in pictures.iter().enumerate() {
        let uri = png_uri(picture)?;
        images.push_str(&format!(
            "<img src=\"{uri}\" width=\"{WIDTH}\" height=\"{HEIGHT}\" alt=\"{name}, view {}\">",
            i + 1
        ));
    }
    let caption = if caption.is_empty() { String::new() } else { format!("<span>{caption}</span>") };
    Ok(format!("<figure><figcaption><b>{name}</b>{caption}</figcaption><div class=\"views\">{images}</div></figure>"))
}

fn painted(surface: &LoadedMesh, views: &[View]) -> Vec<RgbaImage> {
    let colour = |triangle, weights| albedo(surface, triangle, weights).unwrap_or(PLASTER);
    views.iter().map(|view| render(&surface.mesh, view, colour)).collect()
}

fn plaster(mesh: &TriangleMesh, views: &[View]) -> Vec<RgbaImage> {
    views.iter().map(|view| render(mesh, view, |_, _| PLASTER)).collect()
}

fn guessed(mesh: &TriangleMesh, measured: usize) -> Vec<RgbaImage> {
    let colour = |triangle: u32, _| if (triangle as usize) < measured { PLASTER } else { ORANGE };
    four_views_from_below(mesh, WIDTH, HEIGHT).iter().map(|view| render(mesh, view, colour)).collect()
}

/// Sizes (never negative) of the vertices as colours; a triangle takes those of its corners that have one.
fn size_pictures(mesh: &TriangleMesh, size_m: &[f32], views: &[View], end_mm: f64) -> Vec<RgbaImage> {
    let size_mm = |i: u32| size_m.get(i as usize).map_or(f64::NAN, |size| f64::from(*size) / METRES_PER_MM);
    let colour = |triangle: u32, weights: [f64; 3]| {
        let corners = mesh.triangles[triangle as usize].map(size_mm);
        let known = corners.iter().zip(weights).filter(|(size, _)| size.is_finite());
        let (sum, weight) = known.fold((0.0, 0.0), |(sum, all), (size, w)| (sum + size * w, all + w));
        if weight > 0.0 { error_map::colour(sum / weight, end_mm) } else { PLASTER }
    };
    views.iter().map(|view| render(mesh, view, colour)).collect()
}

fn error_pictures(
    model: &TriangleMesh,
    truth: &TriangleMesh,
    views: &[View],
    end_mm: f64,
) -> Result<Vec<RgbaImage>, PageError> {
    let distances = error_map::vertex_distances_mm(model, truth)?;
    let colour = |triangle: u32, weights: [f64; 3]| {
        let corners = model.triangles[triangle as usize].map(|i| distances[i as usize]);
        error_map::colour(corners.iter().zip(weights).map(|(d, w)| d * w).sum(), end_mm)
    };
    Ok(views.iter().map(|view| render(model, view, colour)).collect())
}
