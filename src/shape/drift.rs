//! Stitches that do not stand quite straight: how far a fabric twists by itself, and surfaces twisted the other way.

use super::{Jet, Mirrored, ParametricSurface};
use crate::ir::{Gauge, Graph, Hand, Maker};
use crate::math::{TAU, sin_cos_turns};
use glam::{DMat3, DVec3};

/// Pieces of a tube; within one the axis of the twist stands still.
const PIECES: usize = 256;
/// Points around a tube by which its axis and girth are told.
const AROUND: u32 = 24;
/// Fewest stitches of a round, as in a magic ring.
const LEAST_ROUND: f64 = 6.0;

/// How a tube twists as it is worked. The top of a single crochet does not lie straight over its post, so columns drift
/// by `lean` stitches in each round, and with them all that lies on them: bumps, and the direction of bends.
///
/// Rotating everything above a row about the axis of that row, row by row, is a rigid motion M(u) for each row u. What is
/// laid on the surface M S comes out as S once it has drifted: see [`Twisted`].
#[derive(Clone, Debug)]
pub struct Drift {
    pieces: Vec<Piece>,
}

/// A piece of the tube.
#[derive(Clone, Copy, Debug)]
struct Piece {
    /// Drift at its start, in turns, and how it grows with u.
    start: f64,
    rate: f64,
    /// A point of the axis there, and the direction about which v turns right-handed.
    center: DVec3,
    axis: DVec3,
    /// The motion at its start.
    turn: DMat3,
    shift: DVec3,
}

/// The motion of one row: first about the axis of its piece, then with all rows below.
struct Motion<'d> {
    piece: &'d Piece,
    sin: f64,
    cos: f64,
}

impl Motion<'_> {
    /// A vector turned about the axis of the piece.
    fn turned(&self, x: DVec3) -> DVec3 {
        let axis = self.piece.axis;
        x * self.cos + axis.cross(x) * self.sin + axis * (axis.dot(x) * (1.0 - self.cos))
    }
    fn apply(&self, x: DVec3) -> DVec3 {
        let Piece { center, turn, shift, .. } = *self.piece;
        turn * (center + self.turned(x - center)) + shift
    }
    fn undo(&self, x: DVec3) -> DVec3 {
        let Piece { center, turn, shift, .. } = *self.piece;
        let back = Self { piece: self.piece, sin: -self.sin, cos: self.cos };
        center + back.turned(turn.transpose() * (x - shift) - center)
    }
}

impl Drift {
    /// The drift of stitches of a size that lean by so many stitches a round, positive in working direction.
    pub fn new(surface: &dyn ParametricSurface, gauge: &Gauge, lean: f64) -> Self {
        let step = 1.0 / PIECES as f64;
        let mut pieces: Vec<Piece> = Vec::with_capacity(PIECES);
        let (mut start, mut turn, mut shift) = (0.0, DMat3::IDENTITY, DVec3::ZERO);
        for k in 0..PIECES {
            let u = (k as f64 + 0.5) * step;
            let jets: Vec<Jet> =
                (0..AROUND).map(|j| surface.jet(u, f64::from(j) / f64::from(AROUND))).collect();
            let mean = |of: &dyn Fn(&Jet) -> f64| jets.iter().map(of).sum::<f64>() / f64::from(AROUND);
            let center = jets.iter().map(|jet| jet.point).sum::<DVec3>() / f64::from(AROUND);
            let next = jets.iter().cycle().skip(1);
            let area: DVec3 =
                jets.iter().zip(next).map(|(a, b)| (a.point - center).cross(b.point - center)).sum();
            let before = pieces.last().map_or(DVec3::NEG_Z, |piece| piece.axis);
            let rows = mean(&rows_apart) / gauge.height;
            let round = (mean(&|jet| jet.dv.length()) / gauge.width).max(LEAST_ROUND);
            let rate = Some(lean * rows / round).filter(|rate| rate.is_finite()).unwrap_or(0.0);
            let piece = Piece { start, rate, center, axis: area.normalize_or(before), turn, shift };
            let motion = piece.motion(step);
            turn = DMat3::from_cols(
                piece.turn * motion.turned(DVec3::X),
                piece.turn * motion.turned(DVec3::Y),
                piece.turn * motion.turned(DVec3::Z),
            );
            shift = motion.apply(DVec3::ZERO);
            start += rate * step;
            pieces.push(piece);
        }
        Self { pieces }
    }

