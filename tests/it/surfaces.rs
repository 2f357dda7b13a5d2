//! Surfaces against closed forms and finite differences.
#![expect(clippy::unwrap_used, reason = "helpers of tests")]

use glam::{DVec2, DVec3};
use picot::math::{PI, TAU, atan2, cos, sin};
use picot::shape::analytic::{Bulge, Cone, Cylinder, Ellipsoid, Fluted, Sphere, SphereZone, TorusArc};
use picot::shape::bezier::Chain;
use picot::shape::{
    Bezier, End, Fault, Interpolation, ParametricSurface, Profile, Section, Sweep, TubeSpec, area, girth,
    is_revolution, length_along,
};
use proptest::prelude::*;

fn ellipse(at: f64, axes: [f64; 2], x: f64, y: f64) -> Section {
    Section { at, profile: Profile::Ellipse { axes, offset: DVec2::new(x, y) } }
}

fn circle(at: f64, radius: f64) -> Section {
    ellipse(at, [radius; 2], 0.0, 0.0)
}

fn curve(points: &[[f64; 3]]) -> Vec<Bezier> {
    let points: Vec<DVec3> = points.iter().copied().map(DVec3::from).collect();
    vec![Bezier::new(&points).unwrap()]
}

fn open_tube(curve: Vec<Bezier>, sections: Vec<Section>) -> TubeSpec {
    TubeSpec { curve, sections, interpolation: Interpolation::Linear, start: End::Open, end: End::Open }
}

/// Shape C of the paper, in mm.
fn shape_c() -> TubeSpec {
    let s = 333.333_333;
    let points = [[0.0; 3], [0.0, -0.02 * s, 0.05 * s], [0.0, 0.0, 0.1 * s]];
    open_tube(curve(&points), vec![circle(0.0, 0.05 * s), circle(1.0, 0.02 * s)])
}

/// Shape D of the paper, in mm.
fn shape_d() -> TubeSpec {
    let points = [[0.0; 3], [0.0, 0.0, 90.0], [0.0, 100.0, 0.0]];
    open_tube(curve(&points), vec![circle(0.0, 10.0), circle(1.0, 4.0)])
}

/// A straight tube up the z axis.
fn straight(length: f64, sections: Vec<Section>) -> TubeSpec {
    open_tube(curve(&[[0.0; 3], [0.0, 0.0, length]]), sections)
}

fn closed(spec: TubeSpec) -> TubeSpec {
    TubeSpec { start: End::Closed, end: End::Closed, ..spec }
}

fn smooth(spec: TubeSpec) -> TubeSpec {
    TubeSpec { interpolation: Interpolation::Smooth, ..spec }
}

