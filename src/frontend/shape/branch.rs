//! `[[branch]]`: reading branches, finding what each grows from, and cutting them off at its surface.

use super::fit;
use super::pair;
use super::short;
use super::tube::{self, Places, Tube};
use super::walk::{Number, Value, Walk};
use crate::diag::{Code, Diagnostic, Span, did_you_mean};
use crate::ir::Gauge;
use crate::shape::beads::Beads;
use crate::shape::branch::{Branch, Misfit, crossing};
use crate::shape::solid::{Solid, Table};
use crate::shape::{self, End, Joint};
use glam::DVec3;
use std::collections::BTreeMap;
use std::sync::Arc;
use toml::de::DeTable;

/// Most branches of one file.
const MOST_BRANCHES: usize = 1000;
/// A branch at this place of its parent's curve or later grows from its end.
const AT_END: f64 = 1.0 - 1e-9;
/// Radius of the rounded rim of a flat end, in stitch heights: the tightest edge that rows can follow without a crease.
const RIM: f64 = 2.0;
/// How far from the axis of its parent a branch may begin, in radii of the parent.
const START_RADII: f64 = 1.2;
/// How far (stitches) the first row of a branch may lie off its rim: that much both fabrics give, and a level row is worth
/// it. A slit gives more, for it opens as it likes.
const GIVE: f64 = 0.5;
const SLIT_GIVE: f64 = 1.5;
const JOINTS: &[(&str, Joint)] =
    &[("surface", Joint::Surface), ("opening", Joint::Opening), ("split", Joint::Split)];

/// A branch as it stands in the file.
#[derive(Debug)]
pub(super) struct Limb {
    name: String,
    named: Span,
    from: Number,
    on: Option<(String, Span)>,
    joint: Joint,
    tube: Tube,
}

/// Reads all `[[branch]]` tables; `None` when one of them is broken.
pub(super) fn read(walk: &mut Walk<'_>, top: &DeTable<'_>) -> Option<Vec<Limb>> {
    const EXPECTED: &str = "a list of tables, written [[branch]]";
    let Some((_, value)) = walk.get(top, "branch") else { return Some(Vec::new()) };
    let entries = walk.list(value, "branch", EXPECTED, MOST_BRANCHES)?;
    let limbs: Vec<Option<Limb>> = entries.iter().map(|entry| limb(walk, entry)).collect();
    limbs.into_iter().collect()
}

fn limb(walk: &mut Walk<'_>, entry: &Value<'_>) -> Option<Limb> {
    let table = walk.table(entry, "branch", "a table")?;
    let home = walk.of(entry);
    let name = walk
        .need(table, "name", ("a branch", home), "name = \"arm\"")
        .and_then(|(_, value)| Some((super::line(walk, value)?, walk.of(value))));
    let from = walk
        .need(table, "from", ("a branch", home), "from = 0.5")
        .and_then(|(_, value)| walk.number(value, "from"))
        .and_then(|from| along(walk, from));
    let on = match walk.get(table, "on") {
        Some((_, value)) => {
            Some(Some((walk.text(value, "on", "the name of a part")?.to_owned(), walk.of(value))))
        }
        None => Some(None),
    };
    let joint = match walk.get(table, "join") {
        Some((_, value)) => walk.word(value, "join", JOINTS),
        None => Some(Joint::Surface),
    };
    let tube = tube::read(walk, entry, home, "branch")?;
    let (name, named) = name?;
    if tube.places().start == End::Closed {
        let (span, _) = walk.get(table, "start").unwrap_or((home, entry));
        let message = format!("`{name}` begins on another part and cannot start closed");
        walk.fault(
            Code::BranchStart,
            span,
            message,
            "",
            "leave `start` out; `end = \"closed\"` closes the tip",
        );
        return None;
    }
    Some(Limb { name, named, from: from?, on: on?, joint: joint?, tube })
}

/// A place on a curve.
fn along(walk: &mut Walk<'_>, from: Number) -> Option<Number> {
    if (0.0..=1.0).contains(&from.value) {
        return Some(from);
    }
    let message = format!("a branch leaves at {}, outside of the curve", short(from.value));
    let help = "`from` counts from 0 at the start of the parent's curve to 1 at its end, whatever the unit";
    walk.fault(Code::BranchStart, from.span, message, "expected 0 to 1", help);
    None
}

