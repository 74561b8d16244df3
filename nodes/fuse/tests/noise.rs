//! What three receivers do to 1.5 mm and 3 degrees, against the analytic covariance.

mod handset;

use fuse::Config;
use handset::{ARM_M, MS, Noise, erring, error, fuse, on_arm, triangle};
use nalgebra::Vector3;

/// Root mean square lengths of the paper's tracker (section 3).
const POSITION_M: f64 = 1.5e-3;
const ROTATION_DEG: f64 = 3.0;
const MOMENTS: i64 = 20_000;

/// Along and about one axis.
fn sigmas() -> [f64; 2] {
    [POSITION_M, ROTATION_DEG.to_radians()].map(|length| length / 3f64.sqrt())
}

/// What came of many moments: root mean squares along and about each axis, and what the messages state of them.
struct Measured {
    found: [Vector3<f64>; 2],
    stated: [Vector3<f64>; 2],
    times_apart: Option<f64>,
    advice: Option<&'static str>,
}

fn measure(config: &Config) -> Measured {
    measure_with(config, 1.0)
}

/// By receivers that state so many times the noise that they have.
fn measure_with(config: &Config, times: f64) -> Measured {
    let ([position, rotation], mut noise) = (sigmas(), Noise(7));
    let mut fuse = fuse(config.clone());
    let mut measured =
        Measured { found: Default::default(), stated: Default::default(), times_apart: None, advice: None };
    let mut moments = 0.0;
    for step in 0..MOMENTS {
        for receiver in 0..config.receivers.len() {
            let (off, turn) = (noise.vector(position), noise.vector(rotation));
            let mut pose = erring(config, receiver, step * 10 * MS, off, turn);
            (pose.position_sigma_m, pose.rotation_sigma_rad) = ([times * position; 3], [times * rotation; 3]);
            fuse.pose(receiver, &pose);
        }
        for pose in fuse.drain() {
            let stated = [pose.position_sigma_m, pose.rotation_sigma_rad].map(Vector3::from);
            for (kind, error) in error(&pose).into_iter().enumerate() {
                measured.found[kind] += error.component_mul(&error);
                measured.stated[kind] += stated[kind].component_mul(&stated[kind]);
            }
            moments += 1.0;
        }
    }
    assert!(moments >= MOMENTS as f64, "a moment has no pose");
    (0..config.receivers.len()).for_each(|receiver| fuse.pose(receiver, &handset::end(MOMENTS * 10 * MS)));
    if let Some((_, evidence)) = fuse.end() {
        (measured.times_apart, measured.advice) = (evidence.times_apart(), evidence.advice());
    }
    for sums in [&mut measured.found, &mut measured.stated] {
        sums.iter_mut().for_each(|sum| *sum = sum.map(|square| (square / moments).sqrt()));
    }
    measured
}

fn assert_near(what: &str, found: &Vector3<f64>, wanted: &Vector3<f64>) {
    for axis in 0..3 {
        let ratio = found[axis] / wanted[axis];
        assert!((ratio - 1.0).abs() < 0.03, "{what}, axis {axis}: {} where {} is right", found[axis], wanted[axis]);
    }
}

/// In degrees, and in metres.
fn say(what: &str, measured: &Measured) {
    let [position, rotation] = measured.found;
    println!("{what}: {:.2} mm and {:.2} degrees rms", position.norm() * 1e3, rotation.norm().to_degrees());
}

#[test]
fn three_receivers_on_arms_of_10_cm_turn_3_degrees_into_six_tenths() {
    let config = triangle();
    let one = measure(&Config { receivers: config.receivers[..1].to_vec(), ..config.clone() });
    let three = measure(&config);
    say("one receiver, moved to the body", &one);
    say("three receivers", &three);
    let [position, rotation] = sigmas();
    // About an axis in the plane of the triangle the arms' squares come to 3/2 r^2, across it to 3 r^2.
    let about = |arms: f64| (arms * ARM_M.powi(2) / position.powi(2) + 3.0 / rotation.powi(2)).sqrt().recip();
    let analytic = [Vector3::repeat(position / 3f64.sqrt()), Vector3::new(about(1.5), about(1.5), about(3.0))];
    for (kind, what) in ["position", "rotation"].into_iter().enumerate() {
        assert_near(what, &three.found[kind], &analytic[kind]);
        assert_near(&format!("stated {what}"), &three.stated[kind], &analytic[kind]);
    }
    let degrees = [&one, &three].map(|measured| measured.found[1].norm().to_degrees());
    assert!((degrees[0] - 3.0).abs() < 0.05 && degrees[1] < 0.63, "{degrees:?}");
    let times = three.times_apart.unwrap_or_default();
    assert!((times - 1.0).abs() < 0.01, "they stand {times} times as far apart as they state");
}

#[test]
fn about_the_line_through_two_receivers_only_their_own_rotations_tell() {
    let config = Config { receivers: vec![on_arm("here", 0.0), on_arm("there", 180.0)], ..triangle() };
    let two = measure(&config);
    say("two receivers in a row", &two);
    let [position, rotation] = sigmas();
    let about = |arms: f64| (arms * ARM_M.powi(2) / position.powi(2) + 2.0 / rotation.powi(2)).sqrt().recip();
    let analytic = Vector3::new(about(0.0), about(2.0), about(2.0));
    assert_near("rotation", &two.found[1], &analytic);
    assert_near("stated rotation", &two.stated[1], &analytic);
    assert!(two.stated[1].x > 2.0 * two.stated[1].y);
}

#[test]
fn sigmas_that_are_far_from_right_are_told_with_what_to_do() {
    // Nobody is an outlier here, whatever the sigmas are.
    let config = Config { outlier_sigmas: 100.0, ..triangle() };
    for (times, advice) in [(5.0, Some("smaller `apart_mm`")), (1.0, None), (0.2, Some("raise `apart_mm`"))] {
        let measured = measure_with(&config, times);
        let apart = measured.times_apart.unwrap();
        assert!((apart * times - 1.0).abs() < 0.02, "{times} times the noise is stated: {apart}");
        match (measured.advice, advice) {
            (Some(told), Some(words)) => assert!(told.contains(words), "{times}: {told}"),
            (told, wanted) => assert_eq!(told, wanted, "{times}"),
        }
    }
}
