//! Rays through drops on the glass, against closed forms and conservation laws.

use super::{Layer, LightPath, Windscreen, WindscreenParameters};
use crate::front::drops::{Cap, DropsParameters};
use crate::front::{Curve, MemberRay, Placement, RayOutcome};
use crate::prescription::coating::{Coating, Crossing};
use core::f64::consts::PI;
use etendue_core::maths::f64::{asin, cos, sin, sin_cos, tan};
use etendue_core::random::philox4x32;
use glam::{DMat4, DVec2, DVec3, DVec4};

const GLASS: f64 = 1.52;
const WATER: f64 = 1.333;
const THICK_MM: f64 = 5.0;

/// Flat glass in the camera's frame: the inner face at z = 0.
fn glass(tilt_deg: f64, radius_mm: f64) -> Windscreen {
    let parameters = WindscreenParameters {
        placement: Placement::with_rotation_deg(DVec3::ZERO, [tilt_deg, 0.0, 0.0]),
        radius_across_mm: radius_mm,
        radius_upright_mm: radius_mm,
        layers: vec![Layer { thickness_mm: THICK_MM, index: Curve::Constant(GLASS) }],
        wedge_rad: 0.0,
        tint: None,
        coating: Coating::Uncoated,
        double_image_fraction: Some(0.0),
    };
    Windscreen::new(parameters).expect("legal glass")
}

fn drops(count: u32, radius_mm: [f64; 2], contact_deg: f64) -> DropsParameters {
    DropsParameters {
        offset_mm: DVec2::ZERO,
        size_mm: DVec2::splat(60.0),
        count,
        radius_mm,
        size_exponent: 2.0,
        contact_angle_rad: contact_deg * PI / 180.0,
        index: Curve::Constant(WATER),
        seed: 11,
        course: None,
    }
}

/// Flat glass with one drop on the axis.
fn one(contact_deg: f64) -> Windscreen {
    let p = drops(1, [1.0, 1.0], contact_deg);
    let aside = glass(0.0, f64::INFINITY).with_drops(p.clone()).expect("legal drops");
    let at_mm = aside.drops().expect("drops").droplets()[0].centre_mm;
    let centred = DropsParameters { offset_mm: -at_mm, ..p };
    glass(0.0, f64::INFINITY).with_drops(centred).expect("legal drops")
}

fn ray(x: f64, angle_rad: f64) -> MemberRay {
    let (s, c) = sin_cos(angle_rad);
    MemberRay { point_mm: DVec3::new(x, 0.0, -10.0), direction: DVec3::new(s, 0.0, c) }
}

fn on(outcome: RayOutcome) -> Option<(MemberRay, f64)> {
    match outcome {
        RayOutcome::Transmitted(line, fraction) => Some((line, fraction)),
        _ => None,
    }
}

fn through_wet_glass(glass: &Windscreen, line: MemberRay) -> Option<(MemberRay, f64)> {
    on(glass.through_wet(line, 550.0, LightPath::Direct))
}

fn through_dry_glass(glass: &Windscreen, line: MemberRay) -> (MemberRay, f64) {
    on(glass.through(line, 550.0, LightPath::Direct)).expect("a dry ray")
}

fn transmittance(n: [f64; 2], angle_rad: f64) -> f64 {
    let (s, c) = sin_cos(angle_rad);
    let beyond = (1.0 - n[0] * n[0] * s * s / (n[1] * n[1])).sqrt();
    Coating::Uncoated.transmittance(&Crossing { n, cosine: [c, beyond] }, 550.0)
}

/// Parallel light near the axis crosses it one focal length R/(n − 1) before the apex; a lens of water of 1 mm at 60°: 3.467 mm.
#[test]
fn a_drop_focuses_parallel_light_at_its_focal_length() {
    for contact_deg in [20.0, 60.0, 90.0] {
        let glass = one(contact_deg);
        let cap = Cap::new(1.0, contact_deg * PI / 180.0);
        let (out, _) = through_wet_glass(&glass, ray(1e-4, 0.0)).expect("light");
        let crosses_mm = out.point_mm.z - out.direction.z * out.point_mm.x / out.direction.x;
        let focal_mm = crosses_mm - THICK_MM - cap.height_mm();
        // Spherical aberration goes with the square of 10⁻⁴.
        assert!((focal_mm / cap.focal_length_mm(WATER) - 1.0).abs() < 1e-6, "{contact_deg}: {focal_mm}");
    }
}

