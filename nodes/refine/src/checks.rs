//! What cannot be reached from outside: derivatives and the eliminated system.

use crate::banded::Banded;
use crate::gather::Gathered;
use crate::prior::{Beliefs, Prior};
use crate::scene::{Problem, right_jacobian};
use crate::schur::{Room, frame_data, product, shaken};
use crate::spline::Knots;
use crate::surfel::{Member, Patch};
use crate::tracker::Smoothed;
use crate::unknowns::{Free, SPLINES, Unknowns};
use geometry::uniform;
use geometry::{Smoothing, TimedPose};
use nalgebra::{Isometry3, Matrix6, Translation3, UnitQuaternion, Vector3, Vector6};

/// Four seconds of a hand that moves and turns, without noise.
fn gathered() -> Gathered {
    let mut gathered = Gathered::default();
    for i in 0..400i64 {
        let t = i as f64 * 0.01;
        let turn = UnitQuaternion::new(Vector3::new((2.0 * t).sin(), 0.5 * t, (3.0 * t).cos()));
        let pose = Isometry3::from_parts(Translation3::new(0.1 * t.sin(), 0.05 * t, 0.3), turn);
        let stamp_nanos = i * 10_000_000;
        gathered.readings.push(TimedPose { stamp_nanos, pose, position_sigma_m: 1e-3, rotation_sigma_rad: 1e-2 });
        gathered.rotation_stamps.push(stamp_nanos);
    }
    gathered
}

fn body_from_camera() -> Isometry3<f64> {
    let turn = UnitQuaternion::new(Vector3::new(0.3, -0.2, 1.0));
    Isometry3::from_parts(Translation3::new(0.05, -0.03, 0.02), turn)
}

#[test]
fn the_derivative_of_a_point_by_its_correction_is_exact_far_from_zero_as_well() {
    let gathered = gathered();
    let smoothed = Smoothed::new(&gathered, &Smoothing::default()).unwrap();
    let unknowns = Unknowns { splines: [0.033, 0.1, 0.4].map(|step_s| Knots::over(0.0, 4.0, step_s)) };
    let problem = Problem {
        gathered: &gathered,
        smoothed: &smoothed,
        body_from_camera: body_from_camera(),
        frames: &[],
        unknowns,
        origin: Vector3::zeros(),
    };
    let (base, twist) = smoothed.base(2_000_000_000, [0.0; 2]);
    let row = unknowns.row(2.0, base, twist, &problem.origin);
    let correction = Vector6::new(3e-3, -2e-3, 1e-3, 0.1, -0.15, 0.2);
    let normal = Vector3::new(0.3f32, -0.5, 0.8).normalize();
    let point = [0.02f32, -0.03, 0.21];
    let q = problem.in_body(&point);
    let at = |correction: &Vector6<f64>| row.corrected(correction) * nalgebra::Point3::from(q);
    let jacobian = problem.pose(&row, &correction).jacobian(&normal, &q.cast());
    for axis in 0..6 {
        const STEP: f64 = 1e-6;
        let mut moved = [correction; 2];
        moved[0][axis] -= STEP;
        moved[1][axis] += STEP;
        let numeric = (at(&moved[1]) - at(&moved[0])).dot(&normal.cast::<f64>()) / (2.0 * STEP);
        assert!((numeric - f64::from(jacobian[axis])).abs() < 1e-6, "{axis}: {numeric} {}", jacobian[axis]);
    }
}

#[test]
fn the_derivative_by_the_clock_is_the_twist() {
    let gathered = gathered();
    let smoothed = Smoothed::new(&gathered, &Smoothing::default()).unwrap();
    const STEP_S: f64 = 1e-4;
    let (before, twist) = smoothed.base(2_000_000_000, [-STEP_S, 0.0]);
    let (after, _) = smoothed.base(2_000_000_000, [STEP_S, 0.0]);
    let moved = before.inv_mul(&after);
    assert!((moved.translation.vector / (2.0 * STEP_S) - twist.fixed_rows::<3>(0)).norm() < 1e-4);
    assert!((moved.rotation.scaled_axis() / (2.0 * STEP_S) - twist.fixed_rows::<3>(3)).norm() < 1e-3);
}

