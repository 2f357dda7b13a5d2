//! The scene: each stitch with the corners of its tile, and the yarn of each piece.

use super::frame::{Frames, Point, ring_radius};
use super::net::{NONE, Net, Role, Worked, nets};
use super::predict::{self, Rest};
use super::stitch as keys;
use super::yarn::Yarn;
use crate::diag::Sink;
use crate::ir::maker::mirrored;
use crate::ir::verify::Verified;
use crate::ir::yarn::Yarn as Weight;
use crate::ir::{Direction, Gauge, GaugeOrigin, Graph, Hand, Kind, PartId, Program};
use glam::DVec3;
use serde::Deserialize;
use std::ops::Range;

/// Most stitches that a scene holds.
pub const MAX_STITCHES: u64 = 300_000;
/// The stitch of a pattern that does not tell its own: worsted yarn on a small hook, in mm.
pub const DEFAULT_GAUGE: [f64; 2] = [5.0, 4.25];

/// One stitch, turn, chain or drawn-shut loop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stitch {
    /// Index in [`Scene::pieces`].
    pub piece: u32,
    /// What it is.
    pub role: Role,
    /// Worked from the wrong side: in a back pass, or in every other row of a flat piece.
    pub against: bool,
    /// Number of its round as the pattern prints it; 0 for a chain of the start.
    pub round: u32,
    /// Its place in the round, from 1; 0 for a turn.
    pub index: u32,
    /// Index of its row in the part's rows; `None` for what no row lists.
    pub row: Option<u32>,
    /// Index in [`Scene::colors`].
    pub color: u16,
    /// Corners of its tile in mm. Number x + 2 y + 4 z: x in the course direction of a row from the right side, y from the loops worked into to those
    /// made, z from the inside to the outside.
    pub corners: [DVec3; 8],
    /// (L - l) / l of its top edge against the stitch width, as a fraction.
    pub course_error: f64,
    /// The same of its height.
    pub wale_error: f64,
    /// Absolute cosine between the middle lines of its tile; 0 is square.
    pub skew: f64,
}

impl Stitch {
    /// The point of the tile at (x, y, z) of the unit cube: trilinear between the corners.
    pub fn map(&self, [x, y, z]: [f64; 3]) -> DVec3 {
        let c = &self.corners;
        let edge = |k: usize| c[k].lerp(c[k + 1], x);
        let face = |k: usize| edge(k).lerp(edge(k + 2), y);
        face(0).lerp(face(4), z)
    }
    /// The middle of its outside.
    pub fn face(&self) -> DVec3 {
        self.map([0.5, 0.5, 1.0])
    }
}

/// One part, or one copy of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Piece {
    /// Name of the part.
    pub name: String,
    /// The part.
    pub part: PartId,
    /// Which of its copies, from 0.
    pub copy: u32,
    /// Its stitches in [`Scene::stitches`], in working order.
    pub stitches: Range<usize>,
    /// Its yarn.
    pub yarn: Yarn,
}

/// Everything that there is to see.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// Name of the object.
    pub name: String,
    /// Stitch width and height in mm.
    pub gauge: [f64; 2],
    /// True when the pattern does not tell its gauge.
    pub gauge_assumed: bool,
    /// Thickness of the yarn in mm.
    pub yarn: f64,
    /// Thickness of the fabric in mm.
    pub thickness: f64,
    /// How the prediction went, where positions are predicted.
    pub predicted: Option<Rest>,
    /// Colors as red, green, blue.
    pub colors: Vec<[u8; 3]>,
    /// The pieces in working order.
    pub pieces: Vec<Piece>,
    /// The stitches of all pieces.
    pub stitches: Vec<Stitch>,
}

