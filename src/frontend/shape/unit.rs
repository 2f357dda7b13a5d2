//! Units of length of shape files; everything behind the reader is in millimeters.

/// A unit of length.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Unit {
    /// Millimeters.
    Mm,
    /// Centimeters.
    Cm,
    /// Inches of 25.4 mm.
    Inch,
}

impl Unit {
    /// The units by the words of a shape file.
    pub(super) const WORDS: &'static [(&'static str, Self)] =
        &[("mm", Self::Mm), ("cm", Self::Cm), ("in", Self::Inch)];

    /// Millimeters in one.
    pub(super) fn mm(self) -> f64 {
        match self {
            Self::Mm => 1.0,
            Self::Cm => 10.0,
            Self::Inch => 25.4,
        }
    }

    /// The word for it.
    pub(super) fn word(self) -> &'static str {
        match self {
            Self::Mm => "mm",
            Self::Cm => "cm",
            Self::Inch => "in",
        }
    }

    /// Its full name, many of it.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Mm => "millimeters",
            Self::Cm => "centimeters",
            Self::Inch => "inches",
        }
    }
}
