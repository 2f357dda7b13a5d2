//! Forks at which neither limb goes on: the object divides, as a pair of trousers does.

use super::cut::ASIDE;
use super::levels::Levels;
use super::tree::{Limb, Tree};
use super::way::Way;
use crate::ir::Gauge;
use crate::math::atan2;
use crate::shape::ring::Ring;
use crate::shape::split::share;
use glam::DVec3;
use std::f64::consts::PI;

/// Limbs turn from the direction before by at most this (radians), and by at most this much more than each other.
const MOST_TURN: f64 = 0.6;
const MOST_APART: f64 = 0.25;
/// Least girth of the thinner limb against the thicker one; and least and greatest girth of both together against what
/// divides, for they share it: limbs that are each as thick leave the side of each other.
const ALIKE: f64 = 0.75;
const TOGETHER: [f64; 2] = [0.95, 1.5];
/// Length of the crotch in stitches; and its least and greatest share of the girth of what divides.
const CROTCH: f64 = 5.0;
const CROTCH_SHARE: [f64; 2] = [0.05, 0.12];
/// Lines at which the crotch is measured.
const LINES: u32 = 48;

/// Where and how a limb divides.
#[derive(Clone, Debug)]
pub(super) struct Division {
    /// The level of its last line.
    pub(super) level: f64,
    /// That line.
    pub(super) last: Ring,
    /// The lines that its children begin with, in their order.
    pub(super) rims: [Ring; 2],
}

impl Levels<'_> {
    /// How a limb divides, where both its children are as much a continuation of it as the other.
    pub(super) fn division(&self, tree: &Tree, fork: &Limb, ways: &[Way], gauge: Gauge) -> Option<Division> {
        let [one, two] = fork.children.as_slice() else { return None };
        let children = [tree.limbs.get(*one)?, tree.limbs.get(*two)?];
        let (before, girth) = self.course(fork, ways, false);
        let [(first, thick), (second, thin)] = children.map(|child| self.course(child, ways, true));
        let turn = |to: DVec3| atan2(before.cross(to).length(), before.dot(to));
        let (turns, girths) = ([turn(first), turn(second)], [thick, thin]);
        let (thin, thick) = (thick.min(thin), thick.max(thin));
        if turns.iter().any(|turn| *turn > MOST_TURN)
            || (turns[0] - turns[1]).abs() > MOST_APART
            || thin < ALIKE * thick
            || !(TOGETHER[0]..=TOGETHER[1]).contains(&(girths.iter().sum::<f64>() / girth))
        {
            return None;
        }
        let way = &ways[fork.leaf];
        let lines = children
            .map(|child| self.line(child.low + ASIDE * super::cut::range(tree), &ways[child.leaf].vertices));
        let [Some(first), Some(second)] = lines else { return None };
        let goal = (CROTCH * gauge.width).clamp(CROTCH_SHARE[0] * girth, CROTCH_SHARE[1] * girth);
        let from = way.down_to(fork.high);
        let most = (0.5 * (way.down_to(fork.low) - from)).min(girth / PI);
        (1..=LINES).find_map(|k| {
            let level = way.level_at(from + most * f64::from(k) / f64::from(LINES));
            let last = self.line(level, &way.vertices)?;
            let shares = share(&last, [&first, &second])?;
            (shares.crotch >= goal).then_some(Division { level, last, rims: shares.rims })
        })
    }
}
