//! One function a message: what of it the operator sees, and where.

use crate::cloud::ChunkedCloud;
use crate::handset::handset;
use crate::picture::Picture;
use rerun::{
    Boxes3D, ImageFormat, LineStrips3D, Mesh3D, Pinhole, Points2D, Points3D, Quaternion, RecordingStream, Scalars,
    TextLog, Transform3D, ViewCoordinates,
};
use wire::{Calibration, Header, Health, LogLevel, LogLine, Mesh, Model, Scan, Stripe, Trajectory};

type Result = rerun::RecordingStreamResult<()>;

/// Red, green, blue.
const LASER_RED: [u8; 3] = [255, 60, 40];
const CLAY: [u8; 3] = [196, 178, 158];
pub(crate) const TRAIL: [u8; 3] = [90, 150, 220];
pub(crate) const REFINED: [u8; 3] = [70, 190, 110];
const HOUSING: [u8; 3] = [120, 124, 130];
/// Seen through: the thing behind it is what counts.
const LIGHT: [u8; 4] = [255, 60, 40, 60];

/// All that follows was measured at this stamp.
pub(crate) fn at(rec: &RecordingStream, header: &Header) {
    // A tracker speaks before the scan begins, too: the stamp may be below 0.
    rec.set_time("scan", rerun::TimeCell::from_duration_nanos(header.stamp_nanos));
}

pub(crate) fn world(rec: &RecordingStream) -> Result {
    rec.log_static("world", &ViewCoordinates::RIGHT_HAND_Z_UP())
}

pub(crate) fn calibration(rec: &RecordingStream, calibration: &Calibration, shrunk_by: u32) -> Result {
    let (camera, by) = (&calibration.camera, f64::from(shrunk_by));
    let focal = [(camera.fx / by) as f32, (camera.fy / by) as f32];
    let size = [(camera.width / shrunk_by) as f32, (camera.height / shrunk_by) as f32];
    let pinhole = Pinhole::from_focal_length_and_resolution(focal, size)
        .with_principal_point([(camera.cx / by) as f32, (camera.cy / by) as f32])
        .with_camera_xyz(rerun::components::ViewCoordinates::RDF)
        .with_image_plane_distance(0.06);
    rec.log_static("world/camera", &pinhole)?;
    // Beside the camera, not below it: what is below a pinhole is drawn in its picture.
    let Some(handset) = handset(&calibration.laser) else { return Ok(()) };
    let [middle, half] = handset.housing;
    let housing = Boxes3D::from_centers_and_half_sizes([middle], [half]).with_colors([HOUSING]).with_radii([0.0004]);
    rec.log_static("world/handset/housing", &housing.with_fill_mode(rerun::FillMode::Solid))?;
    let sheet = Mesh3D::new(handset.sheet).with_triangle_indices([[0, 1, 2], [0, 2, 1]]);
    rec.log_static(
        "world/handset/sheet",
        &sheet.with_albedo_factor(rerun::Rgba32::from_unmultiplied_rgba(LIGHT[0], LIGHT[1], LIGHT[2], LIGHT[3])),
    )
}

pub(crate) fn picture(rec: &RecordingStream, picture: &Picture) -> Result {
    let image = rerun::Image::new(picture.rgb.clone(), ImageFormat::rgb8([picture.width, picture.height]));
    rec.log("world/camera/picture", &image)
}

pub(crate) fn stripe(rec: &RecordingStream, stripe: &Stripe, shrunk_by: u32) -> Result {
    let by = shrunk_by as f32;
    let best = stripe.peaks.iter().filter(|peak| peak.is_best());
    let points =
        Points2D::new(best.map(|peak| [peak.u_px / by, peak.v_px / by])).with_colors([LASER_RED]).with_radii([1.0]);
    rec.log("world/camera/picture/stripe", &points)
}

pub(crate) fn trajectory(rec: &RecordingStream, trajectory: &Trajectory, trail: &mut Vec<[f32; 3]>) -> Result {
    let Some(last) = trajectory.samples.last() else { return Ok(()) };
    let [w, x, y, z] = last.rotation_wxyz.map(|q| q as f32);
    let place = last.translation_m.map(|t| t as f32);
    let pose = Transform3D::from_translation_rotation(place, Quaternion::from_xyzw([x, y, z, w]));
    rec.log("world/camera", &pose)?;
    rec.log("world/handset", &pose)?;
    // The trail of the last seconds shows the stroke; the whole of it would hide the thing.
    trail.push(place);
    let start = trail.len().saturating_sub(200);
    trail.drain(..start);
    rec.log("world/trail", &LineStrips3D::new([trail.clone()]).with_colors([TRAIL]).with_radii([0.0004]))
}

