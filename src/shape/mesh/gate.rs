//! From triangles to a sound surface: what is repaired, and what is refused with its place.

use super::soup::{NONE, Soup, find};
use super::{Mesh, Repairs};
use glam::DVec3;
use std::fmt;

/// Why a set of triangles is no surface to work on. Vertices and faces are numbered from 1, as modeling tools do;
/// positions are in the unit and axes of the file.
#[derive(Clone, Debug, PartialEq)]
pub enum Fault {
    /// There is no face, or none with a side.
    Empty,
    /// A coordinate is not a number, infinite, or too large to compute with.
    NotFinite {
        /// Its number.
        vertex: u32,
    },
    /// A face names a vertex that is not there.
    OutOfRange {
        /// The face.
        face: u32,
        /// The vertex that it names, counted from 1.
        vertex: u64,
        /// How many there are.
        vertices: u64,
    },
    /// An edge with more than two faces.
    Edge {
        /// Both ends.
        vertices: [u32; 2],
        /// How many faces meet there.
        faces: u32,
        /// One of them.
        face: u32,
        /// The middle of the edge.
        at: DVec3,
    },
    /// Parts of the surface that touch in one point.
    Vertex {
        /// The point.
        vertex: u32,
        /// How many parts meet there.
        fans: u32,
        /// Where.
        at: DVec3,
    },
    /// The surface is in several pieces: faces and middle of each, largest first, at most eight of them.
    Components {
        /// How many.
        count: u32,
        /// The largest ones.
        largest: Vec<(u32, DVec3)>,
    },
    /// The surface has one side only, like a Möbius strip.
    OneSided {
        /// A face where the sides meet.
        face: u32,
        /// Its middle.
        at: DVec3,
    },
    /// The surface has handles.
    Genus {
        /// How many.
        genus: u32,
        /// The middle of the shortest loop found through or around a handle.
        at: DVec3,
        /// The length of this loop.
        length: f64,
        /// A vertex on it.
        vertex: u32,
    },
    /// A hole in the surface that is no end of a tube.
    Hole {
        /// Its middle.
        at: DVec3,
        /// Its circumference.
        length: f64,
        /// How many edges it has.
        edges: u32,
        /// A vertex on it.
        vertex: u32,
    },
    /// There is only one end, so nothing to work towards.
    NoEnds {
        /// Where it is.
        at: DVec3,
    },
    /// A plane across the control curve meets no line around it.
    NoSlice {
        /// The point of the curve.
        at: DVec3,
    },
    /// Planes across the control curve cross within the object.
    Fold {
        /// The point of the curve.
        at: DVec3,
    },
    /// A limb cannot be told from what it grows from.
    Fork {
        /// Its end.
        at: DVec3,
    },
    /// No rows fit on a limb.
    NoRows {
        /// Its end.
        at: DVec3,
    },
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{self:?}")
    }
}

impl std::error::Error for Fault {}

/// Beyond this a square would lose its digits.
const MOST: f64 = 1e12;

impl Mesh {
    /// The surface of a set of triangles, and what had to be repaired.
    pub fn new(mut soup: Soup) -> Result<(Self, Repairs), Fault> {
        let wrong = |p: &DVec3| !(p.is_finite() && p.abs().max_element() < MOST);
        if let Some(vertex) = soup.points.iter().position(wrong) {
            return Err(Fault::NotFinite { vertex: vertex as u32 + 1 });
        }
        let count = soup.points.len() as u32;
        for (i, face) in soup.faces.iter().enumerate() {
            if let Some(&vertex) = face.iter().find(|vertex| **vertex >= count) {
                let face = soup.number(i as u32);
                let (vertex, vertices) = (u64::from(vertex) + 1, u64::from(count));
                return Err(Fault::OutOfRange { face, vertex, vertices });
            }
        }
        let welded = soup.weld();
        let [degenerate, doubled] = soup.drop_degenerate();
        let mut repairs = Repairs { welded, degenerate, doubled, ..Repairs::default() };
        if soup.faces.is_empty() {
            return Err(Fault::Empty);
        }
        let partners = partners(&soup)?;
        pieces(&soup, &partners)?;
        repairs.flipped = orient(&mut soup, &partners)?;
        let mut mesh = Self::link(soup);
        mesh.fans()?;
        mesh.find_boundaries();
        if mesh.volume() < 0.0 {
            mesh = mesh.inside_out();
            mesh.find_boundaries();
            repairs.inside_out = true;
        }
        mesh.genus()?;
        Ok((mesh, repairs))
    }

    /// Vertices around which the faces form more than one fan.
    fn fans(&self) -> Result<(), Fault> {
        for vertex in 0..self.points.len() as u32 {
            let corners = self.corners(vertex);
            let Some(&first) = corners.first() else { continue };
            // Count the corners that one fan reaches, turning both ways.
            let mut reached = 1;
            let mut at = first;
            loop {
                at = self.twins[Self::before(at) as usize];
                if at == NONE || at == first {
                    break;
                }
                reached += 1;
            }
            if at == NONE {
                let mut at = first;
                while self.twins[at as usize] != NONE {
                    at = Self::after(self.twins[at as usize]);
                    reached += 1;
                }
            }
            if reached < corners.len() {
                let (vertex, at) = (self.number(vertex), self.points[vertex as usize]);
                return Err(Fault::Vertex { vertex, fans: 2, at });
            }
        }
        Ok(())
    }
}