/// Why there is no scene.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Refused {
    /// More stitches than a scene holds.
    #[error(
        "{stitches} stitches are too many to draw; the limit is {MAX_STITCHES}, so use a coarser gauge or leave parts out"
    )]
    TooLarge {
        /// How many there are.
        stitches: u64,
    },
    /// The graph has loops without a place.
    #[error("the stitch graph of {part} has {found} places for {loops} loops")]
    Places {
        /// The part.
        part: String,
        /// Loops of the pattern.
        loops: u32,
        /// Nodes of the graph.
        found: usize,
    },
    /// More triangles than are ever made.
    #[error(
        "{triangles} triangles are too many; the limit is {}, so lower `detail` (1 to 5), or leave it out",
        super::mesh::MAX_TRIANGLES
    )]
    TooFine {
        /// How many there would be.
        triangles: u64,
    },
    /// No picture has this size.
    #[error("a picture is 1 to {} pixels wide and high; set `size` to WIDTHxHEIGHT", super::shade::MAX_SIDE)]
    PictureSize,
    /// Too wide a piece to predict its shape.
    #[error(
        "{stitches} stitches in rounds this wide would take more than 240 MB to predict; use a coarser gauge, leave parts out, or draw the chart (`svg`)"
    )]
    TooWide {
        /// How many there are.
        stitches: u64,
    },
    /// The prediction has stitches that stand straight.
    #[error("the drift of stitches that lean is not predicted; the target shows what comes out")]
    Leans,
    /// The forces have no solution.
    #[error("the shape cannot be predicted from this pattern; the chart (`svg`) shows its stitches")]
    NotPredicted,
    /// The pattern has nothing to draw.
    #[error("the pattern has no stitches to draw")]
    Empty,
}

/// Where the stitches are drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Places {
    /// On the shape that the pattern was made from; predicted where there is none.
    #[default]
    Target,
    /// Where the pattern alone takes them.
    Predicted,
}

/// Yarn when no weight is known, in stitch widths.
const YARN_OF_WIDTH: f64 = 0.30;
/// Fabric thickness in yarn thicknesses.
const LAYERS: f64 = 2.6;

impl Scene {
    /// Builds the scene of a program; `yarn` is a thickness in mm that takes the place of the gauge's own. The shape of
    /// a pattern without graphs is predicted, which the sink hears of.
    pub fn new(
        program: &Verified<'_>,
        yarn: Option<f64>,
        places: Places,
        sink: &Sink<'_>,
    ) -> Result<Self, Refused> {
        let stitches = program.facts().stitches(program);
        if stitches > MAX_STITCHES {
            return Err(Refused::TooLarge { stitches });
        }
        let nets = nets(program, MAX_STITCHES);
        let gauge = program.gauge.map_or(DEFAULT_GAUGE, |gauge| [gauge.width, gauge.height]);
        let mut scene = Self {
            name: program.name.clone(),
            gauge,
            gauge_assumed: program.gauge.is_none(),
            yarn: 0.0,
            thickness: 0.0,
            predicted: None,
            colors: colors(program),
            pieces: Vec::new(),
            stitches: Vec::new(),
        };
        scene.yarn = yarn.unwrap_or_else(|| thickness(program.gauge, gauge[0]));
        scene.yarn = scene.yarn.clamp(0.05 * gauge[0].min(gauge[1]), 0.40 * gauge[0].min(gauge[1]));
        scene.thickness = LAYERS * scene.yarn;
        if !program.graphs.is_empty() && places == Places::Predicted && program.maker.lean != 0.0 {
            return Err(Refused::Leans);
        }
        if program.graphs.is_empty() || places == Places::Predicted {
            sink.stage("predict");
            let (places, rest) = predict::places(&nets, gauge, sink)?;
            scene.predicted = Some(rest);
            for (net, places) in nets.iter().zip(&places) {
                scene.add(program, net, places, None)?;
            }
        } else {
            for (net, graph) in nets.iter().zip(&program.graphs) {
                let graph = graph.right_handed(program.maker.hand);
                let places: Vec<DVec3> = graph.nodes.iter().map(|node| node.position).collect();
                scene.add(program, net, &places, Some(&graph))?;
            }
        }
        if program.maker.hand == Hand::Left {
            scene.mirror();
        }
        if scene.stitches.is_empty() { Err(Refused::Empty) } else { Ok(scene) }
    }

    /// Stitches are built as a right hand makes them; the left one makes their mirror image.
    fn mirror(&mut self) {
        for corner in self.stitches.iter_mut().flat_map(|stitch| &mut stitch.corners) {
            *corner = mirrored(*corner);
        }
        for piece in &mut self.pieces {
            piece.yarn.mirror();
        }
    }

