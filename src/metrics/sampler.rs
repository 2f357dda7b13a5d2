//! The sampling of edges and tiles, and what is summed up from them.

use super::geometry::{along, area, disc, skew, triangle};
use super::mesh::{Class, Mesh};
use super::{LengthError, Lengths, Level, Measure, PaperLengths, Skew, Stats};
use crate::ir::{Gauge, Graph, Node, NodeId};
use crate::shape::{End, ParametricSurface, Tube};

/// Chords along the surface in our convention.
const STEPS: u32 = 16;
/// Chords along the surface in the paper's convention.
const PAPER_STEPS: u32 = 3;
/// Collects the samples of several tubes into one [`Measure`].
#[derive(Debug)]
pub struct Sampler {
    gauge: Gauge,
    measure: Measure,
    chord: Samples,
    surface: Samples,
    paper: Samples,
    skew: Vec<(Class, f64)>,
    /// Area of tiles, of what they can cover, and number of stitches that do.
    tiles: f64,
    coverable: f64,
    coverable_by_count: f64,
    covering: usize,
    level: Vec<f64>,
    spread: f64,
}

/// Errors by kind of edge.
#[derive(Debug, Default)]
struct Samples {
    course: Vec<f64>,
    wale: Vec<f64>,
    step: Vec<f64>,
}

impl Samples {
    /// Course with steps, wales, and all.
    fn merged(&self) -> [Vec<f64>; 3] {
        let course = [self.course.as_slice(), &self.step].concat();
        let all = [course.as_slice(), &self.wale].concat();
        [course, self.wale.clone(), all]
    }
}

impl Sampler {
    /// Nothing measured yet.
    pub fn new(gauge: Gauge) -> Self {
        Self {
            gauge,
            measure: Measure::default(),
            chord: Samples::default(),
            surface: Samples::default(),
            paper: Samples::default(),
            skew: Vec::new(),
            tiles: 0.0,
            coverable: 0.0,
            coverable_by_count: 0.0,
            covering: 0,
            level: Vec::new(),
            spread: 0.0,
        }
    }

    /// Counts increases and decreases of a graph.
    pub fn count(&mut self, graph: &Graph) {
        for stitch in graph.tiles.iter().filter_map(|tile| tile.stitch) {
            self.measure.increases += usize::from(stitch.is_increase());
            self.measure.decreases += usize::from(stitch.is_decrease());
        }
    }

    /// Notes increases, decreases and crossings of a net without stitches.
    pub fn note(&mut self, increases: usize, decreases: usize, crossings: usize) {
        self.measure.increases += increases;
        self.measure.decreases += decreases;
        self.measure.crossings += crossings;
    }

    /// Samples the mesh of one tube.
    pub fn add(&mut self, tube: &Tube, mesh: &Mesh<'_>) {
        self.add_on(&*tube.surface, [tube.start, tube.end], mesh);
    }

    /// Samples a mesh on a surface with these ends.
    pub fn add_on(&mut self, surface: &dyn ParametricSurface, ends: [End; 2], mesh: &Mesh<'_>) {
        let chain = if ends[0] == End::Open { mesh.start } else { 0 };
        self.measure.nodes += mesh.nodes.len();
        self.measure.stitches += mesh.nodes.len() - chain;
        self.measure.short_rows += mesh.short_rows;
        self.lengths(surface, mesh);
        self.skew(mesh);
        self.cover(surface, ends, mesh);
        self.level(surface, ends[1], mesh);
    }

