//! One surface of each model with lobes, for tests of the use of these lobes.

use etendue_spectra::{Spectrum, metal};

use super::*;

/// All with their names.
pub(crate) fn glossy_surfaces() -> Vec<(&'static str, Surface)> {
    vec![
        ("wet road", coated(1.33, 0.06)),
        ("varnish", coated(1.5, 0.01)),
        ("GGX metal", metal(Distribution::Ggx, 0.15)),
        ("Beckmann metal", metal(Distribution::Beckmann, 0.1)),
        ("car paint", car_paint()),
        ("Blinn-Phong", blinn_phong()),
        ("Lafortune", lafortune()),
        ("sheeting", sheeting()),
        ("marking", marking()),
    ]
}

fn grey(reflectance: f64) -> Reflectance {
    Reflectance::Spectrum(Spectrum::constant(reflectance))
}

fn coated(n: f64, alpha: f64) -> Surface {
    Surface::Coated(Box::new(CoatedDiffuse::new(grey(0.1), n, alpha).expect("a coat")))
}

fn metal(distribution: Distribution, alpha: f64) -> Surface {
    let aluminium = metal::by_name("Al").expect("aluminium").clone();
    Surface::Conductor(Box::new(Conductor::new(aluminium, alpha).expect("a metal").with_distribution(distribution)))
}

/// Flakes under a coat that is not quite smooth: two lobes.
fn car_paint() -> Surface {
    let parts = CarPaintParts {
        pigment: grey(0.02),
        flakes: Spectrum::constant(0.85),
        coverage: 0.5,
        flake_alpha: 0.1,
        coat_index: 1.5,
        coat_alpha: 0.02,
    };
    Surface::CarPaint(Box::new(CarPaint::new(parts).expect("a paint")))
}

fn blinn_phong() -> Surface {
    Surface::BlinnPhong(Box::new(BlinnPhong::new(grey(0.1), Spectrum::constant(0.4), 500.0).expect("a gloss")))
}

fn lafortune() -> Surface {
    let lobes = vec![
        Lobe::mirror(300.0, &Spectrum::constant(0.2)),
        Lobe { tangential: -1.0, normal: 0.9, exponent: 15.0, weight: Spectrum::constant(0.1) },
        Lobe::retro(200.0, &Spectrum::constant(0.1)),
    ];
    Surface::Lafortune(Box::new(Lafortune::new(grey(0.1), lobes).expect("lobes that lose energy")))
}

fn sheeting() -> Surface {
    let preset = SheetingPreset::named("ra2", "white").expect("a preset");
    Surface::Sheeting(Box::new(preset.sheeting().expect("a sheeting")))
}

/// With beads of a narrow lobe: that of usual ones is hardly brighter than the paint.
fn marking() -> Surface {
    let white = Spectrum::constant(1.0);
    let marking = RoadMarking::with_spread(300.0, DaytimeBrightness::Qd(130.0), &white, 0.5).expect("a marking");
    Surface::Marking(Box::new(marking))
}
