//! The numbers, as tables and as the row of figures at the head of the page.

use super::text::{count, escape, known, number, percent};
use crate::{Aligned, BorderError, Closed, Report, Stage, StatedError};
use geometry::{Comparison, Completeness};
use std::fmt::Write as _;

/// What one looks for first.
pub fn key_figures(report: &Report) -> String {
    let mut figures: Vec<(String, &str, &str)> = Vec::new();
    if let Some(comparison) = report.shape() {
        let to_truth = &comparison.model_to_truth;
        figures.push((number(to_truth.rms_mm), "mm", "rms distance to the truth"));
        figures.push((number(to_truth.p95_mm), "mm", "95 % are closer"));
        let (seen, what) = match &comparison.seen_truth_to_model {
            Some(seen) => (seen, "of what could be seen is within 1 mm"),
            None => (&comparison.truth_to_model, "of the truth is within 1 mm"),
        };
        if let Some(share) = seen.share_within_mm(1.0) {
            figures.push((percent(share), "", what));
        }
    }
    if let Some(colour) = &report.colour {
        figures.push((number(colour.rms_255), "of 255", "rms colour difference"));
    }
    if report.counts.points > 0 {
        figures.push((count(report.counts.points), "", "points measured"));
    }
    if !report.stages.is_empty() {
        figures.push((count(report.lost()), "", "messages lost"));
    }
    let figure = |(value, unit, what): &(String, &str, &str)| {
        format!("<div><dt>{what}</dt><dd>{value}<small> {unit}</small></dd></div>")
    };
    format!("<dl class=\"figures\">{}</dl>", figures.iter().map(figure).collect::<String>())
}

/// The comparison in both directions.
pub fn comparison(comparison: &Comparison) -> String {
    let d = &comparison.model_to_truth;
    let row = |name: &str, value: f64| format!("<tr><th>{name}</th><td>{}</td></tr>", number(value));
    let distances = [
        row("root mean square", d.rms_mm),
        row("median", d.median_mm),
        row("95 %", d.p95_mm),
        row("largest", d.max_mm),
        row("mean with sign", d.bias_mm),
    ];
    let mut text = format!(
        "<div class=\"pair\"><table><caption>From the model to the truth, mm ({} points)</caption><tbody>{}</tbody></table>",
        count(d.samples as u64),
        distances.concat()
    );
    text.push_str(&within(&comparison.truth_to_model, comparison.seen_truth_to_model.as_ref()));
    text.push_str("</div>");
    text
}

fn within(all: &Completeness, seen: Option<&Completeness>) -> String {
    let head = if seen.is_some() { "<th>of what could be seen</th>" } else { "" };
    let rows = all.within.iter().enumerate().map(|(i, w)| {
        let seen = seen.and_then(|s| s.within.get(i)).map(|w| format!("<td>{}</td>", percent(w.share)));
        let (mm, share) = (w.distance_mm, percent(w.share));
        format!("<tr><th>{mm} mm</th><td>{share}</td>{}</tr>", seen.unwrap_or_default())
    });
    format!(
        "<table><caption>From the truth to the model: the share of the truth that has the model within a distance ({} \
         points)</caption><thead><tr><th>within</th><th>of the whole truth</th>{head}</tr></thead><tbody>{}</tbody></table>",
        count(all.samples as u64),
        rows.collect::<String>()
    )
}

/// Where the model stood, and what that alone cost.
pub fn standing(aligned: &Aligned, as_it_stands: Option<&Comparison>) -> String {
    let stood = as_it_stands.map(|comparison| format!("{} mm", number(comparison.model_to_truth.rms_mm)));
    facts(
        "The figures above are those of the shape: the model was laid onto the truth first, as a whole",
        &[
            ("moved by", format!("{} mm", number(aligned.moved_mm))),
            ("turned by", format!("{} degrees", number(aligned.turned_deg))),
            ("root mean square where it stood", stood.unwrap_or_default()),
        ],
    )
}