    fn lengths(&mut self, surface: &dyn ParametricSurface, mesh: &Mesh<'_>) {
        let edges =
            mesh.courses.iter().map(|edge| (edge, true)).chain(mesh.wales.iter().map(|edge| (edge, false)));
        for (edge, is_course) in edges {
            let (Some(from), Some(to)) = (mesh.node(edge.from), mesh.node(edge.to)) else { continue };
            let length = if is_course { self.gauge.width } else { self.gauge.height };
            let error = |actual: f64| actual / length - 1.0;
            let chord = error(from.position.distance(to.position));
            let on_surface = error(along(surface, from, to, STEPS));
            let pick = |samples: &mut Samples, value| match (is_course, edge.joins_levels) {
                (true, true) => samples.step.push(value),
                (true, false) => samples.course.push(value),
                (false, _) => samples.wale.push(value),
            };
            pick(&mut self.chord, chord);
            pick(&mut self.surface, on_surface);
            if !edge.joins_levels {
                pick(&mut self.paper, error(along(surface, from, to, PAPER_STEPS)));
            }
        }
    }

    fn skew(&mut self, mesh: &Mesh<'_>) {
        for tile in &mesh.tiles {
            if let Some(corners) = mesh.corners(tile) {
                self.skew.push((tile.class, skew(corners, tile.class)));
            }
        }
    }