/// A part on its way from the file to a tube.
struct Node {
    name: String,
    /// Index of the parent; that of the trunk for the trunk itself.
    parent: usize,
    from: Number,
    joint: Joint,
    tube: Option<Tube>,
    /// The part that this one carries on, if it is the continuation of one.
    into: Option<usize>,
    /// First segment of its curve among those of the tube it belongs to, and how many there are.
    first: usize,
    segments: usize,
}

/// What is known of the tubes of a shape as bodies, by their numbers.
#[derive(Default)]
struct Bodies {
    /// Each is made when it is first asked for.
    tables: BTreeMap<usize, Arc<Table>>,
    beads: BTreeMap<usize, Beads>,
}

impl Bodies {
    /// The tube with this number.
    fn solid<'s>(&mut self, index: usize, tube: &'s shape::Tube) -> Solid<'s> {
        let ends = [tube.start, tube.end];
        let table = self.tables.entry(index).or_insert_with(|| Arc::new(Table::new(&*tube.surface, ends)));
        Solid::with_table(&*tube.surface, ends, Arc::clone(table))
    }

    /// True when two tubes certainly lie apart.
    fn apart(&self, one: usize, other: usize) -> bool {
        self.beads.get(&one).zip(self.beads.get(&other)).is_some_and(|(one, other)| !one.meet(other))
    }
}

/// The tubes of a shape: the trunk, and the branches cut off where they leave it.
pub(super) fn grow(
    walk: &mut Walk<'_>,
    trunk: Tube,
    limbs: Vec<Limb>,
    (gauge, gauge_span): (&Gauge, Span),
) -> Option<Vec<shape::Tube>> {
    let mut nodes = nodes(walk, trunk, limbs)?;
    for index in 0..nodes.len() {
        fork(&mut nodes, index);
    }
    let mut tubes: Vec<shape::Tube> = Vec::new();
    let mut bodies = Bodies::default();
    let mut centers: BTreeMap<usize, (usize, Places)> = BTreeMap::new();
    for index in 0..nodes.len() {
        if nodes.get(index).is_some_and(|node| node.joint == Joint::Split && node.tube.is_some()) {
            divide(walk, &mut nodes, index, (gauge, gauge_span), (&mut tubes, &mut bodies), &mut centers)?;
            continue;
        }
        let Some(tube) = nodes.get_mut(index).and_then(|node| node.tube.take()) else { continue };
        let (sweep, places) = tube.sweep(RIM * gauge.height, walk)?;
        let rings = fit::check(walk, &sweep, &places, gauge, gauge_span)?;
        let node = nodes.get(index)?;
        let ends = [places.start, places.end];
        let (tube, beads) = if index == 0 {
            let beads = (nodes.len() > 1).then(|| rings.beads());
            (shape::Tube::new("trunk", Box::new(sweep), ends), beads)
        } else {
            let root = root(&nodes, node.parent);
            let (parent, axis) = centers.get(&root)?;
            let base = tubes.get(*parent)?;
            let at = place_on(&nodes, node);
            begins(walk, node, &places, axis, at, base)?;
            let give = if node.joint == Joint::Opening { SLIT_GIVE } else { GIVE };
            let solid = bodies.solid(*parent, base);
            let beads = rings.beads();
            match Branch::new(sweep, &beads, &solid, [gauge.width, give]) {
                Ok(branch) => {
                    let beads = branch.beads(beads);
                    let tube = shape::Tube::new(&node.name, Box::new(branch), ends);
                    (tube.on(*parent, node.joint), beads)
                }
                Err(misfit) => {
                    let center = axis.point(at);
                    let finding = explain(walk, node, &places, &base.name, misfit, center);
                    walk.report(finding);
                    return None;
                }
            }
        };
        bodies.beads.extend(beads.map(|beads| (tubes.len(), beads)));
        apart(walk, node, &places, (&tube, tubes.len()), &tubes, &mut bodies)?;
        centers.insert(index, (tubes.len(), places));
        tubes.push(tube);
    }
    Some(tubes)
}

