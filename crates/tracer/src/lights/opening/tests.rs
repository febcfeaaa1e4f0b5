//! Projected areas against the meshes, flux, and refusals.

use core::f64::consts::{PI, TAU};
use etendue_core::maths::f64::sin_cos;
use glam::{DVec3, Vec3};

use super::{Opening, OpeningBody, OpeningError};
use crate::geometry::Mesh;
use crate::lights::profile::{Cone, PhotometricAxes, PhotometricGrid, Profile};

fn opening(body: OpeningBody, extents_m: [f64; 3]) -> Opening {
    Opening::new(body, extents_m).expect("an opening")
}

/// A box, a rectangle, a tube, an elliptic disc, and all flat bodies in other orientations.
fn meshed() -> Vec<Opening> {
    vec![
        opening(OpeningBody::Box, [0.3, 0.1, 0.05]),
        opening(OpeningBody::Box, [0.3, 0.0, 0.05]),
        opening(OpeningBody::Box, [0.3, 0.2, 0.0]),
        opening(OpeningBody::Cylinder(1), [0.026, 1.2, 0.026]),
        opening(OpeningBody::Cylinder(2), [0.2, 0.3, 0.1]),
        opening(OpeningBody::Cylinder(0), [0.0, 0.2, 0.1]),
        opening(OpeningBody::Cylinder(2), [0.2, 0.2, 0.0]),
    ]
}

/// n² directions of equal weight: a lattice of rank one.
fn directions(n: usize) -> impl Iterator<Item = DVec3> {
    (0..n * n).map(move |k| {
        let z = -1.0 + 2.0 * ((k as f64 * 0.754_877_666_246_69 + 0.5) % 1.0);
        let (sin, cos) = sin_cos(TAU * ((k as f64 * 0.569_840_290_998_05) % 1.0));
        let aside = (1.0 - z * z).sqrt();
        DVec3::new(aside * cos, aside * sin, z)
    })
}

/// Projected area of an opening's mesh seen from afar: for a body the facing part, for a flat opening either side.
fn by_mesh(mesh: &Mesh, both: bool, direction: DVec3) -> f64 {
    let actual = |primitive: usize| {
        let [a, b, c] = mesh.corners(primitive as u32).map(|corner| corner.as_dvec3());
        let along = 0.5 * (b - a).cross(c - a).dot(direction);
        if both { along.abs() } else { along.max(0.0) }
    };
    (0..mesh.triangles().len()).map(actual).sum()
}

#[test]
fn seen_areas_are_those_of_the_meshes() {
    for opening in meshed() {
        let (mut ratios, mut count) = (0.0, 0.0);
        let (mesh, flat) = (opening.mesh().expect("a mesh"), opening.flat_axis());
        // Flat openings that are nearly edge-on have a minimum area.
        for direction in directions(40).filter(|d| flat.is_none_or(|axis| d[axis].abs() > 2e-3)) {
            let actual = f64::from(opening.projected_area_m2(direction.as_vec3()));
            let meshed = by_mesh(&mesh, flat.is_some(), direction);
            // The silhouette of a polygon of 48 sides deviates by up to 1.5e-3 from the circle's, boxes by f32's rounding.
            let allowed = if matches!(opening.body, OpeningBody::Cylinder(_)) { 1.5e-3 } else { 2e-6 };
            assert!((actual / meshed - 1.0).abs() < allowed, "{opening:?} {direction}: {actual} {meshed}");
            (ratios, count) = (ratios + actual / meshed, count + 1.0);
        }
        // For tubes the mean width is the circle's; that of an ellipse's polygon rotates with its axes.
        assert!((ratios / count - 1.0).abs() < 1e-4, "{opening:?}: {}", ratios / count);
    }
}

#[test]
fn an_ellipsoid_is_seen_as_its_support_says() {
    let [a, b, c] = [0.3, 0.2, 0.1];
    let ball = opening(OpeningBody::Ellipsoid, [2.0 * a, 2.0 * b, 2.0 * c]);
    // The mean projected area of a convex body is a quarter of its surface (Cauchy 1841); by the sections along the axes.
    for (axis, area) in [(Vec3::X, b * c), (Vec3::Y, c * a), (Vec3::Z, a * b)] {
        assert!((f64::from(ball.projected_area_m2(axis)) / (PI * area) - 1.0).abs() < 1e-6);
    }
    let round = opening(OpeningBody::Ellipsoid, [0.4; 3]);
    for direction in directions(8) {
        assert!((f64::from(round.projected_area_m2(direction.as_vec3())) / (PI * 0.04) - 1.0).abs() < 1e-6);
    }
}

