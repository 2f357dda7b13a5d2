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

/// Path data under way.
#[derive(Debug, Default)]
pub(super) struct Path(pub(super) String);

impl Path {
    fn put(&mut self, text: fmt::Arguments<'_>) {
        // Writing to a string does not fail.
        let _ = fmt::Write::write_fmt(&mut self.0, text);
    }
    pub(super) fn line(&mut self, from: P, to: P) {
        self.put(format_args!("M{} {}L{} {}", N(from.0), N(from.1), N(to.0), N(to.1)));
    }
    pub(super) fn curve(&mut self, from: P, bend: P, to: P) {
        self.put(format_args!(
            "M{} {}Q{} {} {} {}",
            N(from.0),
            N(from.1),
            N(bend.0),
            N(bend.1),
            N(to.0),
            N(to.1)
        ));
    }
    /// An ellipse with half axis `along` on the unit vector `axis`.
    pub(super) fn ellipse(&mut self, center: P, axis: P, along: f64, across: f64) {
        let angle = crate::math::atan2(axis.1, axis.0).to_degrees();
        let (from, to) = (center.plus(axis, -along), center.plus(axis, along));
        let (rx, ry, turn) = (N(along), N(across), N(angle));
        self.put(format_args!(
            "M{} {}A{rx} {ry} {turn} 1 1 {} {}A{rx} {ry} {turn} 1 1 {0} {1}Z",
            N(from.0),
            N(from.1),
            N(to.0),
            N(to.1)
        ));
    }
    pub(super) fn closed(&mut self, corners: &[P]) {
        for (index, corner) in corners.iter().enumerate() {
            self.put(format_args!("{}{} {}", if index == 0 { 'M' } else { 'L' }, N(corner.0), N(corner.1)));
        }
        self.0.push('Z');
    }
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
    fn text_cannot_leave_its_place() {
        assert_eq!(Escaped("</a b=\"'&\u{0}").to_string(), "&lt;/a b=&quot;&#39;&amp; ");
    }
}
