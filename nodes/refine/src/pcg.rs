//! Preconditioned conjugate gradients (Hestenes and Stiefel 1952), stopped early: Gauss-Newton needs no exact steps.

/// Solves A x = b from x = 0. `None` when a number is not finite.
pub(crate) fn solve(
    b: &[f64],
    most_steps: usize,
    tolerance: f64,
    mut product: impl FnMut(&[f64]) -> Vec<f64>,
    precondition: impl Fn(&[f64]) -> Vec<f64>,
) -> Option<Vec<f64>> {
    let mut x = vec![0.0; b.len()];
    let mut residual = b.to_vec();
    let mut z = precondition(&residual);
    let mut direction = z.clone();
    let mut energy = dot(&residual, &z);
    let enough = tolerance * tolerance * energy;
    for _ in 0..most_steps {
        if energy <= enough || energy == 0.0 {
            break;
        }
        let moved = product(&direction);
        let curvature = dot(&direction, &moved);
        if curvature.is_nan() || curvature <= 0.0 {
            break;
        }
        let step = energy / curvature;
        add(&mut x, step, &direction);
        add(&mut residual, -step, &moved);
        z = precondition(&residual);
        let next = dot(&residual, &z);
        let keep = next / energy;
        direction.iter_mut().zip(&z).for_each(|(d, z)| *d = z + keep * *d);
        energy = next;
    }
    x.iter().all(|value| value.is_finite()).then_some(x)
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn add(a: &mut [f64], factor: f64, b: &[f64]) {
    a.iter_mut().zip(b).for_each(|(a, b)| *a += factor * b);
}
