//! Sweeps the known world with one of the trackers and prints what refinement makes of it:
//! `cargo run --release -p refine --no-default-features --example measure -- TRACKER SEED [SECONDS]`.

#![allow(clippy::unwrap_used, reason = "an example may stop")]

#[path = "../tests/swept/mod.rs"]
mod swept;

use nalgebra::Vector3;
use refine::{Config, Refiner};
use std::time::Instant;
use swept::{Spec, Sweep, measure};

fn main() {
    let arguments: Vec<String> = std::env::args().collect();
    let name = arguments.get(1).map_or("W", String::as_str);
    let seed = arguments.get(2).map_or(1, |s| s.parse().unwrap());
    let seconds = arguments.get(3).map_or(60.0, |s| s.parse().unwrap());
    let (tracker, kind) = name.split_once('-').unwrap_or((name, ""));
    let mut spec = Spec { seconds, one_way: kind == "1way", ..Spec::named(tracker, seed) };
    spec.pushed = (kind == "pushed").then(|| (0.6 * seconds, Vector3::new(15e-3, 10e-3, 0.0)));
    let sweep = Sweep::new(&spec);
    let points: usize = sweep.profiles.iter().map(|p| p.points.len()).sum();
    println!("{name} seed {seed}: {} frames, {points} points, {} poses", sweep.profiles.len(), sweep.poses.len());
    println!("  smoothed  {}", measure::fit(&sweep, &sweep.smoothed()));
    // Settings as JSON, for trying others.
    let config = std::env::var("CONFIG").map_or(Config::default(), |json| serde_json::from_str(&json).unwrap());
    if std::env::var("LIVE").is_ok() {
        return live(&sweep, config);
    }
    let refiner = sweep.refiner(config);
    let start = Instant::now();
    let refined = refiner.finish().unwrap();
    let took = start.elapsed();
    let scans: Vec<_> = refined.scans().collect();
    println!("  refined   {}   {took:.2?}", measure::fit(&sweep, &scans));
    let e = &refined.evidence;
    println!(
        "  tau {:.2} +- {:.2} ms, residual {:.3} -> {:.3} mm, kept {}, dropped {}, crossing {:.2}, hold {}, excess {:?}",
        e.clock.tau_ms,
        e.clock.sigma_ms.unwrap(),
        e.residual.before_mm,
        e.residual.after_mm,
        e.frames_kept,
        e.dropped.len(),
        e.observed.unwrap().crossing,
        e.observed.unwrap().held_directions,
        e.tracker.excess
    );
    let cover = measure::coverage(&sweep, &scans);
    println!("  within 1 sigma {:.3}, 2 sigma {:.3}   {:?}", cover[0], cover[1], e.notices);
    println!("  hand-eye {:?}", e.hand_eye);
    if std::env::var("FRAMES").is_ok() {
        let mut worst = measure::frames(&sweep, &scans);
        worst.sort_by(|a, b| b.2.total_cmp(&a.2));
        for (stamp, count, rms, mean) in worst.iter().take(30) {
            let told = e.frames.iter().find(|f| f.stamp_nanos == *stamp).unwrap();
            println!("{count} points rms {rms:.3} mean {mean:.3} {told:?}");
        }
        for told in &e.dropped {
            println!("{told:?}");
        }
    }
}

/// A tick each second, as it would go while the scan is on.
fn live(sweep: &Sweep, config: Config) {
    let mut refiner = Refiner::new(config, &sweep.calibration).unwrap();
    let (mut poses, mut profiles) = (sweep.poses.iter().peekable(), sweep.profiles.iter().peekable());
    for second in 1..=sweep.seconds as i64 {
        let until = second * 1_000_000_000;
        while let Some(pose) = poses.next_if(|pose| pose.header.stamp_nanos < until) {
            refiner.pose(pose);
        }
        while let Some(profile) = profiles.next_if(|profile| profile.header.stamp_nanos < until) {
            refiner.profile(profile);
        }
        let start = Instant::now();
        let Some(refined) = refiner.tick() else { continue };
        let took = start.elapsed();
        if second % 5 == 0 {
            let scans: Vec<_> = refined.scans().collect();
            let fit = measure::fit(sweep, &scans);
            let smoothed: Vec<_> = sweep.smoothed().into_iter().filter(|s| s.header.stamp_nanos < until).collect();
            let before = measure::fit(sweep, &smoothed);
            let e = &refined.evidence;
            println!(
                "  {second:3} s {fit} (smoothed {:.3}) dropped {} tau {:.1} {took:.0?} {:?}",
                before.rms,
                e.dropped.len(),
                e.clock.tau_ms,
                e.notices
            );
        }
    }
}