/// Rays from a point on the axis behind the glass (the pupil) leave with slopes −(D′/f − 1) times their own, D′ = D + t/n_g + h/n_w the reduced
/// distance of the apex: a distant test image appears upside down, and smaller by that factor.
#[test]
fn a_drop_inverts_and_scales_what_is_behind_it() {
    let (glass, cap) = (one(60.0), Cap::new(1.0, PI / 3.0));
    for distance_mm in [50.0, 100.0, 400.0] {
        let reduced_mm = distance_mm + THICK_MM / GLASS + cap.height_mm() / WATER;
        let scale = 1.0 - reduced_mm / cap.focal_length_mm(WATER);
        assert!(scale < -10.0);
        for slope in [-2e-6, 1e-6, 3e-6] {
            let direction = DVec3::new(slope, 2.0 * slope, 1.0).normalize();
            let (out, _) =
                through_wet_glass(&glass, MemberRay { point_mm: DVec3::new(0.0, 0.0, -distance_mm), direction })
                    .expect("light");
            let visible = out.direction / out.direction.z;
            assert!((visible.x / (scale * slope) - 1.0).abs() < 1e-4, "{distance_mm}: {} {}", visible.x, scale * slope);
            assert!((visible.y / (2.0 * scale * slope) - 1.0).abs() < 1e-4);
        }
    }
}

/// Under uniform illumination only Fresnel losses are visible: a ray r from the axis transmits T(glass, water) T(water, air at asin(r/R)) in place of
/// T(glass, air), up to r = R/n, where total reflection begins. At the centre the drop is 1.9 % brighter than the glass next to it.
#[test]
fn in_uniform_light_a_drop_is_seen_by_its_fresnel_losses_alone() {
    let (glass, cap) = (one(60.0), Cap::new(1.0, PI / 3.0));
    for i in 0..86 {
        let r = f64::from(i) * 0.01;
        let line = ray(r, 0.0);
        let (_, fraction) = through_wet_glass(&glass, line).expect("light");
        let within = asin(r / cap.sphere_radius_mm());
        let expected =
            transmittance([GLASS, WATER], 0.0) * transmittance([WATER, 1.0], within) / transmittance([GLASS, 1.0], 0.0);
        assert!((fraction / through_dry_glass(&glass, line).1 - expected).abs() < 1e-12, "{r}");
    }
    let middle =
        through_wet_glass(&glass, ray(0.0, 0.0)).expect("light").1 / through_dry_glass(&glass, ray(0.0, 0.0)).1;
    assert!((middle - 1.0188).abs() < 1e-4, "{middle}");
    // Beyond R/n light is reflected at the sphere: it leaves through the other side or not at all.
    let aperture = through_wet_glass(&glass, ray(0.95, 0.0));
    assert!(aperture.is_none_or(|(out, _)| out.direction.x > 0.0), "no plain refraction: {aperture:?}");
    // Next to the drop the glass is dry, to the bit.
    assert_eq!(through_wet_glass(&glass, ray(1.01, 0.0)), Some(through_dry_glass(&glass, ray(1.01, 0.0))));
}

/// Snell's law by hand: a ray in the plane of the axis at an angle, through glass, water and the sphere.
#[test]
fn an_oblique_ray_obeys_snell_at_the_sphere() {
    let (glass, cap) = (one(80.0), Cap::new(1.0, 80.0 * PI / 180.0));
    let angle = 0.5;
    let (inside, water) = (asin(sin(angle) / GLASS), asin(sin(angle) / WATER));
    // Meets the outer face 0.3 mm left of the axis.
    let start = -0.3 - 10.0 * tan(angle) - THICK_MM * tan(inside);
    let (out, _) = through_wet_glass(&glass, ray(start, angle)).expect("light");
    let foot = DVec2::new(-0.3, -cap.centre_height_mm());
    let direction = DVec2::new(sin(water), cos(water));
    let along = foot.dot(direction);
    let r = cap.sphere_radius_mm();
    let point = foot + direction * ((along * along - foot.length_squared() + r * r).sqrt() - along);
    let normal = asin(point.x / r);
    let expected = normal + asin(WATER * sin(water - normal));
    assert!((asin(out.direction.x) - expected).abs() < 1e-12, "{} {expected}", asin(out.direction.x));
    assert!((out.point_mm.x - point.x).abs() < 1e-12);
}

/// Position (x, y) and direction cosines, mm and 1, of a ray after the glass at a plane 20 mm away; before it, at its start.
fn carried(glass: &Windscreen, state: DVec4) -> Option<DVec4> {
    let z = (1.0 - state.z * state.z - state.w * state.w).sqrt();
    let line = MemberRay { point_mm: DVec3::new(state.x, state.y, -10.0), direction: DVec3::new(state.z, state.w, z) };
    let (out, _) = through_wet_glass(glass, line)?;
    let point = out.point_mm + out.direction * ((20.0 - out.point_mm.z) / out.direction.z);
    Some(DVec4::new(point.x, point.y, out.direction.x, out.direction.y))
}

