//! GGX against mpmath: distribution, masking, reflection, and the facets that are drawn.

use super::numerics::{KnownValues, figures, known, ulp_single, worst};
use etendue_testkit::page::{Row, check, worst as greatest};
use etendue_tracer::materials::Ggx;
use glam::{DVec3, Vec2, Vec3};

/// The three numbers from the `i`-th on.
fn vector(at: &[f64], i: usize) -> Vec3 {
    Vec3::new(at[i] as f32, at[i + 1] as f32, at[i + 2] as f32)
}

fn ggx(at: &[f64]) -> Ggx {
    Ggx::from_alpha(at[0] as f32).expect("no mirror")
}

/// The point of the cap that a facet was made of, which is drawn evenly over it: the facet stretched to roughness 1, about which the viewer's direction
/// (stretched as well) is mirrored.
fn on_the_cap(alpha: f64, wo: Vec3, facet: DVec3) -> DVec3 {
    let wo = wo.as_dvec3();
    let viewer = DVec3::new(alpha * wo.x, alpha * wo.y, wo.z).normalize();
    let facet = DVec3::new(facet.x / alpha, facet.y / alpha, facet.z).normalize();
    2.0 * facet.dot(viewer) * facet - viewer
}

/// The greatest distance on the cap, of radius 1, between facets that are drawn and the exact ones.
fn drawn(rows: &[KnownValues]) -> f64 {
    greatest(rows.iter().map(|KnownValues { arguments: at, values: is }| {
        let (alpha, wo) = (at[0], vector(at, 1));
        let sampled = ggx(at).sample(wo, Vec2::new(at[4] as f32, at[5] as f32)).as_dvec3();
        let exact = DVec3::new(is[0][0], is[1][0], is[2][0]);
        on_the_cap(alpha, wo, sampled).distance(on_the_cap(alpha, wo, exact))
    }))
}

#[test]
fn facets() {
    let figures = &figures()["ggx"];
    let ulps = |name: &str, function: &dyn Fn(&[f64]) -> f32| {
        worst(&known(&figures[name]), ulp_single, |at| vec![f64::from(function(at))]).0
    };
    let rows = [
        Row::at_most(
            "distribution, facets of 0.01 to 30 times the roughness in slope",
            "≤ 12 ULP: the number of roundings, those before the square counted twice; no cancellation",
            ulps("density", &|at| ggx(at).density(vector(at, 1))),
            12.0,
        ),
        Row::at_most(
            "masking G₁, cosines 10⁻⁶ to 1",
            "≤ 6 ULP: the number of roundings; no cancellation",
            ulps("masking", &|at| ggx(at).shadowing(vector(at, 1))),
            6.0,
        ),
        Row::at_most(
            "D G₂/(4 cos θₒ), cosines 10⁻⁶ to 1",
            "≤ 24 ULP: the number of roundings; no cancellation",
            ulps("reflection", &|at| ggx(at).reflect(vector(at, 1), vector(at, 4), vector(at, 7))),
            24.0,
        ),
        Row::at_most(
            "sampled facets, cosines 10⁻⁶ to 1",
            "≤ 10⁻⁶: distance of the random numbers on the unit cap of uniformly distributed facets",
            drawn(&known(&figures["drawn"])),
            1e-6,
        ),
    ];
    let introduction =
        "Roughness 10⁻⁴ to 1, compared with mpmath as above; 32 bits, units in the last place of the true value.";
    check("GGX", introduction, &rows);
}
