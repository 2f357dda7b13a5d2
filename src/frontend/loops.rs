//! The text format of loops (paper, section 3.1: a shape as a stack of loops): `grammar/loops.ebnf`.

use super::{Input, Reader, Unit};
use crate::diag::{Code, Diagnostic, Sink, Source, Sources, Span};
use crate::ir::Gauge;
use crate::shape::{Ring, Shape, Stack, Tube, Wishes};
use glam::DVec3;

/// The reader.
pub(crate) const READER: Reader = Reader {
    name: "loops",
    extensions: &["loops"],
    about: "loops: the surface of a tube, loop by loop",
    read,
};

/// First line of a file.
const MAGIC: &str = "picot-loops 1";
/// Most points of a file, and most loops.
const MOST_POINTS: usize = 4_000_000;
const MOST_LOOPS: usize = 20_000;
/// Beyond this a coordinate is a mistake.
const MOST: f64 = 1e9;
/// Samples to a stitch width around.
const SAMPLES_A_STITCH: f64 = 1.5;

fn read(source: &Source, _: &mut Sources<'_>, sink: &mut Sink<'_>) -> Option<Input> {
    read_at(source, None, sink)
}

/// Reads a file of loops; a gauge takes the place of that of the file.
pub(crate) fn read_at(source: &Source, gauge: Option<Gauge>, sink: &mut Sink<'_>) -> Option<Input> {
    match parse(source).and_then(|file| file.shape(source, gauge)) {
        Ok(shape) => Some(Input::Shape(Box::new(shape))),
        Err(found) => {
            sink.push(*found);
            None
        }
    }
}

/// What a file says.
struct File {
    name: String,
    unit: Unit,
    gauge: Option<Gauge>,
    poles: [Option<DVec3>; 2],
    loops: Vec<(Vec<DVec3>, Span)>,
}

type Found<T> = Result<T, Box<Diagnostic>>;

fn fault<T>(span: Span, message: impl Into<String>, help: &str) -> Found<T> {
    Err(Box::new(Diagnostic::new(Code::LoopsSyntax, message).at(span, "").help(help)))
}

fn parse(source: &Source) -> Found<File> {
    let text = match source.text() {
        Ok(text) => text,
        Err(at) => return fault(source.span(at..at + 1), "the file is not UTF-8", "save it as UTF-8"),
    };
    let mut file =
        File { name: stem(source.name()), unit: Unit::Mm, gauge: None, poles: [None; 2], loops: Vec::new() };
    let mut size: Option<([f64; 2], Span)> = None;
    let mut points = 0;
    let mut seen: Vec<&str> = Vec::new();
    let mut begun = false;
    let mut at = 0;
    for raw in text.split_inclusive('\n') {
        let start = at;
        at += raw.len();
        let line = raw.split('#').next().unwrap_or_default().trim();
        if line.is_empty() {
            continue;
        }
        let indent = raw.len() - raw.trim_start().len();
        let span = source.span(start + indent..start + indent + line.len());
        if !begun {
            if line != MAGIC {
                return fault(span, "this is no file of loops", "its first line is `picot-loops 1`");
            }
            begun = true;
            continue;
        }
        let (word, rest) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
        let rest = rest.trim();
        if matches!(word, "name" | "unit" | "gauge" | "start" | "end") {
            if seen.contains(&word) {
                return fault(span, format!("`{word}` stands twice"), "keep one of the two");
            }
            if !file.loops.is_empty() {
                let message = format!("`{word}` stands behind a loop");
                return fault(span, message, "it belongs in front of the first `loop`");
            }
            seen.push(word);
        }
        match word {
            "name" => rest.chars().take(200).collect::<String>().clone_into(&mut file.name),
            "unit" => match Unit::WORDS.iter().find(|(known, _)| *known == rest) {
                Some((_, unit)) => file.unit = *unit,
                None => return fault(span, format!("the unit `{rest}` is not known"), "mm, cm or in"),
            },
            "gauge" => match numbers::<2>(rest) {
                Some(sides) if sides.iter().all(|side| *side > 0.0) => size = Some((sides, span)),
                _ => return fault(span, "a gauge is two lengths above 0", "`gauge 5 5`: width and height"),
            },
            "start" | "end" => {
                let Some(point) = numbers::<3>(rest) else {
                    let help = "`start x y z` closes the start at a point; leave it out for an open start";
                    return fault(span, format!("`{word}` needs a point"), help);
                };
                file.poles[usize::from(word == "end")] = Some(DVec3::from_array(point));
            }
            "loop" if rest.is_empty() => {
                if file.loops.len() == MOST_LOOPS {
                    return fault(span, format!("more than {MOST_LOOPS} loops"), "leave some out");
                }
                file.loops.push((Vec::new(), span));
            }
            _ => {
                let Some(point) = numbers::<3>(line) else {
                    let help = "a line is `loop`, or the three numbers of a point";
                    return fault(span, "this line is neither a loop nor a point", help);
                };
                let Some((ring, _)) = file.loops.last_mut() else {
                    return fault(
                        span,
                        "a point stands before the first loop",
                        "begin each loop with a line `loop`",
                    );
                };
                points += 1;
                if points > MOST_POINTS {
                    return fault(span, format!("more than {MOST_POINTS} points"), "leave some out");
                }
                ring.push(DVec3::from_array(point));
            }
        }
    }
    if !begun {
        return fault(source.span(0..0), "the file is empty", "its first line is `picot-loops 1`");
    }
    if let Some(([width, height], _)) = size {
        file.gauge = Some(Gauge::new(width * file.unit.mm(), height * file.unit.mm()));
    }
    Ok(file)
}

