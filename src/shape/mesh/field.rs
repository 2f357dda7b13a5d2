//! The field over a mesh whose level lines become rows.
//!
//! A flow enters the surface at one end and leaves it at others; its potential rises along it. All fields here are made of
//! one potential for each end, that of a unit flow from the end to one fixed vertex: the Laplacian is factored once, an end
//! costs one solution, and every field is a combination of them.

use super::Mesh;
use super::ends::{Ends, Tip};
use super::factor::Factor;
use super::patch::eliminate;
use super::solver::{Matrix, Solver};
use super::soup::NONE;
use std::collections::BTreeMap;

/// Where the rows of a mesh come from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Field {
    /// Harmonic between the ends: no extrema but the ends, so a tube or a branch for each, and rows that are uneven where
    /// the thickness changes, which short rows take up.
    #[default]
    Harmonic,
    /// Distance from the start: even rows, but ragged where fronts meet behind an obstacle.
    Geodesic,
}

const TOLERANCE: f64 = 1e-7;
/// Systems of more unknowns are solved step by step: their factor would not fit.
const MOST_FACTORED: usize = 150_000;
/// Cotangents of slivers are cut to this.
const FLATTEST: f64 = 1e3;
/// Weights are positive where obtuse triangles would make an extremum that is no end.
const LEAST_WEIGHT: f64 = 1e-4;
/// Rounds of that, after which all weights are.
const MENDS: u32 = 3;

/// The potentials of flows over one mesh.
pub(super) struct Flows<'m> {
    mesh: &'m Mesh,
    /// For each vertex its group: the ground, whose potential is 0, the openings, and each other vertex by itself.
    slot: Vec<u32>,
    groups: Groups,
    weights: Vec<f64>,
    system: System,
    /// Whether fields keep to the maximum principle at the cost of distortion, and how often weights were mended for it.
    strict: bool,
    mended: u32,
    /// By first vertex and bits of the radius of the cap.
    sources: BTreeMap<(u32, u64), Source>,
}

/// Vertices with one potential: rings, the first of which is the ground, and then single ones.
struct Groups {
    rings: Vec<Vec<u32>>,
    singles: Vec<u32>,
}

impl Groups {
    fn get(&self, group: usize) -> &[u32] {
        let single = group.wrapping_sub(self.rings.len());
        self.rings.get(group).map_or_else(|| &self.singles[single..=single], Vec::as_slice)
    }

    fn count(&self) -> usize {
        self.rings.len() + self.singles.len()
    }
}

enum System {
    Factored(Factor),
    Iterative(Box<Solver>),
}

impl System {
    fn solve(&mut self, right: &[f64]) -> Vec<f64> {
        match self {
            Self::Factored(factor) => factor.solve(right),
            Self::Iterative(solver) => {
                let mut x = vec![0.0; right.len()];
                solver.solve(right, &mut x, TOLERANCE);
                x
            }
        }
    }
}

/// The field of a flow to one limb.
pub(super) struct Lone {
    pub(super) field: Vec<f64>,
    /// The vertices at which it is about 0.
    pub(super) ground: Vec<u32>,
}

/// An end as the source of a unit flow.
struct Source {
    /// Where the flow enters, and its share there.
    cap: Vec<(u32, f64)>,
    /// The potential at each vertex when it leaves through the ground.
    potential: Vec<f64>,
}

impl Source {
    /// The mean of a potential where this flow enters.
    fn mean(&self, potential: &[f64]) -> f64 {
        self.cap.iter().map(|(vertex, share)| share * potential[*vertex as usize]).sum()
    }
}

impl<'m> Flows<'m> {
    /// Prepares for flows between any ends: openings are what they are, and tips may lie anywhere. The ground is an opening,
    /// else some vertex.
    pub(super) fn new(mesh: &'m Mesh, strict: bool) -> Self {
        let mut slot = vec![NONE; mesh.points.len()];
        let mut groups = Groups { rings: mesh.boundaries().to_vec(), singles: Vec::new() };
        if groups.rings.is_empty() {
            groups.rings.push(vec![0]);
        }
        for (group, ring) in (0..).zip(&groups.rings) {
            for vertex in ring {
                slot[*vertex as usize] = group;
            }
        }
        for vertex in 0..mesh.points.len() as u32 {
            if slot[vertex as usize] == NONE {
                slot[vertex as usize] = groups.count() as u32;
                groups.singles.push(vertex);
            }
        }
        let weights = mesh.weights();
        let system = system(mesh, &groups, &slot, &weights);
        let sources = BTreeMap::new();
        Self { mesh, slot, groups, weights, system, strict, mended: 0, sources }
    }

    /// The value of every vertex: least at the start, where it is 0, greatest at the other ends.
    pub(super) fn field(&mut self, field: Field, ends: &Ends) -> Vec<f64> {
        match field {
            Field::Geodesic => ends.distance.clone(),
            Field::Harmonic => self.harmonic(ends),
        }
    }

