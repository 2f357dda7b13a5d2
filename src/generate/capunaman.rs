//! The baseline of the paper's tables, after Çapunaman, Bingöl and Gürsoy (2017): rows of evenly spaced nodes on the
//! helix, each joined to the nearest node of the next row. No short rows, no moving window, and its wales may cross.

use super::options::Options;
use super::relax::{Effort, Ends, Mark, Relaxer, Stretch};
use super::sheet::{Foot, Shaped, Sheet};
use crate::diag::{Code, Diagnostic, Sink};
use crate::ir::{Gauge, MAX_ROW, Node, NodeId};
use crate::shape::{End, ParametricSurface, Tube};

/// Places around a row where its distance to the next is taken.
const AROUND: u32 = 20;
/// Chords that a row's length is summed over.
const ROW_STEPS: u32 = 80;
/// Most distances that the search for nearest nodes may take; it is quadratic in the stitches of a row.
const MAX_DISTANCES: usize = 4_000_000_000;
/// Wales from the last part of a row to the first part of the next are refused: they would jump over the seam.
const SEAM: [f64; 2] = [0.6, 0.3];

/// A net of nodes and wales. The yarn runs from node to node.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Baseline {
    /// The nodes along the helix.
    pub nodes: Vec<Node>,
    /// First node of each row, and the number of nodes at the end.
    pub rows: Vec<usize>,
    /// From a node to one in the next row, sorted.
    pub wales: Vec<(NodeId, NodeId)>,
}

impl Baseline {
    /// Nodes of the first row.
    pub fn start(&self) -> usize {
        self.rows.get(1).copied().unwrap_or(self.nodes.len())
    }

    /// Lets all nodes but the first row of an open tube move on the surface until lengths and angles agree best, as the
    /// stitches of our own algorithm do in the end. The wales stay.
    pub fn settle(&mut self, tube: &Tube, gauge: &Gauge, options: &Options) {
        let surface = &*tube.surface;
        let mut sheet = Sheet::new(gauge, self.nodes.len());
        for (id, node) in self.nodes.iter().enumerate() {
            let jet = surface.jet(node.u, node.v);
            let foot = Foot {
                u: node.u,
                v: node.tau,
                point: jet.point,
                du: jet.du,
                dv: jet.dv,
                along: jet.dv.normalize_or_zero(),
            };
            sheet.add(&foot, Shaped::No);
            if id > 0 {
                sheet.course(id as NodeId - 1, id as NodeId);
            }
        }
        let mut before: Option<(NodeId, NodeId)> = None;
        for &(base, top) in &self.wales {
            let beside = before.filter(|&(left, last)| base - left <= 1 && last <= top && top - last <= 1);
            sheet.wale(beside, base, top);
            before = Some((base, top));
        }
        let free = if tube.start == End::Closed { 0 } else { self.start() };
        let all = Stretch::since(Mark { nodes: free, ..Mark::default() }, &sheet);
        Relaxer::default().relax(
            surface,
            &mut sheet,
            all,
            0,
            Effort { sweeps: options.sweeps_over(all.until.nodes), squareness: options.squareness },
            Ends { range: [0.0, 1.0], ring: None, level: None, opens: false },
        );
        for (id, node) in self.nodes.iter_mut().enumerate() {
            let (u, tau) = (sheet.u[id], sheet.v[id]);
            *node = Node { position: sheet.point[id], u, tau, v: tau.rem_euclid(1.0) };
        }
    }

    /// Counts of shapings and crossings.
    pub fn counts(&self) -> Counts {
        let increases = self.wales.windows(2).filter(|pair| pair[0].0 == pair[1].0).count();
        let mut tops: Vec<NodeId> = self.wales.iter().map(|wale| wale.1).collect();
        let crossings = tops.windows(2).filter(|pair| pair[0] > pair[1]).count();
        tops.sort_unstable();
        let decreases = tops.windows(2).filter(|pair| pair[0] == pair[1]).count();
        Counts { increases, decreases, crossings }
    }

    /// The first row, from 1, that no hook can work: a loop of it is skipped, or wales out of it cross.
    pub fn unworkable_row(&self) -> Option<usize> {
        let crossing =
            self.wales.windows(2).find(|pair| pair[0].1 > pair[1].1).map(|pair| pair[0].0 as usize);
        let worked = self.rows.len().checked_sub(2).map_or(0, |last| self.rows[last]);
        let bases: std::collections::BTreeSet<NodeId> = self.wales.iter().map(|wale| wale.0).collect();
        let skipped = (0..worked).find(|node| !bases.contains(&(*node as NodeId)));
        let node = crossing.into_iter().chain(skipped).min()?;
        Some(self.rows.partition_point(|first| *first <= node))
    }
}

/// What a baseline net is made of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Wales beyond the first out of a node.
    pub increases: usize,
    /// Wales beyond the first into a node.
    pub decreases: usize,
    /// Pairs of neighboring wales that cross.
    pub crossings: usize,
}

