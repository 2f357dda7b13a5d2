//! Units of length of shapes and meshes; everything behind the readers is in millimeters.

/// A unit of length.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit {
    /// Millimeters.
    Mm,
    /// Centimeters.
    Cm,
    /// Inches of 25.4 mm.
    Inch,
    /// Meters, in which glTF counts.
    Meter,
}

impl Unit {
    /// The units by the words of a shape file.
    pub const WORDS: &'static [(&'static str, Self)] =
        &[("mm", Self::Mm), ("cm", Self::Cm), ("in", Self::Inch)];

    /// Millimeters in one.
    pub fn mm(self) -> f64 {
        match self {
            Self::Mm => 1.0,
            Self::Cm => 10.0,
            Self::Inch => 25.4,
            Self::Meter => 1000.0,
        }
    }

    /// The word for it.
    pub fn word(self) -> &'static str {
        match self {
            Self::Mm => "mm",
            Self::Cm => "cm",
            Self::Inch => "in",
            Self::Meter => "m",
        }
    }

    /// Its full name, many of it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Mm => "millimeters",
            Self::Cm => "centimeters",
            Self::Inch => "inches",
            Self::Meter => "meters",
        }
    }
}
