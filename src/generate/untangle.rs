//! The last resort against inverted tiles: the few loops around each are moved, one by one, to where none is.
//!
//! The sweeps of the relaxation move all loops at once, and judge a tile by a normal that is a few sweeps old. Here the surface
//! is looked up at every place that is tried, so that what comes out is what a measure of the result finds. Nothing moves
//! where no tile is inverted.

use super::relax::{STEP_REST, STEP_WEIGHT};
use super::sheet::{EdgeKind, Quad, Sheet, pull_back};
use crate::ir::NodeId;
use crate::shape::{Jet, ParametricSurface};
use glam::DVec3;
use std::collections::BTreeMap;

/// A tile that has less than this share of its area is pushed open: the weight of what it lacks, squared, and the price of one
/// that is inverted. Strains are squared too.
const NARROW: f64 = 0.3;
const NARROW_WEIGHT: f64 = 4.0;
const INVERTED: f64 = 3.0;
/// Weight of square tiles.
const SQUARENESS: f64 = 0.27;
/// Cosine between a tile and the surface as last seen, squared, under which the tile is looked at closely; and the square of the
/// surface's area there as a share of that at the opposite corner, for at the inner side of a tight bend normals change fast.
const LEANING: f64 = 0.36;
const PINCHED: f64 = 0.5;
/// First and last step of the search for a place, in stitch widths and heights.
const FIRST_STEP: f64 = 0.4;
const LAST_STEP: f64 = 0.02;
/// Directions of the search.
const DIAGONAL: f64 = std::f64::consts::FRAC_1_SQRT_2;
const DIRECTIONS: [[f64; 2]; 8] = [
    [1.0, 0.0],
    [-1.0, 0.0],
    [0.0, 1.0],
    [0.0, -1.0],
    [DIAGONAL, DIAGONAL],
    [DIAGONAL, -DIAGONAL],
    [-DIAGONAL, DIAGONAL],
    [-DIAGONAL, -DIAGONAL],
];
/// Longest step around the tube, in turns: at a pole all of them are one place.
const LONGEST_TURN: f64 = 0.1;
/// Most passes over the loops.
const PASSES: u32 = 24;

/// Where loops may lie, and what their tiles are seen against.
pub(super) struct Untangler<'s> {
    /// The surface that loops lie on, and the one whose outside counts.
    pub on: &'s dyn ParametricSurface,
    pub outside: &'s dyn ParametricSurface,
    /// How much farther around the tube the places of a sheet lie on both.
    pub turn: f64,
    /// Least and greatest u of a loop.
    pub range: [f64; 2],
    /// Loops of the first row.
    pub start: usize,
    /// The center of the ring that these are worked into; without it they stay where they are.
    pub pole: Option<DVec3>,
    /// The surface as last seen by a sheet says little about the outside: each tile is looked at closely.
    pub close: bool,
}

