//! What the viewer's script is given: the scene as packed numbers, and how rounds lie in it.

use crate::backends::Backend;
use crate::backends::crochet::Crochet;
use crate::diag::Sink;
use crate::ir::verify::Verified;
use crate::ir::{Direction, Stitch};
use crate::preview::{Role, Scene};
use glam::DVec3;
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// Writes the JSON. It stands in a script element, so that no `<` may be in it.
pub(super) fn write(program: &Verified<'_>, scene: Option<&Scene>, plain: &Crochet, out: &mut String) {
    let mut text = String::new();
    let mut pattern = Vec::new();
    // A vector takes all that is written.
    let _ = plain.emit(program, &mut pattern, &mut Sink::new());
    let _ = write!(
        text,
        "{{\"schema\":\"picot.page/1\",\"name\":{},\"hash\":\"{}\"",
        quoted(&program.name),
        hash(program)
    );
    let parts = program
        .pattern
        .parts
        .iter()
        .map(|part| format!("{{\"name\":{},\"flat\":{}}}", quoted(&part.name), part.flat));
    let _ = write!(text, ",\"parts\":[{}]", parts.collect::<Vec<_>>().join(","));
    let _ = write!(text, ",\"text\":{}", quoted(&String::from_utf8_lossy(&pattern)));
    if let Some(scene) = scene {
        write_scene(scene, &mut text);
    }
    text.push('}');
    out.push_str(&text.replace('<', "\\u003c"));
}

fn write_scene(scene: &Scene, text: &mut String) {
    let [width, height] = scene.gauge;
    let _ = write!(
        text,
        ",\"gauge\":[{width:.4},{height:.4}],\"yarn\":{:.4},\"thickness\":{:.4}",
        scene.yarn, scene.thickness
    );
    if let Some(rest) = scene.predicted {
        let _ = write!(text, ",\"predicted\":{}", rest.converged);
    }
    let list = |items: &mut dyn Iterator<Item = String>| items.collect::<Vec<_>>().join(",");
    let colors = list(&mut scene.colors.iter().map(|[r, g, b]| format!("[{r},{g},{b}]")));
    let (all, places) = ways(scene);
    let ways = list(&mut all.iter().map(|way| {
        let keys = list(&mut way.iter().map(|[x, y, z]| format!("{x:.3},{y:.3},{z:.3}")));
        format!("[{keys}]")
    }));
    let pieces = list(&mut scene.pieces.iter().map(|piece| {
        let strands = piece.yarn.strands().len();
        let (first, count) = (piece.stitches.start, piece.stitches.len());
        format!(
            "{{\"part\":{},\"copy\":{},\"first\":{first},\"count\":{count},\"strands\":{strands}}}",
            piece.part.0, piece.copy
        )
    }));
    let _ = write!(text, ",\"colors\":[{colors}],\"ways\":[{ways}],\"pieces\":[{pieces}]");
    stitches(scene, text);
    strands(scene, &places, text);
}

/// The different ways of yarn through a tile, and for each piece where its own are among them.
fn ways(scene: &Scene) -> (Vec<&[[f64; 3]]>, Vec<Vec<usize>>) {
    let mut all: Vec<&[[f64; 3]]> = Vec::new();
    let mut place = |way| {
        all.iter().position(|known| *known == way).unwrap_or_else(|| {
            all.push(way);
            all.len() - 1
        })
    };
    let pieces = scene.pieces.iter();
    let places = pieces.map(|piece| piece.yarn.ways().iter().map(|way| place(way)).collect()).collect();
    (all, places)
}

/// Kinds, rounds, and for each stitch its kind, color and errors.
fn stitches(scene: &Scene, text: &mut String) {
    let mut kinds: BTreeMap<Kind, u8> = BTreeMap::new();
    let mut order: Vec<Kind> = Vec::new();
    let mut rounds: Vec<[i64; 5]> = Vec::new();
    let mut bytes = Bytes::default();
    for (id, stitch) in scene.stitches.iter().enumerate() {
        let kind = Kind::of(stitch.role, stitch.against);
        let number = *kinds.entry(kind).or_insert_with(|| {
            order.push(kind);
            (order.len() - 1).min(255) as u8
        });
        let row = stitch.row.map_or(-1, i64::from);
        let (piece, round) = (i64::from(stitch.piece), i64::from(stitch.round));
        match rounds.last_mut() {
            Some(last) if last[0] == piece && last[1] == round && last[2] == row => last[4] += 1,
            _ => rounds.push([piece, round, row, id as i64, 1]),
        }
        bytes.0.push(number);
        bytes.0.push(stitch.color.min(255) as u8);
        for error in [stitch.course_error, stitch.wale_error] {
            bytes.short((error.clamp(-3.0, 3.0) * 10_000.0).round() as i16 as u16);
        }
        bytes.0.push((stitch.skew.clamp(0.0, 1.0) * 255.0).round() as u8);
    }
    let kinds: Vec<String> = order.iter().map(|kind| kind.json()).collect();
    let rounds: Vec<String> = rounds.iter().map(|[a, b, c, d, e]| format!("[{a},{b},{c},{d},{e}]")).collect();
    let _ = write!(
        text,
        ",\"kinds\":[{}],\"rounds\":[{}],\"stitches\":\"{}\"",
        kinds.join(","),
        rounds.join(","),
        bytes.base64()
    );
}

