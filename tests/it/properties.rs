//! Random surfaces through the whole pipeline: each gives a pattern that can be worked, or is refused with a reason.

use glam::{DQuat, DVec2, DVec3};
use picot::diag::{Severity, Sink};
use picot::generate::{Options, generate};
use picot::ir::verify::verify;
use picot::ir::{Finish, Gauge, Hand, Maker, Pattern, Program};
use picot::lower::trace;
use picot::shape::{Bezier, End, Interpolation, Profile, Section, Sweep, Tube, TubeSpec};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// The generator `SplitMix64`: the same surfaces on every machine.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }
    pub(crate) fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }
    fn below(&mut self, n: u64) -> u64 {
        self.bits() % n
    }
}

/// A surface that someone could want: lengths of 20 to 150 mm, radii of 4 to 25 mm, stitches of 2.5 to 8 mm.
pub(crate) fn surface(random: &mut Random) -> (TubeSpec, Gauge) {
    let length = random.within(20.0, 150.0);
    let p = |x: f64, y: f64, z: f64| DVec3::new(x, y, z) * length;
    let bow = random.within(0.1, 0.8);
    let segments: Vec<Vec<DVec3>> = match random.below(5) {
        0 => vec![vec![p(0.0, 0.0, 0.0), p(0.0, 0.0, 1.0)]],
        1 => vec![vec![p(0.0, 0.0, 0.0), p(0.0, bow, 0.5), p(0.0, 0.0, 1.0)]],
        2 => vec![vec![p(0.0, 0.0, 0.0), p(0.0, bow, 0.3), p(bow, -bow, 0.7), p(0.0, 0.0, 1.0)]],
        3 => vec![
            vec![p(0.0, 0.0, 0.0), p(0.0, 0.5 * bow, 0.25), p(0.0, 0.0, 0.5)],
            vec![p(0.0, 0.0, 0.5), p(0.0, -0.5 * bow, 0.75), p(0.0, 0.0, 1.0)],
        ],
        _ => vec![vec![p(0.0, 0.0, 0.0), p(0.0, 0.0, 1.2), p(0.0, 1.5 * bow, 1.2), p(0.0, 1.5 * bow, 0.0)]],
    };
    let axis = DVec3::new(random.within(-1.0, 1.0), random.within(-1.0, 1.0), random.within(-1.0, 1.0));
    let turn = match random.below(3) {
        0 => DQuat::IDENTITY,
        1 => DQuat::from_rotation_arc(DVec3::Z, DVec3::X),
        _ => DQuat::from_rotation_arc(DVec3::Z, axis.normalize_or(DVec3::Y)),
    };
    let bezier = |points: &Vec<DVec3>| {
        let points: Vec<DVec3> = points.iter().map(|&point| turn * point).collect();
        Bezier::new(&points).expect("two to four points")
    };
    let count = 1 + random.below(4);
    let radius = random.within(4.0, 25.0);
    let mut sections: Vec<Section> = (0..count)
        .map(|index| {
            let at = if count == 1 { 0.0 } else { index as f64 / (count - 1) as f64 };
            let wide = radius * random.within(0.6, 1.5);
            let flat = if random.below(2) == 0 { 1.0 } else { random.within(0.5, 1.6) };
            let shift = if random.below(3) == 0 { 0.3 * radius } else { 0.0 };
            let offset = DVec2::new(random.within(-shift, shift), random.within(-shift, shift));
            Section { at, profile: Profile::Ellipse { axes: [wide, wide * flat], offset } }
        })
        .collect();
    let mut end = |random: &mut Random, section: usize| {
        if random.below(2) == 0 {
            return End::Open;
        }
        if let (true, Some(Profile::Ellipse { axes, .. })) =
            (count > 1 && random.below(3) > 0, sections.get_mut(section).map(|section| &mut section.profile))
        {
            *axes = [0.0; 2];
        }
        End::Closed
    };
    let (start, end) = (end(random, 0), end(random, count as usize - 1));
    let interpolation = if random.below(2) == 0 { Interpolation::Linear } else { Interpolation::Smooth };
    let width = random.within(2.5, 8.0);
    let height = if random.below(2) == 0 { width } else { width * random.within(0.6, 1.6) };
    let spec = TubeSpec { curve: segments.iter().map(bezier).collect(), sections, interpolation, start, end };
    (spec, Gauge::new(width, height))
}