impl Untangler<'_> {
    /// Moves loops until no tile is inverted, or it helps no more. Returns the inverted tiles before and after.
    pub(super) fn untangle(&self, sheet: &mut Sheet) -> [usize; 2] {
        let mut inverted = self.inverted(sheet);
        let before = inverted.len();
        for _ in 0..PASSES {
            if inverted.is_empty() {
                break;
            }
            let fixed = if self.pole.is_some() { 0 } else { self.start };
            let near = near(sheet, &inverted, fixed);
            let moved = near.iter().filter(|(id, around)| self.settle(sheet, **id, around)).count();
            inverted = self.inverted(sheet);
            if moved == 0 {
                break;
            }
        }
        [before, inverted.len()]
    }

    fn normal(&self, u: f64, v: f64) -> DVec3 {
        let jet = self.outside.jet(u, v + self.turn);
        jet.dv.cross(jet.du).normalize_or_zero()
    }

    fn normal_at(&self, sheet: &Sheet, id: NodeId) -> DVec3 {
        self.normal(sheet.u[id as usize], sheet.v[id as usize])
    }

    /// The inverted tiles, as places in the list of all.
    fn inverted(&self, sheet: &Sheet) -> Vec<usize> {
        let seen = |id: NodeId| {
            let jet = sheet.jet(id);
            jet.dv.cross(jet.du)
        };
        let leans = |quad: &Quad, area: DVec3| {
            let normal = seen(quad.corners[0]);
            let (cos, size) = (area.dot(normal), normal.length_squared());
            cos <= 0.0
                || cos * cos < LEANING * area.length_squared() * size
                || size < PINCHED * seen(quad.corners[3]).length_squared()
        };
        let is_inverted = |quad: &Quad| {
            quad.area(|id| sheet.point[id as usize]).is_some_and(|area| {
                (self.close || leans(quad, area)) && area.dot(self.normal_at(sheet, quad.corners[0])) <= 0.0
            })
        };
        let quads = sheet.quads.iter().enumerate();
        quads.filter(|(_, quad)| is_inverted(quad)).map(|(index, _)| index).collect()
    }

    /// Moves one loop to the best place nearby. True if it moved.
    fn settle(&self, sheet: &mut Sheet, id: NodeId, around: &Around) -> bool {
        let i = id as usize;
        // The normals of tiles that begin with another loop do not change.
        let begins = |quad: &Quad| quad.corners[0] == id;
        let tiles: Vec<(&Quad, Option<DVec3>)> = around
            .quads
            .iter()
            .map(|quad| (quad, (!begins(quad)).then(|| self.normal_at(sheet, quad.corners[0]))))
            .collect();
        let begins = around.quads.iter().any(begins);
        let pole = self.pole.filter(|_| i < self.start);
        let price = |u: f64, v: f64, point: DVec3| {
            let own = if begins { self.normal(u, v) } else { DVec3::ZERO };
            let at = |other: NodeId| if other == id { point } else { sheet.point[other as usize] };
            let tiles = tiles.iter().map(|(quad, normal)| tile(sheet, quad, at, normal.unwrap_or(own)));
            let edges = around.links.iter().map(|link| {
                let strain = point.distance(sheet.point[link.to as usize]) / link.rest - 1.0;
                link.weight * strain * strain
            });
            let ring = pole.map_or(0.0, |pole| (point.distance(pole) / sheet.height - 1.0).powi(2));
            tiles.sum::<f64>() + edges.sum::<f64>() + ring
        };
        let (mut u, mut v) = (sheet.u[i], sheet.v[i]);
        let first = price(u, v, sheet.point[i]);
        let mut best = first;
        let mut step = FIRST_STEP;
        while step > LAST_STEP {
            let jet = self.on.jet(u, v + self.turn);
            let mut next = None;
            for [x, y] in DIRECTIONS {
                let way = along(&jet, x * step * sheet.width, y * step * sheet.height);
                let (by_u, by_v) = pull_back(jet.du, jet.dv, way);
                let to_u = (u + by_u).clamp(self.range[0], self.range[1]);
                let to_v = v + by_v.clamp(-LONGEST_TURN, LONGEST_TURN);
                let price = price(to_u, to_v, self.on.point(to_u, to_v + self.turn));
                if price < best - 1e-9 {
                    (best, next) = (price, Some((to_u, to_v)));
                }
            }
            match next {
                Some(place) => (u, v) = place,
                None => step *= 0.5,
            }
        }
        if best < first {
            let jet = self.on.jet(u, v + self.turn);
            (sheet.u[i], sheet.v[i], sheet.point[i]) = (u, v, jet.point);
            (sheet.du[i], sheet.dv[i]) = (jet.du, jet.dv);
        }
        best < first
    }
}

/// The price of a tile that is seen against a normal; 0 for turns and tiles of three corners.
fn tile(sheet: &Sheet, quad: &Quad, at: impl Fn(NodeId) -> DVec3, normal: DVec3) -> f64 {
    let Some(area) = quad.area(&at) else { return 0.0 };
    let [b0, b1, t0, t1] = quad.corners.map(at);
    let (across, up) = ((b1 - b0) + (t1 - t0), (t0 - b0) + (t1 - b1));
    let size = (across.length_squared() * up.length_squared()).sqrt();
    let cos = if size > 0.0 { across.dot(up) / size } else { 0.0 };
    let share = area.dot(normal) / (2.0 * sheet.width * sheet.height);
    let lack = (NARROW - share).max(0.0);
    let inverted = if share <= 0.0 { INVERTED } else { 0.0 };
    SQUARENESS * cos * cos + NARROW_WEIGHT * lack * lack + inverted
}

/// So far around the tube and along it (mm).
fn along(jet: &Jet, x: f64, y: f64) -> DVec3 {
    let around = jet.dv.normalize_or_zero();
    let up = (jet.du - around * jet.du.dot(around)).normalize_or_zero();
    around * x + up * y
}

/// An edge to another loop.
struct Link {
    to: NodeId,
    rest: f64,
    weight: f64,
}

/// What hangs on a loop.
#[derive(Default)]
struct Around {
    links: Vec<Link>,
    quads: Vec<Quad>,
}

