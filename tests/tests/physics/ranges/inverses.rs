//! Projections and their inverses, from the axis to the edge of the field of each model.

use core::f64::consts::{PI, TAU};
use etendue_core::maths::f64::sin_cos;
use etendue_projection::Model;
use etendue_projection::model::{
    Division, DoubleSphere, ExtendedUnified, FTheta, FThetaSense, FieldOfView, Ideal, KannalaBrandt, Ocam, Perspective,
    ThinPrismFisheye, Unified,
};
use etendue_projection::plane::{Affine, DistortionTerms};
use etendue_testkit::page::{Row, check, worst};
use glam::{DVec2, DVec3};

const TERMS: DistortionTerms = DistortionTerms {
    numerator: [-0.3, 0.1, -0.02, 0.0],
    denominator: [0.05, 0.01, 0.0],
    tangential: [1e-3, -5e-4],
    prism: [1e-4, 0.0, -1e-4, 0.0],
};
const AFFINE: Affine = Affine { c: 1.001, d: 1e-3, e: -2e-3 };

/// Every model that has an axis, with the numbers of a lens.
fn models() -> Vec<(&'static str, Model)> {
    let fisheye = KannalaBrandt::new([-0.01, 0.003, -0.002, 3e-4]).expect("legal");
    let f_theta = |sense| FTheta::new(sense, vec![0.0, 1.0, 0.01, -0.02, 0.003], 1.9, AFFINE).expect("legal");
    let ocam = Ocam::new(vec![-500.0, 0.0, 8e-4, -1e-7, 2e-9], AFFINE).expect("legal");
    vec![
        (
            "perspective with rational, tangential and prism terms",
            Model::Perspective(Perspective::new(TERMS, [0.02, -0.01]).expect("legal")),
        ),
        ("division, −0.4", Model::Division(Division::new(-0.4).expect("legal"))),
        ("field of view, 1.5 rad", Model::FieldOfView(FieldOfView::new(1.5).expect("legal"))),
        ("Kannala–Brandt", Model::KannalaBrandt(fisheye)),
        ("thin-prism fisheye", Model::ThinPrismFisheye(ThinPrismFisheye::new(fisheye, TERMS).expect("legal"))),
        ("unified, ξ 1.2", Model::Unified(Unified::new(1.2, TERMS).expect("legal"))),
        ("extended unified, α 0.6, β 1.2", Model::ExtendedUnified(ExtendedUnified::new(0.6, 1.2).expect("legal"))),
        ("double sphere, ξ −0.2, α 0.6", Model::DoubleSphere(DoubleSphere::new(-0.2, 0.6).expect("legal"))),
        ("Scaramuzza's polynomial", Model::Ocam(ocam)),
        ("f-theta, angle to radius", Model::FTheta(f_theta(FThetaSense::AngleToRadius))),
        ("f-theta, radius to angle", Model::FTheta(f_theta(FThetaSense::RadiusToAngle))),
        ("equidistant", Model::Ideal(Ideal::Equidistant)),
        ("equisolid", Model::Ideal(Ideal::Equisolid)),
        ("stereographic", Model::Ideal(Ideal::Stereographic)),
        ("orthographic", Model::Ideal(Ideal::Orthographic)),
        ("rectilinear", Model::Ideal(Ideal::Rectilinear)),
    ]
}

/// Field angles over that of the edge: close to the axis, all over, close to the edge.
fn parts() -> impl Iterator<Item = f64> {
    let close = [1e-300, 1e-150, 1e-12, 1e-9, 1e-6, 1e-3];
    let regular = (1..40).map(|i| f64::from(i) / 40.0);
    close.into_iter().chain(regular).chain([1.0 - 1e-3, 1.0 - 1e-6, 1.0 - 1e-9])
}

/// So close to the edge an image point may be rounded onto it, where nothing is seen.
const ON_THE_EDGE: f64 = 1.0 - 1e-8;

/// The greatest distance of an image point from the image of what it sees, over its distance from the centre; and the number of
/// directions that have no such point.
fn distance(model: &Model) -> (f64, usize) {
    let edge = model.edge().angle_rad;
    let (mut distances, mut lost) = (Vec::new(), 0);
    for part in parts() {
        for turn in 0..7 {
            let ((sin, cos), (x, y)) = (sin_cos(part * edge), sin_cos(TAU * (f64::from(turn) + 0.3) / 7.0));
            let direction = DVec3::new(sin * x, sin * y, cos);
            let again =
                model.project(direction).and_then(|point| Some((point, model.project(model.unproject(point)?)?)));
            match again {
                Some((point, again)) => distances.push(off(point, again)),
                None if part > ON_THE_EDGE => {}
                None => lost += 1,
            }
        }
    }
    (worst(distances), lost)
}

/// Relative to the point, whose squares must not underflow.
fn off(point: DVec2, again: DVec2) -> f64 {
    let size = point.abs().max_element();
    if size == 0.0 { again.length() } else { ((again - point) / size).length() }
}

#[test]
fn image_points_are_the_images_of_what_they_see() {
    let row = |(name, model): (&'static str, Model)| {
        let (farthest, lost) = distance(&model);
        let edge_deg = model.edge().angle_rad * 180.0 / PI;
        Row {
            extreme: format!("{name}, to {edge_deg:.1}°"),
            expected: "≤ 10⁻⁹, 0 lost".to_owned(),
            actual: format!("{farthest:.0e}, {lost} lost"),
            holds: farthest <= 1e-9 && lost == 0,
        }
    };
    let rows: Vec<_> = models().into_iter().map(row).collect();
    let introduction = "Directions from 10⁻³⁰⁰ of the field angle off the axis to 10⁻⁹ of it within the edge of the field, in seven azimuths, are projected, unprojected and projected again in 64 bits. Errors are relative to the distance from the centre. Image points within 10⁻⁸ of the edge may be lost.";
    check("Projections and their inverses", introduction, &rows);
}
