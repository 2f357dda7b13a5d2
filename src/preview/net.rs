//! Which loop a stitch is worked into and which it leaves: the loops of every piece, followed along the yarn.

use crate::ir::{Direction, Finish, Kind, Part, PartId, Program, Segment, Start, Step, Stitch};
use std::collections::{BTreeMap, VecDeque};
use std::ops::Range;

/// No loop.
pub(super) const NONE: u32 = u32::MAX;

/// What a tile of the scene is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// A chain of the start.
    Chain,
    /// A single crochet in the magic ring.
    Ring,
    /// A stitch of a row.
    Work(Stitch),
    /// The yarn's way up between two passes of a short row; the new direction.
    Turn(Direction),
    /// A loop of the last round that is drawn shut.
    Close,
}

/// One step of the yarn with its loops.
#[derive(Clone, Debug)]
pub(super) struct Worked {
    pub(super) role: Role,
    /// Worked against the course direction of the fabric: a back pass, or every other flat row.
    pub(super) against: bool,
    /// Loops worked into, as a range of [`Net::bases`], in course direction; empty where there are none.
    pub(super) base: Range<u32>,
    /// First loop made.
    pub(super) top: u32,
    /// Loops made.
    pub(super) makes: u32,
    /// Number of the round, as the pattern prints it; 0 for a chain.
    pub(super) round: u32,
    /// Place in the round, from 1; 0 for a turn.
    pub(super) index: u32,
    /// Index of the yarn color.
    pub(super) color: u16,
    /// Row of the pattern's part, for whoever links text to stitches; `NONE` for what no row lists.
    pub(super) row: u32,
}

/// The loops of one piece: a part, or one copy of it.
#[derive(Clone, Debug)]
pub(super) struct Net {
    pub(super) part: PartId,
    pub(super) copy: u32,
    /// Loops of the first row.
    pub(super) start: u32,
    /// Number of loops.
    pub(super) loops: u32,
    pub(super) worked: Vec<Worked>,
    pub(super) bases: Vec<u32>,
    /// The neighbor of each loop against course direction, or `NONE`.
    pub(super) before: Vec<u32>,
    /// The neighbor of each loop in course direction, or `NONE`.
    pub(super) after: Vec<u32>,
    /// Loops open at the end, in course direction.
    pub(super) open: Vec<u32>,
    /// Loops that lie ready when a row begins, one list a row, the start first.
    pub(super) rings: Vec<Vec<u32>>,
    /// Where loops of the first row are loops of another piece: (piece, loop).
    pub(super) shared: Vec<Option<(u32, u32)>>,
    /// Loops held for other parts.
    held: BTreeMap<PartId, VecDeque<u32>>,
    /// Another part starts from its open loops.
    pub(super) taken: bool,
    /// Worked in rows that turn.
    pub(super) flat: bool,
    /// For each of `rings` the number of steps before it.
    pub(super) cuts: Vec<u32>,
}

/// The loops of every piece of a program, in working order of its parts. Copies beyond `most` in all are left out.
pub(super) fn nets(program: &Program, most: u64) -> Vec<Net> {
    let mut nets: Vec<Net> = Vec::new();
    let mut loops = 0_u64;
    for (index, part) in program.pattern.parts.iter().enumerate() {
        for copy in 0..part.copies.max(1) {
            if copy > 0 && (loops >= most || !program.graphs.is_empty()) {
                break;
            }
            let net = Walk::piece(part, PartId(index as u32), copy, &mut nets);
            loops += u64::from(net.loops);
            nets.push(net);
        }
    }
    nets
}

/// The hook on its way through a part.
struct Walk {
    net: Net,
    ahead: VecDeque<u32>,
    behind: VecDeque<u32>,
    direction: Direction,
    /// Rows run against the course direction of the fabric.
    reversed: bool,
    /// The loop made last, when the yarn runs on from it.
    last: u32,
    /// The base of the last stitch, for one in the same place.
    place: u32,
    color: u16,
}

impl Walk {
    fn piece(part: &Part, id: PartId, copy: u32, nets: &mut [Net]) -> Net {
        let start = part.start.loops();
        let net = Net {
            part: id,
            copy,
            start,
            loops: 0,
            worked: Vec::new(),
            bases: Vec::new(),
            before: Vec::new(),
            after: Vec::new(),
            open: Vec::new(),
            rings: Vec::new(),
            shared: Vec::new(),
            held: BTreeMap::new(),
            taken: false,
            flat: part.flat,
            cuts: Vec::new(),
        };
        let mut walk = Self {
            net,
            ahead: VecDeque::new(),
            behind: VecDeque::new(),
            direction: Direction::Forward,
            reversed: false,
            last: NONE,
            place: NONE,
            color: 0,
        };
        walk.begin(part, nets);
        for (row, (number, body)) in part.numbered_rows().enumerate() {
            for done in 0..body.times {
                walk.cut();
                walk.row(&body.body, row as u32, number.saturating_add(done));
                walk.row_ends(part.flat);
            }
        }
        walk.net.open = walk.ready();
        walk.cut();
        if part.finish == Finish::DrawnShut {
            for id in walk.net.open.clone() {
                let base = walk.base(&[id]);
                walk.push(Role::Close, false, base, NONE, 0, [0, 0], NONE);
            }
        }
        walk.net
    }

