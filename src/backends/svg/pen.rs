//! Text of SVG: escaped words, short numbers, path data.

use std::fmt::{self, Display};

/// A length in user units, rounded to a tenth.
#[derive(Clone, Copy, Debug)]
pub(crate) struct N(pub(super) f64);

impl Display for N {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let tenths = (self.0 * 10.0).round();
        if !tenths.is_finite() {
            return f.write_str("0");
        }
        let tenths = tenths as i64;
        let sign = if tenths < 0 { "-" } else { "" };
        let (whole, rest) = (tenths.unsigned_abs() / 10, tenths.unsigned_abs() % 10);
        match (whole, rest) {
            (whole, 0) => write!(f, "{sign}{whole}"),
            (0, rest) => write!(f, "{sign}.{rest}"),
            (whole, rest) => write!(f, "{sign}{whole}.{rest}"),
        }
    }
}

/// Text in XML or HTML, in content or in an attribute with double quotes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Escaped<'t>(pub(crate) &'t str);

impl Display for Escaped<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        use fmt::Write;
        for c in self.0.chars() {
            match c {
                '&' => f.write_str("&amp;")?,
                '<' => f.write_str("&lt;")?,
                '>' => f.write_str("&gt;")?,
                '"' => f.write_str("&quot;")?,
                '\'' => f.write_str("&#39;")?,
                // Neither can stand in an XML document.
                '\u{fffe}' | '\u{ffff}' => f.write_char('\u{fffd}')?,
                c if c.is_control() => f.write_char(' ')?,
                c => f.write_char(c)?,
            }
        }
        Ok(())
    }
}

/// A point in the plane, y down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct P(pub(super) f64, pub(super) f64);

impl P {
    pub(super) fn towards(self, to: Self, part: f64) -> Self {
        Self(self.0 + (to.0 - self.0) * part, self.1 + (to.1 - self.1) * part)
    }
    pub(super) fn plus(self, direction: Self, length: f64) -> Self {
        Self(self.0 + direction.0 * length, self.1 + direction.1 * length)
    }
}

/// Path data under way: after the first point all are told from the one before, which keeps it short.
#[derive(Debug, Default)]
pub(super) struct Path {
    text: String,
    /// The last point, in tenths.
    at: Option<[i64; 2]>,
}

impl Path {
    /// The value of the attribute `d`.
    pub(super) fn data(&self) -> &str {
        &self.text
    }
    pub(super) fn is_empty(&self) -> bool {
        self.text.is_empty()
    }
    /// Writes numbers of tenths, with a space where they would run together.
    fn numbers(&mut self, numbers: &[i64]) {
        for number in numbers {
            let last = self.text.bytes().next_back();
            if *number >= 0 && last.is_some_and(|last| last.is_ascii_digit()) {
                self.text.push(' ');
            }
            // Writing to a string does not fail.
            let _ = fmt::Write::write_fmt(&mut self.text, format_args!("{}", N(*number as f64 / 10.0)));
        }
    }
    fn go(&mut self, to: P) {
        let to = tenths(to);
        match self.at {
            Some([x, y]) if [x, y] != to => {
                self.text.push('m');
                self.numbers(&[to[0] - x, to[1] - y]);
            }
            Some(_) => {}
            None => {
                self.text.push('M');
                self.numbers(&to);
            }
        }
        self.at = Some(to);
    }
    /// Writes points from the last one on, of which the last is the new one.
    fn by(&mut self, letter: char, points: &[P]) {
        let [x, y] = self.at.unwrap_or_default();
        self.text.push(letter);
        for point in points {
            let to = tenths(*point);
            self.numbers(&[to[0] - x, to[1] - y]);
            self.at = Some(to);
        }
    }
    pub(super) fn line(&mut self, from: P, to: P) {
        self.go(from);
        self.by('l', &[to]);
    }
    pub(super) fn curve(&mut self, from: P, bend: P, to: P) {
        self.go(from);
        self.by('q', &[bend, to]);
    }
    /// An ellipse with half axis `along` on the unit vector `axis`.
    pub(super) fn ellipse(&mut self, center: P, axis: P, along: f64, across: f64) {
        let angle = crate::math::atan2(axis.1, axis.0).to_degrees();
        let (from, to) = (tenths(center.plus(axis, -along)), tenths(center.plus(axis, along)));
        let form = [along, across, angle].map(tenth);
        let way = [to[0] - from[0], to[1] - from[1]];
        self.go(center.plus(axis, -along));
        for [x, y] in [way, way.map(|step| -step)] {
            self.text.push('a');
            self.numbers(&form);
            self.numbers(&[10, 10, x, y]);
        }
        self.text.push('z');
    }
    pub(super) fn closed(&mut self, corners: &[P]) {
        if let Some((first, rest)) = corners.split_first() {
            self.go(*first);
            for corner in rest {
                self.by('l', &[*corner]);
            }
            self.text.push('z');
            self.at = Some(tenths(*first));
        }
    }
}

fn tenth(value: f64) -> i64 {
    if value.is_finite() { (value * 10.0).round() as i64 } else { 0 }
}

fn tenths(point: P) -> [i64; 2] {
    [tenth(point.0), tenth(point.1)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        let text = [0.0, -0.04, 0.5, -1.25, 12.0].map(|x| N(x).to_string());
        assert_eq!(text, ["0", "0", ".5", "-1.3", "12"]);
        assert_eq!(N(f64::NAN).to_string(), "0");
    }

    #[test]
    fn points_are_told_from_the_one_before() {
        let mut path = Path::default();
        path.line(P(10.0, -2.04), P(12.5, 0.0));
        path.line(P(12.5, 0.0), P(12.0, 3.0));
        path.line(P(1.0, 3.0), P(1.0, 4.0));
        assert_eq!(path.data(), "M10-2l2.5 2l-.5 3m-11 0l0 1");
        let mut path = Path::default();
        path.ellipse(P(5.0, 5.0), P(1.0, 0.0), 2.0, 1.0);
        path.closed(&[P(0.0, 0.0), P(1.0, 0.0), P(1.0, 1.0)]);
        assert_eq!(path.data(), "M3 5a2 1 0 1 1 4 0a2 1 0 1 1-4 0zm-3-5l1 0l0 1z");
    }

    #[test]
    fn text_cannot_leave_its_place() {
        assert_eq!(Escaped("</a b=\"'&\u{0}").to_string(), "&lt;/a b=&quot;&#39;&amp; ");
    }
}
