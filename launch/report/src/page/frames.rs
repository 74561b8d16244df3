//! Each laser-lit picture over the time of the scan: how well its place is known, and how well it fits.

use super::text::number;
use crate::FrameError;
use std::fmt::Write as _;

const WIDTH: f64 = 720.0;
const HEIGHT: f64 = 150.0;
const TOP: f64 = 18.0;
const BASE: f64 = 118.0;
/// Pictures that share a column of the plot are drawn as one stroke, from the least to the most.
const COLUMNS: usize = 360;

/// Two plots over one time; nothing without pictures.
pub fn plots(frames: &[FrameError]) -> String {
    let end_s = frames.iter().map(|frame| frame.at_s).fold(0.0, f64::max);
    if frames.is_empty() || end_s <= 0.0 {
        return String::new();
    }
    let left_out = frames.iter().filter(|frame| frame.left_out).count();
    let caption = if left_out > 0 { " Red: left out of the model." } else { "" };
    let sigma = plot(frames, end_s, "standard deviation, mm", |frame| Some(frame.sigma_mm));
    let residual = plot(frames, end_s, "off the surface, mm", |frame| frame.residual_mm);
    format!(
        "<figure>{sigma}{residual}<figcaption>Each laser-lit picture over the seconds of the scan: how far its pose's error \
         moves its points, as stated, and how far four in five of its points at most lie off the common surface. What is above \
         the top is drawn at the top.{caption}</figcaption></figure>"
    )
}

fn plot(frames: &[FrameError], end_s: f64, name: &str, value: impl Fn(&FrameError) -> Option<f64>) -> String {
    let known: Vec<(&FrameError, f64)> = frames.iter().filter_map(|frame| Some((frame, value(frame)?))).collect();
    let kept = known.iter().filter(|(frame, _)| !frame.left_out);
    let top_mm = top(kept.map(|(_, mm)| *mm).collect());
    let y = |mm: f64| BASE - (BASE - TOP) * (mm / top_mm).clamp(0.0, 1.0);
    let mut columns = vec![[None::<[f64; 2]>; 2]; COLUMNS];
    for (frame, mm) in known {
        let column = ((frame.at_s / end_s * COLUMNS as f64) as usize).min(COLUMNS - 1);
        let range = columns[column][usize::from(frame.left_out)].get_or_insert([mm, mm]);
        *range = [range[0].min(mm), range[1].max(mm)];
    }
    let strokes = |which: usize| {
        let mut path = String::new();
        for (column, ranges) in columns.iter().enumerate() {
            let Some([low, high]) = ranges[which] else { continue };
            let x = (column as f64 + 0.5) / COLUMNS as f64 * WIDTH;
            // A single picture is a dot.
            let _ = write!(path, "M{x:.1} {:.1}V{:.1}", y(low) + 0.8, y(high) - 0.8);
        }
        path
    };
    let mut svg = format!(r#"<svg class="chart" viewBox="0 0 {WIDTH} {HEIGHT}" role="img" aria-label="{name}">"#);
    let _ = write!(
        svg,
        r#"<path class="kept" d="{}"/><path class="left" d="{}"/><text x="0" y="11">{name}; {} at the top</text>"#,
        strokes(0),
        strokes(1),
        number(top_mm),
    );
    axis(&mut svg, end_s);
    svg + "</svg>"
}

/// Of a hundred values, 99 are below it.
fn top(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let p99 = values.get(values.len() * 99 / 100).copied().unwrap_or(1.0);
    if p99 > 0.0 { p99 } else { 1.0 }
}

fn axis(svg: &mut String, end_s: f64) {
    let _ = write!(svg, r#"<path class="axis" d="M0 {BASE}H{WIDTH}"/>"#);
    for i in 0..=4 {
        let at = f64::from(i) / 4.0;
        let x = (at * WIDTH).clamp(0.5, WIDTH - 0.5);
        let anchor = ["start", "middle", "middle", "middle", "end"][i as usize];
        let label = number(at * end_s);
        let _ = write!(
            svg,
            r#"<path class="axis" d="M{x} {BASE}v5"/><text x="{x}" y="{}" text-anchor="{anchor}">{label} s</text>"#,
            BASE + 20.0,
        );
    }
}