/// The two parts that one divides into, of which `index` is the first.
fn divide(
    walk: &mut Walk<'_>,
    nodes: &mut [Node],
    index: usize,
    (gauge, gauge_span): (&Gauge, Span),
    (tubes, bodies): (&mut Vec<shape::Tube>, &mut Bodies),
    centers: &mut BTreeMap<usize, (usize, Places)>,
) -> Option<()> {
    let own = nodes.get(index)?.parent;
    let pair: Vec<usize> =
        (0..nodes.len()).filter(|i| nodes[*i].parent == own && nodes[*i].joint == Joint::Split).collect();
    let home = root(nodes, own);
    let (parent, axis) = centers.get(&home)?;
    let (parent, name) = (*parent, nodes.get(index)?.name.clone());
    let base = tubes.get(parent)?;
    let mut odd = |span: Span, message: String, help: &str| {
        walk.report(Diagnostic::new(Code::DividesOddly, message).at(span, "").help(help));
        None
    };
    let early = pair.iter().filter_map(|i| nodes.get(*i)).find(|node| node.from.value < AT_END);
    if let Some(node) = early {
        let message = format!("`{}` is to divide `{}` before its end", node.name, base.name);
        return odd(node.from.span, message, "give `from = 1`, or another `join`");
    }
    let from = nodes.get(index)?.from.span;
    if base.end == End::Closed {
        let message = format!("`{}` is closed at its end and cannot divide", base.name);
        return odd(from, message, "give it `end = \"open\"`");
    }
    let &[one, other] = pair.as_slice() else {
        let count = pair.len();
        let message = format!("`{}` divides into {count} with `{name}`, not into two", base.name);
        return odd(
            from,
            message,
            "two branches of one part have `join = \"split\"`; either may divide again",
        );
    };
    let at = place_on(nodes, nodes.get(one)?);
    let mut legs = Vec::with_capacity(2);
    for i in [one, other] {
        let node = nodes.get_mut(i)?;
        let (sweep, places) = node.tube.take()?.sweep(RIM * gauge.height, walk)?;
        fit::check(walk, &sweep, &places, gauge, gauge_span)?;
        begins(walk, node, &places, axis, at, base)?;
        legs.push(pair::Leg { name: node.name.clone(), sweep, places });
    }
    let legs: [pair::Leg; 2] = legs.try_into().ok()?;
    let others = tubes.len();
    for ((stack, leg), i) in pair::legs(walk, base, legs, gauge)?.into_iter().zip([one, other]) {
        let ends = [leg.places.start, leg.places.end];
        let tube = shape::Tube::new(&leg.name, Box::new(stack), ends).on(parent, Joint::Split);
        let own = (&tube, tubes.len());
        apart(walk, nodes.get(i)?, &leg.places, own, tubes.get(..others)?, bodies)?;
        centers.insert(i, (tubes.len(), leg.places));
        tubes.push(tube);
    }
    Some(())
}

