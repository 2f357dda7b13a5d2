//! Stacks that are all but round: made exactly round, so that they get the even repeats of a designer.

use super::stack::Stack;
use crate::math::{TAU, sin_cos};
use glam::{DVec2, DVec3};

/// Greatest distance from a round tube, in stitch widths, and as a share of the radius for tubes of many stitches.
const TOLERANCE: f64 = 0.2;
const SHARE: f64 = 0.02;

impl Stack {
    /// Makes the tube a surface of revolution when it is one but for less than what stitches of this width can show.
    /// True when it is.
    pub(crate) fn revolve(&mut self, width: f64) -> bool {
        let rows: Vec<&[DVec3]> = self.rows().collect();
        let around = rows.first().map_or(1, |row| row.len());
        // Twice the area of each row as a vector, all of them summed: the axis, against the sense of v.
        let area = |row: &[DVec3]| -> DVec3 {
            row.iter().zip(row.iter().cycle().skip(1)).map(|(a, b)| (*a - row[0]).cross(*b - row[0])).sum()
        };
        let areas: Vec<DVec3> = rows.iter().map(|row| area(row)).collect();
        let axis = -areas.iter().sum::<DVec3>().normalize_or_zero();
        if axis == DVec3::ZERO {
            return false;
        }
        let center = |row: &[DVec3]| row.iter().sum::<DVec3>() / around as f64;
        let weight: f64 = areas.iter().map(|area| area.length()).sum();
        let centers = rows.iter().zip(&areas).map(|(row, area)| center(row) * area.length());
        let origin = centers.sum::<DVec3>() / weight;
        let split = |p: DVec3| {
            let arm = p - origin;
            let height = arm.dot(axis);
            (height, arm - axis * height)
        };
        let mut meridian = Vec::with_capacity(rows.len());
        for row in &rows {
            let mean = |f: &dyn Fn(DVec3) -> f64| row.iter().map(|p| f(*p)).sum::<f64>() / around as f64;
            let (height, radius) = (mean(&|p| split(p).0), mean(&|p| split(p).1.length()));
            let off = |p: &DVec3| DVec2::new(split(*p).0 - height, split(*p).1.length() - radius).length();
            let most = row.iter().map(off).fold(0.0, f64::max);
            if most > (TOLERANCE * width).max(SHARE * radius) {
                return false;
            }
            meridian.push((height, radius));
        }
        let widest = (0..rows.len()).max_by(|a, b| meridian[*a].1.total_cmp(&meridian[*b].1)).unwrap_or(0);
        let Some(first) = rows[widest].first().map(|p| split(*p).1.normalize_or_zero()) else { return false };
        // Clockwise seen from the end of the tube.
        let second = -axis.cross(first);
        self.set(|row, k| {
            let (sin, cos) = sin_cos(TAU * k as f64 / around as f64);
            let (height, radius) = meridian[row];
            origin + axis * height + (first * cos + second * sin) * radius
        });
        self.respace();
        true
    }
}
