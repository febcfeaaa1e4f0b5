use proptest::prelude::*;

use super::*;

fn distortion(sense: DistortionDirection, k1: f64, k2: f64, unit_mm: f64) -> RadialDistortion {
    RadialDistortion::new(sense, k1, k2, unit_mm).expect("legal")
}

#[test]
fn barrel_pulls_points_inwards_in_either_direction() {
    // OpenCV's barrel has k1 < 0; the same image written as an inverse (fetching) filter has k1 > 0.
    let forward = distortion(DistortionDirection::IdealToObserved, -0.1, 0.0, 10.0);
    let fetch = distortion(DistortionDirection::ObservedToIdeal, 0.1, 0.0, 10.0);
    for d in [forward, fetch] {
        assert!(d.observed_radius_mm(5.0).expect("inside") < 5.0);
        assert!(d.ideal_radius_mm(5.0).expect("inside") > 5.0);
    }
    // r′ = 0.5 (1 − 0.1 · 0.25) focal lengths.
    assert!((forward.observed_radius_mm(5.0).expect("inside") - 4.875).abs() < 1e-14);
    assert!((fetch.ideal_radius_mm(5.0).expect("inside") - 5.125).abs() < 1e-14);
}

#[test]
fn a_fold_inside_the_image_is_refused_with_its_radius() {
    let d = distortion(DistortionDirection::ObservedToIdeal, -0.2, 0.0, 4.0);
    let fold_mm = 4.0 * (1.0_f64 / 0.6).sqrt();
    assert!(d.check(fold_mm * 0.999).is_ok());
    let refused = d.check(fold_mm * 1.001).expect_err("folds");
    assert!(matches!(refused, DistortionError::Fold { fold_mm: f, .. } if (f - fold_mm).abs() < 1e-12));
    assert!(refused.to_string().contains("5.163978 mm"), "{refused}");
    // The other direction folds at an observed radius that is the polynomial's value.
    let d = distortion(DistortionDirection::IdealToObserved, -0.2, 0.0, 4.0);
    assert!((d.fold_observed_mm() - fold_mm * (1.0 - 0.2 / 0.6)).abs() < 1e-12);
    assert!(d.ideal(DVec2::new(d.fold_observed_mm() + 1e-9, 0.0)).is_none());
}

#[test]
fn a_unit_changes_the_numbers_and_not_the_lens() {
    let scales = RadiusScales { principal_distance_mm: 12.0, half_diagonal_mm: 4.0, pixel_pitch_mm: 0.005 };
    let in_mm = distortion(DistortionDirection::IdealToObserved, -1e-3, 2e-5, 1.0);
    for unit in [RadiusUnit::Millimetres, RadiusUnit::FocalLengths, RadiusUnit::HalfDiagonals, RadiusUnit::Pixels] {
        let u = unit.length_mm(&scales);
        let d = distortion(DistortionDirection::IdealToObserved, -1e-3 * u * u, 2e-5 * u * u * u * u, u);
        let (a, b) = (d.observed_radius_mm(3.0), in_mm.observed_radius_mm(3.0));
        assert!((a.expect("inside") - b.expect("inside")).abs() < 1e-12);
    }
}

#[test]
fn the_area_ratio_is_the_determinant() {
    for sense in [DistortionDirection::IdealToObserved, DistortionDirection::ObservedToIdeal] {
        let d = distortion(sense, -0.05, 0.02, 8.0);
        let (p, h) = (DVec2::new(2.0, 1.5), 1e-5);
        let at = |q: DVec2| d.ideal(q).expect("inside");
        let dx = (at(p + DVec2::X * h) - at(p - DVec2::X * h)) / (2.0 * h);
        let dy = (at(p + DVec2::Y * h) - at(p - DVec2::Y * h)) / (2.0 * h);
        let ratio = d.ideal_area_per_observed(p.length()).expect("inside");
        // Central differences: h² · third derivative and ε/h, both about 1e-10.
        assert!((dx.perp_dot(dy) - ratio).abs() < 1e-8);
    }
}

#[test]
fn numbers_that_are_none_are_refused() {
    let nan = RadialDistortion::new(DistortionDirection::IdealToObserved, f64::NAN, 0.0, 1.0);
    assert!(matches!(nan, Err(DistortionError::Coefficient { .. })));
    let flat = RadialDistortion::new(DistortionDirection::IdealToObserved, 0.0, 0.0, 0.0);
    assert!(matches!(flat, Err(DistortionError::Unit { .. })));
}

