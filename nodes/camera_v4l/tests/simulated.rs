//! What lit a picture, on pictures of the simulated world, which say it of themselves: daylight, texture, a hand that moves,
//! a gain that is set anew for each picture, every sixth picture under the lamp.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps")]

use camera_sim::CameraSim;
use camera_v4l::{LightConfig, LightJudge, look};
use std::path::Path;
use wire::{Light, Phase};
use world::Setup;

/// Of so many pictures each light is told: right, not for certain (as neither or as both), and as the other one.
#[derive(Debug, Default)]
struct Told {
    right: usize,
    uncertain: usize,
    wrong: usize,
}

/// What the judge makes of pictures from `first` on: those of the laser, and those of the lamp.
fn told(rig: &str, seed: u64, first: u64, count: u64) -> [Told; 2] {
    let config = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../config");
    let (scene, rig) = (config.join("scenes/cow.toml"), config.join(format!("rigs/{rig}.toml")));
    let known = Setup { scene, rig, seed, ..Setup::default() }.open().unwrap();
    let laser = known.rig.calibration().unwrap().laser;
    let (sim, config) = (CameraSim::new(&known).unwrap(), LightConfig::default());
    let (mut judge, mut tables) = (LightJudge::default(), [Told::default(), Told::default()]);
    for (number, frame) in sim.batch(first..first + count).into_iter().enumerate() {
        let truth = frame.light;
        let light = judge.judge(Phase::Both, &look(&frame, &laser, &config).unwrap(), &config);
        // It has to have seen both.
        if number < 12 {
            continue;
        }
        let table = &mut tables[usize::from(truth.lamp)];
        match light {
            light if light == truth => table.right += 1,
            Light { laser, lamp } if laser == lamp => table.uncertain += 1,
            _ => table.wrong += 1,
        }
    }
    tables
}

#[test]
fn no_picture_is_taken_for_the_other_light_and_few_are_uncertain() {
    for (rig, seed, first, count) in [("paper", 1, 100, 300), ("paper", 2, 600, 300), ("fine", 1, 400, 120)] {
        let [laser, lamp] = told(rig, seed, first, count);
        println!("{rig}, seed {seed}, {count} pictures from {first}: laser {laser:?}, lamp {lamp:?}");
        assert_eq!((laser.wrong, lamp.wrong), (0, 0), "{rig}, seed {seed}");
        assert!(20 * laser.uncertain < laser.right, "{rig}, seed {seed}: {laser:?}");
        assert!(5 * lamp.uncertain < lamp.right, "{rig}, seed {seed}: {lamp:?}");
    }
}
