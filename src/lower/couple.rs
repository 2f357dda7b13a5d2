//! Two rings of points side by side: the nearest ring of stitches, and the coupling of two rings with least distance.

use glam::DVec3;

/// Sizes of the groups of a coupling: how many of the one ring go with how many of the other.
type Groups = Vec<(usize, usize)>;

/// Samples of a ring between two of its points.
const BETWEEN: usize = 6;
/// Table entries of one coupling beyond which only starts near the nearest point are tried.
const MOST_WORK: usize = 4_000_000;

/// The closed cycle of places nearest to a ring of points: indices into `places` in the order of the ring, none twice.
pub(super) fn cycle(ring: &[DVec3], places: &[DVec3]) -> Vec<usize> {
    let mut cycle: Vec<usize> = Vec::new();
    let mut squares: Vec<f64> = Vec::with_capacity(places.len());
    let mut close: Vec<usize> = Vec::new();
    for (index, from) in ring.iter().enumerate() {
        let to = ring[(index + 1) % ring.len()];
        // What is nearest to a point between the two is nearly so to their middle.
        let middle = from.midpoint(to);
        squares.clear();
        squares.extend(places.iter().map(|place| place.distance_squared(middle)));
        let least = squares.iter().copied().fold(f64::INFINITY, f64::min).sqrt();
        let reach = (least + from.distance(to)) * (1.0 + 1e-9);
        let within = squares.iter().enumerate().filter(|(_, square)| **square <= reach * reach);
        close.clear();
        close.extend(within.map(|(place, _)| place));
        for k in 0..BETWEEN {
            let point = from.lerp(to, k as f64 / BETWEEN as f64);
            let mut near = None;
            let mut least = f64::INFINITY;
            for &place in &close {
                let square = places[place].distance_squared(point);
                if square < least {
                    (near, least) = (Some(place), square);
                }
            }
            let Some(near) = near else { return cycle };
            if !cycle.contains(&near) {
                cycle.push(near);
            }
        }
    }
    cycle
}

/// For each point of a ring the index of its partner in another ring of the same direction.
///
/// Points are coupled one to one, one to several or several to one, all in order around both rings, with the least total
/// distance; several are two unless one ring has more than twice the points of the other. Of several partners the nearest
/// is given. Empty when either ring is.
pub(super) fn couple(ring: &[DVec3], other: &[DVec3]) -> Vec<usize> {
    let (n, m) = (ring.len(), other.len());
    if n == 0 || m == 0 {
        return Vec::new();
    }
    let most = n.div_ceil(m).max(m.div_ceil(n)).max(2);
    let nearest = (0..m)
        .min_by(|a, b| other[*a].distance_squared(ring[0]).total_cmp(&other[*b].distance_squared(ring[0])));
    let around = nearest.unwrap_or(0);
    let window = (MOST_WORK / (n * m * 2 * most * most).max(1)).clamp(3.min(m), m);
    let distances: Vec<f64> = ring.iter().flat_map(|a| other.iter().map(|b| a.distance(*b))).collect();
    // Every point of the ring costs at least the distance of its nearest partner.
    let least: Vec<f64> =
        distances.chunks_exact(m).map(|row| row.iter().copied().fold(f64::INFINITY, f64::min)).collect();
    let mut rest = vec![0.0; n + 1];
    let mut table = Table::default();
    let mut best: Option<(f64, usize, usize, Groups)> = None;
    // What the start at the nearest point costs, no other one need exceed.
    let first = straight([n, m], most, (f64::INFINITY, &rest), &mut table, |i, j| {
        distances[i * m + if around + j < m { around + j } else { around + j - m }]
    });
    let mut bound = first.map_or(f64::INFINITY, |first| first.0 * (1.0 + 1e-9) + 1e-9);
    // A group of points may lie across the place where the ring is cut.
    for turn in 0..most.min(n) {
        let row = |i: usize| if i < turn { n + i - turn } else { i - turn };
        for i in (0..n).rev() {
            rest[i] = rest[i + 1] + least[row(i)];
        }
        for shift in 0..window {
            let start = (around + m + shift - window / 2) % m;
            if distances[row(0) * m + start] + rest[1] > bound {
                continue;
            }
            let column = |j: usize| if start + j < m { start + j } else { start + j - m };
            let at = |i: usize, j: usize| distances[row(i) * m + column(j)];
            if let Some((cost, groups)) = straight([n, m], most, (bound, &rest), &mut table, at)
                && best.as_ref().is_none_or(|best| cost < best.0 - 1e-9)
            {
                bound = bound.min(cost);
                best = Some((cost, turn, start, groups));
            }
        }
    }
    let Some((_, turn, start, groups)) = best else { return Vec::new() };
    let mut partner = vec![0; n];
    let (mut i, mut j) = (0, 0);
    for (mine, theirs) in groups {
        for k in i..i + mine {
            let index = (n + k - turn) % n;
            let near = (j..j + theirs).map(|j| (start + j) % m).min_by(|a, b| {
                other[*a].distance_squared(ring[index]).total_cmp(&other[*b].distance_squared(ring[index]))
            });
            partner[index] = near.unwrap_or(0);
        }
        (i, j) = (i + mine, j + theirs);
    }
    partner
}

