//! The models of reflection beyond metals and coats, by the same tests.

use super::chi_square::{Grid, judge, p_of_draws};
use super::*;

/// A matt base under a mirror, an off-specular and a retro lobe.
fn lobes() -> Surface {
    let weight = |v| Spectrum::from_fn(move |nm| v * (0.5 + nm / 2200.0));
    let lobes = vec![
        Lobe::mirror(200.0, &weight(0.2)),
        Lobe { tangential: -1.0, normal: 0.9, exponent: 15.0, weight: weight(0.4) },
        Lobe::retro(40.0, &weight(0.1)),
    ];
    Surface::Lafortune(Box::new(Lafortune::new(grey(0.2), lobes).expect("lobes that lose energy")))
}

fn blinn_phong(base: f64, gloss: f64, n: f64) -> Surface {
    Surface::BlinnPhong(Box::new(BlinnPhong::new(grey(base), Spectrum::constant(gloss), n).expect("a legal model")))
}

/// Surfaces for the tests that all materials pass.
pub(super) fn surfaces() -> Vec<Surface> {
    vec![lobes(), blinn_phong(0.0, 1.0, 0.0), blinn_phong(0.3, 0.7, 20.0), blinn_phong(0.0, 1.0, 5000.0)]
}

#[test]
fn directions_are_drawn_by_the_density_told() {
    let cases = [(lobes(), 0.3), (blinn_phong(0.3, 0.7, 1.0), 1.0), (blinn_phong(0.3, 0.5, 200.0), 0.2)];
    let mut p_values = vec![];
    for (k, (surface, scale)) in cases.into_iter().enumerate() {
        let palette = palette(surface);
        for (i, degrees) in [0.0, 30.0, 70.0, 86.0].into_iter().enumerate() {
            let wo = at_degrees(degrees);
            let p = p_of_draws(&bsdf(&palette), wo, &Grid::of_mirror(wo, scale), 1000 + (k * 4 + i) as u32);
            p_values.push((p, format!("case {k} at {degrees}°")));
        }
    }
    judge(&p_values);
}
