//! Where the loops begin: each round a rigid ring on the one before, tilted by what its short rows lift.

use super::Numbers;
use crate::ir::Kind;
use crate::math::{TAU, atan2, sin_cos};
use crate::preview::net::{Net, Role, Worked};
use glam::DVec3;

/// Places all loops and poles, in mm.
pub(super) fn place(nets: &[Net], numbers: &Numbers, gauge: [f64; 2], x: &mut [DVec3]) {
    let mut known = vec![false; x.len()];
    let mut right = 0.0;
    for (piece, net) in nets.iter().enumerate() {
        let ids = &numbers.ids[piece];
        let first: Vec<Option<DVec3>> = ids
            .iter()
            .take(net.start as usize)
            .map(|id| known[*id as usize].then(|| x[*id as usize]))
            .collect();
        let widest = net.rings.iter().map(Vec::len).max().unwrap_or(0) as f64;
        let reach = gauge[0] * widest * if net.flat { 0.5 } else { 1.0 / TAU } + gauge[0];
        let mut walk = Walk::new(net, gauge);
        if first.iter().all(Option::is_none) {
            walk.center.x = right + reach;
            right += 2.0 * reach;
        }
        let (places, poles) = if net.flat { (walk.rows(), [DVec3::ZERO; 2]) } else { walk.rounds(&first) };
        for (id, place) in ids.iter().zip(places) {
            if !std::mem::replace(&mut known[*id as usize], true) {
                x[*id as usize] = place;
            }
        }
        for (pole, place) in numbers.poles[piece].iter().zip(poles) {
            if let Some(pole) = pole {
                x[*pole as usize] = place;
            }
        }
    }
}

/// How much of what a round is off its plane goes on into the next.
const UNEVEN: f64 = 0.8;

struct Walk<'n> {
    net: &'n Net,
    width: f64,
    height: f64,
    center: DVec3,
    axis: DVec3,
    /// The direction of angle 0.
    right: DVec3,
    radius: f64,
    /// Angle of each loop.
    angle: Vec<f64>,
    /// Height of each loop above the plane of its round.
    rise: Vec<f64>,
    places: Vec<DVec3>,
}

impl<'n> Walk<'n> {
    fn new(net: &'n Net, [width, height]: [f64; 2]) -> Self {
        let count = net.loops as usize;
        Self {
            net,
            width,
            height,
            center: DVec3::ZERO,
            axis: DVec3::Z,
            right: DVec3::NEG_Y,
            radius: width,
            angle: vec![0.0; count],
            rise: vec![0.0; count],
            places: vec![DVec3::ZERO; count],
        }
    }

    /// The way out at an angle; the course runs to the left seen from outside.
    fn out(&self, angle: f64) -> DVec3 {
        let (sin, cos) = sin_cos(angle);
        self.right * cos + self.right.cross(self.axis) * sin
    }