/// The parts with their parents, every parent before its branches.
fn nodes(walk: &mut Walk<'_>, trunk: Tube, limbs: Vec<Limb>) -> Option<Vec<Node>> {
    let fold = |name: &str| name.trim().to_lowercase();
    let mut names: BTreeMap<String, Option<Span>> = BTreeMap::from([("trunk".to_owned(), None)]);
    let mut sound = true;
    for limb in &limbs {
        if let Some(before) = names.insert(fold(&limb.name), Some(limb.named)) {
            let message = format!("two parts are called `{}`", limb.name);
            let finding = Diagnostic::new(Code::PartNameTwice, message).at(limb.named, "given again here");
            let finding = before.into_iter().fold(finding, |finding, span| finding.at(span, "given here"));
            walk.report(finding.help("each part has a name of its own, such as `left arm` and `right arm`"));
            sound = false;
        }
    }
    for limb in &limbs {
        let Some((on, span)) = &limb.on else { continue };
        let known = fold(on);
        let finding = if known == fold(&limb.name) {
            Diagnostic::new(Code::NoParent, format!("`{}` grows from itself", limb.name))
                .at(*span, "")
                .help("name the part that it leaves, or leave `on` out for the trunk")
        } else if names.contains_key(&known) {
            continue;
        } else {
            let near = did_you_mean(&known, names.keys().map(String::as_str));
            let label = near.map_or_else(String::new, |near| format!("did you mean \"{near}\"?"));
            Diagnostic::new(
                Code::NoParent,
                format!("there is no part `{on}` for `{}` to grow from", limb.name),
            )
            .at(*span, label)
            .help("`on` names another branch, or \"trunk\"")
        };
        walk.report(finding);
        sound = false;
    }
    if !sound {
        return None;
    }
    let segments = trunk.segment_count();
    let from = Number { value: 0.0, span: trunk.places().home() };
    let mut nodes = vec![Node {
        name: "trunk".to_owned(),
        parent: 0,
        from,
        joint: Joint::Surface,
        tube: Some(trunk),
        into: None,
        first: 0,
        segments,
    }];
    let mut places: BTreeMap<String, usize> = BTreeMap::from([("trunk".to_owned(), 0)]);
    let mut waiting = limbs;
    while !waiting.is_empty() {
        let before = waiting.len();
        let mut rest = Vec::new();
        for limb in waiting {
            let parent = limb.on.as_ref().map_or_else(|| "trunk".to_owned(), |(on, _)| fold(on));
            let Some(parent) = places.get(&parent).copied() else {
                rest.push(limb);
                continue;
            };
            places.insert(fold(&limb.name), nodes.len());
            let segments = limb.tube.segment_count();
            let Limb { name, from, joint, tube, .. } = limb;
            nodes.push(Node { name, parent, from, joint, tube: Some(tube), into: None, first: 0, segments });
        }
        if rest.len() == before {
            let names: Vec<String> = rest.iter().map(|limb| format!("`{}`", limb.name)).collect();
            let mut finding = Diagnostic::new(
                Code::NoParent,
                format!("{} grow from each other in a circle", names.join(", ")),
            );
            for (_, span) in rest.iter().filter_map(|limb| limb.on.as_ref()) {
                finding = finding.at(*span, "");
            }
            walk.report(finding.help("let one of them grow from the trunk"));
            return None;
        }
        waiting = rest;
    }
    Some(nodes)
}

/// Of the branches at the open end of a part, the one that turns least carries it on.
fn fork(nodes: &mut [Node], index: usize) {
    let root = root(nodes, index);
    let Some(Some(tube)) = nodes.get(root).map(|node| node.tube.as_ref()) else { return };
    if tube.places().end == End::Closed {
        return;
    }
    let end = tube.direction_at_end();
    let turn = |node: &Node| {
        let start = node.tube.as_ref().map_or(DVec3::ZERO, Tube::direction_at_start);
        crate::math::atan2(end.cross(start).length(), end.dot(start))
    };
    let next = (index + 1..nodes.len())
        .filter(|child| {
            nodes.get(*child).is_some_and(|node| {
                node.parent == index && node.from.value >= AT_END && node.joint != Joint::Split
            })
        })
        .min_by(|a, b| turn(&nodes[*a]).total_cmp(&turn(&nodes[*b])));
    let Some(next) = next else { return };
    let Some(child) = nodes.get_mut(next) else { return };
    let Some(tube) = child.tube.take() else { return };
    child.into = Some(root);
    let Some(base) = nodes.get_mut(root) else { return };
    let first = base.tube.as_mut().map_or(0, |base| base.carry_on(tube));
    if let Some(child) = nodes.get_mut(next) {
        child.first = first;
    }
}

/// The part whose tube a part belongs to.
fn root(nodes: &[Node], index: usize) -> usize {
    nodes.get(index).and_then(|node| node.into).unwrap_or(index)
}

/// Where a part leaves its parent, as a parameter of the whole curve that the parent belongs to.
fn place_on(nodes: &[Node], node: &Node) -> f64 {
    let root = root(nodes, node.parent);
    let all: usize = nodes
        .iter()
        .enumerate()
        .filter(|(index, other)| *index == root || other.into == Some(root))
        .map(|(_, other)| other.first + other.segments)
        .max()
        .unwrap_or(1);
    let Some(parent) = nodes.get(node.parent) else { return 0.0 };
    (parent.first as f64 + node.from.value * parent.segments as f64) / all as f64
}