/// Flux that leaves an opening, over that of the profile: ∫ value · A(mesh)/A(projected) dΩ.
fn remaining_flux(opening: &Opening, profile: &Profile) -> f64 {
    let n = 200;
    let (mesh, flat) = (opening.mesh().expect("a mesh"), opening.flat_axis().is_some());
    let of = |d: DVec3| {
        let towards = d.as_vec3();
        let meshed = by_mesh(&mesh, flat, d);
        let value = f64::from(profile.value(towards));
        (value * meshed / f64::from(opening.projected_area_m2(towards)), value)
    };
    let (left, total) = directions(n).map(of).fold((0.0, 0.0), |sum, (a, b)| (sum.0 + a, sum.1 + b));
    left / total
}

#[test]
fn the_flux_is_kept_but_for_what_a_flat_opening_loses_along_its_plane() {
    let spot = Profile::Cone(Cone::new(0.4, 0.7).expect("a spot"));
    for opening in meshed() {
        for profile in [&Profile::Isotropic, &spot] {
            let (kept_flux_sr, lost) = (remaining_flux(&opening, profile), opening.lost_fraction(profile));
            // Some 40 of 40 000 directions lie in the band about the plane; sides of tubes are exact in the mean.
            assert!((kept_flux_sr + lost - 1.0).abs() < 2e-4, "{opening:?} {profile:?}: {kept_flux_sr} {lost}");
        }
        let lost = opening.lost_fraction(&Profile::Isotropic);
        let expected = if opening.flat_axis().is_some() { 5e-4 } else { 0.0 };
        assert!((lost - expected).abs() <= 1e-9 + 1e-6 * expected, "{opening:?}: {lost}");
    }
}

#[test]
fn extents_out_of_range_are_refused() {
    for (body, extents_m) in [
        (OpeningBody::Box, [0.0, 0.0, 1.0]),
        (OpeningBody::Box, [-0.1, 0.1, 0.1]),
        (OpeningBody::Box, [f64::NAN, 0.1, 0.1]),
        (OpeningBody::Cylinder(0), [0.1, 0.1, 0.0]),
        (OpeningBody::Cylinder(2), [0.1, 101.0, 0.0]),
        (OpeningBody::Ellipsoid, [0.1, 0.1, 0.0]),
        (OpeningBody::Ellipsoid, [1e-5; 3]),
    ] {
        let refused = Opening::new(body, extents_m);
        assert!(matches!(refused, Err(OpeningError::Extents { .. })), "{body:?} {extents_m:?}: {refused:?}");
    }
}

#[test]
fn a_beam_along_the_plane_of_a_flat_opening_is_refused() {
    let edge_on = opening(OpeningBody::Box, [0.2, 0.2, 0.0]);
    // Falling within a degree to either side of the horizon: 0.0573° of it are lost.
    let value = |v: f32| if v == 0.0 { 1.0 } else { 0.0 };
    let vertical = vec![-1.0, 0.0, 1.0];
    let horizontal = vec![-20.0, 20.0];
    let values = horizontal.iter().flat_map(|_| vertical.iter().map(|v| value(*v))).collect();
    let beam = Profile::PhotometricGrid(
        PhotometricGrid::new(PhotometricAxes::A, vertical, horizontal, values).expect("a grid"),
    );
    let refused = edge_on.check(&beam);
    assert!(
        matches!(refused, Err(OpeningError::EdgeOn { fraction }) if (0.05..0.06).contains(&fraction)),
        "{refused:?}"
    );
    assert_eq!(opening(OpeningBody::Box, [0.0, 0.2, 0.2]).check(&beam), Ok(()));
    assert_eq!(opening(OpeningBody::Box, [0.2, 0.2, 0.01]).check(&beam), Ok(()), "a body has area everywhere");
}