/// The loops of some tiles and of those beside them, with what hangs on each; without the first ones that are fixed.
fn near(sheet: &Sheet, tiles: &[usize], fixed: usize) -> BTreeMap<NodeId, Around> {
    let mut is_near = vec![false; sheet.len()];
    for id in tiles.iter().flat_map(|tile| sheet.quads[*tile].corners) {
        is_near[id as usize] = true;
    }
    let beside = sheet.quads.iter().filter(|quad| quad.corners.iter().any(|id| is_near[*id as usize]));
    let beside: Vec<NodeId> = beside.flat_map(|quad| quad.corners).collect();
    for id in beside {
        is_near[id as usize] = true;
    }
    is_near[..fixed].fill(false);
    let mut near: BTreeMap<NodeId, Around> = BTreeMap::new();
    for edge in &sheet.edges {
        let (rest, weight) = match edge.kind {
            EdgeKind::Course => (sheet.width, 1.0),
            EdgeKind::Wale => (sheet.height, 1.0),
            EdgeKind::Step => (f64::from(STEP_REST) * sheet.width, f64::from(STEP_WEIGHT)),
        };
        for (own, to) in [(edge.a, edge.b), (edge.b, edge.a)] {
            if is_near[own as usize] {
                near.entry(own).or_default().links.push(Link { to, rest, weight });
            }
        }
    }
    for quad in &sheet.quads {
        for (k, id) in quad.corners.iter().enumerate() {
            if is_near[*id as usize] && !quad.corners[..k].contains(id) {
                near.entry(*id).or_default().quads.push(*quad);
            }
        }
    }
    near
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate::rows::{Rows, lead};
    use crate::generate::{first_row, symmetric};
    use crate::ir::Gauge;
    use crate::shape::End;
    use crate::shape::analytic::Cone;

    /// Rounds of 20 on a cylinder of 20 mm radius.
    fn tube() -> (Cone, Sheet) {
        let gauge = Gauge::new(std::f64::consts::TAU, 6.0);
        let cylinder = Cone { start: 20.0, end: 20.0, length: 60.0 };
        let rows = Rows::new(&cylinder, [lead(End::Open); 2], &gauge).expect("rows");
        let mut sheet = Sheet::new(&gauge, 200);
        first_row::lay(&cylinder, &mut sheet, first_row::centered_places(20), &rows);
        symmetric::lay_rounds(&cylinder, &mut sheet, &rows, &[20; 9], |_| {});
        (cylinder, sheet)
    }

    fn untangler(on: &Cone) -> Untangler<'_> {
        Untangler { on, outside: on, turn: 0.0, range: [0.0, 1.0], start: 20, pole: None, close: false }
    }

    fn move_to(cylinder: &Cone, sheet: &mut Sheet, id: usize, u: f64, v: f64) {
        (sheet.u[id], sheet.v[id], sheet.point[id]) = (u, v, cylinder.point(u, v));
    }

    #[test]
    fn loops_that_crossed_come_apart_and_those_far_away_stay() {
        let (cylinder, mut sheet) = tube();
        let smooth = sheet.point.clone();
        // A loop beyond the two after it, and one above that on it.
        let [u, v] = [sheet.u[92], sheet.v[92] + 0.07];
        move_to(&cylinder, &mut sheet, 91, u, v);
        let [u, v] = [sheet.u[70] - 0.02, sheet.v[70]];
        move_to(&cylinder, &mut sheet, 90, u, v);
        let [before, after] = untangler(&cylinder).untangle(&mut sheet);
        assert!(before > 1 && after == 0, "{before} to {after}");
        for (id, (point, smooth)) in sheet.point.iter().zip(&smooth).enumerate() {
            let far = if (48..=135).contains(&id) { 6.0 } else { 0.0 };
            assert!(point.distance(*smooth) <= far, "{id}: {}", point.distance(*smooth));
        }
    }

    #[test]
    fn where_no_tile_is_inverted_nothing_moves() {
        let (cylinder, mut sheet) = tube();
        let [u, v] = [sheet.u[91], sheet.v[91] + 0.02];
        move_to(&cylinder, &mut sheet, 91, u, v);
        let before = sheet.point.clone();
        assert_eq!(untangler(&cylinder).untangle(&mut sheet), [0, 0]);
        assert!(sheet.point == before);
    }

    #[test]
    fn loops_of_an_open_first_row_stay() {
        let (cylinder, mut sheet) = tube();
        let [u, v] = [sheet.u[6], sheet.v[6] + 0.07];
        move_to(&cylinder, &mut sheet, 5, u, v);
        let first = sheet.point[..20].to_vec();
        let [before, _] = untangler(&cylinder).untangle(&mut sheet);
        assert!(before > 0 && sheet.point[..20] == first);
    }
}
