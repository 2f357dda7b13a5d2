//! The figures that the paper prints in its Tables 1 to 3, and what is known about them.

/// A shape of the paper, and what it prints about it.
#[derive(Debug)]
pub(crate) struct Printed {
    /// Our name: `a'` and `b'` stand in for shapes that were not published.
    pub(crate) name: &'static str,
    /// The shape file.
    pub(crate) source: &'static str,
    /// Length error in percent and its deviation: Çapunaman 2017, proposed, Wu 2019.
    pub(crate) length: [[f64; 2]; 3],
    /// Skew in percent and its deviation, in the same order.
    pub(crate) skew: [[f64; 2]; 3],
    /// Computation time at 0.25, 0.20 and 0.15 cm: Çapunaman 2017 and proposed in ms, Wu 2019 in s.
    pub(crate) time: [[f64; 3]; 3],
}

/// Shapes a to d.
#[expect(clippy::approx_constant, reason = "a printed deviation looks like 1/pi")]
pub(crate) static PRINTED: [Printed; 4] = [
    Printed {
        name: "a'",
        source: include_str!("../../../shapes/paper/a.toml"),
        length: [[4.2, 0.069], [-1.9, 0.074], [-4.72, 0.098]],
        skew: [[22.4, 0.160], [9.7, 0.084], [10.90, 0.121]],
        time: [[117.0, 231.0, 559.0], [67.0, 106.0, 183.0], [3.13, 5.77, 15.03]],
    },
    Printed {
        name: "b'",
        source: include_str!("../../../shapes/paper/b.toml"),
        length: [[14.9, 0.419], [-3.3, 0.176], [-29.94, 0.263]],
        skew: [[19.8, 0.138], [17.7, 0.149], [13.06, 0.142]],
        time: [[50.0, 96.0, 241.0], [20.0, 30.0, 55.0], [4.25, 9.08, 23.83]],
    },
    Printed {
        name: "c",
        source: include_str!("../../../shapes/paper/c.toml"),
        length: [[17.6, 0.249], [-2.9, 0.101], [-7.93, 0.142]],
        skew: [[17.3, 0.116], [14.9, 0.146], [13.26, 0.137]],
        time: [[17.0, 39.0, 82.0], [12.0, 19.0, 38.0], [4.36, 10.43, 27.06]],
    },
    Printed {
        name: "d",
        source: include_str!("../../../shapes/paper/d.toml"),
        length: [[8.8, 0.193], [-1.5, 0.083], [-37.63, 0.318]],
        skew: [[12.6, 0.115], [10.1, 0.089], [12.97, 0.140]],
        time: [[33.0, 63.0, 153.0], [39.0, 64.0, 119.0], [3.39, 6.66, 18.19]],
    },
];

/// What a reader must know to compare.
pub(crate) const NOTES: [&str; 4] = [
    "a' and b' stand in for shapes A and B, which were not published: they follow the paper's description, and their numbers are no reproduction.",
    "Each printed row of Tables 1 and 2 is one stitch size (C 0.20 cm, D 0.25 cm; A and B are not known), not a mean over sizes.",
    "Table 2, shape D: the printed columns are swapped. The authors' public data give 10.1 % (0.089) for Capunaman and 12.6 % (0.115) for the proposed algorithm; the baseline has the lower skew on D.",
    "Times of the paper are of another machine and of graph construction only; ours are of the generator with its relaxation.",
];
