//! To rest: a quasi-Newton method (limited-memory BFGS) whose first guess is the factored stiffness of all springs,
//! looked at anew now and then.

use super::Rest;
use super::envelope::Envelope;
use super::system::System;
use crate::diag::Sink;
use crate::preview::scene::Refused;
use glam::DVec3;
use std::collections::VecDeque;

/// Steps that are remembered.
const MEMORY: usize = 8;
/// Most steps.
const STEPS: u32 = 500;
/// Root mean square of the forces at rest.
const AT_REST: f64 = 2e-5;
/// Forces beyond which a shape counts as not at rest.
const UNREST: f64 = 2e-4;
/// Steps with one factored stiffness: at most, and at least where it serves badly.
const AGE: u32 = 30;
const YOUNG: u32 = 6;
/// Stiffness that every direction has at least.
const FREE: f64 = 0.03;
/// Most entries of the matrix: 240 MB.
const MAX_ENTRIES: u64 = 60_000_000;

/// Lets the loops go to rest.
pub(super) fn relax(system: &System, x: &mut [DVec3], sink: &Sink<'_>) -> Result<Rest, Refused> {
    let (first, entries) = Envelope::size(system.count, system.edges());
    if entries > MAX_ENTRIES {
        return Err(Refused::TooWide { stitches: system.count as u64 });
    }
    let mut matrix = Envelope::new(first);
    let mut slope = vec![DVec3::ZERO; x.len()];
    let mut energy = system.energy(x, &mut slope);
    let mut memory: VecDeque<Memory> = VecDeque::new();
    let mut trial = x.to_vec();
    let mut trial_slope = slope.clone();
    let mut steps = 0;
    // Steps since the stiffness was looked at.
    let mut age = AGE;
    // The forces then.
    let mut before = 0.0;
    while steps < STEPS && rms(&slope) > AT_REST {
        sink.step(u64::from(steps), u64::from(STEPS));
        let force = rms(&slope);
        if age >= AGE || (age >= YOUNG && force > 0.7 * before) {
            factor(system, x, &mut matrix)?;
            memory.clear();
            (age, before) = (0, force);
        }
        age += 1;
        let mut way = direction(&matrix, &memory, &slope);
        let mut descent = dot(&way, &slope);
        if descent.is_nan() || descent >= 0.0 {
            memory.clear();
            way = direction(&matrix, &memory, &slope);
            descent = dot(&way, &slope);
        }
        // No loop moves by more than half a stitch at once.
        let longest = way.iter().map(|way| way.length_squared()).fold(0.0, f64::max).sqrt();
        let mut length = f64::min(1.0, 0.5 / longest.max(1e-12));
        let mut found = false;
        for _ in 0..12 {
            for ((trial, x), way) in trial.iter_mut().zip(x.iter()).zip(&way) {
                *trial = *x + *way * length;
            }
            let there = system.energy(&trial, &mut trial_slope);
            if there <= energy + 1e-4 * length * descent {
                energy = there;
                found = true;
                break;
            }
            length *= 0.5;
        }
        steps += 1;
        if !found {
            if age == 1 {
                break;
            }
            age = AGE;
            continue;
        }
        let step: Vec<DVec3> = way.iter().map(|way| *way * length).collect();
        let change: Vec<DVec3> = trial_slope.iter().zip(&slope).map(|(new, old)| *new - *old).collect();
        let curvature = dot(&step, &change);
        if curvature > 1e-12 * dot(&step, &step).sqrt() * dot(&change, &change).sqrt() {
            if memory.len() == MEMORY {
                memory.pop_front();
            }
            memory.push_back(Memory { step, change, inverse: 1.0 / curvature });
        }
        x.copy_from_slice(&trial);
        slope.copy_from_slice(&trial_slope);
    }
    let residual = rms(&slope);
    let converged = residual <= UNREST && x.iter().all(|place| place.is_finite());
    Ok(Rest { residual, strain: system.strain(x), steps, converged })
}

/// The stiffness here, made a little stiffer everywhere, so that no direction is free.
fn factor(system: &System, x: &[DVec3], matrix: &mut Envelope) -> Result<(), Refused> {
    matrix.clear();
    system.stiffness(x, matrix);
    for node in 0..system.count {
        matrix.add(node, node, [[FREE, 0.0, 0.0], [0.0, FREE, 0.0], [0.0, 0.0, FREE]]);
    }
    if matrix.factor() { Ok(()) } else { Err(Refused::NotPredicted) }
}

struct Memory {
    step: Vec<DVec3>,
    change: Vec<DVec3>,
    inverse: f64,
}

/// The way downhill by what is known of the stiffness.
fn direction(matrix: &Envelope, memory: &VecDeque<Memory>, slope: &[DVec3]) -> Vec<DVec3> {
    let mut way: Vec<DVec3> = slope.iter().map(|slope| -*slope).collect();
    let mut shares = Vec::with_capacity(memory.len());
    for known in memory.iter().rev() {
        let share = known.inverse * dot(&known.step, &way);
        add(&mut way, &known.change, -share);
        shares.push(share);
    }
    matrix.solve(&mut way);
    for (known, share) in memory.iter().zip(shares.iter().rev()) {
        let back = known.inverse * dot(&known.change, &way);
        add(&mut way, &known.step, share - back);
    }
    way
}

fn add(to: &mut [DVec3], what: &[DVec3], times: f64) {
    for (to, what) in to.iter_mut().zip(what) {
        *to += *what * times;
    }
}

fn dot(a: &[DVec3], b: &[DVec3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.dot(*b)).sum()
}

fn rms(slope: &[DVec3]) -> f64 {
    (dot(slope, slope) / slope.len().max(1) as f64).sqrt()
}