/// Étendue is conserved: the map from x, y and direction cosines before to those after has a determinant of 1 or −1, for all surfaces a ray meets
/// (from within, from the side, by total reflection).
#[test]
fn etendue_is_conserved_through_drops() {
    for (contact_deg, count) in [(30.0, 900), (70.0, 900), (120.0, 300)] {
        let glass = glass(0.0, f64::INFINITY).with_drops(drops(count, [0.3, 2.0], contact_deg)).expect("legal drops");
        let (mut tested, mut bent) = (0, 0);
        for i in 0..3000 {
            let u = philox4x32([i, 0, 0, 0], [5, 0]).map(|w| f64::from(w) / 4_294_967_296.0);
            let state =
                DVec4::new(40.0 * u[0] - 20.0, 40.0 * u[1] - 20.0, 1.8 * (u[2] - 0.5) * 0.7, 1.8 * (u[3] - 0.5) * 0.7);
            let step = [1e-6, 1e-6, 1e-7, 1e-7];
            let Some(middle) = carried(&glass, state) else { continue };
            let columns: Option<Vec<DVec4>> = (0..4)
                .map(|k| {
                    let mut shift = DVec4::ZERO;
                    shift[k] = step[k];
                    let (a, b) = (carried(&glass, state - shift)?, carried(&glass, state + shift)?);
                    // There is no derivative across the edge of a drop.
                    ((a + b) * 0.5 - middle).abs().max_element().lt(&1e-6).then(|| (b - a) / (2.0 * step[k]))
                })
                .collect();
            let Some(c) = columns else { continue };
            // If the map stretches a thousandfold, differences of 10⁻⁷ of it are meaningless.
            if c.iter().any(|c| c.abs().max_element() > 300.0) {
                continue;
            }
            let determinant = DMat4::from_cols(c[0], c[1], c[2], c[3]).determinant().abs();
            assert!((determinant - 1.0).abs() < 1e-2, "{contact_deg}: {state} → {determinant}");
            tested += 1;
            let direction = DVec2::new(middle.z - state.z, middle.w - state.w);
            bent += u32::from(direction.length() > 1e-6);
        }
        assert!(tested > 1500 && bent > 150, "{contact_deg}: {tested}, {bent}");
    }
}

/// Oblique light on tilted glass, as in cars: no fraction exceeds the incident light, and light that leaves comes out of the glass.
#[test]
fn drops_on_tilted_curved_glass_lose_light_and_make_none() {
    for contact_deg in [10.0, 60.0, 100.0, 150.0] {
        let glass = glass(60.0, 3000.0).with_drops(drops(900, [0.3, 2.0], contact_deg)).expect("legal drops");
        let normal = glass.parameters().placement.rotation.z_axis;
        let (mut bright, mut dark) = (0, 0);
        for i in 0..4000 {
            let u = philox4x32([i, 0, 0, 0], [6, 0]).map(|w| f64::from(w) / 4_294_967_296.0);
            let direction = DVec3::new(u[2] - 0.5, 0.5 * (u[3] - 0.5), 1.0).normalize();
            let start = DVec3::new(30.0 * (u[0] - 0.5), 15.0 * (u[1] - 0.5), 0.0) - direction * 60.0;
            match through_wet_glass(&glass, MemberRay { point_mm: start, direction }) {
                Some((out, fraction)) => {
                    bright += 1;
                    assert!(fraction > 0.0 && fraction < 1.0 && (out.direction.length() - 1.0).abs() < 1e-12);
                    assert!(out.direction.dot(normal) > -0.02, "leaves: {}", out.direction.dot(normal));
                }
                None => dark += 1,
            }
        }
        assert!(bright > 2000 && dark < 2000, "{contact_deg}: {bright} {dark}");
    }
}

/// Under a drop, the double image has the reflectance of glass to water at the outer face, 0.43 % in place of 4.3 %.
#[test]
fn the_double_image_is_fainter_under_a_drop() {
    let glass = one(60.0);
    let doubled = |outcome| on(outcome).expect("a double image").1;
    let line = ray(0.0, 0.0);
    let ratio = doubled(glass.through_wet(line, 550.0, LightPath::DoubleReflection))
        / doubled(glass.through(line, 550.0, LightPath::DoubleReflection));
    let (water, air) = (transmittance([GLASS, WATER], 0.0), transmittance([GLASS, 1.0], 0.0));
    let expected = (1.0 - water) * water * transmittance([WATER, 1.0], 0.0) / ((1.0 - air) * air);
    assert!((ratio - expected).abs() < 1e-12, "{ratio} {expected}");
}