/// The surface as a shape file, for whoever looks into a failure.
fn toml(spec: &TubeSpec, gauge: Gauge) -> String {
    let mut out = format!(
        "name = \"found\"\nunit = \"mm\"\n[gauge]\nstitch = {{ width = {:?}, height = {:?} }}\n[trunk]\ncurve = [",
        gauge.width, gauge.height
    );
    for segment in &spec.curve {
        let points: Vec<_> =
            segment.points().iter().map(|p| format!("[{:?}, {:?}, {:?}]", p.x, p.y, p.z)).collect();
        let _ = write!(out, "[{}], ", points.join(", "));
    }
    let end = |end| if end == End::Open { "open" } else { "closed" };
    let smooth = if spec.interpolation == Interpolation::Smooth { "smooth" } else { "linear" };
    let _ = writeln!(
        out,
        "]\nstart = \"{}\"\nend = \"{}\"\ninterpolation = \"{smooth}\"\nsection = [",
        end(spec.start),
        end(spec.end)
    );
    for section in &spec.sections {
        if let Profile::Ellipse { axes: [a, b], offset } = &section.profile {
            let _ = writeln!(
                out,
                "  {{ at = {:?}, ellipse = [{a:?}, {b:?}], offset = [{:?}, {:?}] }},",
                section.at, offset.x, offset.y
            );
        }
    }
    out + "]\n"
}

enum Outcome {
    Pattern { stitches: u64 },
    Refused(String),
    Wrong(String),
}

fn compile(spec: &TubeSpec, gauge: Gauge, options: &Options) -> Outcome {
    let sweep = match Sweep::new(spec) {
        Ok(sweep) => sweep,
        Err(fault) => {
            let name = format!("{fault:?}");
            return Outcome::Refused(name.split([' ', '{']).next().unwrap_or_default().to_owned());
        }
    };
    let tube = Tube::new("trunk", Box::new(sweep), [spec.start, spec.end]);
    let mut sink = Sink::new();
    let Some(graph) = generate(&tube, &gauge, options, &mut sink) else {
        let reason = sink.diagnostics().iter().find(|found| found.severity == Severity::Error);
        return reason.map_or_else(
            || Outcome::Wrong("refused without a reason".into()),
            |found| Outcome::Refused(found.code.as_str().to_owned()),
        );
    };
    let finish = if spec.end == End::Closed { Finish::DrawnShut } else { Finish::Open };
    let part = trace("trunk", &graph, finish);
    let pattern = Pattern { parts: vec![part] };
    let mut program = Program {
        name: "found".into(),
        gauge: Some(gauge),
        maker: Maker::default(),
        colors: Vec::new(),
        pattern,
        graphs: vec![graph],
    };
    let before = program.pattern.clone();
    picot::passes::run(&mut program, &mut sink);
    if !picot::passes::same_steps(&before, &program.pattern) {
        return Outcome::Wrong("the passes changed the steps".into());
    }
    let Some(verified) = verify(&program, &mut sink) else {
        let fault = sink.diagnostics().iter().find(|found| found.severity == Severity::Error);
        return Outcome::Wrong(format!("not workable: {fault:?}"));
    };
    let stitches = verified.facts().stitches(&program);
    match crate::xml::loses(&program) {
        None => Outcome::Pattern { stitches },
        Some(what) => Outcome::Wrong(format!("lost in XML: {what}")),
    }
}

#[expect(clippy::print_stderr, reason = "the share refused is worth a look")]
fn run(count: u64) {
    let mut random = Random(2026);
    let (mut made, mut stitches) = (0, 0);
    let mut refused: BTreeMap<String, u32> = BTreeMap::new();
    let mut wrong: Vec<(usize, String)> = Vec::new();
    // One surface in eight gets all the tries that the options allow, and some of the others are for special makers.
    let once = Options { tries: 1, ..Options::default() };
    let often = Options::default();
    let simple = Options { readability: Some(1.0), ..once.clone() };
    let left = Options { hand: Some(Hand::Left), ..once.clone() };
    let leaning = Options { lean: Some(-0.1), ..once.clone() };
    for index in 0..count {
        let (spec, gauge) = surface(&mut random);
        let options = match index % 8 {
            0 => &often,
            2 => &left,
            4 => &simple,
            6 => &leaning,
            _ => &once,
        };
        let outcome = catch_unwind(AssertUnwindSafe(|| compile(&spec, gauge, options)));
        match outcome.unwrap_or_else(|_| Outcome::Wrong("it panicked".into())) {
            Outcome::Pattern { stitches: more } => (made, stitches) = (made + 1, stitches + more),
            Outcome::Refused(reason) => *refused.entry(reason).or_default() += 1,
            Outcome::Wrong(what) => {
                let toml = toml(&spec, gauge);
                wrong.push((toml.len(), format!("{what}\n{toml}")));
            }
        }
    }
    eprintln!(
        "{count} surfaces: {made} patterns of {stitches} stitches in all, refused {refused:?}, wrong {}",
        wrong.len()
    );
    wrong.sort();
    let simplest: Vec<_> = wrong.iter().take(3).map(|(_, what)| what.as_str()).collect();
    assert!(wrong.is_empty(), "{} of {count} are wrong, the simplest:\n{}", wrong.len(), simplest.join("\n"));
    assert!(made * 2 > count, "most surfaces give a pattern: {made} of {count}, {refused:?}");
}

#[test]
fn two_thousand_random_surfaces_give_a_pattern_or_a_reason() {
    run(2000);
}

#[test]
#[ignore = "takes minutes"]
fn twenty_thousand_random_surfaces_give_a_pattern_or_a_reason() {
    run(20_000);
}