/// The table of a coupling: for each row the places that are worth anything, and for each place the least total distance up to
/// there, with the group that ends there.
#[derive(Default)]
struct Table {
    cost: Vec<(f64, u32, u32)>,
    /// The first place of each row that has a cost, and the one behind the last.
    spans: Vec<[usize; 2]>,
    width: usize,
}

const NOTHING: (f64, u32, u32) = (f64::INFINITY, 0, 0);

impl Table {
    /// No place has a cost but the first one.
    fn clear(&mut self, [n, m]: [usize; 2]) {
        self.width = m + 1;
        // What lies outside of the spans is never looked at, so it may stay as it is.
        if self.cost.len() < (n + 1) * self.width {
            self.cost.resize((n + 1) * self.width, NOTHING);
        }
        self.spans.clear();
        self.spans.resize(n + 1, [0; 2]);
        self.spans[0] = [0, 1];
        self.cost[0] = (0.0, 0, 0);
    }

    fn get(&self, i: usize, j: usize) -> (f64, u32, u32) {
        let [first, end] = self.spans[i];
        if (first..end).contains(&j) { self.cost[i * self.width + j] } else { NOTHING }
    }

    /// A way to a place by a group of so many.
    fn offer(&mut self, [i, j]: [usize; 2], cost: f64, [mine, theirs]: [usize; 2]) {
        let [first, end] = self.spans[i];
        let row = &mut self.cost[i * self.width..(i + 1) * self.width];
        if first == end {
            self.spans[i] = [j, j + 1];
            row[j] = NOTHING;
        } else if j >= end {
            row[end..=j].fill(NOTHING);
            self.spans[i][1] = j + 1;
        } else if j < first {
            row[j..first].fill(NOTHING);
            self.spans[i][0] = j;
        }
        if cost < row[j].0 {
            row[j] = (cost, mine as u32, theirs as u32);
        }
    }
}