proptest! {
    #[test]
    fn both_directions_are_inverse(k1 in -0.15..0.15f64, k2 in -0.02..0.02f64, x in -4.0..4.0f64, y in -4.0..4.0f64, forward: bool) {
        let sense = if forward { DistortionDirection::IdealToObserved } else { DistortionDirection::ObservedToIdeal };
        let d = distortion(sense, k1, k2, 5.0);
        let p = DVec2::new(x, y);
        prop_assume!(p.length() < 0.95 * d.fold_observed_mm());
        let back = d.ideal(p).and_then(|i| d.observed(i)).expect("before the fold");
        // 1e-12 relative, times the root's condition near the fold (at most about 10 at 95 % of it).
        prop_assert!((back - p).length() <= 1e-11 * (p.length() + 1e-3));
    }
}

#[test]
fn the_fit_of_the_other_direction_comes_near_and_says_how_near() {
    let d = RadialDistortion::new(DistortionDirection::IdealToObserved, -0.08, 0.01, 10.0).expect("legal");
    let fit = d.fitted(DistortionDirection::ObservedToIdeal, 5.0).expect("no fold");
    let [k1, _] = fit.distortion.coefficients();
    // Series reversal: k1 of the inverse is −k1 + O(r²).
    assert!((k1 - 0.08).abs() < 0.01, "k1 = {k1}");
    assert!(fit.worst_mm > 0.0 && fit.worst_mm < 1e-3, "{}", fit.worst_mm);
    for i in 0..=50 {
        let r = 0.1 * f64::from(i);
        let gap = fit.distortion.ideal_radius_mm(r).expect("inside") - d.ideal_radius_mm(r).expect("inside");
        // The fit's own grid is five times finer than this one; its worst error is within a few per cent of the true worst.
        assert!(gap.abs() <= 1.05 * fit.worst_mm, "{gap} at {r}");
    }
    let same = d.fitted(DistortionDirection::IdealToObserved, 5.0).expect("no fold");
    // A fit to a member of the family returns it, within the conditioning of the normal equations (about 1e3 · ε).
    assert!(same.worst_mm < 1e-11, "{}", same.worst_mm);
}

#[test]
fn the_fold_is_the_first_zero_of_the_derivative() {
    assert_eq!(RadialPolynomial::new(0.1, 0.02).fold(), f64::INFINITY);
    assert_eq!(RadialPolynomial::new(0.0, 0.0).fold(), f64::INFINITY);
    // 1 − 3·0.1·r² = 0.
    assert!((RadialPolynomial::new(-0.1, 0.0).fold() - (1.0_f64 / 0.3).sqrt()).abs() < 1e-15);
    for (k1, k2) in [(-0.3, 0.01), (-0.4, 0.05), (0.2, -0.1), (0.0, -1.0), (-1e-9, -1e-3)] {
        let p = RadialPolynomial::new(k1, k2);
        assert!(p.derivative(p.fold()).abs() < 1e-9, "k1 {k1}, k2 {k2}: fold {}", p.fold());
        for i in 0..100 {
            assert!(p.derivative(p.fold() * f64::from(i) / 100.0) > 0.0, "an earlier zero");
        }
    }
}

#[test]
fn beyond_the_fold_there_is_nothing() {
    let p = RadialPolynomial::new(-0.1, 0.0);
    assert!(p.forward(p.fold()).is_none() && p.forward(10.0).is_none());
    assert!(p.inverse(p.fold_value()).is_none() && p.inverse(f64::NAN).is_none());
    assert!(p.forward(p.fold() * 0.999).is_some() && p.inverse(p.fold_value() * 0.999).is_some());
}

proptest! {
    #[test]
    fn the_inverse_inverts(k1 in -0.5..0.5f64, k2 in -0.2..0.2f64, fraction in 0.0..0.98f64) {
        let p = RadialPolynomial::new(k1, k2);
        let r = fraction * p.fold().min(4.0);
        let back = p.inverse(p.forward(r).expect("before the fold")).expect("before the fold");
        // The root's condition number is r′/(r · dr′/dr) ≤ 1/0.04 at 98 % of the fold.
        prop_assert!((back - r).abs() <= 1e-12 * r, "{back} for {r}");
    }
}
