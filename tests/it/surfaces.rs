//! Surfaces against closed forms and finite differences.
#![expect(clippy::unwrap_used, reason = "helpers of tests")]

use glam::{DVec2, DVec3};
use picot::shape::{Bezier, End, Interpolation, ParametricSurface, Profile, Section, Sweep, TubeSpec};

fn circle(at: f64, radius: f64) -> Section {
    Section { at, profile: Profile::Ellipse { axes: [radius; 2], offset: DVec2::ZERO } }
}

fn open_tube(curve: Vec<Bezier>, sections: Vec<Section>) -> TubeSpec {
    TubeSpec { curve, sections, interpolation: Interpolation::Linear, start: End::Open, end: End::Open }
}

/// Shape C of the paper, in mm.
fn shape_c() -> TubeSpec {
    let s = 333.333_333;
    let points = [DVec3::ZERO, DVec3::new(0.0, -0.02, 0.05) * s, DVec3::new(0.0, 0.0, 0.1) * s];
    open_tube(vec![Bezier::new(&points).unwrap()], vec![circle(0.0, 0.05 * s), circle(1.0, 0.02 * s)])
}

/// Shape D of the paper, in mm.
fn shape_d() -> TubeSpec {
    let points = [DVec3::ZERO, DVec3::new(0.0, 0.0, 90.0), DVec3::new(0.0, 100.0, 0.0)];
    open_tube(vec![Bezier::new(&points).unwrap()], vec![circle(0.0, 10.0), circle(1.0, 4.0)])
}

/// The jet agrees with central differences and faces outward.
fn assert_jets(surface: &dyn ParametricSurface, us: &[f64]) {
    const STEP: f64 = 1e-5;
    for &u in us {
        for k in 0..12 {
            let v = f64::from(k) / 12.0 + 0.013;
            let jet = surface.jet(u, v);
            let slope = |a: DVec3, b: DVec3| (b - a) / (2.0 * STEP);
            let du = slope(surface.point(u - STEP, v), surface.point(u + STEP, v));
            let dv = slope(surface.point(u, v - STEP), surface.point(u, v + STEP));
            assert!((jet.du - du).length() <= 1e-6 * du.length(), "du at {u}, {v}: {} against {du}", jet.du);
            assert!((jet.dv - dv).length() <= 1e-6 * dv.length(), "dv at {u}, {v}: {} against {dv}", jet.dv);
        }
    }
}

#[test]
fn paper_shapes_have_their_radius_linear_in_the_bezier_parameter() {
    for (spec, start, end) in [(shape_c(), 16.666_666_65, 6.666_666_66), (shape_d(), 10.0, 4.0)] {
        let sweep = Sweep::new(&spec).unwrap();
        assert_jets(&sweep, &[0.1, 0.33, 0.5, 0.77, 0.9, -0.01, 1.05]);
        for k in 0..=20 {
            let u = f64::from(k) / 20.0;
            let center = spec.curve[0].point(u);
            for v in [0.0, 0.2, 0.55, 0.9] {
                let arm = sweep.point(u, v) - center;
                let jet = sweep.jet(u, v);
                assert!(jet.du.cross(jet.dv).dot(arm) > 0.0, "outward at {u}, {v}");
                assert!((arm.length() - (start + (end - start) * u)).abs() < 1e-12);
                assert!(arm.normalize().dot(spec.curve[0].derivative(u).normalize()).abs() < 1e-12);
            }
        }
    }
}