#[test]
fn a_lag_turns_the_body_alone_and_is_its_own_derivative() {
    let gathered = gathered();
    let smoothed = Smoothed::new(&gathered, &Smoothing::default()).unwrap();
    const STEP_S: f64 = 1e-4;
    const LAG_S: f64 = 0.03;
    let at = |tau_s: f64, lag_s: f64| smoothed.base(2_000_000_000, [tau_s, lag_s]);
    let (before, (middle, twist), after) = (at(0.0, LAG_S - STEP_S).0, at(0.0, LAG_S), at(0.0, LAG_S + STEP_S).0);
    assert_eq!(middle.translation, at(0.0, 0.0).0.translation);
    assert!(middle.rotation.angle_to(&at(LAG_S, 0.0).0.rotation) < 1e-12);
    let turned = (before.rotation.inverse() * after.rotation).scaled_axis();
    assert!((turned / (2.0 * STEP_S) - twist.fixed_rows::<3>(3)).norm() < 1e-3);
    let moved =
        middle.rotation.inverse() * (at(STEP_S, LAG_S).0.translation.vector - at(-STEP_S, LAG_S).0.translation.vector);
    assert!((moved / (2.0 * STEP_S) - twist.fixed_rows::<3>(0)).norm() < 1e-4);
}

#[test]
fn the_right_jacobian_turns_a_small_step_into_a_product() {
    let (turn, step) = (Vector3::new(0.4, -0.3, 0.7), Vector3::new(1e-5, 2e-5, -1e-5));
    let exact = (UnitQuaternion::new(turn).inverse() * UnitQuaternion::new(turn + step)).scaled_axis();
    assert!((exact - right_jacobian(&turn) * step).norm() < 1e-9);
    assert!((right_jacobian(&Vector3::new(1e-9, 0.0, 0.0)) - nalgebra::Matrix3::identity()).norm() < 1e-8);
}

/// Surfels of one plane z = 0: members at random places of random frames.
fn plane_patches(frames: u32) -> Vec<Patch> {
    let random = |i: u64| uniform(7, i) - 0.5;
    let mut patches = vec![Patch::default(); 2];
    for surfel in 0..20u64 {
        let members: Vec<Member> = (0..16u64)
            .map(|k| {
                let i = 100 * surfel + 4 * k;
                let (u, v) = (random(i) as f32, random(i + 1) as f32);
                let frame = ((random(i + 2) + 0.5) * f64::from(frames)) as u32;
                let place = Vector3::new(0.1 * u + 0.01 * surfel as f32, 0.1 * v, 0.0);
                let turn = place.cross(&Vector3::z());
                let jacobian = [0.0, 0.0, 1.0, turn.x, turn.y, turn.z];
                let terms = [1.0, u, v, u * u, u * v, v * v];
                Member { jacobian, terms, frame, residual: random(i + 3) as f32, distance_m: 0.0, root_weight: 1.0 }
            })
            .collect();
        let patch = &mut patches[(surfel % 2) as usize];
        patch.members.extend(whitened(members));
        patch.ends.push(patch.members.len() as u32);
    }
    patches
}

fn whitened(mut members: Vec<Member>) -> Vec<Member> {
    let terms = |member: &Member| Vector6::from_fn(|i, _| f64::from(member.terms[i]));
    let normal = members.iter().fold(Matrix6::identity() * 1e-9, |sum, m| sum + terms(m) * terms(m).transpose());
    let factor = nalgebra::Cholesky::new(normal).unwrap().l();
    for member in &mut members {
        let white = factor.solve_lower_triangular(&terms(member)).unwrap();
        (0..6).for_each(|i| member.terms[i] = white[i] as f32);
    }
    members
}

#[test]
fn the_eliminated_system_is_symmetric_and_has_no_negative_direction() {
    const FRAMES: usize = 9;
    let patches = plane_patches(FRAMES as u32);
    let mut room = Room::new(&patches, FRAMES);
    let vector = |seed: u64| -> Vec<Vector6<f64>> {
        (0..FRAMES).map(|k| Vector6::from_fn(|i, _| uniform(seed, (6 * k + i) as u64) - 0.5)).collect()
    };
    let dot = |a: &[Vector6<f64>], b: &[Vector6<f64>]| a.iter().zip(b).map(|(a, b)| a.dot(b)).sum::<f64>();
    for seed in 0..20 {
        let (a, b) = (vector(2 * seed), vector(2 * seed + 1));
        let (ha, hb) = (product(&patches, 1.0, &a, &mut room), product(&patches, 1.0, &b, &mut room));
        assert!((dot(&a, &hb) - dot(&b, &ha)).abs() < 1e-4 * dot(&a, &ha).abs());
        assert!(dot(&a, &ha) >= 0.0);
    }
}