    fn begin(&mut self, part: &Part, nets: &mut [Net]) {
        let start = part.start.loops();
        for index in 0..start {
            let id = self.make();
            if index > 0 {
                self.join(id - 1, id);
            }
            self.ahead.push_back(id);
        }
        self.net.shared = vec![None; start as usize];
        match &part.start {
            Start::Ring { .. } => {
                for index in 0..start {
                    self.push(Role::Ring, false, 0..0, index, 1, [1, index + 1], NONE);
                }
                self.last = start.checked_sub(1).unwrap_or(NONE);
            }
            Start::Chain { joined, .. } => {
                // A flat row goes back over its chain, so the chain was made from its last loop to its first.
                for index in 0..start {
                    let id = if *joined { index } else { start - 1 - index };
                    self.push(Role::Chain, !joined, 0..0, id, 1, [0, index + 1], NONE);
                }
                self.last = if *joined { start.checked_sub(1).unwrap_or(NONE) } else { NONE };
            }
            Start::Join { segments } => {
                self.pick_up(segments, nets);
                self.last = start.checked_sub(1).unwrap_or(NONE);
            }
        }
    }

    /// Finds the loops of other pieces that this one starts from.
    fn pick_up(&mut self, segments: &[Segment], nets: &mut [Net]) {
        let mut next = 0_u32;
        for segment in segments {
            let count = segment.loops();
            let mut found: Vec<(u32, u32)> = Vec::new();
            match *segment {
                Segment::Chain { loops } => {
                    for index in next..next.saturating_add(loops) {
                        self.push(Role::Chain, false, 0..0, index, 1, [0, index + 1], NONE);
                    }
                }
                Segment::Open { part, .. } => {
                    let from = nets.iter_mut().enumerate().find(|(_, net)| net.part == part && !net.taken);
                    if let Some((piece, net)) = from {
                        net.taken = true;
                        found.extend(net.open.iter().map(|id| (piece as u32, *id)));
                    }
                }
                Segment::Held { part, loops } => {
                    for (piece, net) in nets.iter_mut().enumerate().filter(|(_, net)| net.part == part) {
                        let Some(held) = net.held.get_mut(&self.net.part) else { continue };
                        let left = (loops as usize - found.len()).min(held.len());
                        found.extend(held.drain(..left).map(|id| (piece as u32, id)));
                    }
                }
                Segment::Surface { part, round, first, loops, back } => {
                    if let Some((piece, net)) = nets.iter().enumerate().find(|(_, net)| net.part == part) {
                        let made = net.worked.iter().filter(|step| step.round == round);
                        let tops = made.flat_map(|step| step.top..step.top.saturating_add(step.makes));
                        let tops = tops.filter(|id| *id < net.loops);
                        let tops = tops.skip(first.saturating_sub(1) as usize).take(loops as usize);
                        let begin = found.len();
                        found.extend(tops.map(|id| (piece as u32, id)));
                        if back && let Some(new) = found.get_mut(begin..) {
                            new.reverse();
                        }
                    }
                }
            }
            for (offset, place) in found.into_iter().take(count as usize).enumerate() {
                if let Some(shared) = self.net.shared.get_mut(next as usize + offset) {
                    *shared = Some(place);
                }
            }
            next = next.saturating_add(count);
        }
    }

    fn row(&mut self, body: &crate::ir::Block, row: u32, round: u32) {
        let mut index = 0;
        for step in body.steps() {
            match step {
                Step::Work(stitch) => {
                    if stitch.kind != Kind::Skip {
                        index += 1;
                    }
                    self.work(stitch, row, [round, index]);
                }
                Step::Turn(direction) => {
                    let from = self.last;
                    self.direction = direction;
                    self.last = NONE;
                    let base = if from == NONE { 0..0 } else { self.base(&[from]) };
                    let against = (direction == Direction::Back) != self.reversed;
                    let top = self.net.loops;
                    self.push(Role::Turn(direction), against, base, top, 0, [round, 0], row);
                }
                Step::Hold { loops, by } => {
                    for _ in 0..loops {
                        let Some(id) = self.ahead.pop_front() else { break };
                        self.net.held.entry(by).or_default().push_back(id);
                    }
                }
                Step::Leave { .. } => {}
                Step::Color(color) => self.color = color,
            }
        }
    }