    fn add(
        &mut self,
        program: &Program,
        net: &Net,
        places: &[DVec3],
        graph: Option<&Graph>,
    ) -> Result<(), Refused> {
        let name = program.pattern.parts.get(net.part.0 as usize).map_or("", |part| part.name.as_str());
        if places.len() != net.loops as usize {
            let (part, loops, found) = (name.to_owned(), net.loops, places.len());
            return Err(Refused::Places { part, loops, found });
        }
        let mean = |ids: &[u32]| {
            let sum: DVec3 = ids.iter().filter_map(|id| places.get(*id as usize)).sum();
            sum / ids.len().max(1) as f64
        };
        let ring = net.worked.first().is_some_and(|step| step.role == Role::Ring);
        let first: Vec<u32> = (0..net.start).collect();
        let pole = graph.and_then(|graph| graph.pole).or_else(|| ring.then(|| mean(&first)));
        let end_pole = graph.and_then(|graph| graph.end_pole).unwrap_or_else(|| mean(&net.open));
        let frames = Frames::new(net, places, pole, self.gauge[0]);
        let tiles = Tiles {
            net,
            frames,
            pole,
            end_pole,
            shares: shares(net),
            gauge: self.gauge,
            thickness: self.thickness,
        };
        let from = self.stitches.len();
        let piece = self.pieces.len() as u32;
        self.stitches.reserve(net.worked.len());
        for (index, step) in net.worked.iter().enumerate() {
            self.stitches.push(tiles.stitch(piece, index, step));
        }
        let yarn = tiles.yarn(from, &self.stitches[from..]);
        let stitches = from..self.stitches.len();
        self.pieces.push(Piece { name: name.to_owned(), part: net.part, copy: net.copy, stitches, yarn });
        Ok(())
    }
}

/// Yarn thickness by the gauge.
fn thickness(gauge: Option<Gauge>, width: f64) -> f64 {
    let weight = match gauge.map(|gauge| gauge.origin) {
        Some(GaugeOrigin::Estimated { weight, .. }) => Weight::of_weight(weight).and_then(Weight::diameter),
        Some(GaugeOrigin::Given | GaugeOrigin::Swatch) | None => None,
    };
    weight.unwrap_or(YARN_OF_WIDTH * width)
}

/// Colors by the names of a pattern: `#rrggbb`, else one of a few that are easy to tell apart.
fn colors(program: &Program) -> Vec<[u8; 3]> {
    const PALETTE: [[u8; 3]; 8] = [
        [222, 148, 92],
        [96, 140, 170],
        [226, 196, 122],
        [122, 152, 104],
        [176, 104, 118],
        [232, 222, 204],
        [110, 92, 128],
        [92, 84, 78],
    ];
    let named = |index: usize, name: &String| {
        let digits = name.rsplit('#').next().filter(|digits| digits.len() == 6 && name.contains('#'));
        let value = digits.and_then(|digits| u32::from_str_radix(digits, 16).ok());
        value.map_or(PALETTE[index % PALETTE.len()], |value| {
            let [_, red, green, blue] = value.to_be_bytes();
            [red, green, blue]
        })
    };
    let colors: Vec<_> = program.colors.iter().enumerate().map(|(index, name)| named(index, name)).collect();
    if colors.is_empty() { vec![PALETTE[0]] } else { colors }
}

/// For each base of [`Net::bases`]: which share of the loop the stitch has, of how many.
fn shares(net: &Net) -> Vec<(u32, u32)> {
    let mut users = vec![0_u32; net.loops as usize];
    let mut rank = vec![0_u32; net.bases.len()];
    let worked = || net.worked.iter().filter(|step| step.makes > 0);
    for step in worked() {
        let range = step.base.start as usize..step.base.end as usize;
        let bases = net.bases.get(range.clone()).unwrap_or_default();
        for (id, rank) in bases.iter().zip(rank.get_mut(range).unwrap_or_default()) {
            if let Some(users) = users.get_mut(*id as usize) {
                *rank = *users;
                *users += 1;
            }
        }
    }
    let mut shares: Vec<(u32, u32)> = net
        .bases
        .iter()
        .zip(&rank)
        .map(|(id, rank)| (*rank, users.get(*id as usize).copied().unwrap_or(1).max(1)))
        .collect();
    for step in worked().filter(|step| step.against) {
        for share in shares.get_mut(step.base.start as usize..step.base.end as usize).unwrap_or_default() {
            share.0 = share.1.saturating_sub(1 + share.0);
        }
    }
    shares
}

/// What the tiles of one piece are made from.
struct Tiles<'n> {
    net: &'n Net,
    frames: Frames<'n>,
    pole: Option<DVec3>,
    end_pole: DVec3,
    shares: Vec<(u32, u32)>,
    gauge: [f64; 2],
    thickness: f64,
}