    /// The field of a flow that enters at the start and leaves at the other ends, through each as much as fits its girth:
    /// so it rises by about 1 a unit of length on every limb, and each tip is a maximum. At closed ends the flow is spread
    /// evenly over a cap, around whose middle the level lines are rings; on an open edge the field has one value.
    fn harmonic(&mut self, ends: &Ends) -> Vec<f64> {
        let total: f64 = ends.others.iter().map(|tip| tip.girth).sum();
        let flows = |_: &mut Self| {
            let others = ends.others.iter().map(|tip| (key(tip), tip.girth));
            others.chain([(key(&ends.start), -total)]).collect()
        };
        let mut field = self.mended(ends, flows);
        let start = ends.start.ring.first().map_or(0.0, |v| field[*v as usize]);
        for value in &mut field {
            *value -= start;
        }
        field
    }

    /// The field of a flow that leaves at one end and enters at all others alike: around the limb that goes to that end the
    /// level lines are rings, and where it leaves the object they spread out evenly.
    pub(super) fn lone(&mut self, ends: &Ends, which: usize) -> Lone {
        let field = self.mended(ends, |flows| flows.alike(ends, which));
        let rest: Vec<&Tip> = ends.beside(which).collect();
        let level: f64 =
            rest.iter().filter_map(|tip| self.sources.get(&key(tip))).map(|it| it.mean(&field)).sum();
        let level = level / rest.len().max(1) as f64;
        let mut ground = Vec::new();
        for source in rest.iter().filter_map(|tip| self.sources.get(&key(tip))) {
            ground.extend(source.cap.iter().map(|(vertex, _)| *vertex));
        }
        ground.extend(rest.iter().flat_map(|tip| &tip.ring));
        ground.sort_unstable();
        ground.dedup();
        Lone { field: field.into_iter().map(|value| value - level).collect(), ground }
    }

    /// How much flows through each end when it leaves at one and all others have the same potential.
    fn alike(&self, ends: &Ends, which: usize) -> Vec<((u32, u64), f64)> {
        let rest: Vec<(u32, u64)> = ends.beside(which).map(key).collect();
        let own = key(&ends.others[which]);
        let flow = ends.others[which].girth;
        // Unknown are the flows and the common potential; no more flows out than in.
        let size = rest.len() + 1;
        let width = size + 1;
        let mut table = vec![0.0; size * width];
        let mean = |of: (u32, u64), by: (u32, u64)| {
            self.sources.get(&of).zip(self.sources.get(&by)).map_or(0.0, |(of, by)| of.mean(&by.potential))
        };
        for (i, of) in rest.iter().enumerate() {
            for (j, by) in rest.iter().enumerate() {
                table[i * width + j] = mean(*of, *by);
            }
            table[i * width + size - 1] = -1.0;
            table[i * width + size] = -flow * mean(*of, own);
            table[(size - 1) * width + i] = 1.0;
        }
        table[size * width - 1] = -flow;
        let even = -flow / rest.len().max(1) as f64;
        let flows = eliminate(table, size).unwrap_or_else(|| vec![even; size]);
        rest.into_iter().zip(flows).chain([(own, flow)]).collect()
    }

    /// A combination of the potentials of all ends; where fields are strict, one without extrema between ends.
    fn mended(&mut self, ends: &Ends, flows: impl Fn(&mut Self) -> Vec<((u32, u64), f64)>) -> Vec<f64> {
        loop {
            for tip in ends.others.iter().chain(&ends.off).chain([&ends.start]) {
                self.prepare(tip);
            }
            let mut field = vec![0.0; self.slot.len()];
            for (key, flow) in flows(self) {
                if let Some(source) = self.sources.get(&key) {
                    for (value, potential) in field.iter_mut().zip(&source.potential) {
                        *value += flow * potential;
                    }
                }
            }
            if !self.strict || self.mended > MENDS || !self.mend(&field) {
                return field;
            }
        }
    }

    /// Solves for the flow out of an end, unless that is done.
    fn prepare(&mut self, tip: &Tip) {
        if self.sources.contains_key(&key(tip)) {
            return;
        }
        let cap = self.mesh.cap(tip);
        let mut right = vec![0.0; self.groups.count() - 1];
        for (vertex, share) in &cap {
            if let Some(unknown) = self.slot[*vertex as usize].checked_sub(1) {
                right[unknown as usize] += share;
            }
        }
        let x = self.system.solve(&right);
        let value = |slot: &u32| slot.checked_sub(1).map_or(0.0, |unknown| x[unknown as usize]);
        let potential = self.slot.iter().map(value).collect();
        self.sources.insert(key(tip), Source { cap, potential });
    }

