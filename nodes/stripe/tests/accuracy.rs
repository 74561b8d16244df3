//! Peaks against the truth of synthetic pictures.

#![allow(clippy::unwrap_used, reason = "helpers of tests")]

mod picture;

use picture::{Scene, red_laser, rgb, truth};
use stripe::{Config, StripeDetector};
use wire::{PeaksPer, Stripe, StripePeak};

struct Score {
    rms_px: f64,
    found: f64,
    /// Standard deviation of error over sigma.
    pull: f64,
    gross: usize,
}

/// Errors of the best peaks; beyond 1 px they count as gross.
fn score(scene: &Scene, stripe: &Stripe, peaks_per: PeaksPer) -> Score {
    let mut errors = Vec::new();
    let mut gross = 0;
    for peak in stripe.peaks.iter().filter(|p| p.is_best()) {
        let (line, position) = match peaks_per {
            PeaksPer::Row => (peak.v_px, peak.u_px),
            PeaksPer::Column => (peak.u_px, peak.v_px),
        };
        let error = f64::from(position) - truth(scene, line as usize)[0];
        if error.abs() > 1.0 {
            gross += 1;
        } else {
            errors.push((error, f64::from(peak.sigma_px)));
        }
    }
    let n = errors.len() as f64;
    let rms_px = (errors.iter().map(|(e, _)| e * e).sum::<f64>() / n).sqrt();
    let pull = (errors.iter().map(|(e, s)| (e / s).powi(2)).sum::<f64>() / n).sqrt();
    Score { rms_px, found: n / scene.height as f64, pull, gross }
}

fn run(scene: &Scene, peaks_per: PeaksPer, config: Config) -> Score {
    let frame = rgb(scene, peaks_per);
    let mut detector = StripeDetector::new(config, &red_laser(peaks_per)).unwrap();
    let stripe = detector.process(&frame).unwrap();
    let score = score(scene, &stripe, peaks_per);
    println!(
        "speckle {:.2} read noise {:.0} brightness {:.1}: rms {:.4} px, pull {:.2}, found {:.4}, gross {}, refused {:?}",
        scene.speckle_contrast,
        scene.read_noise,
        scene.brightness,
        score.rms_px,
        score.pull,
        score.found,
        score.gross,
        stripe.refused
    );
    score
}

#[test]
fn a_line_without_speckle_is_found_to_a_tenth_of_a_pixel() {
    let score = run(&Scene::default(), PeaksPer::Row, Config::default());
    assert!(score.rms_px <= 0.10 && score.found >= 0.995 && score.gross == 0);
    assert!((0.7..=1.4).contains(&score.pull));
}

#[test]
fn a_line_with_speckle_is_found_to_a_seventh_of_a_pixel() {
    let scene = Scene { speckle_contrast: 0.1, ..Scene::default() };
    let score = run(&scene, PeaksPer::Row, Config::default());
    assert!(score.rms_px <= 0.15 && score.found >= 0.995 && score.gross == 0);
    assert!((0.7..=1.4).contains(&score.pull));
}

#[test]
fn columns_are_found_like_rows() {
    let scene = Scene { speckle_contrast: 0.1, seed: 5, ..Scene::default() };
    let rows = run(&scene, PeaksPer::Row, Config::default());
    let columns = run(&scene, PeaksPer::Column, Config::default());
    assert!((rows.rms_px - columns.rms_px).abs() < 0.01 && columns.found >= 0.995);
}

#[test]
fn sigma_tells_the_error_at_every_noise() {
    for (read_noise, speckle_contrast) in [(0.0, 0.0), (1.0, 0.0), (6.0, 0.0), (0.5, 0.05), (1.0, 0.2), (3.0, 0.2)] {
        let scene = Scene { read_noise, speckle_contrast, seed: 11, ..Scene::default() };
        let score = run(&scene, PeaksPer::Row, Config::default());
        assert!(
            (0.7..=1.4).contains(&score.pull),
            "read noise {read_noise}, speckle {speckle_contrast}: {}",
            score.pull
        );
    }
}

#[test]
fn sigma_tells_the_error_without_averaging() {
    let config = Config { lateral_lines: 0, ..Config::default() };
    for speckle_contrast in [0.0, 0.1] {
        let score = run(&Scene { speckle_contrast, ..Scene::default() }, PeaksPer::Row, config.clone());
        assert!((0.7..=1.4).contains(&score.pull) && score.rms_px < 0.2);
    }
}

#[test]
fn a_clipped_line_keeps_its_middle_and_says_so() {
    let scene = Scene { brightness: 4.0, ..Scene::default() };
    let stripe = StripeDetector::new(Config::default(), &red_laser(PeaksPer::Row))
        .unwrap()
        .process(&rgb(&scene, PeaksPer::Row))
        .unwrap();
    let clipped = stripe.peaks.iter().filter(|p| p.flags & StripePeak::SATURATED != 0).count();
    assert!(clipped > 900, "{clipped}");
    let score = run(&scene, PeaksPer::Row, Config::default());
    assert!(score.rms_px <= 0.10 && score.found >= 0.995);
    assert!((0.7..=1.4).contains(&score.pull));
}
