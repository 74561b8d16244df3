//! The model beside the truth, from four sides, and where it errs.

use super::chart;
use crate::albedo::albedo;
use crate::data_uri::png_uri;
use crate::{Exhibits, PageError, View, error_map, four_views, render};
use formats::mesh::LoadedMesh;
use geometry::{METRES_PER_MM, TriangleMesh};
use image::RgbaImage;

const WIDTH: u32 = 420;
const HEIGHT: u32 = 340;
/// Albedo of a surface without colours.
const PLASTER: [f32; 3] = [0.62, 0.60, 0.56];

/// The pictures, row by row: truth, before refinement, model, shape alone, error map, expected error; what is missing is
/// left out. The views are chosen by the truth, or by the model when there is none.
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
        if let Some(truth) = exhibits.truth {
            let map = error_pictures(&model.mesh, &truth.mesh, &views, end_mm)?;
            let text = "Distance of the model from the truth: blue is inside, red outside.";
            rows.push_str(&row("Error", &format!("{text}{}", chart::legend(end_mm)), &map)?);
        }
    }
    if let Some((mesh, sigma_m)) = exhibits.stated {
        let caption =
            "What the scan itself says of its error: one standard deviation, on the red half of the same scale.";
        rows.push_str(&row("Expected error", caption, &stated_pictures(mesh, sigma_m, &views, end_mm))?);
    }
    Ok(format!("<section class=\"gallery\">{rows}</section>"))
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

fn stated_pictures(mesh: &TriangleMesh, sigma_m: &[f32], views: &[View], end_mm: f64) -> Vec<RgbaImage> {
    let sigma_mm = |i: u32| sigma_m.get(i as usize).map_or(0.0, |sigma| f64::from(*sigma) / METRES_PER_MM);
    let colour = |triangle: u32, weights: [f64; 3]| {
        let corners = mesh.triangles[triangle as usize].map(sigma_mm);
        error_map::colour(corners.iter().zip(weights).map(|(d, w)| d * w).sum(), end_mm)
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