/// Along any direction the forces of draws have the variance that the product gives.
#[test]
fn draws_are_as_wide_as_the_system_says() {
    const FRAMES: usize = 9;
    const DRAWS: u64 = 4000;
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let flat = |forces: &[Vector6<f64>]| forces.iter().flat_map(|f| f.iter().copied()).collect::<Vec<f64>>();
    let patches = plane_patches(FRAMES as u32);
    let mut room = Room::new(&patches, FRAMES);
    let unknowns = Unknowns { splines: [0.5, 0.7, 1.1].map(|step_s| Knots::over(0.0, 3.0, step_s)) };
    let beliefs = Beliefs {
        white: [1e-3, 1e-2],
        inflation: [1.0, 2.0],
        smoothness: [1e5, 1e3],
        tremor: [3e-4, 5e-3],
        bias: [1e-3, 1e-2],
        field: [2e-3, 2e-2],
        hand_eye: [1e-3, 1e-2],
        clock_s: 0.01,
        lag_s: 0.01,
    };
    let times: Vec<f64> = (0..300).map(|i| 0.01 * f64::from(i)).collect();
    let prior = Prior::new(&unknowns, &times, &beliefs);
    let free = Free { splines: [true; SPLINES], field: true, hand_eye: true, clock: true, lag: true };
    for seed in 0..3 {
        let moves: Vec<Vector6<f64>> =
            (0..FRAMES).map(|k| Vector6::from_fn(|i, _| uniform(seed, (6 * k + i) as u64) - 0.5)).collect();
        let wanted = dot(&flat(&moves), &flat(&product(&patches, 3.0, &moves, &mut room)));
        let mut along = |draw| dot(&flat(&moves), &flat(&shaken(&patches, 3f64.sqrt(), draw, &mut room)));
        let found = (0..DRAWS).map(|draw| along(draw).powi(2)).sum::<f64>() / DRAWS as f64;
        assert!((found / wanted - 1.0).abs() < 0.1, "data: {found} of {wanted}");
        // Each unknown in its own unit, or the stiffest would hide all others.
        let v: Vec<f64> = (0..unknowns.len()).map(|i| uniform(seed, i as u64) - 0.5).collect();
        let mut stiff = vec![0.0; v.len()];
        prior.add_product(&unknowns, &free, &v, &mut stiff);
        let v: Vec<f64> = v.iter().zip(&stiff).map(|(v, stiff)| v / stiff.abs().max(1.0).sqrt()).collect();
        let mut answer = vec![0.0; v.len()];
        prior.add_product(&unknowns, &free, &v, &mut answer);
        let along = |draw| dot(&v, &prior.shaken(&unknowns, &free, draw));
        let found = (0..DRAWS).map(|draw| along(draw).powi(2)).sum::<f64>() / DRAWS as f64;
        assert!((found / dot(&v, &answer) - 1.0).abs() < 0.1, "prior: {found} of {}", dot(&v, &answer));
    }
}

#[test]
fn what_moves_all_frames_as_one_piece_costs_nothing() {
    const FRAMES: usize = 9;
    let patches = plane_patches(FRAMES as u32);
    let mut room = Room::new(&patches, FRAMES);
    // All frames rise and tilt together: each surfel takes it up.
    let rigid = vec![Vector6::new(0.3, -0.2, 0.5, 0.4, -0.6, 0.1); FRAMES];
    let force = product(&patches, 1.0, &rigid, &mut room);
    let alone: Vec<_> = (0..FRAMES).map(|k| if k == 0 { rigid[0] } else { Vector6::zeros() }).collect();
    let usual = product(&patches, 1.0, &alone, &mut room)[0].norm();
    assert!(force.iter().all(|f| f.norm() < 1e-4 * usual), "{force:?} {usual}");
    assert!(frame_data(&patches, 1.0, FRAMES).iter().map(|frame| frame.members).sum::<u32>() == 320);
}

#[test]
fn a_banded_matrix_is_solved_and_inverted_as_a_full_one() {
    const SIZE: usize = 40;
    let mut band = Banded::zeros(SIZE, 5);
    let mut full = nalgebra::DMatrix::<f64>::zeros(SIZE, SIZE);
    for row in 0..SIZE {
        for column in row.saturating_sub(5)..=row {
            let value = if row == column { 8.0 } else { uniform(3, (row * SIZE + column) as u64) };
            band.add(row, column, value);
            full[(row, column)] = value;
            full[(column, row)] = value;
        }
    }
    let inverse = full.clone().try_inverse().unwrap();
    let right = nalgebra::DVector::from_fn(SIZE, |i, _| uniform(4, i as u64));
    let factor = band.factor();
    let mut x = right.as_slice().to_vec();
    factor.solve(&mut x);
    assert!((&inverse * right - nalgebra::DVector::from_vec(x)).norm() < 1e-10);
    // L L^T, column by column.
    let unit = nalgebra::DMatrix::<f64>::identity(SIZE, SIZE);
    let columns = (0..SIZE).map(|k| factor.product(unit.column(k).as_slice()));
    let lower = nalgebra::DMatrix::from_columns(&columns.map(nalgebra::DVector::from_vec).collect::<Vec<_>>());
    assert!((&lower * lower.transpose() - full).norm() < 1e-10);
    let part = factor.inverse_band();
    for row in 0..SIZE {
        for column in row.saturating_sub(5)..=row {
            assert!((part.at(row, column) - inverse[(row, column)]).abs() < 1e-10, "{row} {column}");
        }
    }
}
