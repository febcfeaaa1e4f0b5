//! Dirt in front of the lens, compared with closed forms.

use core::f64::consts::PI;
use etendue_core::maths::f64::acos;
use etendue_optics::front::{Dirt, DirtParameters, Front, Mask, Placement};
use etendue_optics::{Lens, ThinParameters};
use glam::{DVec2, DVec3};

const FOCAL_MM: f64 = 25.0;
const DISTANCE_MM: f64 = 40.0;
const SIZE_MM: f64 = 40.0;
const TEXELS: usize = 2000;

/// Opaque from the axis to the right.
fn half_plane() -> Dirt {
    let row = (0..TEXELS).map(|x| if x < TEXELS / 2 { 1.0 } else { 0.0 }).collect();
    let mask = Mask::new(TEXELS, 1, row).expect("a mask");
    let placement = Placement::with_rotation_deg(DVec3::new(0.0, 0.0, DISTANCE_MM), [0.0; 3]);
    Dirt::new(DirtParameters { placement, size_mm: DVec2::splat(SIZE_MM), mask }).expect("dirt")
}

fn lens() -> Lens {
    let p = ThinParameters {
        focal_length_mm: FOCAL_MM,
        f_number: 4.0,
        focus_distance_m: f64::INFINITY,
        transmittance: 1.0,
    };
    Lens::thin(p).expect("a lens")
}

/// Fraction of a disc of radius 1 to the left of the line x = h.
fn left_of(h: f64) -> f64 {
    if h >= 1.0 {
        1.0
    } else if h <= -1.0 {
        0.0
    } else {
        1.0 - (acos(h) - h * (1.0 - h * h).sqrt()) / PI
    }
}

#[test]
fn an_edge_has_the_penumbra_of_the_pupil() {
    let (lens, dirt) = (lens(), half_plane());
    let radius_mm = 1e3 * lens.entrance_pupil_radius_m();
    for x in -9..=9 {
        let tangent = 0.01 * f64::from(x);
        let at = DVec2::new(FOCAL_MM * tangent, 0.0);
        // The bundle crosses the mask as a disc of the pupil's size about distance × tangent.
        let expected = left_of(-DISTANCE_MM * tangent / radius_mm);
        let shade = dirt.shade(&lens, at);
        // 1 024 uniform samples across an edge (about 4 · 1 024^(−3/4)/2π), a texel of 0.02 mm of 3.1, and z²/d⁴, which off the axis varies by ± 2 %
        // over the pupil.
        assert!((shade - expected).abs() < 8e-3, "{tangent}: {shade} against {expected}");
    }
    assert!((dirt.shade(&lens, DVec2::ZERO) - 0.5).abs() < 2e-3);
}

#[test]
fn both_routes_agree() {
    let (lens, dirt) = (lens(), half_plane());
    let front = Front::new(Some(dirt.clone()), None).expect("dirt");
    for x in [-0.05, -0.02, 0.0, 0.03, 0.06] {
        let at = DVec2::new(FOCAL_MM * x, 0.5);
        let side = 96;
        let pupil = |i: u32| (f64::from(i) + 0.5) / f64::from(side);
        let mean = |ray: &dyn Fn(DVec2) -> f64| {
            (0..side * side).map(|i| ray(DVec2::new(pupil(i % side), pupil(i / side)))).sum::<f64>()
        };
        let dirty = mean(&|u| front.ray(&lens, at, u, 550.0).map_or(0.0, |r| r.ray.weight_sr));
        let clean = mean(&|u| lens.ray(at, u, 550.0).map_or(0.0, |r| r.weight_sr));
        // Two quadratures of one integral, the coarser as above; the finer of strata along the edge, 1/192.
        assert!((dirty / clean - dirt.shade(&lens, at)).abs() < 6e-3, "{x}");
    }
}

#[test]
fn beyond_the_mask_the_glass_is_clean_and_a_mask_is_upright() {
    let mask = Mask::new(2, 2, vec![0.0, 0.25, 0.5, 1.0]).expect("a mask");
    let placement = Placement::with_rotation_deg(DVec3::new(0.0, 0.0, DISTANCE_MM), [0.0; 3]);
    let dirt = Dirt::new(DirtParameters { placement, size_mm: DVec2::splat(8.0), mask }).expect("dirt");
    let front = Front::new(Some(dirt), None).expect("dirt");
    // Close to a pinhole: the view of the pupil's centre.
    let p = ThinParameters {
        focal_length_mm: FOCAL_MM,
        f_number: 4.0,
        focus_distance_m: f64::INFINITY,
        transmittance: 1.0,
    };
    let lens = Lens::thin(p).expect("a lens");
    let transmittance_at = |x_mm: f64, y_mm: f64| {
        let at = DVec2::new(x_mm, y_mm) / DISTANCE_MM * FOCAL_MM;
        let bare = lens.ray(at, DVec2::splat(0.5), 550.0).expect("light").weight_sr;
        front.ray(&lens, at, DVec2::splat(0.5), 550.0).map_or(0.0, |ray| ray.ray.weight_sr / bare)
    };
    // Right is right and down is down, as in the image.
    for (x, y, expected) in [(-3.0, -3.0, 0.0), (3.0, -3.0, 0.25), (-3.0, 3.0, 0.5), (3.0, 3.0, 1.0), (-5.0, -3.0, 1.0)]
    {
        assert!((transmittance_at(x, y) - expected).abs() < 1e-12, "{x} {y}: {}", transmittance_at(x, y));
    }
    assert!((transmittance_at(0.0, -3.0) - 0.125).abs() < 1e-7, "linear between texels");
}

#[test]
fn masks_that_are_none_are_refused() {
    assert!(Mask::new(2, 2, vec![1.0; 3]).expect_err("none").to_string().contains("2 × 2"));
    assert!(Mask::new(1, 1, vec![1.5]).expect_err("none").to_string().contains("1.5"));
}