    /// Makes weights positive around extrema of a field that are no ends; false when there are none.
    fn mend(&mut self, field: &[f64]) -> bool {
        let mesh = self.mesh;
        let value = |v: u32| field[v as usize];
        let mut free: Vec<bool> =
            self.slot.iter().map(|slot| *slot as usize >= self.groups.rings.len()).collect();
        for (vertex, _) in self.sources.values().flat_map(|source| &source.cap) {
            free[*vertex as usize] = false;
        }
        let wrong = |v: &u32| {
            let (mut above, mut below) = (false, false);
            for other in mesh.neighbors(*v) {
                above |= value(other) > value(*v);
                below |= value(other) < value(*v);
            }
            !(above && below)
        };
        let wrong: Vec<u32> = (0..free.len() as u32).filter(|v| free[*v as usize]).filter(wrong).collect();
        if wrong.is_empty() {
            return false;
        }
        self.mended += 1;
        if self.mended > MENDS {
            for weight in &mut self.weights {
                *weight = weight.max(LEAST_WEIGHT);
            }
        }
        for h in wrong.iter().flat_map(|v| mesh.corners(*v)).flat_map(|h| [*h, Mesh::before(*h)]) {
            let twin = mesh.twins[h as usize];
            let least = self.weights[h as usize].max(LEAST_WEIGHT);
            self.weights[h as usize] = least;
            if twin != NONE {
                self.weights[twin as usize] = least;
            }
        }
        self.system = system(mesh, &self.groups, &self.slot, &self.weights);
        self.sources.clear();
        true
    }
}

fn key(tip: &Tip) -> (u32, u64) {
    (tip.ring.first().copied().unwrap_or(0), tip.cap.to_bits())
}

/// The Laplacian of all groups but the ground, ready to be solved.
fn system(mesh: &Mesh, groups: &Groups, slot: &[u32], weights: &[f64]) -> System {
    let matrix = laplacian(mesh, groups, slot, weights);
    let unknowns = matrix.diagonal.len();
    if unknowns <= MOST_FACTORED {
        let places: Vec<_> = (1..=unknowns).map(|group| mesh.point(groups.get(group)[0])).collect();
        let rings: Vec<u32> = (0..groups.rings.len() as u32 - 1).collect();
        if let Some(factor) = Factor::new(&matrix, &places, &rings) {
            return System::Factored(factor);
        }
    }
    System::Iterative(Box::new(Solver::new(matrix)))
}

fn laplacian(mesh: &Mesh, groups: &Groups, slot: &[u32], weights: &[f64]) -> Matrix {
    let mut matrix = Matrix { starts: vec![0], ..Matrix::default() };
    for row in 1..groups.count() {
        let mut diagonal = 0.0;
        let mut add = |other: u32, weight: f64| {
            let column = slot[other as usize];
            if column as usize == row {
                return;
            }
            diagonal += weight;
            if column > 0 {
                matrix.columns.push(column - 1);
                matrix.values.push(-weight);
            }
        };
        for &vertex in groups.get(row) {
            for &h in mesh.corners(vertex) {
                add(mesh.to(h), weights[h as usize]);
                // An open edge is seen from one of its ends only.
                let back = Mesh::before(h);
                if mesh.twins[back as usize] == NONE {
                    add(mesh.from(back), weights[back as usize]);
                }
            }
        }
        matrix.diagonal.push(diagonal);
        matrix.starts.push(matrix.columns.len() as u32);
    }
    matrix
}

impl Mesh {
    /// Where a unit flow enters at an end: all over the cap of a closed one.
    fn cap(&self, tip: &Tip) -> Vec<(u32, f64)> {
        let Some(&first) = tip.ring.first() else { return Vec::new() };
        if tip.open {
            return vec![(first, 1.0)];
        }
        let near = self.distances(&[first], tip.cap);
        let share = |v: u32| self.corners(v).iter().map(|h| self.normal(h / 3).length()).sum::<f64>();
        let mut cap: Vec<(u32, f64)> =
            (0..near.len() as u32).filter(|v| near[*v as usize] <= tip.cap).map(|v| (v, share(v))).collect();
        let whole: f64 = cap.iter().map(|(_, share)| share).sum();
        for (_, share) in &mut cap {
            *share /= whole.max(f64::MIN_POSITIVE);
        }
        cap
    }

    /// For every half-edge half the sum of the cotangents across it.
    fn weights(&self) -> Vec<f64> {
        let cotangent: Vec<f64> = (0..self.twins.len() as u32)
            .map(|h| {
                let apex = self.point(self.from(Self::before(h)));
                let (a, b) = (self.point(self.from(h)) - apex, self.point(self.to(h)) - apex);
                let sine = a.cross(b).length();
                if sine > 0.0 { (a.dot(b) / sine).clamp(-FLATTEST, FLATTEST) } else { 0.0 }
            })
            .collect();
        let sum = |h: usize| {
            let twin = self.twins[h];
            0.5 * (cotangent[h] + if twin == NONE { 0.0 } else { cotangent[twin as usize] })
        };
        (0..cotangent.len()).map(sum).collect()
    }
}