/// What a stitch is called.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Kind {
    Chain,
    Ring,
    Turn(Direction),
    Close,
    Work(Stitch, bool),
}

impl Kind {
    fn of(role: Role, against: bool) -> Self {
        match role {
            Role::Chain => Self::Chain,
            Role::Ring => Self::Ring,
            Role::Turn(direction) => Self::Turn(direction),
            Role::Close => Self::Close,
            Role::Work(stitch) => Self::Work(stitch, against),
        }
    }

    /// Its name, the group of colors that it has, and whether it is worked from the wrong side.
    fn json(self) -> String {
        let (role, against) = match self {
            Self::Chain => (Role::Chain, false),
            Self::Ring => (Role::Ring, false),
            Self::Turn(direction) => (Role::Turn(direction), direction == Direction::Back),
            Self::Close => (Role::Close, false),
            Self::Work(stitch, against) => (Role::Work(stitch), against),
        };
        let (group, step) = match self {
            Self::Chain => ("chain", false),
            Self::Ring => ("plain", false),
            Self::Turn(_) => ("turn", true),
            Self::Close => ("close", false),
            Self::Work(stitch, _) if stitch.is_increase() => ("inc", true),
            Self::Work(stitch, _) if stitch.is_decrease() => ("dec", true),
            Self::Work(stitch, _) if stitch.kind == crate::ir::Kind::Sc => ("plain", true),
            Self::Work(..) => ("other", true),
        };
        format!(
            "{{\"name\":{},\"group\":\"{group}\",\"against\":{against},\"step\":{step}}}",
            quoted(&role.to_string())
        )
    }
}

/// The tiles that the yarn goes through: a table of points with their outsides, and four points a tile.
fn strands(scene: &Scene, ways: &[Vec<usize>], text: &mut String) {
    let all = || {
        scene
            .pieces
            .iter()
            .zip(ways)
            .flat_map(|(piece, ways)| piece.yarn.strands().iter().map(move |strand| (strand, ways)))
    };
    let places =
        all().flat_map(|(strand, _)| (0..4).map(|k| (strand.corners[k] + strand.corners[k + 4]) * 0.5));
    let (low, high) =
        places.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), at| (low.min(at), high.max(at)));
    let (low, size) = if low.is_finite() && high.is_finite() {
        (low, (high - low).max_element().max(1e-3))
    } else {
        (DVec3::ZERO, 1.0)
    };
    let mut table: BTreeMap<[u16; 6], u32> = BTreeMap::new();
    let (mut points, mut tiles) = (Bytes::default(), Bytes::default());
    let mut before = 0;
    for (strand, ways) in all() {
        for k in 0..4 {
            let (inner, outer) = (strand.corners[k], strand.corners[k + 4]);
            let at = ((inner + outer) * 0.5 - low) / size * 65_535.0;
            let out = (outer - inner).normalize_or_zero() * 127.0;
            let code = |value: f64| value.round() as i8 as u8;
            let [x, y, z] = at.to_array().map(|value| value.round() as u16);
            let [a, b, c] = out.to_array().map(code);
            let key = [x, y, z, a.into(), b.into(), c.into()];
            let next = table.len() as u32;
            let id = *table.entry(key).or_insert_with(|| {
                for value in [x, y, z] {
                    points.short(value);
                }
                points.0.extend([a, b, c]);
                next
            });
            tiles.0.extend(&id.to_le_bytes()[..3]);
        }
        let way = ways.get(strand.way as usize).copied().unwrap_or(0);
        tiles.0.push(way.min(255) as u8);
        tiles.0.push(strand.stitch.saturating_sub(before).min(255) as u8);
        before = strand.stitch;
    }
    let _ = write!(
        text,
        ",\"low\":[{:.4},{:.4},{:.4}],\"size\":{size:.4},\"points\":\"{}\",\"tiles\":\"{}\"",
        low.x,
        low.y,
        low.z,
        points.base64(),
        tiles.base64()
    );
}

fn quoted(text: &str) -> String {
    serde_json::Value::from(text).to_string()
}

/// Names the pattern for what the page remembers of it (FNV-1a over its text).
fn hash(program: &Verified<'_>) -> String {
    let text = crate::ir::dump::pattern(&program.pattern);
    let hash = program.name.bytes().chain(text.bytes()).fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    });
    format!("{hash:016x}")
}

/// Bytes that go into the page as base64.
#[derive(Default)]
struct Bytes(Vec<u8>);

impl Bytes {
    fn short(&mut self, value: u16) {
        self.0.extend(value.to_le_bytes());
    }

    fn base64(&self) -> String {
        const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        let mut text = String::with_capacity(self.0.len().div_ceil(3) * 4);
        for three in self.0.chunks(3) {
            let [a, b, c] = [0, 1, 2].map(|k| u32::from(three.get(k).copied().unwrap_or(0)));
            let bits = a << 16 | b << 8 | c;
            for (k, shift) in [18, 12, 6, 0].into_iter().enumerate() {
                let letter = LETTERS[(bits >> shift & 63) as usize];
                text.push(if k <= three.len() { char::from(letter) } else { '=' });
            }
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::Bytes;

    #[test]
    fn base64_is_that_of_the_rfc() {
        let of = |text: &str| Bytes(text.as_bytes().to_vec()).base64();
        assert_eq!(["", "f", "fo", "foo", "foob"].map(of), ["", "Zg==", "Zm8=", "Zm9v", "Zm9vYg=="]);
    }
}