pub(crate) fn scan(rec: &RecordingStream, scan: &Scan) -> Result {
    let points = Points3D::new(scan.points.iter().map(|p| p.position_m)).with_colors([LASER_RED]).with_radii([0.0006]);
    rec.log("world/stripe", &points)
}

pub(crate) fn cloud(rec: &RecordingStream, cloud: &mut ChunkedCloud) -> Result {
    for (number, balls) in cloud.changes() {
        let colours = balls.iter().map(|ball| match ball.colour {
            [r, g, b, 255] => [r, g, b],
            _ => by_count(ball.count),
        });
        let points = Points3D::new(balls.iter().map(|ball| ball.position_m)).with_colors(colours).with_radii([0.0005]);
        rec.log(format!("world/cloud/{number:03}"), &points)?;
    }
    Ok(())
}

/// Seen once is orange, seen often is green: what still needs another stroke shows by itself.
fn by_count(count: u32) -> [u8; 3] {
    let often = (f64::from(count).ln() / 30f64.ln()).clamp(0.0, 1.0);
    [(230.0 - 150.0 * often) as u8, (120.0 + 80.0 * often) as u8, 70]
}

/// A surface without colours yet.
pub(crate) fn bare(rec: &RecordingStream, mesh: &Mesh) -> Result {
    let shape = Mesh3D::new(mesh.vertices_m.iter().copied())
        .with_vertex_normals(mesh.normals.iter().copied())
        .with_triangle_indices(mesh.triangles.iter().copied())
        .with_albedo_factor(CLAY);
    rec.log("world/surface", &rerun::Clear::flat())?;
    rec.log("world/bare", &shape)
}

/// How large it is.
pub(crate) fn bounds(rec: &RecordingStream, mesh: &Mesh) -> Result {
    let Some([low, high]) = geometry::TriangleMesh::from(mesh).bounds() else { return Ok(()) };
    let half = (high - low) * 0.5;
    let box_around =
        Boxes3D::from_centers_and_half_sizes([<[f32; 3]>::from((low + half).coords)], [<[f32; 3]>::from(half)]);
    let millimetres = (half * 2000.0).map(|edge| edge.round());
    let label = format!("{} x {} x {} mm", millimetres.x, millimetres.y, millimetres.z);
    rec.log(
        "world/bounds",
        &box_around
            .with_colors([TRAIL])
            .with_radii([0.0002])
            .with_labels([label])
            .with_fill_mode(rerun::FillMode::MajorWireframe),
    )
}

/// A surface with its colours: so far, or in the end, when the points have had their say.
pub(crate) fn model(rec: &RecordingStream, model: &Model) -> Result {
    let rgb: Vec<u8> = model.texture.iter().flat_map(|texel| [texel[0], texel[1], texel[2]]).collect();
    let painted = Mesh3D::new(model.mesh.vertices_m.iter().copied())
        .with_vertex_normals(model.mesh.normals.iter().copied())
        .with_triangle_indices(model.mesh.triangles.iter().copied())
        .with_vertex_texcoords(model.uv.iter().copied())
        .with_albedo_texture_format(ImageFormat::rgb8([model.texture_width, model.texture_height]))
        .with_albedo_texture_buffer(rgb);
    rec.log("world/surface", &painted)?;
    rec.log("world/bare", &rerun::Clear::flat())?;
    if model.header.is_end() {
        rec.log("world/cloud", &rerun::Clear::recursive())?;
    }
    Ok(())
}

/// Rates from the counts of two reports.
pub(crate) fn health(rec: &RecordingStream, now: &Health, before: Option<&Health>, seconds: f64) -> Result {
    let node = now.node.replace('/', "_");
    let value = |plot: &str, value: f64| rec.log(format!("plots/{plot}/{node}"), &Scalars::single(value));
    value("latency_ms", now.latency_p50_nanos as f64 * 1e-6)?;
    value("lost", now.inputs.iter().map(|input| input.lost as f64).sum())?;
    match before {
        Some(before) if seconds > 0.0 => value("rate", now.published.saturating_sub(before.published) as f64 / seconds),
        _ => Ok(()),
    }
}

pub(crate) fn log(rec: &RecordingStream, line: &LogLine) -> Result {
    let level = match line.level {
        LogLevel::Error => "ERROR",
        LogLevel::Warn => "WARN",
        LogLevel::Info => "INFO",
        LogLevel::Debug => "DEBUG",
    };
    rec.log("log", &TextLog::new(format!("{}: {}", line.node, line.text)).with_level(level))
}
