//! `limn stripe IMAGE`: the first stage on one picture.

use crate::config;
use crate::live::print;
use anyhow::{Context as _, Result, bail};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use stripe::StripeDetector;
use wire::{LaserPlane, PeaksPer, StripePeak};

/// Examples for `--help`.
pub const HELP: &str = "Examples:
  limn stripe frame.png > peaks.csv
  limn stripe frame.png --rig config/rigs/fine.toml --picture found.png
  limn stripe frame.png --set min_amplitude=12
Columns: u_px, v_px, sigma_px, amplitude, width_px, best (of its row or column), saturated.";

/// The arguments.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// PNG or JPEG.
    pub image: PathBuf,
    /// Whose channel weights and direction of the stripe to take; without it: the red channel, one peak a row.
    #[arg(long)]
    pub rig: Option<PathBuf>,
    /// Write the picture with the peaks marked in it (PNG).
    #[arg(long, value_name = "FILE")]
    pub picture: Option<PathBuf>,
    /// Overrule a value of the detector. May come again.
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub sets: Vec<String>,
}

/// Prints the peaks as a table.
pub fn run(args: &Args) -> Result<()> {
    let laser = laser(args.rig.as_deref())?;
    let mut detector = StripeDetector::new(config::of_kind("stripe", &args.sets)?, &laser)?;
    let frame = formats::image_file::read_frame(&args.image)?;
    let found = detector.process(&frame).with_context(|| args.image.display().to_string())?;
    for refusal in &found.refused {
        tracing::warn!("{} x {}", refusal.count, refusal.reason);
    }
    if let Some(path) = &args.picture {
        mark(&args.image, &found.peaks, path)?;
    }
    let mut text = "u_px,v_px,sigma_px,amplitude,width_px,best,saturated\n".to_owned();
    for p in found.peaks.iter() {
        let (best, saturated) = (u8::from(p.is_best()), u8::from(p.flags & StripePeak::SATURATED != 0));
        let StripePeak { u_px, v_px, sigma_px, amplitude, width_px, .. } = p;
        let _ = writeln!(text, "{u_px:.4},{v_px:.4},{sigma_px:.4},{amplitude:.2},{width_px:.3},{best},{saturated}");
    }
    print(&text)?;
    if found.peaks.is_empty() {
        bail!("no stripe in {}", args.image.display());
    }
    Ok(())
}

fn laser(rig: Option<&Path>) -> Result<LaserPlane> {
    let Some(path) = rig else {
        let (normal, channel_weights) = ([1.0, 0.0, 0.0], [1.0, 0.0, 0.0]);
        return Ok(LaserPlane { normal, distance_m: 0.0, channel_weights, peaks_per: PeaksPer::Row });
    };
    let text = std::fs::read_to_string(path).with_context(|| format!("cannot read the rig {}", path.display()))?;
    let rig = geometry::Rig::parse(&text).with_context(|| format!("the rig {}", path.display()))?;
    Ok(rig.calibration()?.laser)
}

/// Marks the best peaks green and the others blue.
fn mark(image: &Path, peaks: &[StripePeak], path: &Path) -> Result<()> {
    let mut picture = image::open(image).with_context(|| image.display().to_string())?.to_rgb8();
    for peak in peaks {
        let (u, v) = (peak.u_px.round() as u32, peak.v_px.round() as u32);
        if let Some(pixel) = picture.get_pixel_mut_checked(u, v) {
            *pixel = image::Rgb(if peak.is_best() { [0, 255, 0] } else { [64, 64, 255] });
        }
    }
    Ok(formats::image_file::write_rgb(path, &picture)?)
}
