//! Materials that transmit light.

use super::chi_square::{DirectionGrid, check_p_values, lobe, p_of_samples};
use super::*;

#[test]
fn transmitted_directions_are_sampled_by_the_density_stated() {
    let mut p_values = vec![];
    let glasses = [(1.5, 0.02), (1.33, 0.1), (1.5, 0.3), (2.4, 0.8)];
    for (k, (n, alpha)) in glasses.into_iter().enumerate() {
        let material_table = material_table(glass(n, alpha));
        for (side, bsdf) in [bsdf(&material_table), from_back(&material_table)].iter().enumerate() {
            for (i, degrees) in [0.0, 25.0, 60.0, 84.0].into_iter().enumerate() {
                let wo = at_degrees(degrees);
                let Bsdf::Dielectric(glass) = bsdf else { unreachable!() };
                // Beyond the critical angle the transmitting facets send light along the surface.
                let straight = Vec3::new(-wo.x, -wo.y, -0.1).normalize();
                let below = dielectric::refracted(wo, Vec3::Z, glass.eta()).unwrap_or(straight);
                let alpha = alpha as f32;
                let grid = DirectionGrid::new(lobe(Vec3::new(-wo.x, -wo.y, wo.z), alpha), lobe(below, alpha.max(0.02)));
                let p = p_of_samples(bsdf, wo, &grid, (1000 + k * 8 + side * 4 + i) as u32);
                p_values.push((p, format!("n {n}, α {alpha}, side {side}, {degrees}°")));
            }
        }
    }
    for (k, (r, t)) in [(0.4, 0.6), (0.3, 0.1), (0.0, 0.5)].into_iter().enumerate() {
        let material_table = material_table(leaf(r, t));
        let wo = at_degrees(50.0);
        let grid = DirectionGrid::new(lobe(Vec3::Z, 1.0), lobe(Vec3::NEG_Z, 1.0));
        p_values.push((p_of_samples(&bsdf(&material_table), wo, &grid, 1100 + k as u32), format!("leaf {r} {t}")));
    }
    check_p_values(&p_values);
}

#[test]
fn smooth_glass_sends_on_all_light() {
    let material_table = material_table(glass(1.5, 0.0));
    for bsdf in [bsdf(&material_table), from_back(&material_table)] {
        for degrees in [0.0, 30.0, 41.0, 42.0, 80.0, 89.0] {
            let wo = at_degrees(degrees);
            let [reflected, transmitted] = albedos(&bsdf, wo);
            let Bsdf::Dielectric(glass) = &bsdf else { unreachable!() };
            // The lattice counts a fraction of 2^17 points: 2e-4.
            assert!((reflected[0] - fresnel::interface(wo.z, glass.eta())).abs() < 2e-4, "{degrees}");
            assert!((reflected[0] + transmitted[0] - 1.0).abs() < 1e-5, "{degrees}");
        }
    }
}

#[test]
fn hardly_rough_glass_is_like_smooth_glass() {
    let (smooth, rough) = (material_table(glass(1.5, 0.0)), material_table(glass(1.5, 0.01)));
    for (smooth, rough) in [(bsdf(&smooth), bsdf(&rough)), (from_back(&smooth), from_back(&rough))] {
        for degrees in [0.0, 30.0, 60.0] {
            let (a, b) = (albedos(&smooth, at_degrees(degrees)), albedos(&rough, at_degrees(degrees)));
            for side in 0..2 {
                // Facets tilt by about α: the Fresnel factor changes by its slope times α, and by α² in shadowing.
                assert!((a[side][0] - b[side][0]).abs() < 3e-3, "{degrees}: {a:?} {b:?}");
            }
        }
    }
}

#[test]
fn rough_glass_loses_only_what_is_scattered_twice() {
    // Measured: 0.1 %, 2.9 % and 22 %.
    for (alpha, loss) in [(0.05, 0.002), (0.3, 0.04), (1.0, 0.25)] {
        let albedo = albedo(&bsdf(&material_table(glass(1.5, alpha))), at_degrees(45.0))[0];
        assert!(albedo <= 1.0 + 1e-3 && albedo > 1.0 - loss, "α {alpha}: {albedo}");
    }
}

#[test]
fn radiance_thins_out_on_its_way_in() {
    let material_table = material_table(glass(1.5, 0.0));
    let inside = bsdf(&material_table).sample(Vec3::Z, 0.99, Vec2::ZERO).expect("light");
    assert!(inside.wi.z == -1.0 && inside.event == Event::Specular && (inside.weight[0] - 1.0 / 2.25).abs() < 1e-6);
    let outside = from_back(&material_table).sample(Vec3::Z, 0.99, Vec2::ZERO).expect("light");
    assert!(outside.wi.z == -1.0 && (outside.weight[0] - 2.25).abs() < 1e-5);
}

#[test]
fn panes_share_what_arrives_by_their_series() {
    let material_table = material_table(pane(1.52, 1.0));
    for degrees in [0.0, 45.0, 80.0] {
        let wo = at_degrees(degrees);
        let passage = material_table.passage(MaterialId(0), &LOOKUP, &|_| wo.z, &WAVELENGTHS).expect("a pane");
        let [reflected, passed] = albedos(&bsdf(&material_table), wo);
        assert!((passed[0] - passage[0]).abs() < 2e-4 && (reflected[0] + passed[0] - 1.0).abs() < 1e-5, "{degrees}");
        let straight = bsdf(&material_table).sample(wo, 0.999, Vec2::ZERO).expect("light");
        assert_eq!((straight.event, straight.wi), (Event::Null, -wo));
    }
    assert!(bsdf(&material_table).is_delta() && !bsdf(&material_table).transmits() && material_table.has_passages());
}

#[test]
fn leaves_scatter_the_stated_shares_to_each_side() {
    for (r, t) in [(0.4, 0.6), (0.05, 0.45)] {
        let [above, below] = albedos(&bsdf(&material_table(leaf(r, t))), at_degrees(70.0));
        assert!(
            (f64::from(above[0]) - r).abs() < 1e-3 && (f64::from(below[0]) - t).abs() < 1e-3,
            "{above:?} {below:?}"
        );
    }
}