/// The jet agrees with central differences and faces outward.
fn assert_jets(surface: &dyn ParametricSurface, us: &[f64]) {
    const STEP: f64 = 1e-5;
    for &u in us {
        for k in 0..12 {
            let v = f64::from(k) / 12.0 + 0.0131;
            let jet = surface.jet(u, v);
            let slope = |a: DVec3, b: DVec3| (b - a) / (2.0 * STEP);
            let du = slope(surface.point(u - STEP, v), surface.point(u + STEP, v));
            let dv = slope(surface.point(u, v - STEP), surface.point(u, v + STEP));
            let scale = jet.point.length() * 1e-10 / STEP;
            assert!(
                (jet.du - du).length() <= 1e-6 * du.length() + scale,
                "du at {u}, {v}: {} against {du}",
                jet.du
            );
            assert!(
                (jet.dv - dv).length() <= 1e-6 * dv.length() + scale,
                "dv at {u}, {v}: {} against {dv}",
                jet.dv
            );
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

const INNER: [f64; 9] = [0.003, 0.0411, 0.123, 0.251, 0.377, 0.5013, 0.6871, 0.8437, 0.9711];

/// The surface faces outward: away from the middle of its own ring.
fn assert_outward(surface: &dyn ParametricSurface) {
    for &u in &INNER {
        let ring: Vec<_> = (0..24).map(|k| surface.jet(u, f64::from(k) / 24.0)).collect();
        let middle = ring.iter().map(|jet| jet.point).sum::<DVec3>() / 24.0;
        // The flux of the normals against the arms, so that a loop may be hollow.
        let flux: f64 = ring.iter().map(|jet| jet.du.cross(jet.dv).dot(jet.point - middle)).sum();
        // A flat cap has its normal across the arms.
        assert!(
            flux > -1e-9 * ring.iter().map(|jet| jet.du.length() * jet.dv.length()).sum::<f64>(),
            "inward at {u}"
        );
    }
}

#[test]
fn closed_forms_agree_with_quadrature_and_face_outward() {
    let cylinder = Cylinder { radius: 15.0, length: 80.0 };
    let cone = Cone { start: 5.0, end: 30.0, length: 50.0 };
    let sphere = Sphere { radius: 30.0 };
    let zone = SphereZone { radius: 30.0, from: 0.3, to: 2.7 };
    let tall = Ellipsoid { axes: DVec3::new(20.0, 20.0, 35.0) };
    let flat = Ellipsoid { axes: DVec3::new(20.0, 20.0, 9.0) };
    let uneven = Ellipsoid { axes: DVec3::new(20.0, 26.0, 9.0) };
    let bend = TorusArc { major: 40.0, minor: 15.0, angle: 2.0 };
    let (fluted, bulge) = (Fluted { scale: 10.0 }, Bulge { scale: 10.0 });
    let all: [(&dyn ParametricSurface, f64, bool); 10] = [
        (&cylinder, cylinder.area(), true),
        (&cone, cone.area(), true),
        (&sphere, sphere.area(), true),
        (&zone, zone.area(), true),
        (&tall, tall.area(), true),
        (&flat, flat.area(), true),
        (&uneven, uneven.area(), false),
        (&bend, bend.area(), false),
        // Areas that the design states in cm^2.
        (&fluted, 12_260.0, false),
        (&bulge, 6_080.0, false),
    ];
    for (i, &(surface, exact, revolution)) in all.iter().enumerate() {
        let tolerance = if i < 8 { 1e-9 } else { 1e-3 };
        let measured = area(surface, 32, 256);
        assert!((measured / exact - 1.0).abs() < tolerance, "area {measured} against {exact}: number {i}");
        assert_eq!(is_revolution(surface), revolution);
        assert_jets(surface, &INNER);
        assert_outward(surface);
    }
    assert!((length_along(&cone, 0.3, 0.0..1.0, 1) - cone.slant()).abs() < 1e-9);
    assert!((length_along(&zone, 0.3, 0.0..1.0, 8) - zone.slant()).abs() < 1e-9);
    for v in [0.0, 0.3, 0.5] {
        assert!((length_along(&bend, v, 0.0..1.0, 1) - bend.slant(v)).abs() < 1e-9);
    }
    assert!((girth(&cone, 0.2, 16) - TAU * 10.0).abs() < 1e-9);
}

#[test]
fn sweeps_of_known_forms_have_the_known_lengths_and_areas() {
    let cylinder = Sweep::new(&straight(80.0, vec![circle(0.4, 15.0)])).unwrap();
    assert!((area(&cylinder, 4, 16) - Cylinder { radius: 15.0, length: 80.0 }.area()).abs() < 1e-8);
    assert!(is_revolution(&cylinder));
    let cone = Sweep::new(&straight(50.0, vec![circle(0.0, 5.0), circle(1.0, 30.0)])).unwrap();
    assert!((area(&cone, 4, 16) - Cone { start: 5.0, end: 30.0, length: 50.0 }.area()).abs() < 1e-8);
    // C and D as the design states them, in mm^2.
    for (spec, stated) in [(shape_c(), 2616.0), (shape_d(), 6097.0)] {
        let sweep = Sweep::new(&spec).unwrap();
        assert!((area(&sweep, 64, 64) / stated - 1.0).abs() < 1e-3);
        assert!(!is_revolution(&sweep));
    }
}

/// Sections of a ball of radius 30 at the given curve parameters.
fn ball(places: &[f64]) -> TubeSpec {
    let radius = |at: f64| (at * (1.0 - at)).max(0.0).sqrt() * 60.0;
    // As a person writes them: to a hundredth of a millimeter.
    let sections = places.iter().map(|&at| circle(at, (radius(at) * 100.0).round() / 100.0)).collect();
    closed(smooth(straight(60.0, sections)))
}

#[test]
fn a_ball_by_sections_is_round() {
    for count in 9..=13_u32 {
        let even: Vec<f64> = (0..count).map(|k| f64::from(k) / f64::from(count - 1)).collect();
        let angles: Vec<f64> = even.iter().map(|t| (0.5 - 0.5 * cos(PI * t)).clamp(0.0, 1.0)).collect();
        for places in [even, angles] {
            let sweep = Sweep::new(&ball(&places)).unwrap();
            for k in 0..=400 {
                let jet = sweep.jet(f64::from(k) / 400.0, 0.37);
                let miss = (jet.point - DVec3::new(0.0, 0.0, 30.0)).length() / 30.0 - 1.0;
                assert!(miss.abs() < 5e-3, "{count} sections, {k}: {miss}");
                let pace = jet.du.length() / (PI * 30.0);
                assert!((0.5..2.0).contains(&pace), "{count} sections, {k}: pace {pace}");
            }
            let exact = Sphere { radius: 30.0 }.area();
            assert!((area(&sweep, 64, 16) / exact - 1.0).abs() < 5e-3);
            assert!((length_along(&sweep, 0.1, 0.0..1.0, 64) / (PI * 30.0) - 1.0).abs() < 5e-3);
            assert!(is_revolution(&sweep));
            assert_jets(&sweep, &INNER);
            assert_outward(&sweep);
            for (pole, z) in [(0.0, 0.0), (1.0, 60.0)] {
                let jet = sweep.jet(pole, 0.2);
                assert!(jet.point.distance(DVec3::new(0.0, 0.0, z)) < 1e-9 && jet.dv == DVec3::ZERO);
                assert!(jet.du.z.abs() < 1e-2 * jet.du.length());
            }
            // Beyond the pole the surface goes on over the other side.
            assert!(sweep.point(-0.01, 0.2).distance(sweep.point(0.01, 0.7)) < 1e-9);
        }
    }
}

#[test]
fn closed_ends_with_a_size_get_flat_caps_with_round_rims() {
    let sweep = Sweep::new(&closed(straight(50.0, vec![circle(0.0, 20.0), circle(1.0, 10.0)]))).unwrap();
    let side = Cone { start: 20.0, end: 10.0, length: 50.0 };
    let range = sweep.tube_range();
    let cap = 0.8 + 0.1 * PI; // disk and quarter turn of a rim of a fifth, in radii
    let meridian = 20.0 * cap + side.slant() + 10.0 * cap;
    let shares = (20.0 * cap / meridian, 10.0 * cap / meridian);
    assert!((range.start - shares.0).abs() < 1e-6 && (range.end - 1.0 + shares.1).abs() < 1e-6);
    let parts = [0.0..range.start, range.clone(), range.end..1.0];
    let lengths = parts.map(|part| length_along(&sweep, 0.3, part, 8));
    for (length, exact) in lengths.iter().zip([20.0 * cap, side.slant(), 10.0 * cap]) {
        assert!((length - exact).abs() < 1e-3, "{length} against {exact}");
    }
    for k in 0..8 {
        let v = f64::from(k) / 8.0;
        assert!(sweep.point(0.0, v).distance(DVec3::new(0.0, 0.0, -4.0)) < 1e-9);
        assert!(sweep.point(1.0, v).distance(DVec3::new(0.0, 0.0, 52.0)) < 1e-9);
        assert!((sweep.point(0.5 * range.start, v).z + 4.0).abs() < 1e-9, "the bottom is flat");
        assert!((sweep.point(0.5 * range.start, v).truncate().length() - 10.0 * cap).abs() < 1e-9);
    }
    assert_jets(&sweep, &INNER);
    assert_outward(&sweep);
    assert!(is_revolution(&sweep));
    assert!((sweep.curve_parameter(sweep.surface_parameter(0.3)) - 0.3).abs() < 1e-12);
    assert_eq!((sweep.curve_parameter(0.0), sweep.curve_parameter(1.0)), (0.0, 1.0));
}

/// A dish or a lid: the cap takes more than half of the way from end to end.
#[test]
fn a_cap_on_a_low_wall_is_whole() {
    let (wall, radius) = (10.0, 30.0);
    let both = closed(straight(wall, vec![circle(0.0, radius)]));
    for spec in [TubeSpec { end: End::Open, ..both.clone() }, TubeSpec { start: End::Open, ..both }] {
        let sweep = Sweep::new(&spec).unwrap();
        let range = sweep.tube_range();
        assert!(range.start > 0.6 || range.end < 0.4, "{range:?}");
        assert_jets(&sweep, &INNER);
        assert_outward(&sweep);
        // Pappus for the rim's quarter turn.
        let rim = radius * radius * PI * (0.64 + 0.4 * (0.4 * PI + 0.2));
        let exact = 2.0 * PI * radius * wall + rim;
        assert!((area(&sweep, 256, 16) / exact - 1.0).abs() < 1e-3, "{}", area(&sweep, 256, 16) / exact);
        let meridian = wall + radius * (0.8 + 0.1 * PI);
        for k in 0..200 {
            let [a, b] = [k, k + 1].map(|k| sweep.point(f64::from(k) / 200.0, 0.3));
            assert!((a.distance(b) * 200.0 / meridian - 1.0).abs() < 0.01, "{k}: {a} to {b}");
        }
    }
}

#[test]
fn a_cone_with_an_apex_stays_a_cone() {
    let sweep = Sweep::new(&closed(straight(50.0, vec![circle(0.0, 0.0), circle(1.0, 30.0)]))).unwrap();
    // The base is a disk with a rim of a fifth: Pappus for the quarter turn.
    let base = 900.0 * PI * (0.64 + 0.4 * (0.4 * PI + 0.2));
    let exact = Cone { start: 0.0, end: 30.0, length: 50.0 }.area() + base;
    assert!((area(&sweep, 256, 16) / exact - 1.0).abs() < 1e-3, "{} {exact}", area(&sweep, 256, 16));
    let jet = sweep.jet(0.0, 0.0);
    assert!((jet.du.normalize().x - 30.0 / sweep_slant(30.0, 50.0)).abs() < 1e-6);
}

fn sweep_slant(radius: f64, height: f64) -> f64 {
    (radius * radius + height * height).sqrt()
}

/// The loop-stack shapes of the reference implementation, in mm.
fn goose() -> TubeSpec {
    let rows = [
        [0.0, 0.7, 0.7, 0.0, 0.0],
        [2.5, 4.0, 6.0, 0.0, 0.0],
        [4.0, 5.0, 7.5, 0.0, 0.0],
        [5.0, 5.0, 7.5, 0.0, 0.0],
        [7.0, 2.5, 2.5, 0.0, 4.0],
        [8.5, 1.0, 1.0, 0.0, 5.0],
        [10.0, 1.0, 1.0, 0.0, 4.75],
        [12.0, 1.0, 1.0, 0.0, 4.5],
        [13.0, 1.5, 1.5, 0.0, 4.5],
        [14.0, 1.0, 1.0, 0.0, 4.5],
    ];
    let section = |[z, a, b, x, y]: [f64; 5]| ellipse(z / 14.0, [10.0 * a, 10.0 * b], -10.0 * x, -10.0 * y);
    straight(140.0, rows.map(section).to_vec())
}

fn beastie() -> TubeSpec {
    let at = [(0.0, 0.0), (0.2, 0.0), (0.5, 30.0), (0.8, 0.0), (1.0, 0.0)];
    straight(70.0, at.map(|(at, x)| ellipse(at, [30.0; 2], x, 0.0)).to_vec())
}

#[test]
fn goose_and_beastie_are_surfaces() {
    for spec in
        [goose(), beastie(), smooth(goose()), smooth(beastie()), closed(goose()), closed(smooth(goose()))]
    {
        let sweep = Sweep::new(&spec).unwrap();
        assert_jets(&sweep, &INNER);
        assert_outward(&sweep);
    }
    let sweep = Sweep::new(&goose()).unwrap();
    // The local axes of a curve along +z are the global ones.
    let neck = sweep.point(10.0 / 14.0, 0.0);
    assert!(neck.distance(DVec3::new(10.0, -47.5, 100.0)) < 1e-9, "{neck}");
    assert!(sweep.point(10.0 / 14.0, 0.25).distance(DVec3::new(0.0, -57.5, 100.0)) < 1e-9);
}

/// A quarter bend of radius 20 as a cubic, turned to start along `along` and bend toward `toward`.
fn quarter(along: DVec3, toward: DVec3) -> Bezier {
    let k = 0.552_284_75;
    let at = |a: f64, b: f64| 20.0 * (along * a + toward * b);
    Bezier::new(&[at(0.0, 0.0), at(k, 0.0), at(1.0, 1.0 - k), at(1.0, 1.0)]).unwrap()
}

#[test]
fn bends_are_sound_in_every_direction() {
    let axes = [DVec3::X, -DVec3::X, DVec3::Y, -DVec3::Y, DVec3::Z, -DVec3::Z];
    for along in axes {
        for toward in axes {
            if along.dot(toward) != 0.0 {
                continue;
            }
            let sweep = Sweep::new(&open_tube(vec![quarter(along, toward)], vec![circle(0.0, 8.0)])).unwrap();
            assert_jets(&sweep, &INNER);
            assert_outward(&sweep);
            let exact = TAU * 8.0 * 20.0 * PI / 2.0;
            assert!((area(&sweep, 16, 32) / exact - 1.0).abs() < 1e-3);
        }
    }
}

#[test]
fn curvature_times_radius_below_one_passes_and_above_is_refused() {
    let bend =
        |radius: f64| Sweep::new(&open_tube(vec![quarter(DVec3::X, DVec3::Z)], vec![circle(0.0, radius)]));
    let sweep = bend(18.0).unwrap();
    let torus = TorusArc { major: 20.0, minor: 18.0, angle: PI / 2.0 };
    assert!((area(&sweep, 16, 32) / torus.area() - 1.0).abs() < 1e-3);
    match bend(22.0) {
        Err(Fault::Fold { ratio, .. }) => assert!((ratio - 1.1).abs() < 0.02, "{ratio}"),
        other => panic!("{other:?}"),
    }
    // An offset to the inner side counts, one to the outer side helps.
    let offset = |x: f64| {
        Sweep::new(&open_tube(vec![quarter(DVec3::Z, DVec3::X)], vec![ellipse(0.0, [10.0; 2], x, 0.0)]))
    };
    assert!(matches!(offset(12.0), Err(Fault::Fold { .. })));
    assert!(offset(-12.0).is_ok());
}

#[test]
fn s_curves_u_turns_and_chains_keep_their_frames() {
    let s = curve(&[[0.0; 3], [0.0, 120.0, 0.0], [60.0, -60.0, 30.0], [60.0, 60.0, 60.0]]);
    let u_turn = vec![quarter(DVec3::Z, DVec3::X), {
        let points = quarter(DVec3::X, -DVec3::Z).points().to_vec();
        Bezier::new(&points.iter().map(|p| *p + DVec3::new(20.0, 0.0, 20.0)).collect::<Vec<_>>()).unwrap()
    }];
    let uneven = vec![
        Bezier::line(DVec3::ZERO, DVec3::new(0.0, 0.0, 1.0)),
        Bezier::line(DVec3::new(0.0, 0.0, 1.0), DVec3::new(0.0, 0.0, 100.0)),
    ];
    for curve in [s, u_turn, uneven] {
        for ends in [open_tube as fn(_, _) -> _, |curve, sections| closed(open_tube(curve, sections))] {
            let sweep = Sweep::new(&ends(curve.clone(), vec![circle(0.0, 6.0), circle(1.0, 4.0)])).unwrap();
            assert_jets(&sweep, &INNER);
            assert_outward(&sweep);
        }
    }
}

#[test]
fn repeated_control_points_still_have_a_tangent() {
    let lazy = [[0.0; 3], [0.0; 3], [0.0, 0.0, 70.0], [0.0, 0.0, 70.0]];
    let very_lazy = [[0.0; 3], [0.0; 3], [0.0; 3], [0.0, 0.0, 70.0]];
    for points in [lazy, very_lazy] {
        let chain = Chain::new(&curve(&points)).unwrap();
        for u in [0.0, 0.5, 1.0] {
            assert_eq!(chain.at(u).tangent, DVec3::Z);
        }
        assert!((chain.length() - 70.0).abs() < 1e-9);
        for length in [0.0, 0.01, 3.0, 35.0, 69.99, 70.0] {
            assert!((chain.length_to(chain.parameter_at(length)) - length).abs() < 1e-9);
        }
        let sweep = Sweep::new(&open_tube(curve(&points), vec![circle(0.0, 6.0)])).unwrap();
        assert_jets(&sweep, &INNER);
        for k in 0..=200 {
            let pace = sweep.jet(f64::from(k) / 200.0, 0.1).du.length() / 70.0;
            assert!((0.5..2.0).contains(&pace), "{k}: {pace}");
        }
    }
}

#[test]
fn chains_measure_their_length_and_curvature() {
    let arc = vec![quarter(DVec3::X, DVec3::Z)];
    let chain = Chain::new(&arc).unwrap();
    assert!((chain.length() / (10.0 * PI) - 1.0).abs() < 5e-4);
    assert!((chain.length() - arc[0].length()).abs() < 1e-9);
    assert!((chain.at(0.5).curvature() * 20.0 - 1.0).abs() < 0.02);
    let step = 1e-5;
    for u in [0.1, 0.5, 0.9] {
        let slope = (arc[0].point(u + step) - arc[0].point(u - step)) / (2.0 * step);
        assert!(slope.distance(arc[0].derivative(u)) < 1e-6);
        let change = (arc[0].derivative(u + step) - arc[0].derivative(u - step)) / (2.0 * step);
        assert!(change.distance(arc[0].second_derivative(u)) < 1e-4);
        let turn = (chain.at(u + step).tangent - chain.at(u - step).tangent) / (2.0 * step);
        assert!(turn.distance(chain.at(u).turn) < 1e-6);
    }
}

/// Points around an ellipse, clockwise or not, begun anywhere.
fn ring(count: u32, axes: [f64; 2], first: f64, sign: f64, z: f64) -> Profile {
    let point = |k: u32| {
        let angle = TAU * (f64::from(k) / f64::from(count) + first) * sign;
        DVec3::new(axes[0] * cos(angle), axes[1] * sin(angle), z * cos(2.0 * angle))
    };
    Profile::Loop((0..count).map(point).collect())
}

#[test]
fn loops_are_smooth_and_wherever_they_begin_and_however_they_run_give_one_surface() {
    let circles =
        Sweep::new(&straight(60.0, vec![circle(0.0, 20.0), circle(0.5, 26.0), circle(1.0, 10.0)])).unwrap();
    for (first, sign) in [(0.0, 1.0), (0.3, 1.0), (0.1, -1.0)] {
        let section = |at: f64, radius: f64, first: f64| Section {
            at,
            profile: ring(16, [radius; 2], first, sign, 0.0),
        };
        let spec =
            straight(60.0, vec![section(0.0, 20.0, first), section(0.5, 26.0, -first), circle(1.0, 10.0)]);
        for spec in [spec.clone(), smooth(spec)] {
            let linear = spec.interpolation == Interpolation::Linear;
            let sweep = Sweep::new(&spec).unwrap();
            assert_outward(&sweep);
            for &u in &INNER {
                for k in 0..8 {
                    let v = f64::from(k) / 8.0 + 0.01;
                    let miss = sweep.point(u, v).distance(circles.point(u, v));
                    assert!(!linear || miss < 0.05, "{miss} at {u}, {v}, {first}, {sign}");
                }
            }
            let free: Vec<f64> = INNER.iter().copied().filter(|u| (u - 0.5).abs() > 0.01).collect();
            assert_jets(&sweep, &free);
        }
    }
    // A saddle-shaped rim: its points are not in one plane.
    let rim = Section { at: 1.0, profile: ring(24, [20.0, 20.0], 0.0, 1.0, 4.0) };
    let spec = straight(60.0, vec![circle(0.0, 20.0), rim]);
    for spec in [spec.clone(), closed(spec.clone()), closed(smooth(spec))] {
        let sweep = Sweep::new(&spec).unwrap();
        assert_jets(&sweep, &INNER);
        assert_outward(&sweep);
    }
    let sweep =
        Sweep::new(&straight(60.0, vec![Section { at: 0.0, profile: ring(24, [20.0; 2], 0.0, 1.0, 4.0) }]))
            .unwrap();
    assert!((sweep.point(0.0, 0.0).z - 4.0).abs() < 0.02 && (sweep.point(1.0, 0.25).z - 56.0).abs() < 0.02);
}

#[test]
fn a_smooth_stack_of_loops_ends_round() {
    let radius = |at: f64| (at * (1.0 - at)).sqrt() * 60.0;
    let mut sections = vec![circle(0.0, 0.0)];
    for k in 1..10 {
        let at = f64::from(k) / 10.0;
        sections.push(Section { at, profile: ring(20, [radius(at); 2], 0.0, 1.0, 0.0) });
    }
    sections.push(circle(1.0, 0.0));
    let sweep = Sweep::new(&closed(smooth(straight(60.0, sections)))).unwrap();
    for k in 0..=100 {
        let miss = sweep.point(f64::from(k) / 100.0, 0.37).distance(DVec3::new(0.0, 0.0, 30.0)) / 30.0 - 1.0;
        assert!(miss.abs() < 5e-3, "{k}: {miss}");
    }
    assert_jets(&sweep, &INNER);
}

#[test]
fn what_is_no_tube_is_refused_with_the_place() {
    let tube = |sections: Vec<Section>| Sweep::new(&straight(50.0, sections)).map(|_| ()).unwrap_err();
    assert_eq!(tube(vec![]), Fault::Empty);
    assert_eq!(tube(vec![circle(0.0, f64::NAN)]), Fault::NotFinite);
    assert_eq!(tube(vec![circle(f64::NAN, 1.0)]), Fault::NotFinite);
    assert_eq!(tube(vec![circle(0.0, 1e300)]), Fault::NotFinite);
    assert_eq!(tube(vec![circle(0.5, 5.0), circle(0.5, 6.0)]), Fault::SectionOrder { section: 1 });
    assert_eq!(tube(vec![circle(0.5, 5.0), circle(1.5, 6.0)]), Fault::SectionOrder { section: 1 });
    assert_eq!(tube(vec![circle(0.0, 5.0), circle(1.0, -6.0)]), Fault::SectionSize { section: 1 });
    assert_eq!(tube(vec![circle(0.0, 0.0), circle(1.0, 6.0)]), Fault::SectionSize { section: 0 });
    let eight =
        (0..24).map(|k| TAU * f64::from(k) / 24.0).map(|a| DVec3::new(9.0 * sin(a), 9.0 * sin(2.0 * a), 0.0));
    let loops = |points: Vec<DVec3>| tube(vec![Section { at: 0.0, profile: Profile::Loop(points) }]);
    assert_eq!(loops(eight.collect()), Fault::SectionNotEnclosing { section: 0 });
    assert_eq!(loops(vec![DVec3::X, DVec3::Y]), Fault::SectionNotEnclosing { section: 0 });
    assert_eq!(loops(vec![DVec3::X; 9]), Fault::SectionNotEnclosing { section: 0 });

    let sweep =
        |points: &[[f64; 3]]| Sweep::new(&open_tube(curve(points), vec![circle(0.0, 5.0)])).map(|_| ());
    assert_eq!(sweep(&[[1.0; 3], [1.0; 3]]), Err(Fault::ZeroLength { segment: 0 }));
    assert_eq!(sweep(&[[0.0; 3], [f64::INFINITY, 0.0, 0.0]]), Err(Fault::NotFinite));
    // There and back on a line.
    assert!(matches!(sweep(&[[0.0; 3], [0.0, 0.0, 90.0], [0.0, 0.0, 10.0]]), Err(Fault::Kink { .. })));
    let corner = vec![
        Bezier::line(DVec3::ZERO, DVec3::new(0.0, 0.0, 50.0)),
        Bezier::line(DVec3::new(0.0, 0.0, 50.0), DVec3::new(50.0, 0.0, 50.0)),
    ];
    match Sweep::new(&open_tube(corner, vec![circle(0.0, 5.0)])) {
        Err(Fault::Kink { u, degrees }) => assert!(u == 0.5 && (degrees - 90.0).abs() < 1e-9),
        other => panic!("{other:?}"),
    }
    let gap = vec![
        Bezier::line(DVec3::ZERO, DVec3::new(0.0, 0.0, 50.0)),
        Bezier::line(DVec3::new(0.0, 3.0, 50.0), DVec3::new(0.0, 3.0, 90.0)),
    ];
    let gap = Sweep::new(&open_tube(gap, vec![circle(0.0, 5.0)])).map(|_| ());
    assert_eq!(gap, Err(Fault::Gap { segment: 1, distance: 3.0 }));
    // A loop of the curve that comes back through itself; a smaller tube fits past.
    let knot = [[0.0; 3], [300.0, 0.0, 150.0], [-200.0, 0.0, 150.0], [100.0, 0.0, 0.0]];
    assert!(matches!(sweep(&knot), Err(Fault::SelfIntersect { .. })));
    let past = [[0.0; 3], [300.0, 0.0, 150.0], [-200.0, 60.0, 150.0], [100.0, 60.0, 0.0]];
    assert_eq!(sweep(&past), Ok(()));
}

/// Four quarter bends: a ring that closes on itself, ends touching.
#[test]
fn a_ring_may_close_on_itself_and_rounded_joints_heal() {
    let directions = [DVec3::X, DVec3::Z, -DVec3::X, -DVec3::Z];
    let mut from = DVec3::ZERO;
    let round = |p: DVec3| (p * 100.0).round() / 100.0 + DVec3::new(0.0, 0.0, 0.004 * p.x.signum());
    let curve: Vec<Bezier> = (0..4)
        .map(|k| {
            let segment = quarter(directions[k], directions[(k + 1) % 4]);
            let points: Vec<DVec3> = segment.points().iter().map(|p| round(from + *p)).collect();
            from += segment.point(1.0);
            Bezier::new(&points).unwrap()
        })
        .collect();
    let sweep = Sweep::new(&open_tube(curve, vec![circle(0.0, 8.0)])).unwrap();
    let exact = TAU * 8.0 * TAU * 20.0;
    assert!((area(&sweep, 64, 32) / exact - 1.0).abs() < 2e-3);
    for joint in [0.25, 0.5, 0.75] {
        let u = sweep.surface_parameter(joint);
        for k in 0..8 {
            let v = f64::from(k) / 8.0;
            assert!(sweep.point(u - 1e-9, v).distance(sweep.point(u + 1e-9, v)) < 1e-5, "no step at {joint}");
        }
    }
}

fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![
        12 => -100.0..100.0_f64,
        2 => Just(0.0),
        1 => prop_oneof![Just(f64::NAN), Just(f64::INFINITY), Just(1e308), Just(-1e-308), Just(1e7), Just(1e-12)],
    ]
}

fn any_point() -> impl Strategy<Value = DVec3> {
    [coordinate(), coordinate(), coordinate()].prop_map(DVec3::from)
}

fn any_section() -> impl Strategy<Value = Profile> {
    prop_oneof![
        ([coordinate(), coordinate()], [coordinate(), coordinate()])
            .prop_map(|(axes, offset)| Profile::Ellipse { axes, offset: DVec2::from(offset) }),
        (0.1..20.0_f64).prop_map(|r| Profile::Ellipse { axes: [r; 2], offset: DVec2::ZERO }),
        prop::collection::vec(any_point(), 0..9).prop_map(Profile::Loop),
        (3_u32..9, 0.1..20.0_f64).prop_map(|(n, r)| ring(n, [r, 1.5 * r], 0.0, 1.0, 0.1 * r)),
    ]
}

fn any_end() -> impl Strategy<Value = End> {
    prop_oneof![Just(End::Open), Just(End::Closed)]
}

prop_compose! {
    fn any_spec()(
        curve in prop::collection::vec(prop::collection::vec(any_point(), 2..5), 0..3),
        chained in any::<bool>(),
        profiles in prop::collection::vec(any_section(), 0..5),
        straight in any::<bool>(),
        interpolation in prop_oneof![Just(Interpolation::Linear), Just(Interpolation::Smooth)],
        start in any_end(),
        end in any_end(),
    ) -> TubeSpec {
        let mut segments: Vec<Bezier> = curve.iter().filter_map(|points| Bezier::new(points)).collect();
        if chained {
            segments.truncate(1);
        }
        if straight {
            segments = vec![Bezier::line(DVec3::ZERO, DVec3::new(0.0, 0.0, 60.0))];
        }
        let last = profiles.len().max(2) - 1;
        let sections =
            profiles.into_iter().enumerate().map(|(i, profile)| Section { at: i as f64 / last as f64, profile }).collect();
        TubeSpec { curve: segments, sections, interpolation, start, end }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, rng_seed: prop::test_runner::RngSeed::Fixed(7), failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_input_panics_and_every_tube_is_finite(spec in any_spec()) {
        if let Ok(sweep) = Sweep::new(&spec) {
            for u in [-0.5, -0.02, 0.0, 1e-9, 1e-3, 0.3, 0.5, 0.77, 1.0 - 1e-9, 1.0, 1.06, 2.0] {
                for v in [-3.25, 0.0, 0.4, 1.0] {
                    let jet = sweep.jet(u, v);
                    prop_assert!(jet.point.is_finite() && jet.du.is_finite() && jet.dv.is_finite(), "{u} {v} {jet:?}");
                }
            }
            let range = sweep.tube_range();
            prop_assert!(range.start >= 0.0 && range.end <= 1.0 && range.start < range.end);
            sweep.jet(f64::NAN, f64::NAN);
            sweep.jet(f64::INFINITY, 1e300);
        }
    }

    #[test]
    fn frames_are_orthonormal_along_random_curves(
        points in prop::collection::vec([-100.0..100.0_f64, -100.0..100.0, -100.0..100.0], 2..5),
        at in prop::collection::vec(0.0..1.0_f64, 8),
    ) {
        let points: Vec<DVec3> = points.into_iter().map(DVec3::from).collect();
        let segment = Bezier::new(&points).unwrap();
        // Thin enough for any curve but a cusp.
        let spec = open_tube(vec![segment], vec![circle(0.0, 0.01)]);
        if let Ok(sweep) = Sweep::new(&spec) {
            for u in at {
                let center = segment.point(sweep.curve_parameter(u));
                let [a, b] = [sweep.point(u, 0.0) - center, sweep.point(u, -0.25) - center];
                let tangent = segment.derivative(sweep.curve_parameter(u)).normalize();
                for (x, y, z) in [(a, b, tangent), (b, a, tangent)] {
                    prop_assert!((x.length() - 0.01).abs() < 1e-11);
                    prop_assert!(x.normalize().dot(y.normalize()).abs() < 1e-9);
                    prop_assert!(x.normalize().dot(z).abs() < 1e-9);
                }
                prop_assert!((atan2(a.cross(b).dot(tangent), a.dot(b)) - PI / 2.0).abs() < 1e-9);
                // The frame does not turn about the tangent.
                let jet = sweep.jet(u, 0.0);
                prop_assert!(jet.du.dot(b.normalize()).abs() < 1e-9 * jet.du.length().max(1.0));
            }
        }
    }

    #[test]
    fn jets_of_random_bent_tubes_are_exact(
        points in prop::collection::vec([-100.0..100.0_f64, -100.0..100.0, -100.0..100.0], 2..5),
        radii in [0.5..12.0_f64, 0.5..12.0],
        smoothed in any::<bool>(),
        shut in any::<bool>(),
    ) {
        let points: Vec<DVec3> = points.into_iter().map(DVec3::from).collect();
        let mut spec = open_tube(vec![Bezier::new(&points).unwrap()], vec![circle(0.0, radii[0]), circle(1.0, radii[1])]);
        if smoothed {
            spec = smooth(spec);
        }
        if shut {
            spec = closed(spec);
        }
        if let Ok(sweep) = Sweep::new(&spec) {
            let range = sweep.tube_range();
            const STEP: f64 = 1e-5;
            for k in 0..10 {
                let u = range.start + (range.end - range.start) * (f64::from(k) + 0.413) / 10.0;
                let jet = sweep.jet(u, 0.3);
                let du = (sweep.point(u + STEP, 0.3) - sweep.point(u - STEP, 0.3)) / (2.0 * STEP);
                let miss = jet.du.distance(du) / du.length();
                prop_assert!(miss < 2e-6, "{miss} at {u}");
            }
        }
    }
}
