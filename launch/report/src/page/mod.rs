//! One page that stands alone: no script, nothing fetched.

mod chart;
mod frames;
mod pictures;
mod refined;
mod tables;
mod text;

use crate::{Exhibits, PageError, Report, error_map};
use geometry::METRES_PER_MM;
use text::{count, escape, number, percent};

const STYLE: &str = include_str!("style.css");

/// The page as text.
pub fn html(report: &Report, exhibits: &Exhibits<'_>) -> Result<String, PageError> {
    let end_mm = error_map::end_mm(largest_mm(report, exhibits));
    let accuracy_of = if report.shape().is_some() { "How far it is from the truth" } else { "How well it is known" };
    let title = if report.title.is_empty() { "A scan" } else { &report.title };
    let title = escape(title);
    Ok(format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" \
         content=\"width=device-width, initial-scale=1\">\n<title>{title}</title>\n<style>\n{STYLE}</style>\n</head>\n\
         <body>\n<header><h1>{title}</h1>\n{}{}</header>\n{}\n{}\n{}\n{}\n{}</body>\n</html>\n",
        lead(report),
        verdict(report),
        tables::key_figures(report),
        section("What was scanned, and what came out", &pictures::gallery(exhibits, end_mm)?),
        section(accuracy_of, &accuracy(report, end_mm)),
        section("The way there", &way(report)),
        section("How it was made", &made(report)),
    ))
}

/// What the colours of the maps must tell apart: the error, or what is expected of it when nobody knows the truth.
fn largest_mm(report: &Report, exhibits: &Exhibits<'_>) -> f64 {
    if let Some(shape) = report.shape() {
        return shape.model_to_truth.p95_mm;
    }
    let stated = exhibits.stated.map(|(_, sigma_m)| sigma_m.iter().map(|sigma| f64::from(*sigma)));
    let mut sigmas: Vec<f64> = stated.into_iter().flatten().filter(|sigma| sigma.is_finite()).collect();
    sigmas.sort_by(f64::total_cmp);
    sigmas.get(sigmas.len() * 19 / 20).map_or(1.0, |sigma| sigma / METRES_PER_MM)
}

fn section(heading: &str, content: &str) -> String {
    if content.is_empty() { String::new() } else { format!("<h2>{heading}</h2>\n{content}\n") }
}

fn lead(report: &Report) -> String {
    let run = &report.run;
    let sweep = run.sweep_s.map(|s| format!("a sweep of {} s", number(s)));
    let parts = [Some(escape(&run.object)), sweep, Some(escape(&run.date))];
    let parts: Vec<String> = parts.into_iter().flatten().filter(|part| !part.is_empty()).collect();
    if parts.is_empty() { String::new() } else { format!("<p class=\"lead\">{}</p>\n", parts.join(" \u{b7} ")) }
}

fn verdict(report: &Report) -> String {
    let failures: String = report.failures.iter().map(|f| format!("<li>{}</li>", escape(f))).collect();
    let lost = match report.lost() {
        0 => "No message was lost.".to_owned(),
        n => format!("{} messages were lost.", count(n)),
    };
    match (report.is_good(), failures.is_empty()) {
        (true, _) if report.stages.is_empty() => String::new(),
        (true, _) => format!("<p class=\"verdict\">Every stage finished. {lost}</p>\n"),
        (false, true) => format!("<p class=\"verdict bad\">{lost}</p>\n"),
        (false, false) => format!("<div class=\"verdict bad\">Not all went well. {lost}<ul>{failures}</ul></div>\n"),
    }
}

fn accuracy(report: &Report, end_mm: f64) -> String {
    let mut text = String::new();
    if let Some(comparison) = report.shape() {
        if !comparison.signed_mm.is_empty() {
            text.push_str(&chart::histogram(&comparison.signed_mm, end_mm));
        }
        text.push_str(&tables::comparison(comparison));
    }
    if let Some(aligned) = &report.aligned {
        text.push_str(&tables::standing(aligned, report.comparison.as_ref()));
    }
    if let Some(closed) = &report.closed {
        text.push_str(&tables::closed(closed));
    }
    if let Some(stated) = &report.stated {
        text.push_str(&tables::stated(stated));
    }
    if let Some(refined) = &report.refinement {
        text.push_str(&refined::refined(refined));
    }
    if let Some(colour) = &report.colour {
        let three = |values: [f64; 3]| values.map(number).join(", ");
        text.push_str(&tables::facts(
            "Colours of the cells that were seen against the albedo of the truth, in sRGB values of 0 to 255",
            &[
                ("root mean square", number(colour.rms_255)),
                ("red, green, blue", three(colour.channel_rms_255)),
                ("95 %", number(colour.p95_255)),
                ("gain of each channel, taken out", three(colour.gain)),
                ("cells compared", count(colour.cells as u64)),
            ],
        ));
    }
    if let Some(borders) = &report.borders {
        text.push_str(&tables::borders(borders));
    }
    text
}

fn way(report: &Report) -> String {
    let c = &report.counts;
    let known = |value: u64| if value == 0 { String::new() } else { count(value) };
    let area = if c.area_mm2 > 0.0 { format!("{} mm\u{b2}", number(c.area_mm2)) } else { String::new() };
    let counts = tables::facts(
        "How much there was",
        &[
            ("pictures", known(c.frames)),
            ("tracker readings", known(c.poses)),
            ("points measured", known(c.points)),
            ("points after clustering", known(c.cloud_points)),
            ("triangles", known(c.triangles)),
            ("texture cells seen", known(c.texture_cells)),
            ("surface", area),
        ],
    );
    let times: Vec<(String, String)> =
        report.times.iter().map(|t| (escape(&t.what), format!("{} s", number(t.seconds)))).collect();
    let rows: Vec<(&str, String)> = times.iter().map(|(what, seconds)| (what.as_str(), seconds.clone())).collect();
    let times = tables::facts("Time on the wall", &rows);
    let mut text = if counts.is_empty() && times.is_empty() {
        counts
    } else {
        format!("<div class=\"pair\">{counts}{times}</div>")
    };
    if !report.stages.is_empty() {
        text.push_str(&tables::stages(&report.stages));
        text.push_str(&tables::refused(&report.stages));
    }
    text
}

fn made(report: &Report) -> String {
    let (run, machine) = (&report.run, &report.machine);
    let code = |value: &str| if value.is_empty() { String::new() } else { format!("<code>{}</code>", escape(value)) };
    let cores = match machine.cores {
        0 => String::new(),
        1 => "1 core".to_owned(),
        n => format!("{n} cores"),
    };
    let machine = [escape(&machine.processor), cores, escape(&machine.system)];
    let machine: Vec<String> = machine.into_iter().filter(|part| !part.is_empty()).collect();
    let seen = report.comparison.as_ref().and_then(|c| Some((c.seen_truth_to_model.as_ref()?, &c.truth_to_model)));
    let seen = seen.map(|(seen, all)| percent(seen.samples as f64 / all.samples.max(1) as f64)).unwrap_or_default();
    tables::facts(
        "Enough to make it again",
        &[
            ("command", code(&run.command)),
            ("scene", code(&run.scene)),
            ("rig", code(&run.rig)),
            ("seed", run.seed.map(|s| s.to_string()).unwrap_or_default()),
            ("pace", escape(&run.pace)),
            ("of the truth the camera could see", seen),
            ("version", escape(&run.version)),
            ("machine", machine.join(", ")),
        ],
    )
}
