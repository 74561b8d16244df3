//! The result in the terminal.

use crate::live::print as write;
use anyhow::Result;
use report::Report;
use std::fmt::Write as _;
use std::path::Path;

/// Prints the numbers that matter, and where the rest is.
pub fn print(report: &Report, out: &Path) -> Result<()> {
    let mut text = String::from("\n");
    let mut row = |what: &str, value: String| {
        // A String takes all text.
        let _ = writeln!(text, "  {what:<34} {value}");
    };
    row("points", report.counts.points.to_string());
    row("balls", report.counts.cloud_points.to_string());
    row("triangles", report.counts.triangles.to_string());
    row("area covered", format!("{:.0} mm2", report.counts.area_mm2));
    if let Some(comparison) = &report.comparison {
        let d = &comparison.model_to_truth;
        let (rms, median, p95, max) = (d.rms_mm, d.median_mm, d.p95_mm, d.max_mm);
        row("model to truth", format!("rms {rms:.3} mm, median {median:.3}, 95 % {p95:.3}, max {max:.2}"));
        let mut shares = |what: &str, completeness: &geometry::Completeness| {
            let share = |w: &geometry::Within| format!("{:.1} % within {} mm", w.share * 100.0, w.distance_mm);
            row(what, completeness.within.iter().map(share).collect::<Vec<_>>().join(", "));
        };
        shares("truth to model", &comparison.truth_to_model);
        if let Some(seen) = &comparison.seen_truth_to_model {
            shares("truth that the camera could see", seen);
        }
    }
    if let Some(aligned) = &report.aligned {
        let d = &aligned.comparison.model_to_truth;
        row("laid onto the truth", format!("rms {:.3} mm, median {:.3}, 95 % {:.3}", d.rms_mm, d.median_mm, d.p95_mm));
        row("moved for that", format!("{:.2} mm, {:.2} degrees", aligned.moved_mm, aligned.turned_deg));
    }
    if let Some(closed) = &report.closed {
        let is_closed =
            if closed.watertight { "yes".to_owned() } else { format!("no, {} open edges", closed.open_edges) };
        row("closed", format!("{is_closed}; {:.1} % of the area was not measured", 100.0 * closed.unmeasured_share));
        if let Some(caps) = &closed.caps_to_truth {
            row("caps over that to the truth", format!("rms {:.2} mm, 95 % {:.2}", caps.rms_mm, caps.p95_mm));
        }
        if let Some(rms_mm) = closed.rms_mm {
            row("the closed model to the truth", format!("rms {rms_mm:.3} mm"));
        }
    }
    if let Some(stated) = &report.stated {
        let [one, two] = [stated.within_one, stated.within_two].map(|share| 100.0 * share);
        let median = stated.median_sigma_mm;
        row("as its own sigma says", format!("{one:.0} % within 1, {two:.0} % within 2; median sigma {median:.3} mm"));
    }
    if let Some(refined) = &report.refinement {
        if let Some(without) = &refined.without {
            let d = &without.comparison.model_to_truth;
            row("the same without refinement", format!("rms {:.3} mm, 95 % {:.3}", d.rms_mm, d.p95_mm));
        }
        let [offset, sigma] = refined.offset_error_ms;
        row("clock offset found", format!("{offset:+.2} ms, sigma {sigma:.2}"));
        row("frames left out", refined.frames_dropped.to_string());
        refined.notices.iter().for_each(|notice| row("NOTE", notice.clone()));
    }
    if let Some(colour) = &report.colour {
        row("colour against albedo", format!("rms {:.1} of 255", colour.rms_255));
    }
    if let Some(borders) = &report.borders {
        let (rms, median, p95) = (borders.rms_mm, borders.median_mm, borders.p95_mm);
        row("borders of colour", format!("rms {rms:.3} mm, median {median:.3}, 95 % {p95:.3}"));
        let (places, lost, unseen) = (borders.places, borders.lost, borders.unseen);
        row("places on them", format!("{places} judged, {lost} without a border, {unseen} not seen"));
    }
    for time in &report.times {
        row(&time.what, format!("{:.1} s", time.seconds));
    }
    row("messages lost", report.lost().to_string());
    for failure in &report.failures {
        row("FAILED", failure.clone());
    }
    let _ = writeln!(text, "\n  {}", out.join("report.html").display());
    write(&text)
}
