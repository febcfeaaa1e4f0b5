//! For random parameters: a camera's results are correct, and `None` elsewhere.

use core::f64::consts::PI;

use etendue_core::maths::f64::{acos, sin_cos};
use etendue_projection::Model;
use etendue_projection::model::{
    Division, DoubleSphere, ExtendedUnified, FTheta, FThetaSense, FieldOfView, Ideal, KannalaBrandt, Ocam, Panorama,
    Perspective, ThinPrismFisheye, Unified,
};
use etendue_projection::plane::{Affine, DistortionTerms};
use glam::{DVec2, DVec3};
use proptest::prelude::*;

/// Coefficients far beyond those of real lenses.
fn terms() -> impl Strategy<Value = DistortionTerms> {
    let radial = (prop::array::uniform4(-0.5..0.5f64), prop::array::uniform3(-0.3..0.3f64));
    let rest = (prop::array::uniform2(-0.05..0.05f64), prop::array::uniform4(-0.05..0.05f64));
    let bare = (any::<bool>(), any::<bool>());
    (radial, rest, bare).prop_map(|((numerator, denominator), (tangential, prism), (no_denominator, only_radial))| {
        let denominator = if no_denominator { [0.0; 3] } else { denominator };
        let (tangential, prism) = if only_radial { ([0.0; 2], [0.0; 4]) } else { (tangential, prism) };
        DistortionTerms { numerator, denominator, tangential, prism }
    })
}

fn fisheye() -> impl Strategy<Value = KannalaBrandt> {
    prop::array::uniform4(-0.2..0.2f64).prop_map(|k| KannalaBrandt::new(k).expect("legal"))
}

fn affine() -> impl Strategy<Value = Affine> {
    (0.8..1.2f64, -0.1..0.1f64, -0.1..0.1f64).prop_map(|(c, d, e)| Affine { c, d, e })
}

fn perspective() -> impl Strategy<Value = Model> {
    let tilt = prop::array::uniform2(-0.5..0.5f64);
    (terms(), tilt).prop_map(|(terms, tilt)| Model::Perspective(Perspective::new(terms, tilt).expect("legal")))
}

fn f_theta() -> impl Strategy<Value = Model> {
    let c = (0.5..2.0f64, prop::array::uniform3(-0.3..0.3f64));
    (any::<bool>(), c, 0.3..3.1f64, affine()).prop_map(|(by_angle, (c1, [c2, c3, c4]), maximum, affine)| {
        let sense = if by_angle { FThetaSense::AngleToRadius } else { FThetaSense::RadiusToAngle };
        Model::FTheta(FTheta::new(sense, vec![0.0, c1, c2, c3, c4], maximum, affine).expect("legal"))
    })
}

fn ocam() -> impl Strategy<Value = Model> {
    (0.5..2.0f64, prop::array::uniform4(-0.5..0.5f64), affine()).prop_map(|(a0, [a1, a2, a3, a4], affine)| {
        Model::Ocam(Ocam::new(vec![-a0, a1, a2, a3, a4], affine).expect("legal"))
    })
}

fn closed_form() -> impl Strategy<Value = Model> {
    let ideal = [Ideal::Equidistant, Ideal::Equisolid, Ideal::Stereographic, Ideal::Orthographic, Ideal::Rectilinear];
    prop_oneof![
        (-0.5..0.5f64).prop_map(|k| Model::Division(Division::new(k).expect("legal"))),
        (0.01..3.1f64).prop_map(|omega| Model::FieldOfView(FieldOfView::new(omega).expect("legal"))),
        (0.0..=1.0f64, 0.2..5.0f64)
            .prop_map(|(a, b)| Model::ExtendedUnified(ExtendedUnified::new(a, b).expect("legal"))),
        (-0.95..0.95f64, 0.0..=1.0f64)
            .prop_map(|(xi, a)| Model::DoubleSphere(DoubleSphere::new(xi, a).expect("legal"))),
        prop::sample::select(ideal.map(Model::Ideal).to_vec()),
        prop::sample::select([Panorama::Cylindrical, Panorama::Equirectangular].map(Model::Panorama).to_vec()),
    ]
}