    fn work(&mut self, stitch: Stitch, row: u32, place: [u32; 2]) {
        let back = self.direction == Direction::Back;
        let against = back != self.reversed;
        let mut base: Vec<u32> = Vec::with_capacity(stitch.works.into());
        for _ in 0..stitch.works {
            let popped = if back { self.behind.pop_back() } else { self.ahead.pop_front() };
            base.extend(popped);
        }
        if let Some(&last) = base.last() {
            self.place = last;
        }
        if stitch.kind == Kind::Skip {
            return;
        }
        // Of chains that cross a gap only the first leaves from a stitch.
        let again = stitch.kind == Kind::Ch
            && self
                .net
                .worked
                .last()
                .is_some_and(|step| matches!(step.role, Role::Work(it) if it.kind == Kind::Ch));
        if base.is_empty() && self.place != NONE && stitch.makes > 0 && stitch.kind != Kind::Fsc && !again {
            base.push(self.place);
        }
        if against {
            base.reverse();
        }
        let top = self.net.loops;
        for _ in 0..stitch.makes {
            let id = self.make();
            if self.last != NONE {
                if against { self.join(id, self.last) } else { self.join(self.last, id) }
            }
            self.last = id;
            if back { self.ahead.push_front(id) } else { self.behind.push_back(id) }
        }
        let base = self.base(&base);
        self.push(Role::Work(stitch), against, base, top, u32::from(stitch.makes), place, row);
    }

    /// What is behind lies ahead of the next row; after the turn of a flat row in the opposite order.
    fn row_ends(&mut self, flat: bool) {
        if flat {
            std::mem::swap(&mut self.ahead, &mut self.behind);
            self.ahead.make_contiguous().reverse();
            self.behind.make_contiguous().reverse();
            self.reversed = !self.reversed;
            self.last = NONE;
        } else {
            self.ahead.append(&mut self.behind);
        }
        self.place = NONE;
    }

    /// Notes what lies ready between two rows.
    fn cut(&mut self) {
        let ring = self.ready();
        self.net.rings.push(ring);
        self.net.cuts.push(self.net.worked.len() as u32);
    }

    /// The loops ahead, in course direction of the fabric.
    fn ready(&self) -> Vec<u32> {
        let mut ready: Vec<u32> = self.ahead.iter().copied().collect();
        if self.reversed {
            ready.reverse();
        }
        ready
    }

    fn make(&mut self) -> u32 {
        let id = self.net.loops;
        self.net.loops += 1;
        self.net.before.push(NONE);
        self.net.after.push(NONE);
        id
    }

    fn join(&mut self, from: u32, to: u32) {
        if let Some(after) = self.net.after.get_mut(from as usize) {
            *after = to;
        }
        if let Some(before) = self.net.before.get_mut(to as usize) {
            *before = from;
        }
    }

    fn base(&mut self, ids: &[u32]) -> Range<u32> {
        let from = self.net.bases.len() as u32;
        self.net.bases.extend_from_slice(ids);
        from..self.net.bases.len() as u32
    }

    #[expect(clippy::too_many_arguments, reason = "the fields of one record")]
    fn push(
        &mut self,
        role: Role,
        against: bool,
        base: Range<u32>,
        top: u32,
        makes: u32,
        [round, index]: [u32; 2],
        row: u32,
    ) {
        let color = self.color;
        self.net.worked.push(Worked { role, against, base, top, makes, round, index, color, row });
    }
}

impl Net {
    /// True when it starts with stitches in a magic ring.
    pub(super) fn has_ring(&self) -> bool {
        self.worked.first().is_some_and(|step| step.role == Role::Ring)
    }
    /// True when its end is drawn shut.
    pub(super) fn is_shut(&self) -> bool {
        self.worked.last().is_some_and(|step| step.role == Role::Close)
    }
    /// The loops that a step is worked into, in course direction.
    pub(super) fn base(&self, step: &Worked) -> &[u32] {
        self.bases.get(step.base.start as usize..step.base.end as usize).unwrap_or_default()
    }
    /// The loops that a step makes, in course direction.
    pub(super) fn top(step: &Worked) -> impl DoubleEndedIterator<Item = u32> + use<> {
        let (top, makes, against) = (step.top, step.makes, step.against);
        (0..makes).map(move |k| top + if against { makes - 1 - k } else { k })
    }
}