/// Lays the baseline on a tube; `None` with the reason in the sink when not two rows fit, or too many nodes.
pub fn capunaman(tube: &Tube, gauge: &Gauge, sink: &mut Sink<'_>) -> Option<Baseline> {
    let surface = &*tube.surface;
    let knots = knots(surface, gauge.height);
    if knots.len() < 3 {
        let message =
            format!("the baseline needs two rows of {:.2} mm, and this tube is too short", gauge.height);
        sink.push(Diagnostic::new(Code::TooLarge, message).in_round(&tube.name, None));
        return None;
    }
    let mut net = Baseline::default();
    let mut distances = 0_usize;
    for row in 0..knots.len() - 1 {
        let at = |share: f64| knots[row] + share * (knots[row + 1] - knots[row]);
        let mut length = 0.0;
        let mut before = surface.point(at(0.0), 0.0);
        for i in 1..=ROW_STEPS {
            let share = f64::from(i) / f64::from(ROW_STEPS);
            let point = surface.point(at(share), share);
            length += point.distance(before);
            before = point;
        }
        let count = (length / gauge.width).round().max(1.0);
        let below = net.rows.last().map_or(0, |first| net.nodes.len() - first);
        distances = distances.saturating_add(below.saturating_mul(count as usize));
        if count > f64::from(MAX_ROW) || distances > MAX_DISTANCES {
            let message =
                format!("row {} of the baseline has {count:.0} stitches, too many for its search", row + 1);
            sink.push(
                Diagnostic::new(Code::TooLarge, message)
                    .in_round(&tube.name, None)
                    .help("its cost grows with the square of a row; use a larger stitch"),
            );
            return None;
        }
        net.rows.push(net.nodes.len());
        for j in 0..count as u32 {
            let v = f64::from(j) / count;
            let u = at(v);
            net.nodes.push(Node { position: surface.point(u, v), u, tau: row as f64 + v, v });
        }
    }
    net.rows.push(net.nodes.len());
    for row in 0..net.rows.len().saturating_sub(2) {
        link(&mut net, row);
    }
    net.wales.sort_unstable();
    net.wales.dedup();
    Some(net)
}

/// Surface parameters of whole rows: the least distance of two rows at equal v is the stitch height.
fn knots(surface: &dyn ParametricSurface, height: f64) -> Vec<f64> {
    let mut knots = vec![0.0];
    let mut u = 0.0;
    let mut step = 1e-3;
    // A whole number of rows must not lose its last one to rounding.
    let (height, end) = (height * (1.0 - 1e-12), 1.0 + 1e-12);
    while knots.len() < MAX_ROW as usize {
        let row: Vec<_> = (0..AROUND).map(|j| surface.point(u, f64::from(j) / f64::from(AROUND))).collect();
        let distance = |u: f64| {
            let others = (0..AROUND).map(|j| surface.point(u, f64::from(j) / f64::from(AROUND)));
            row.iter().zip(others).map(|(a, b)| a.distance(b)).fold(f64::MAX, f64::min)
        };
        let (mut low, mut high) = (u, u + step);
        while distance(high) < height {
            if high >= end {
                return knots;
            }
            (low, high) = (high, high + step);
            step *= 1.5;
        }
        for _ in 0..48 {
            let middle = 0.5 * (low + high);
            if distance(middle) < height { low = middle } else { high = middle }
        }
        if high > end {
            return knots;
        }
        step = 0.5 * (high - u);
        u = high.min(1.0);
        knots.push(u);
    }
    knots
}

/// Joins a row with the next.
fn link(net: &mut Baseline, row: usize) {
    let (from, to, end) = (net.rows[row], net.rows[row + 1], net.rows[row + 2]);
    let (lower, upper) = (&net.nodes[from..to], &net.nodes[to..end]);
    let nearest = |node: &Node, others: &[Node], allowed: &dyn Fn(usize) -> bool| {
        let mut best = None;
        let mut least = f64::MAX;
        for (index, other) in others.iter().enumerate() {
            let distance = node.position.distance_squared(other.position);
            if distance < least && allowed(index) {
                least = distance;
                best = Some(index);
            }
        }
        best
    };
    let mut pairs: Vec<(usize, usize)> = Vec::with_capacity(upper.len() + lower.len());
    let mut wales = vec![0_u32; lower.len()];
    let mut covered = vec![false; upper.len()];
    for (base, node) in lower.iter().enumerate() {
        let Some(top) = nearest(node, upper, &|_| true) else { continue };
        if node.v > SEAM[0] && upper[top].v < SEAM[1] {
            continue;
        }
        pairs.push((base, top));
        wales[base] += 1;
        covered[top] = true;
    }
    let mut left = Vec::new();
    for (top, node) in upper.iter().enumerate().filter(|(top, _)| !covered[*top]) {
        match nearest(node, lower, &|base| wales[base] < 2) {
            Some(base) => {
                pairs.push((base, top));
                wales[base] += 1;
            }
            None => left.push(top),
        }
    }
    for top in left {
        if let Some(base) = nearest(&upper[top], lower, &|_| true) {
            pairs.push((base, top));
        }
    }
    pairs.sort_unstable();
    pairs.dedup();
    straighten(&mut pairs);
    net.wales.extend(pairs.iter().map(|(base, top)| ((from + base) as NodeId, (to + top) as NodeId)));
}

/// A decrease directly followed by an increase on its second base is two plain stitches.
fn straighten(pairs: &mut Vec<(usize, usize)>) {
    let mut index = 0;
    while index + 2 < pairs.len() {
        let [(a, p), (b, q), (c, r)] = [pairs[index], pairs[index + 1], pairs[index + 2]];
        if a + 1 == b && p == q && b == c && q + 1 == r {
            pairs.remove(index + 1);
        }
        index += 1;
    }
}