/// For every half-edge the other one on its edge, whichever way it runs; [`NONE`] at an open edge.
fn partners(soup: &Soup) -> Result<Vec<u32>, Fault> {
    let faces = &soup.faces;
    let ends = |h: u32| {
        let face = faces[h as usize / 3];
        let (a, b) = (face[h as usize % 3], face[(h as usize + 1) % 3]);
        (a.min(b), a.max(b))
    };
    // Half-edges by their lower end, so that a search looks at a handful.
    let halves = 3 * faces.len() as u32;
    let mut starts = vec![0_u32; soup.points.len() + 1];
    for h in 0..halves {
        starts[ends(h).0 as usize + 1] += 1;
    }
    for i in 1..starts.len() {
        starts[i] += starts[i - 1];
    }
    let mut fill = starts.clone();
    let mut sorted = vec![0_u32; halves as usize];
    for h in 0..halves {
        let slot = &mut fill[ends(h).0 as usize];
        sorted[*slot as usize] = h;
        *slot += 1;
    }
    let mut partners = vec![NONE; halves as usize];
    for pair in starts.windows(2) {
        let bucket = &mut sorted[pair[0] as usize..pair[1] as usize];
        bucket.sort_unstable_by_key(|h| (ends(*h).1, *h));
        let mut rest = &*bucket;
        while let Some(&first) = rest.first() {
            let edge = ends(first);
            let count = rest.iter().take_while(|h| ends(**h) == edge).count();
            if count > 2 {
                return Err(Fault::Edge {
                    vertices: [edge.0 + 1, edge.1 + 1],
                    faces: count as u32,
                    face: soup.number(first / 3),
                    at: 0.5 * (soup.points[edge.0 as usize] + soup.points[edge.1 as usize]),
                });
            }
            if count == 2 {
                partners[first as usize] = rest[1];
                partners[rest[1] as usize] = first;
            }
            rest = &rest[count..];
        }
    }
    Ok(partners)
}

/// Refuses a surface in several pieces.
fn pieces(soup: &Soup, partners: &[u32]) -> Result<(), Fault> {
    let count = soup.faces.len();
    let mut leader: Vec<u32> = (0..count as u32).collect();
    for (h, &partner) in partners.iter().enumerate() {
        if partner != NONE && h < partner as usize {
            let (a, b) = (find(&mut leader, h as u32 / 3), find(&mut leader, partner / 3));
            leader[a.max(b) as usize] = a.min(b);
        }
    }
    if (0..count as u32).all(|face| find(&mut leader, face) == 0) {
        return Ok(());
    }
    let mut sizes = vec![(0_u32, DVec3::ZERO); count];
    for face in 0..count as u32 {
        let size = &mut sizes[find(&mut leader, face) as usize];
        size.0 += 1;
        size.1 += middle(soup, face);
    }
    let mut found: Vec<(u32, DVec3)> =
        sizes.into_iter().filter(|size| size.0 > 0).map(|(n, sum)| (n, sum / f64::from(n))).collect();
    let count = found.len() as u32;
    found.sort_by_key(|found| std::cmp::Reverse(found.0));
    found.truncate(8);
    Err(Fault::Components { count, largest: found })
}

fn middle(soup: &Soup, face: u32) -> DVec3 {
    soup.faces[face as usize].iter().map(|&v| soup.points[v as usize]).sum::<DVec3>() / 3.0
}

/// Turns faces so that neighbors agree. Returns how many were turned: the fewer ones.
fn orient(soup: &mut Soup, partners: &[u32]) -> Result<u32, Fault> {
    const UNSEEN: u8 = 2;
    let count = soup.faces.len();
    let from = |h: u32| soup.faces[h as usize / 3][h as usize % 3];
    let mut turned = vec![UNSEEN; count];
    turned[0] = 0;
    let mut queue = vec![0_u32];
    while let Some(face) = queue.pop() {
        for h in 3 * face..3 * face + 3 {
            let partner = partners[h as usize];
            if partner == NONE {
                continue;
            }
            // Neighbors agree when their half-edges run in opposite directions.
            let agree = from(h) != from(partner);
            let wanted = turned[face as usize] ^ u8::from(!agree);
            let other = partner / 3;
            if turned[other as usize] == UNSEEN {
                turned[other as usize] = wanted;
                queue.push(other);
            } else if turned[other as usize] != wanted {
                return Err(Fault::OneSided { face: soup.number(face), at: middle(soup, face) });
            }
        }
    }
    let ones: usize = turned.iter().map(|turned| usize::from(*turned)).sum();
    let swap = u8::from(2 * ones <= count);
    for (face, turned) in soup.faces.iter_mut().zip(&turned) {
        if *turned == swap {
            face.swap(1, 2);
        }
    }
    Ok(ones.min(count - ones) as u32)
}