    /// The piece of a row and the way into it; below the first row nothing drifts.
    fn at(&self, u: f64) -> (&Piece, f64) {
        let inside = u.max(0.0);
        let index = ((inside * PIECES as f64) as usize).min(PIECES - 1);
        (&self.pieces[index], inside - index as f64 / PIECES as f64)
    }

    /// How far the row at u has drifted, in turns.
    pub fn turns(&self, u: f64) -> f64 {
        let (piece, past) = self.at(u);
        piece.start + piece.rate * past
    }

    fn motion(&self, u: f64) -> Motion<'_> {
        let (piece, past) = self.at(u);
        piece.motion(past)
    }

    /// A graph that was laid on the [`Twisted`] surface, as it comes out.
    #[must_use]
    pub fn come_out(&self, graph: Graph) -> Graph {
        self.moved(graph, 1.0)
    }

    /// A graph as it was laid on the [`Twisted`] surface, from one as it came out.
    #[must_use]
    pub fn as_laid(&self, graph: Graph) -> Graph {
        self.moved(graph, -1.0)
    }

    /// With the drift (1) or against it (-1).
    fn moved(&self, mut graph: Graph, sign: f64) -> Graph {
        let way = |motion: &Motion<'_>, x| if sign > 0.0 { motion.undo(x) } else { motion.apply(x) };
        for node in &mut graph.nodes {
            node.position = way(&self.motion(node.u), node.position);
            let v = (node.v + sign * self.turns(node.u)).rem_euclid(1.0);
            // A hair below zero rounds up to a whole turn.
            node.v = if v < 1.0 { v } else { 0.0 };
        }
        graph.pole = graph.pole.map(|pole| way(&self.motion(0.0), pole));
        graph.end_pole = graph.end_pole.map(|pole| way(&self.motion(1.0), pole));
        graph
    }
}

/// Distance of neighboring rows for one unit of u.
fn rows_apart(jet: &Jet) -> f64 {
    let around = jet.dv.length();
    if around > 1e-12 { jet.du.cross(jet.dv).length() / around } else { jet.du.length() }
}

impl Piece {
    /// Against the drift, so far into the piece.
    fn motion(&self, past: f64) -> Motion<'_> {
        let (sin, cos) = sin_cos_turns(-self.rate * past);
        Motion { piece: self, sin, cos }
    }
}

/// A surface twisted against the drift of its stitches: T(u, v) = M(u) S(u, v + d(u)), where d is the drift in turns.
/// A surface of revolution with a straight axis is its own twist.
#[derive(Clone, Copy, Debug)]
pub struct Twisted<'s> {
    /// The surface as it shall come out.
    pub surface: &'s dyn ParametricSurface,
    /// The drift of its stitches.
    pub drift: &'s Drift,
}

impl ParametricSurface for Twisted<'_> {
    fn point(&self, u: f64, v: f64) -> DVec3 {
        self.drift.motion(u).apply(self.surface.point(u, v + self.drift.turns(u)))
    }

    fn jet(&self, u: f64, v: f64) -> Jet {
        let (piece, past) = self.drift.at(u);
        let motion = piece.motion(past);
        let jet = self.surface.jet(u, v + piece.start + piece.rate * past);
        let rate = if u < 0.0 { 0.0 } else { piece.rate };
        let arm = motion.turned(jet.point - piece.center);
        let carried = piece.axis.cross(arm) * (-TAU * rate);
        Jet {
            point: piece.turn * (piece.center + arm) + piece.shift,
            du: piece.turn * (motion.turned(jet.du + jet.dv * rate) + carried),
            dv: piece.turn * motion.turned(jet.dv),
        }
    }
}