/// What closes the model, and how far that is off.
pub fn closed(closed: &Closed) -> String {
    let is_closed = match closed.open_edges {
        0 => "yes: every edge has two triangles".to_owned(),
        open => format!("no: {} edges are open", count(open as u64)),
    };
    let caps = closed.caps_to_truth.map(|caps| {
        let [rms, median, p95] = [caps.rms_mm, caps.median_mm, caps.p95_mm].map(number);
        format!("rms {rms} mm, median {median} mm, 95 % within {p95} mm")
    });
    facts(
        "The closed model (mesh.stl, model.glb, model.obj): caps close what nobody saw. The figures above are of what was \
         measured (mesh.ply)",
        &[
            ("closed", is_closed),
            ("of its area, nobody measured", percent(closed.unmeasured_share)),
            ("from these caps to the truth", caps.unwrap_or_default()),
            (
                "from all of it to the truth",
                closed.rms_mm.map(|rms| format!("rms {} mm", number(rms))).unwrap_or_default(),
            ),
        ],
    )
}

/// How honest the surface's own sigmas are.
pub fn stated(stated: &StatedError) -> String {
    facts(
        "What the surface says of its own error",
        &[
            ("standard deviation, median", format!("{} mm", number(stated.median_sigma_mm))),
            ("closer to the truth than one of it (68 % if it is honest)", percent(stated.within_one)),
            ("closer than two (95 %)", percent(stated.within_two)),
            ("vertices that state one", count(stated.vertices as u64)),
        ],
    )
}

/// Where the borders between colours lie.
pub fn borders(borders: &BorderError) -> String {
    facts(
        "Borders between patches of colour against those of the truth: how far apart the half-way colours are, across the \
         border",
        &[
            ("root mean square", format!("{} mm", number(borders.rms_mm))),
            ("median", format!("{} mm", number(borders.median_mm))),
            ("95 %", format!("{} mm", number(borders.p95_mm))),
            ("places judged", count(borders.places as u64)),
            ("places where the model has no such border", count(borders.lost as u64)),
            ("places that no picture saw", count(borders.unseen as u64)),
        ],
    )
}

/// Each node's work.
pub fn stages(stages: &[Stage]) -> String {
    let row = |s: &Stage| {
        let refused: u64 = s.refused.iter().map(|r| r.count).sum();
        let lost = if s.lost > 0 { " class=\"bad\"" } else { "" };
        format!(
            "<tr><th>{}</th><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td{lost}>{}</td>\
             <td>{}</td></tr>",
            escape(&s.node),
            count(s.received),
            count(s.published),
            known(s.rate_hz),
            number(s.busy_s),
            number(s.cpu_s),
            known(s.latency_p50_ms),
            known(s.latency_p99_ms),
            count(s.lost),
            count(refused),
        )
    };
    format!(
        "<div class=\"wide\"><table><thead><tr><th>node</th><th>taken in</th><th>sent</th><th>per second</th><th>busy, \
         s</th><th>processor, s</th><th>latency, ms: median</th><th>99 %</th><th>lost</th><th>refused</th></tr></thead>\
         <tbody>{}</tbody></table></div>",
        stages.iter().map(row).collect::<String>()
    )
}

/// Everything refused, with its reason; nothing when nothing was.
pub fn refused(stages: &[Stage]) -> String {
    let mut rows = String::new();
    for stage in stages {
        for refused in &stage.refused {
            let (node, reason) = (escape(&stage.node), escape(&refused.reason));
            let _ = write!(
                rows,
                "<tr><th>{node}</th><td class=\"text\">{reason}</td><td>{}</td></tr>",
                count(refused.count)
            );
        }
    }
    if rows.is_empty() {
        return String::new();
    }
    format!(
        "<table><caption>Refused, by reason: measured, but not good enough to keep</caption><thead><tr><th>node</th><th \
         class=\"text\">reason</th><th>count</th></tr></thead><tbody>{rows}</tbody></table>"
    )
}

/// Two columns of names and values; what is empty is left out.
pub fn facts(caption: &str, rows: &[(&str, String)]) -> String {
    let rows = rows.iter().filter(|(_, value)| !value.is_empty());
    let rows: String =
        rows.map(|(name, value)| format!("<tr><th>{name}</th><td class=\"text\">{value}</td></tr>")).collect();
    if rows.is_empty() {
        rows
    } else {
        format!("<table class=\"facts\"><caption>{caption}</caption><tbody>{rows}</tbody></table>")
    }
}