    /// Steps of one row.
    fn row(&self, row: usize) -> &'n [Worked] {
        let from = self.net.cuts.get(row).map_or(0, |cut| *cut as usize);
        let to = self.net.cuts.get(row + 1).map_or(self.net.worked.len(), |cut| *cut as usize);
        self.net.worked.get(from..to).unwrap_or_default()
    }

    fn rounds(&mut self, first: &[Option<DVec3>]) -> (Vec<DVec3>, [DVec3; 2]) {
        let count = self.net.start.max(1);
        self.radius = f64::from(count) * self.width / TAU;
        self.sit(first);
        let start_pole = self.center;
        if self.net.has_ring() {
            let rise = self.height * self.height - self.radius * self.radius;
            self.center += self.axis * rise.max(0.04 * self.height * self.height).sqrt();
        }
        for id in 0..self.net.start as usize {
            let share = id as f64 / f64::from(count);
            self.angle[id] = TAU * share;
            self.rise[id] = self.height * (share - 0.5);
            let here = self.center + self.out(self.angle[id]) * self.radius + self.axis * self.rise[id];
            self.places[id] = first.get(id).copied().flatten().unwrap_or(here);
        }
        for row in 0..self.net.rings.len().saturating_sub(1) {
            self.round(row);
        }
        let end = self.center + self.axis * (0.2 * self.height);
        (std::mem::take(&mut self.places), [start_pole, end])
    }

    /// Takes the plane of loops that are there already.
    fn sit(&mut self, first: &[Option<DVec3>]) {
        let there: Vec<DVec3> = first.iter().copied().flatten().collect();
        if there.len() < 3 {
            return;
        }
        self.center = there.iter().sum::<DVec3>() / there.len() as f64;
        let turn = (0..there.len())
            .map(|k| (there[k] - self.center).cross(there[(k + 1) % there.len()] - self.center))
            .sum::<DVec3>();
        if let Some(axis) = (-turn).try_normalize() {
            self.axis = axis;
        }
        let to_first = first.first().copied().flatten().unwrap_or(there[0]) - self.center;
        let flat = to_first - self.axis * to_first.dot(self.axis);
        self.right = flat.try_normalize().unwrap_or_else(|| self.axis.any_orthonormal_vector());
    }

    fn round(&mut self, row: usize) {
        let Some(ring) = self.net.rings.get(row + 1).filter(|ring| !ring.is_empty()) else { return };
        let count = ring.len() as f64;
        let radius = count * self.width / TAU;
        let between = 0.5 * (self.radius + radius);
        let quarter = 0.5 * self.width / between.max(self.width);
        for step in self.row(row) {
            self.lay(step, quarter);
        }
        // Loops stand evenly around, turned so that they lie over those below as well as they can.
        let (mut sine, mut cosine) = (0.0, 0.0);
        for (k, id) in ring.iter().enumerate() {
            let (sin, cos) = sin_cos(self.angle[*id as usize] - TAU * k as f64 / count);
            (sine, cosine) = (sine + sin, cosine + cos);
        }
        let turn = if sine == 0.0 && cosine == 0.0 { 0.0 } else { atan2(sine, cosine) };
        // The plane of the round: its mean height and tilt, beside the rise of the helix.
        let helix = |k: usize| self.height * (k as f64 / count - 0.5);
        let (mut mean, mut along, mut across) = (0.0, 0.0, 0.0);
        for (k, id) in ring.iter().enumerate() {
            let (sin, cos) = sin_cos(turn + TAU * k as f64 / count);
            let off = self.rise[*id as usize] - helix(k);
            (mean, along, across) = (mean + off, along + off * cos, across + off * sin);
        }
        let (mean, along, across) = (mean / count, 2.0 * along / count, 2.0 * across / count);
        let flare = (radius - self.radius) / mean.max(0.2 * self.height);
        let steep = (1.0 - flare * flare).max(0.02).sqrt();
        for step in self.row(row) {
            for id in Net::top(step) {
                let k = id as usize;
                self.places[k] =
                    self.center + self.out(self.angle[k]) * between + self.axis * (self.rise[k] * steep);
            }
        }
        let forward = self.right.cross(self.axis);
        let (by_right, by_forward) = (along / radius, across / radius);
        self.center += self.axis * (mean * steep);
        let axis = (self.axis - self.right * by_right - forward * by_forward).normalize_or(self.axis);
        let right = self.right - axis * self.right.dot(axis);
        self.right = right.try_normalize().unwrap_or_else(|| axis.any_orthonormal_vector());
        self.axis = axis;
        self.radius = radius;
        for (k, id) in ring.iter().enumerate() {
            let angle = turn + TAU * k as f64 / count;
            let (sin, cos) = sin_cos(angle);
            let rest = self.rise[*id as usize] - helix(k) - mean - along * cos - across * sin;
            let id = *id as usize;
            self.angle[id] = angle;
            self.rise[id] = rest * UNEVEN + helix(k);
            self.places[id] = self.center + self.out(angle) * radius + self.axis * self.rise[id];
        }
    }

    /// Angle and height of what a step makes.
    fn lay(&mut self, step: &Worked, quarter: f64) {
        let base = self.net.base(step);
        let tall = match step.role {
            Role::Work(stitch) => stitch.kind.height(),
            Role::Chain | Role::Ring | Role::Turn(_) | Role::Close => Kind::Sc.height(),
        };
        let (angle, rise) = if let Some(&first) = base.first() {
            let from = self.angle[first as usize];
            let turn = |id: &u32| {
                let turn = (self.angle[*id as usize] - from) / TAU;
                (turn - turn.round()) * TAU
            };
            let share = 1.0 / base.len() as f64;
            let rise = base.iter().map(|id| self.rise[*id as usize]).sum::<f64>() * share;
            (from + base.iter().map(turn).sum::<f64>() * share, rise)
        } else {
            let before = step.top.saturating_sub(1) as usize;
            let angle = self.angle.get(before).copied().unwrap_or(0.0);
            (angle + 2.0 * quarter, self.rise.get(before).copied().unwrap_or(0.0) - self.height * tall)
        };
        let middle = 0.5 * (f64::from(step.makes) - 1.0);
        for (k, id) in Net::top(step).enumerate() {
            self.angle[id as usize] = angle + (k as f64 - middle) * quarter;
            self.rise[id as usize] = rise + self.height * tall;
        }
    }

    /// A flat piece stands upright and faces the front.
    fn rows(&mut self) -> Vec<DVec3> {
        let place = |center: DVec3, along: f64, up: f64| center + DVec3::new(-along, 0.0, up);
        let start = self.net.start;
        for id in 0..start as usize {
            self.angle[id] = (id as f64 - 0.5 * (f64::from(start) - 1.0)) * self.width;
        }
        for row in 0..self.net.rings.len().saturating_sub(1) {
            let mut made: Vec<u32> = Vec::new();
            for step in self.row(row) {
                // Angles are lengths here, too small to be taken for turns.
                let base = self.net.base(step);
                let share = 1.0 / base.len().max(1) as f64;
                let before = step.top.saturating_sub(1) as usize;
                let (along, up) = if base.is_empty() {
                    let side = if step.against { -self.width } else { self.width };
                    (
                        self.angle.get(before).map_or(0.0, |a| a + side),
                        self.rise.get(before).copied().unwrap_or(0.0),
                    )
                } else {
                    let sum = base.iter().fold((0.0, 0.0), |sum: (f64, f64), id| {
                        (sum.0 + self.angle[*id as usize], sum.1 + self.rise[*id as usize])
                    });
                    let tall = match step.role {
                        Role::Work(stitch) => stitch.kind.height(),
                        Role::Chain | Role::Ring | Role::Turn(_) | Role::Close => 0.0,
                    };
                    (sum.0 * share, sum.1 * share + tall * self.height)
                };
                for id in Net::top(step) {
                    self.angle[id as usize] = along;
                    self.rise[id as usize] = up;
                    made.push(id);
                }
            }
            if self.row(row).first().is_some_and(|step| step.against) {
                made.reverse();
            }
            let middle =
                made.iter().map(|id| self.angle[*id as usize]).sum::<f64>() / made.len().max(1) as f64;
            let half = 0.5 * (made.len() as f64 - 1.0);
            for (k, id) in made.iter().enumerate() {
                self.angle[*id as usize] = middle + (k as f64 - half) * self.width;
            }
        }
        let both = self.angle.iter().zip(&self.rise);
        both.map(|(along, up)| place(self.center, *along, *up)).collect()
    }
}