fn models() -> impl Strategy<Value = Model> {
    let thin = |(k, terms)| Model::ThinPrismFisheye(ThinPrismFisheye::new(k, terms).expect("legal"));
    prop_oneof![
        perspective(),
        (0.0..3.0f64, terms()).prop_map(|(xi, terms)| Model::Unified(Unified::new(xi, terms).expect("legal"))),
        fisheye().prop_map(Model::KannalaBrandt),
        (fisheye(), terms()).prop_map(thin),
        f_theta(),
        ocam(),
        closed_form(),
    ]
}

fn directions() -> impl Strategy<Value = DVec3> {
    (-1.0..1.0f64, -PI..PI).prop_map(|(cos, azimuth)| {
        let (sin, _) = sin_cos(acos(cos));
        (DVec2::from(sin_cos(azimuth)) * sin).extend(cos)
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1500))]

    #[test]
    fn what_a_point_sees_is_seen_there(model in models(), x in -2.5..2.5f64, y in -1.5..1.5f64) {
        let point = DVec2::new(x, y);
        let direction_seen = model.unproject(point);
        prop_assert_eq!(model.solid_angle_per_area(point).is_some(), direction_seen.is_some());
        if let Some(direction) = direction_seen {
            prop_assert!((direction.length() - 1.0).abs() < 1e-14);
            prop_assert!(model.solid_angle_per_area(point) > Some(0.0));
            // The same operations, done once.
            let sight = model.sight(point).expect("seen");
            prop_assert_eq!((sight.direction, Some(sight.sr_per_area)), (direction, model.solid_angle_per_area(point)));
            let back = model.project(direction);
            // Rounding may put a direction at the edge outside.
            prop_assert!(back.is_some() || !inside(&model, direction), "{} is not seen again", direction);
            if let Some(back) = back {
                // 1e-9 px at a focal length of 1 000 px.
                prop_assert!((back - point).length() < 1e-12 * (1.0 + slope(&model, point)), "{} for {}", back, point);
            }
        }
    }

    #[test]
    fn what_is_seen_at_a_point_is_what_the_point_sees(model in models(), direction in directions()) {
        let Some(point) = model.project(direction).filter(|p| p.length() < 4.0) else { return Ok(()) };
        let back = model.unproject(point);
        prop_assert!(back.is_some() || !inside(&model, direction), "{} sees nothing", point);
        if let Some(back) = back {
            // At folds and horizons a direction is only accurate to the root of the rounding: the plane hardly grows with the angle there. Elsewhere
            // it is accurate to the rounding times that ratio.
            let ratio = model.solid_angle_per_area(point).expect("seen");
            prop_assert!(ratio > 1e4 || (back - direction).length() < 1e-10, "{} for {}", back, direction);
        }
    }

    #[test]
    fn nothing_is_seen_beyond_the_edge(model in models(), direction in directions()) {
        let angle = acos(direction.z.clamp(-1.0, 1.0));
        prop_assert!(angle < model.edge().angle_rad + 1e-9 || model.project(direction).is_none());
    }
}

/// True if a direction is clear of the edge, and of the horizon of a tilted sensor, where all far points crowd.
fn inside(model: &Model, direction: DVec3) -> bool {
    let tilted = matches!(model, Model::Perspective(m) if m.tilt().is_some());
    let limit = if tilted { model.edge().angle_rad.min(1.2) } else { model.edge().angle_rad };
    acos(direction.z.clamp(-1.0, 1.0)) < limit - 1e-7
}

/// Plane per angle at a point: the scale for rounding of directions.
fn slope(model: &Model, point: DVec2) -> f64 {
    model.solid_angle_per_area(point).map_or(1.0, |ratio| 1e-3 / ratio)
}