impl Tiles<'_> {
    /// The ends of the loops worked into, in course direction.
    fn base(&self, step: &Worked) -> Option<[Point; 2]> {
        let range = step.base.start as usize..step.base.end as usize;
        let (first, last) = (range.start, range.end.checked_sub(1)?);
        let end = |index: usize, right: u32| {
            let id = *self.net.bases.get(index)?;
            let (rank, of) = self.shares.get(index).copied().unwrap_or((0, 1));
            let (left, end) = (self.frames.left(id), self.frames.right(id));
            Some(left.lerp(end, f64::from(rank + right) / f64::from(of)))
        };
        (first <= last).then_some(())?;
        Some([end(first, 0)?, end(last, 1)?])
    }

    /// The ends of the loops made, in course direction.
    fn top(&self, step: &Worked) -> Option<[Point; 2]> {
        let mut tops = Net::top(step);
        let first = tops.next()?;
        let last = tops.next_back().unwrap_or(first);
        Some([self.frames.left(first), self.frames.right(last)])
    }

    /// Base and top, each from left to right.
    fn span(&self, index: usize, step: &Worked) -> [Point; 4] {
        let [width, height] = self.gauge;
        let below = |id: u32, by: f64| {
            let way = self.frames.up(id) * -by;
            let down = |point: Point| Point { at: point.at + way, ..point };
            [down(self.frames.left(id)), down(self.frames.right(id))]
        };
        match step.role {
            Role::Close => {
                let [left, right] = self.base(step).unwrap_or_default();
                let radius = 0.12 * ring_radius(self.net.open.len() as u32, width);
                let shut = |point: Point| Frames::beside(self.end_pole, point, radius);
                [left, right, shut(left), shut(right)]
            }
            Role::Ring => {
                let [left, right] = self.top(step).unwrap_or_default();
                let pole = self.pole.unwrap_or_default();
                let radius = (0.3 * width).min(0.5 * ring_radius(self.net.start, width));
                let inner = |point: Point| Frames::beside(pole, point, radius);
                [inner(left), inner(right), left, right]
            }
            Role::Chain => {
                let [left, right] = self.top(step).unwrap_or_default();
                let [low, lower] = below(step.top, 0.4 * height);
                [low, lower, left, right]
            }
            Role::Work(stitch) if step.makes > 0 => {
                let [left, right] = self.top(step).unwrap_or_default();
                let [low, lower] =
                    self.base(step).unwrap_or_else(|| below(step.top, height * stitch.kind.height()));
                [low, lower, left, right]
            }
            Role::Work(_) | Role::Turn(_) => self.side(index, step),
        }
    }

    /// A narrow strip beside the end of a row, from the loop made before to the one made next.
    fn side(&self, index: usize, step: &Worked) -> [Point; 4] {
        let own = self.net.base(step).first().copied();
        let earlier = || self.net.worked[..index].iter().rev().find(|step| step.makes > 0);
        let from = own.or_else(|| earlier().map(|step| step.top)).unwrap_or(0);
        let to = if step.top < self.net.loops { step.top } else { from };
        let right = step.against;
        let strip = |id: u32| {
            let edge = if right { self.frames.right(id) } else { self.frames.left(id) };
            let way = self.frames.along.get(id as usize).copied().unwrap_or(DVec3::X) * (0.2 * self.gauge[0]);
            let outer = Point { at: if right { edge.at + way } else { edge.at - way }, ..edge };
            if right { [edge, outer] } else { [outer, edge] }
        };
        let ([a, b], [c, d]) = (strip(from), strip(to));
        [a, b, c, d]
    }

    fn stitch(&self, piece: u32, index: usize, step: &Worked) -> Stitch {
        let span = self.span(index, step);
        let half = 0.5 * self.thickness;
        let corner = |k: usize| {
            let Point { at, out } = span[k % 4];
            at + out * if k < 4 { -half } else { half }
        };
        let [a, b, c, d] = span.map(|point| point.at);
        let [width, height] = self.gauge;
        let kind = match step.role {
            Role::Work(stitch) => stitch.kind,
            Role::Chain | Role::Ring | Role::Turn(_) | Role::Close => Kind::Sc,
        };
        let off = |length: f64, rest: f64| (length - rest) / rest;
        let (up, across) = (c + d - a - b, b + d - a - c);
        let plain = step.makes > 0 && matches!(step.role, Role::Work(_));
        let figure = |value: f64| if plain && value.is_finite() { value } else { 0.0 };
        Stitch {
            piece,
            role: step.role,
            against: step.against,
            round: step.round,
            index: step.index,
            row: (step.row != NONE).then_some(step.row),
            color: step.color,
            corners: std::array::from_fn(corner),
            course_error: figure(off(c.distance(d), width * f64::from(step.makes.max(1)))),
            wale_error: figure(off(0.5 * up.length(), height * kind.height().max(0.1))),
            skew: figure(up.normalize_or_zero().dot(across.normalize_or_zero()).abs()),
        }
    }

    /// The yarn through all stitches.
    fn yarn(&self, from: usize, stitches: &[Stitch]) -> Yarn {
        let mut yarn = Yarn::default();
        let mut way = Vec::new();
        for (index, (stitch, step)) in stitches.iter().zip(&self.net.worked).enumerate() {
            let id = (from + index) as u32;
            match step.role {
                Role::Chain => keys::chain(way.as_mut()),
                Role::Turn(_) => keys::turn(way.as_mut()),
                Role::Close => keys::close(way.as_mut()),
                Role::Ring => keys::post(Kind::Sc, 0.5, 0.5, way.as_mut()),
                Role::Work(work) => {
                    let legs = step.makes;
                    for leg in 0..legs {
                        let bases = step.base.len().max(1) as f64;
                        let (first, last) =
                            if legs > 1 { (0.5, 0.5) } else { (0.5 / bases, 1.0 - 0.5 / bases) };
                        keys::post(work.kind, first, last, way.as_mut());
                        let tile = self.leg(stitch, step, leg);
                        draw(&mut yarn, &tile, step, way.as_mut(), id);
                    }
                    if legs == 0 {
                        keys::turn(way.as_mut());
                    }
                }
            }
            draw(&mut yarn, stitch, step, way.as_mut(), id);
        }
        yarn
    }

    /// The tile of one of several stitches in one loop, in working order.
    fn leg(&self, stitch: &Stitch, step: &Worked, leg: u32) -> Stitch {
        if step.makes <= 1 {
            return *stitch;
        }
        let place = if step.against { step.makes - 1 - leg } else { leg };
        let id = step.top + leg;
        let (left, right) = (self.frames.left(id), self.frames.right(id));
        let half = 0.5 * self.thickness;
        let mut tile = *stitch;
        for side in 0..2 {
            let share = f64::from(place + side) / f64::from(step.makes);
            for z in 0..2 {
                let k = 4 * z;
                tile.corners[k + side as usize] = stitch.corners[k].lerp(stitch.corners[k + 1], share);
                let Point { at, out } = if side == 0 { left } else { right };
                tile.corners[k + 2 + side as usize] = at + out * if z == 0 { -half } else { half };
            }
        }
        tile
    }
}