/// Hands on the surface that the stitches of this maker are laid on, so that the surface itself comes out: its mirror image for
/// the left hand, twisted against the drift of stitches that lean; and that drift.
pub fn for_maker<R>(
    surface: &dyn ParametricSurface,
    gauge: &Gauge,
    maker: Maker,
    then: impl FnOnce(&dyn ParametricSurface, Option<&Drift>) -> R,
) -> R {
    let mirror = Mirrored(surface);
    let surface: &dyn ParametricSurface = match maker.hand {
        Hand::Right => surface,
        Hand::Left => &mirror,
    };
    if maker.lean == 0.0 {
        return then(surface, None);
    }
    let drift = Drift::new(surface, gauge, maker.lean);
    then(&Twisted { surface, drift: &drift }, Some(&drift))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{cos, sin};

    /// A bent, bumpy tube.
    #[derive(Debug)]
    struct Bumpy;

    impl ParametricSurface for Bumpy {
        fn point(&self, u: f64, v: f64) -> DVec3 {
            let radius = 10.0 + 2.0 * cos(TAU * v) * sin(6.0 * u) + 3.0 * u;
            let out = DVec3::new(cos(TAU * v), -sin(TAU * v), 0.0) * radius;
            DVec3::new(8.0 * u * u, 0.0, 60.0 * u) + out
        }
    }

    #[test]
    fn derivatives_are_those_of_the_points() {
        let drift = Drift::new(&Bumpy, &Gauge::new(2.0, 2.0), 0.4);
        let twisted = Twisted { surface: &Bumpy, drift: &drift };
        for (u, v) in [(0.1, 0.2), (0.5004, 0.7), (0.93, 0.05)] {
            let jet = twisted.jet(u, v);
            let slope = |a: DVec3, b: DVec3| (b - a) / 2e-6;
            let du = slope(twisted.point(u - 1e-6, v), twisted.point(u + 1e-6, v));
            let dv = slope(twisted.point(u, v - 1e-6), twisted.point(u, v + 1e-6));
            assert!(jet.point.distance(twisted.point(u, v)) < 1e-12);
            assert!(jet.du.distance(du) < 1e-3 * du.length(), "{} {du}", jet.du);
            assert!(jet.dv.distance(dv) < 1e-3 * dv.length(), "{} {dv}", jet.dv);
        }
    }

    #[test]
    fn the_motion_of_a_row_is_rigid_and_has_an_inverse() {
        let drift = Drift::new(&Bumpy, &Gauge::new(2.0, 2.0), -0.7);
        for u in [0.0, 0.3, 0.77, 1.0, 1.04] {
            let motion = drift.motion(u);
            let (a, b) = (DVec3::new(3.0, -20.0, 11.0), DVec3::new(-7.0, 4.0, 50.0));
            assert!((motion.apply(a).distance(motion.apply(b)) - a.distance(b)).abs() < 1e-9);
            assert!(motion.undo(motion.apply(a)).distance(a) < 1e-9);
        }
        assert_eq!(drift.turns(-0.1), 0.0);
        assert!(drift.turns(1.0) < -0.3);
    }

    #[test]
    fn a_straight_tube_of_revolution_stays_as_it_is() {
        let sphere = crate::shape::analytic::Sphere { radius: 30.0 };
        let drift = Drift::new(&sphere, &Gauge::new(4.0, 4.0), 0.5);
        let twisted = Twisted { surface: &sphere, drift: &drift };
        for (u, v) in [(0.02, 0.1), (0.4, 0.6), (0.99, 0.9)] {
            assert!(twisted.point(u, v).distance(sphere.point(u, v)) < 1e-9);
        }
    }
}