    fn cover(&mut self, surface: &dyn ParametricSurface, ends: [End; 2], mesh: &Mesh<'_>) {
        for tile in &mesh.tiles {
            let Some([a, b, c, d]) = mesh.corners(tile) else { continue };
            match tile.class {
                // The pair of stitches that a turn tile measures has its own tile.
                Class::TurnLeft | Class::TurnRight => continue,
                Class::Quad | Class::Step => {
                    let inverted = mesh.node(tile.corners[0]).is_some_and(|node| {
                        let jet = surface.jet(node.u, node.v);
                        jet.dv.cross(jet.du).dot((b - c).cross(d - a)) <= 0.0
                    });
                    self.measure.inverted_tiles += usize::from(inverted);
                }
                Class::Inc | Class::Dec => {}
            }
            self.tiles +=
                0.5 * (triangle(a, b, c) + triangle(b, d, c) + triangle(a, b, d) + triangle(a, d, c));
        }
        for fill in &mesh.fills {
            if let [Some(a), Some(b), Some(c), Some(d)] = fill.map(|id| mesh.node(id)) {
                let [a, b, c, d] = [a, b, c, d].map(|node| node.position);
                self.tiles += triangle(a, b, c) + triangle(a, c, d);
            }
        }
        let (first, last) = (mesh.start, mesh.open.len());
        let wedge = 0.5 * self.gauge.width * self.gauge.height;
        let beyond = |surface: &dyn ParametricSurface, mesh: &Mesh<'_>, row: &[NodeId], u: f64| {
            self.gauge.width
                * row.iter().filter_map(|id| mesh.node(*id)).map(|node| past(surface, node, u)).sum::<f64>()
        };
        let area = area(surface);
        let mut open = 0.0;
        let first_row: Vec<NodeId> = (0..first as NodeId).collect();
        // Between an open edge and the helix lies half a row that no stitch covers; a pole is covered to its center.
        match ends[0] {
            End::Open if mesh.ragged[0] => open += beyond(surface, mesh, &first_row, 0.0),
            End::Open => open += wedge * first as f64,
            End::Closed => {
                self.tiles += disc(mesh, &first_row, surface.point(0.0, 0.0), mesh.nodes.get(first));
            }
        }
        match ends[1] {
            End::Open if mesh.ragged[1] => open -= beyond(surface, mesh, &mesh.open, 1.0),
            End::Open => open += wedge * last as f64,
            End::Closed => {
                let below = mesh.wales.iter().rev().find(|wale| Some(&wale.to) == mesh.open.last());
                let below = below.and_then(|wale| mesh.node(wale.from));
                self.tiles += disc(mesh, &mesh.open, surface.point(1.0, 0.0), below);
            }
        }
        self.coverable += area - open;
        let ragged = mesh.ragged[0] || mesh.ragged[1];
        self.coverable_by_count += area - if ragged { open } else { (first + last) as f64 * wedge };
        // Chains between two sides of a gap cover nothing.
        let chains = if ragged { mesh.nodes.len() - first - mesh.worked() } else { 0 };
        self.covering += mesh.nodes.len() - first - chains;
    }

    fn level(&mut self, surface: &dyn ParametricSurface, end: End, mesh: &Mesh<'_>) {
        // The helix row of a loop is its winding along the yarn, where it is unwrapped step by step.
        let mut winding = Vec::with_capacity(mesh.nodes.len());
        let mut turns = 0.0;
        let mut before: Option<f64> = None;
        for node in mesh.nodes {
            let step = before.map_or(node.v, |before| {
                let step = node.v - before;
                step - step.round()
            });
            turns += step;
            before = Some(node.v);
            winding.push(turns);
        }
        // The helix begins anywhere around the tube: the first row tells where.
        let start = mesh.start.max(1);
        let first = mesh.nodes.iter().zip(&winding).take(start);
        let begin = first.map(|(node, row)| row - node.tau).sum::<f64>() / start as f64;
        let (mut low, mut high) = (f64::MAX, f64::MIN);
        for id in &mesh.open {
            let (Some(node), Some(row)) = (mesh.node(*id), winding.get(*id as usize)) else { continue };
            let lag = row - node.tau;
            low = low.min(lag);
            high = high.max(lag);
            // To a rim the last turn of a helix rises by a row; a pole may be the middle of a seam.
            self.level.push(match end {
                End::Open => self.rows_to_end(surface, node) - 0.5,
                End::Closed => lag - begin,
            });
        }
        if high > low {
            self.spread = self.spread.max(high - low);
        }
    }

    /// Rows from a loop to the end of the surface, straight along it.
    fn rows_to_end(&self, surface: &dyn ParametricSurface, node: &Node) -> f64 {
        let end = Node { u: 1.0, position: surface.point(1.0, node.v), ..*node };
        along(surface, node, &end, STEPS) * (1.0 - node.u).signum() / self.gauge.height
    }

    /// Sums up.
    pub fn finish(self) -> Measure {
        let lengths = |samples: &Samples| samples.merged().map(|mut sample| Stats::of(&mut sample));
        let [course_chord, wale_chord, chord] = lengths(&self.chord);
        let [course_surface, wale_surface, surface] = lengths(&self.surface);
        let [course, wale, all] = lengths(&self.paper);
        let mut step = self.chord.step.clone();
        let mut step_surface = self.surface.step.clone();
        let by = |classes: &[Class]| {
            let of = |(class, skew): &(Class, f64)| classes.contains(class).then_some(*skew);
            Stats::of(&mut self.skew.iter().filter_map(of).collect::<Vec<_>>())
        };
        use Class::{Dec, Inc, Quad, Step, TurnLeft, TurnRight};
        Measure {
            length_error: LengthError {
                chord,
                surface,
                course: Lengths { chord: course_chord, surface: course_surface },
                wale: Lengths { chord: wale_chord, surface: wale_surface },
                step: Lengths { chord: Stats::of(&mut step), surface: Stats::of(&mut step_surface) },
                paper: PaperLengths { all, course, wale },
            },
            skew: Skew {
                all: by(&[Quad, Inc, Dec, Step, TurnLeft, TurnRight]),
                paper: by(&[Quad, Dec, Step]),
                quad: by(&[Quad]),
                inc: by(&[Inc]),
                dec: by(&[Dec]),
                step: by(&[Step]),
                turn: by(&[TurnLeft, TurnRight]),
            },
            coverage: self.tiles / self.coverable,
            coverage_by_count: self.covering as f64 * self.gauge.width * self.gauge.height
                / self.coverable_by_count,
            level: Level {
                missing: self.level.iter().sum::<f64>() / self.level.len().max(1) as f64,
                spread: self.spread,
            },
            ..self.measure
        }
    }
}

/// How far (mm) a loop lies past the line at u.
fn past(surface: &dyn ParametricSurface, node: &Node, u: f64) -> f64 {
    let jet = surface.jet(u, node.v);
    (node.position - jet.point).dot(jet.du.normalize_or_zero())
}