/// Exactly so many usable numbers.
fn numbers<const N: usize>(text: &str) -> Option<[f64; N]> {
    let mut words = text.split_whitespace();
    let mut list = [0.0; N];
    for place in &mut list {
        *place = words.next()?.parse().ok().filter(|x: &f64| x.is_finite() && x.abs() <= MOST)?;
    }
    words.next().is_none().then_some(list)
}

fn stem(name: &str) -> String {
    let last = name.rsplit(['/', '\\']).next().unwrap_or_default();
    last.rsplit_once('.').map_or(last, |(stem, _)| stem).to_owned()
}

impl File {
    fn shape(self, source: &Source, gauge: Option<Gauge>) -> Found<Shape> {
        let home = source.span(0..0);
        let Some(gauge) = gauge.or(self.gauge) else {
            return Err(Box::new(
                Diagnostic::new(Code::GaugeMissing, "the loops do not say how large a stitch is")
                    .at(home, "")
                    .help("add --gauge, for example --gauge 5mmx5mm, or a line `gauge 5 5`"),
            ));
        };
        let unit = self.unit.mm();
        let mut rings = Vec::with_capacity(self.loops.len());
        for (points, span) in &self.loops {
            let Some(ring) = Ring::new(points.iter().map(|p| *p * unit).collect()) else {
                let message =
                    format!("a loop needs three points apart from each other, and this has {}", points.len());
                return fault(*span, message, "a loop that shrinks to a point is a `start` or an `end`");
            };
            rings.push(ring);
        }
        let poles = self.poles.map(|pole| pole.map(|p| p * unit));
        if rings.len() + poles.iter().flatten().count() < 2 || rings.is_empty() {
            return fault(home, "a tube needs two loops, or one and a closed end", "add loops");
        }
        self.around(&rings, poles).map_or(Ok(()), |(place, message)| crossing(place, message))?;
        // Seen from the end loops run clockwise; a file with all of them the other way is as good.
        let ways: Vec<DVec3> = ways(&rings, poles);
        let sense: f64 = rings.iter().zip(&ways).map(|(ring, way)| ring.area().dot(*way)).sum();
        if sense > 0.0 {
            rings = rings.iter().map(Ring::reversed).collect();
        }
        let area: f64 =
            rings.windows(2).map(|pair| pair[0].length() * pair[0].center().distance(pair[1].center())).sum();
        let stitches = area / (gauge.width * gauge.height);
        if stitches.is_nan() || stitches > f64::from(crate::ir::MAX_LOOPS) {
            let message =
                format!("this takes about {stitches:.0} stitches, at most {} are made", crate::ir::MAX_LOOPS);
            let found = Diagnostic::new(Code::ShapeTooLarge, message).at(home, "");
            return Err(Box::new(found.help("use a larger stitch, or check the unit")));
        }
        let most = rings.iter().map(Ring::length).fold(0.0, f64::max);
        let around = (SAMPLES_A_STITCH * most / gauge.width).clamp(48.0, 256.0) as usize;
        let stack = Stack::new(&rings, poles, around.next_multiple_of(16));
        let Some(mut stack) = stack else {
            return fault(
                home,
                "the loops all lie in one place",
                "the loops of a tube follow each other along it",
            );
        };
        stack.revolve(gauge.width, &[], &[]);
        let ends = stack.ends();
        let tubes = vec![Tube::new("trunk", Box::new(stack), ends)];
        Ok(Shape { name: self.name, gauge, tubes, wishes: Wishes::default() })
    }

    /// Two loops that cross each other: the place of the second, and what to say.
    fn around(&self, rings: &[Ring], poles: [Option<DVec3>; 2]) -> Option<(Span, String)> {
        const SAMPLES: usize = 64;
        let ways = ways(rings, poles);
        let mut before = rings.first()?.samples(SAMPLES, 0.0);
        for (k, pair) in rings.windows(2).enumerate() {
            let flipped = pair[0].area().dot(pair[1].area()) < 0.0;
            let after = pair[1].beside(&before);
            let way = (ways[k] + ways[k + 1]).normalize_or_zero();
            let normal =
                (pair[0].area().normalize_or_zero() + pair[1].area().normalize_or_zero()).normalize_or_zero();
            let normal = if normal.dot(way) < 0.0 { -normal } else { normal };
            let room = 1e-9 * pair[0].length();
            let back = before.iter().zip(&after).position(|(a, b)| (*b - *a).dot(normal) < -room);
            let on = before.iter().zip(&after).any(|(a, b)| (*b - *a).dot(normal) > room);
            let span = self.loops.get(k + 1).map(|(_, span)| *span)?;
            if flipped {
                return Some((span, format!("loop {} runs the other way than the one before it", k + 2)));
            }
            if let (Some(at), true) = (back, on) {
                let at = after[at] / self.unit.mm();
                let message = format!(
                    "loop {} crosses the one before it near ({:.3}, {:.3}, {:.3})",
                    k + 2,
                    at.x,
                    at.y,
                    at.z
                );
                return Some((span, message));
            }
            before = after;
        }
        None
    }
}

fn crossing(span: Span, message: String) -> Found<()> {
    let help = "loops lie behind each other along the tube, and all run the same way around it";
    Err(Box::new(Diagnostic::new(Code::LoopsCross, message).at(span, "this loop").help(help)))
}

/// The way along the tube at each loop.
fn ways(rings: &[Ring], poles: [Option<DVec3>; 2]) -> Vec<DVec3> {
    let centers: Vec<DVec3> = rings.iter().map(Ring::center).collect();
    (0..centers.len())
        .map(|k| {
            let before = k.checked_sub(1).map(|k| centers[k]).or(poles[0]).unwrap_or(centers[k]);
            let after = centers.get(k + 1).copied().or(poles[1]).unwrap_or(centers[k]);
            (after - before).normalize_or_zero()
        })
        .collect()
}
