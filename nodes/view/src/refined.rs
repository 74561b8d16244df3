//! Draws what a refinement says of itself: the ways, the pictures on them, plots and a page of facts.

use crate::evidence::{Plotted, SERIES, is_final, summary};
use crate::show::{REFINED, TRAIL};
use crate::ways::Ways;
use rerun::components::MarkerShape;
use rerun::{LineStrips3D, Points3D, RecordingStream, Scalars, SeriesPoints, TextDocument, TimeColumn};
use wire::{FrameFit, Refinement};

/// Of the refined way's samples, which are as dense as the hand trembles.
const DRAWN_EVERY: usize = 10;
/// Of the plots, in the order of [`SERIES`].
const COLOURS: [[u8; 3]; 4] = [TRAIL, REFINED, MISFIT, UNHELD];
const MISFIT: [u8; 3] = [230, 40, 40];
const UNHELD: [u8; 3] = [200, 110, 230];

/// How the plots look, whatever is in them.
pub(crate) fn styles(rec: &RecordingStream) -> anyhow::Result<()> {
    for (name, colour) in SERIES.into_iter().zip(COLOURS) {
        let (marker, size) =
            if name.starts_with("left out") { (MarkerShape::Cross, 4.0) } else { (MarkerShape::Circle, 1.0) };
        for kind in KINDS {
            let style = SeriesPoints::new().with_colors([colour]).with_markers([marker]).with_marker_sizes([size]);
            rec.log_static(plot(kind, name), &style.with_names([format!("{name}, mm")]))?;
        }
    }
    Ok(())
}

const KINDS: [&str; 2] = ["live", "final"];

fn plot(kind: &str, name: &str) -> String {
    format!("refine/frames/{kind}/{}", name.replace([' ', ','], "_"))
}

/// Everything of one revision.
pub(crate) fn refined(
    rec: &RecordingStream,
    ways: &Ways,
    evidence: &Refinement,
    plotted: &mut Plotted,
) -> anyhow::Result<()> {
    draw_ways(rec, ways, evidence)?;
    rec.log("refine/facts", &TextDocument::from_markdown(summary(evidence)))?;
    let value = |path: &str, value: f64| rec.log(format!("refine/{path}"), &Scalars::single(value));
    value("fit/before_mm", evidence.residual_before_m * 1e3)?;
    value("fit/now_mm", evidence.residual_after_m * 1e3)?;
    let [offset, sigma] = [evidence.pose_offset_error_nanos, evidence.pose_offset_sigma_nanos].map(|n| n as f64 * 1e-6);
    value("offset/ms", offset)?;
    value("offset/plus_sigma_ms", offset + sigma)?;
    value("offset/minus_sigma_ms", offset - sigma)?;
    value("left_out/fits_nowhere", evidence.misfits.len() as f64)?;
    value("left_out/held_by_nothing", evidence.unheld.len() as f64)?;
    if let Some(observed) = &evidence.observed {
        value("observed/crossing", observed.crossing)?;
        value("observed/held_of_six", f64::from(observed.held_directions) / 6.0)?;
    }
    let kind = KINDS[usize::from(is_final(evidence))];
    for series in plotted.newer(evidence).into_iter().filter(|series| !series.values_mm.is_empty()) {
        let stamps = TimeColumn::new_duration_nanos("scan", series.stamps_nanos);
        let values = Scalars::new(series.values_mm).columns_of_unit_batches()?;
        rec.send_columns(plot(kind, series.name), [stamps], values)?;
    }
    Ok(())
}

/// The tracker's way, the refined one, and the pictures on it: green to red as they misfit, those that were left out large.
fn draw_ways(rec: &RecordingStream, ways: &Ways, evidence: &Refinement) -> rerun::RecordingStreamResult<()> {
    let line = |places: Vec<[f32; 3]>, colour| LineStrips3D::new([places]).with_colors([colour]).with_radii([4e-4]);
    rec.log("way/tracker", &line(ways.by_tracker().to_vec(), TRAIL))?;
    rec.log("way/refined", &line(ways.by_refinement(DRAWN_EVERY), REFINED))?;
    let (places, colours): (Vec<_>, Vec<_>) = ways.pictures(&evidence.frames).into_iter().unzip();
    rec.log("way/pictures", &Points3D::new(places).with_colors(colours).with_radii([1.2e-3]))?;
    let left_out = |name: &str, fits: &[FrameFit], colour: [u8; 3]| {
        let (places, _): (Vec<_>, Vec<_>) = ways.pictures(fits).into_iter().unzip();
        let labels = vec![name.replace('_', " "); places.len()];
        let points = Points3D::new(places).with_colors([colour]).with_radii([3e-3]);
        // The reason shows under the pointer.
        rec.log(format!("way/left_out/{name}"), &points.with_labels(labels).with_show_labels(false))
    };
    left_out("fits_nowhere", &evidence.misfits, MISFIT)?;
    left_out("held_by_nothing", &evidence.unheld, UNHELD)
}