/// Checks that the curve of a branch begins where `from` says.
fn begins(
    walk: &mut Walk<'_>,
    node: &Node,
    places: &Places,
    axis: &Places,
    at: f64,
    base: &shape::Tube,
) -> Option<()> {
    let (start, center) = (places.point(0.0), axis.point(at));
    let distance = start.distance(center);
    let radius = axis.radius(at).max(1e-9);
    if distance <= START_RADII * radius {
        return Some(());
    }
    let unit = walk.unit;
    let away = short(distance / unit.mm());
    let message =
        format!("`{}` starts {away} {} away from where it leaves `{}`", node.name, unit.word(), base.name);
    walk.report(
        Diagnostic::new(Code::BranchStart, message)
            .at(places.curve(), "starts here")
            .at(node.from.span, format!("which is {}", coordinates(walk, center)))
            .help(format!("start its curve at {}, or change `from`", coordinates(walk, center))),
    );
    None
}

/// Checks that a tube with its number runs through no other one.
fn apart(
    walk: &mut Walk<'_>,
    node: &Node,
    places: &Places,
    (tube, own): (&shape::Tube, usize),
    others: &[shape::Tube],
    bodies: &mut Bodies,
) -> Option<()> {
    let parent = tube.attachment.map(|attachment| attachment.parent);
    for (index, other) in others.iter().enumerate() {
        if parent == Some(index) || bodies.apart(own, index) {
            continue;
        }
        let (own, body) = (bodies.solid(own, tube), bodies.solid(index, other));
        if !own.meets(&body) {
            continue;
        }
        let at = crossing(&own, &body).or_else(|| crossing(&body, &own));
        let Some(at) = at else { continue };
        let message = format!("`{}` runs through `{}` at {}", node.name, other.name, coordinates(walk, at));
        walk.report(
            Diagnostic::new(Code::TubesCross, message)
                .at(places.curve(), "the curve of this one")
                .help("lead one around the other, make one of them thinner, or let them leave farther apart"),
        );
        return None;
    }
    Some(())
}

fn explain(
    walk: &Walk<'_>,
    node: &Node,
    places: &Places,
    base: &str,
    misfit: Misfit,
    center: DVec3,
) -> Diagnostic {
    let name = &node.name;
    let curve = places.curve();
    let section = places.section(0.0);
    match misfit {
        Misfit::Apart { distance } => {
            let (distance, unit) = (short(distance / walk.unit.mm()), walk.unit.word());
            let message = format!("`{name}` does not touch `{base}`: {distance} {unit} lie between them");
            Diagnostic::new(Code::BranchApart, message)
                .at(curve, "starts here")
                .help(format!("start its curve at {}", coordinates(walk, center)))
        }
        Misfit::Beside { share } => {
            let share = (100.0 * share).ceil();
            let message =
                format!("`{name}` is too wide for `{base}`: {share} % of its girth do not come out of it");
            Diagnostic::new(Code::BranchTooWide, message)
                .at(section, "too wide here")
                .at(curve, "for where this leads")
                .help("make the branch thinner where it begins, or lead it straight away from the middle of its parent")
        }
        Misfit::OpenEnd => {
            let message = format!("`{name}` leaves through the open end of `{base}`");
            Diagnostic::new(Code::BranchTooWide, message)
                .at(curve, "starts here")
                .at(node.from.span, "too near to the end")
                .help("let it leave farther from the end, make it thinner, or close the end")
        }
        Misfit::Inside => {
            let message = format!("`{name}` does not come out of `{base}`");
            Diagnostic::new(Code::BranchApart, message)
                .at(curve, "ends inside")
                .help("lead its curve farther out")
        }
        Misfit::Returns { at } => {
            let message = format!("`{name}` runs back into `{base}` at {}", coordinates(walk, at));
            Diagnostic::new(Code::TubesCross, message)
                .at(curve, "this curve")
                .help("lead it farther away, or make one of the two thinner")
        }
    }
}

/// A point in the unit of the file, as the file would have it.
pub(super) fn coordinates(walk: &Walk<'_>, point: DVec3) -> String {
    let [x, y, z] = (point / walk.unit.mm()).to_array().map(|number| {
        let text = short(number);
        if text == "-0" { "0".to_owned() } else { text }
    });
    format!("[{x}, {y}, {z}]")
}