/// The best grouping of two open rows: total distance, and the sizes of groups. `None` where it would cost more than the
/// bound; from each point of the first on, the rest costs at least `rest`. The table is room to work in.
fn straight(
    [n, m]: [usize; 2],
    most: usize,
    (bound, rest): (f64, &[f64]),
    table: &mut Table,
    distance: impl Fn(usize, usize) -> f64,
) -> Option<(f64, Groups)> {
    table.clear([n, m]);
    for i in 0..n {
        let [first, end] = table.spans[i];
        for j in first..end.min(m) {
            let here = table.cost[i * table.width + j].0;
            if here == f64::INFINITY {
                continue;
            }
            let mut offer = |mine: usize, theirs: usize, cost: f64| {
                if cost + rest[i + mine] <= bound {
                    table.offer([i + mine, j + theirs], cost, [mine, theirs]);
                }
            };
            let mut sum = 0.0;
            for k in 0..most.min(n - i) {
                sum += distance(i + k, j);
                offer(k + 1, 1, here + sum);
            }
            let mut sum = 0.0;
            for k in 0..most.min(m - j) {
                sum += distance(i, j + k);
                if k > 0 {
                    offer(1, k + 1, here + sum);
                }
            }
        }
    }
    let total = table.get(n, m).0;
    if total > bound {
        return None;
    }
    let mut groups = Vec::with_capacity(n.max(m));
    let (mut i, mut j) = (n, m);
    while (i, j) != (0, 0) {
        let (value, mine, theirs) = table.get(i, j);
        let (mine, theirs) = (mine as usize, theirs as usize);
        if value == f64::INFINITY || mine == 0 {
            return None;
        }
        groups.push((mine, theirs));
        (i, j) = (i - mine, j - theirs);
    }
    groups.reverse();
    Some((total, groups))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{TAU, cos, sin};

    fn circle(count: usize, radius: f64, phase: f64) -> Vec<DVec3> {
        let at = |k: usize| TAU * (k as f64 + phase) / count as f64;
        (0..count).map(|k| DVec3::new(radius * cos(at(k)), radius * sin(at(k)), 0.0)).collect()
    }

    #[test]
    fn equal_rings_are_coupled_one_to_one() {
        let ring = circle(17, 5.0, 0.0);
        let mut other = circle(17, 5.3, 0.2);
        other.rotate_left(6);
        let partners = couple(&ring, &other);
        let expected: Vec<usize> = (0..17).map(|k| (k + 17 - 6) % 17).collect();
        assert_eq!(partners, expected);
    }

    #[test]
    fn a_coupling_is_as_short_as_any_and_keeps_the_order() {
        for (n, m) in [(5, 7), (7, 5), (6, 12), (4, 11), (9, 9)] {
            let (ring, other) = (circle(n, 4.0, 0.3), circle(m, 4.2, 0.1));
            let partners = couple(&ring, &other);
            assert_eq!(partners.len(), n);
            let steps = (0..n).map(|k| (partners[(k + 1) % n] + m - partners[k]) % m);
            assert!(steps.clone().sum::<usize>() == m, "{n} {m}: around once: {partners:?}");
            for (k, partner) in partners.iter().enumerate() {
                let least = other.iter().map(|p| p.distance(ring[k])).fold(f64::MAX, f64::min);
                assert!(ring[k].distance(other[*partner]) < least + 3.0, "{n} {m}");
            }
        }
    }

    #[test]
    fn the_cycle_is_the_nearest_ring_of_a_lattice() {
        let lattice: Vec<DVec3> = (-10..=10)
            .flat_map(|x| (-10..=10).map(move |y| DVec3::new(f64::from(x), f64::from(y), 0.0)))
            .collect();
        let ring = circle(25, 4.0, 0.5);
        let cycle = cycle(&ring, &lattice);
        assert!(cycle.len() >= 20 && cycle.len() <= 34, "{}", cycle.len());
        for (k, index) in cycle.iter().enumerate() {
            let point = lattice[*index];
            assert!((point.length() - 4.0).abs() < 1.0);
            let next = lattice[cycle[(k + 1) % cycle.len()]];
            assert!(point.distance(next) < 2.3, "neighbors are next to each other");
        }
    }

    #[test]
    fn a_bound_leaves_the_best_grouping_and_nothing_beyond_it() {
        let (ring, other) = (circle(9, 4.0, 0.3), circle(12, 4.4, 0.1));
        let distance = |i: usize, j: usize| ring[i].distance(other[j]);
        let mut table = Table::default();
        let none = vec![0.0; ring.len() + 1];
        let free = straight([9, 12], 2, (f64::INFINITY, &none), &mut table, distance).unwrap();
        let mut rest = none;
        for i in (0..9).rev() {
            rest[i] = rest[i + 1] + (0..12).map(|j| distance(i, j)).fold(f64::INFINITY, f64::min);
        }
        let bound = free.0 + 1e-9;
        // The table is that of the search before.
        assert_eq!(straight([9, 12], 2, (bound, &rest), &mut table, distance), Some(free.clone()));
        assert_eq!(straight([9, 12], 2, (free.0 - 1e-9, &rest), &mut table, distance), None);
        assert_eq!(free.1.iter().fold((0, 0), |sum, it| (sum.0 + it.0, sum.1 + it.1)), (9, 12));
    }
}