/// Maps points of the unit cube into a tile; work from the wrong side is seen from behind.
fn draw(yarn: &mut Yarn, tile: &Stitch, step: &Worked, way: &mut Vec<keys::Key>, id: u32) {
    if way.is_empty() {
        return;
    }
    if step.against {
        for [x, _, z] in way.iter_mut() {
            (*x, *z) = (1.0 - *x, 1.0 - *z);
        }
    }
    yarn.strand(id, tile.corners, way);
    for key in way.drain(..) {
        yarn.push(tile.map(key), id);
    }
}

/// The name of a role, for people.
impl std::fmt::Display for Role {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Chain => f.write_str("ch"),
            Self::Ring => f.write_str("sc"),
            Self::Turn(Direction::Back) => f.write_str("turn back"),
            Self::Turn(Direction::Forward) => f.write_str("turn forward"),
            Self::Close => f.write_str("drawn shut"),
            Self::Work(stitch) => {
                let kind = stitch.kind.us();
                match (stitch.works, stitch.makes) {
                    (1, 2) if kind == "sc" => f.write_str("inc"),
                    (2, 1) if kind == "sc" => f.write_str("dec"),
                    (works, makes) if makes > works && works > 0 => write!(f, "{makes} {kind} in one"),
                    (works, makes) if works > makes && makes > 0 => write!(f, "{kind}{works}tog"),
                    _ => f.write_str(kind),
                }
            }
        }
    }
}
