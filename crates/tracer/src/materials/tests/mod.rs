//! Every material against the contract: densities, values, reciprocity, energy.

pub(in crate::materials) mod chi_square;
mod furnace;
mod maps;
mod reflection;
mod refusals;
mod retro;
mod transmission;
mod wet;

use super::*;
use crate::MaterialId;
use crate::textures::Lookup;
use etendue_core::Wavelengths;
use etendue_core::random::{NoiseDraw, NoiseStream, Pixel};
use etendue_spectra::{Spectrum, metal};

const WAVELENGTHS: Wavelengths<4> = Wavelengths { nm: [450.0, 520.0, 600.0, 680.0], pdf: [1.0 / 400.0; 4] };
const LOOKUP: Lookup = Lookup::point(Vec2::ZERO);

fn material_table(surface: Surface) -> MaterialTable {
    MaterialTable::new(vec![Material::new(surface)], vec![]).expect("a legal material")
}

fn bsdf(material_table: &MaterialTable) -> Bsdf<'_, 4> {
    material_table.bsdf(MaterialId(0), &LOOKUP, true, &WAVELENGTHS)
}

/// The same surface seen from its back.
fn from_back(material_table: &MaterialTable) -> Bsdf<'_, 4> {
    material_table.bsdf(MaterialId(0), &LOOKUP, false, &WAVELENGTHS)
}

fn grey(value: f64) -> Reflectance {
    Reflectance::Spectrum(Spectrum::constant(value))
}

fn metal_of(name: &str, alpha: f64) -> Surface {
    let index = metal::by_name(name).expect("a known metal").clone();
    Surface::Conductor(Box::new(Conductor::new(index, alpha).expect("a metal")))
}

/// A conductor that reflects everything.
fn perfect_metal(alpha: f64) -> Surface {
    let index = metal::ComplexIndex { n: Spectrum::constant(0.0), k: Spectrum::constant(3.0) };
    Surface::Conductor(Box::new(Conductor::new(index, alpha).expect("a metal")))
}

fn paint(albedo: f64, n: f64, alpha: f64) -> Surface {
    Surface::Coated(Box::new(CoatedDiffuse::new(grey(albedo), n, alpha).expect("a paint")))
}

fn glass(n: f64, alpha: f64) -> Surface {
    Surface::Dielectric(Box::new(Dielectric::new(n, alpha, None).expect("a glass")))
}

fn pane(n: f64, transmittance: f64) -> Surface {
    Surface::ThinSheet(Box::new(ThinSheet::new(n, grey(transmittance)).expect("a pane")))
}

fn leaf(reflectance: f64, transmittance: f64) -> Surface {
    Surface::Leaf(Box::new(Leaf { reflectance: grey(reflectance), transmittance: grey(transmittance) }))
}

fn at_degrees(degrees: f32) -> Vec3 {
    let (s, c) = etendue_core::maths::f32::sin_cos(degrees.to_radians());
    // Rotated in azimuth, so that an error of one axis shows.
    Vec3::new(0.8 * s, -0.6 * s, c)
}

fn noise(seed: u32) -> NoiseStream {
    NoiseStream::new(11, 0, 0, 0, Pixel { x: seed, y: 0 }, NoiseDraw::Shot)
}

fn all_surfaces() -> Vec<Surface> {
    let mut surfaces = vec![
        Surface::Absorber,
        Surface::Diffuse(grey(1.0)),
        metal_of("Ag", 0.0),
        metal_of("Al", 1e-3),
        metal_of("Fe", 0.3),
        perfect_metal(1.0),
        paint(0.0, 1.5, 0.0),
        paint(1.0, 1.5, 0.0),
        paint(1.0, 1.5, 0.05),
        paint(1.0, 2.5, 1.0),
        paint(1.0, 1.1, 0.2),
        glass(1.5, 0.0),
        glass(1.5, 1e-3),
        glass(1.33, 0.1),
        glass(2.4, 0.6),
        pane(1.52, 0.8),
        leaf(0.4, 0.6),
        leaf(0.0, 0.5),
    ];
    surfaces.extend(reflection::surfaces());
    surfaces
}

#[test]
fn weights_are_value_over_density() {
    for (k, surface) in all_surfaces().into_iter().enumerate() {
        let material_table = material_table(surface);
        let bsdf = bsdf(&material_table);
        let mut stream = noise(100 + k as u32);
        for degrees in [0.0, 45.0, 80.0, 88.0] {
            let wo = at_degrees(degrees);
            for _ in 0..200 {
                let u = Vec2::new(stream.unit_f32(), stream.unit_f32());
                let Some(s) = bsdf.sample(wo, stream.unit_f32(), u).filter(|s| s.event == Event::Scatter) else {
                    continue;
                };
                let value = bsdf.evaluate(wo, s.wi);
                let ratio = value.value_cos[1] / value.pdf;
                // Narrow lobes: the half vector is good to 6e-8/cos θ; of a lobe of α = 1e-3 at 88° that is 2e-3.
                assert!((ratio - s.weight[1]).abs() < 5e-3 * s.weight[1].max(1e-3), "{k} at {degrees}: {s:?}");
                assert!((value.pdf - s.pdf).abs() < 1e-2 * s.pdf, "{k} at {degrees}: {} {}", value.pdf, s.pdf);
            }
        }
    }
}

/// Ratio of the index of the far side to that of the viewer's, seen from the front.
fn eta(material_table: &MaterialTable) -> f32 {
    match bsdf(material_table) {
        Bsdf::Dielectric(dielectric) => dielectric.eta(),
        _ => 1.0,
    }
}

/// Returns value × |cos| of the BSDF with both directions swapped.
fn evaluate_swapped(material_table: &MaterialTable, wo: Vec3, wi: Vec3) -> Spectral<4> {
    if wi.z > 0.0 {
        return bsdf(material_table).evaluate(wi, wo).value_cos / wo.z;
    }
    let flip = Vec3::new(1.0, 1.0, -1.0);
    from_back(material_table).evaluate(wi * flip, wo * flip).value_cos / wo.z
}

#[test]
fn every_material_is_reciprocal() {
    for (k, surface) in all_surfaces().into_iter().enumerate() {
        let material_table = material_table(surface);
        let bsdf = bsdf(&material_table);
        let mut stream = noise(200 + k as u32);
        for i in 0..4000 {
            let mut sample_direction =
                || etendue_core::warp::cosine_hemisphere(Vec2::new(stream.unit_f32(), stream.unit_f32()));
            let (a, mut b) = (sample_direction(), sample_direction());
            let mut n2 = 1.0;
            if i % 2 == 1 {
                (b.z, n2) = (-b.z, eta(&material_table) * eta(&material_table));
            }
            let (there, back) =
                (bsdf.evaluate(a, b).value_cos / b.z.abs() * n2, evaluate_swapped(&material_table, a, b));
            // Near the critical angle Fresnel's equations subtract nearly equal numbers.
            let (digits, minimum) = if b.z > 0.0 { (1e-4, 1e-10) } else { (1e-4, 2e-5) };
            for i in 0..4 {
                assert!((there[i] - back[i]).abs() <= digits * there[i] + minimum, "{k}: {a} {b} {there:?} {back:?}");
            }
        }
    }
}

/// Fraction of light that a surface scatters, to both sides, at each wavelength.
fn albedo(bsdf: &Bsdf<'_, 4>, wo: Vec3) -> Spectral<4> {
    let [reflected, transmitted] = albedos(bsdf, wo);
    reflected + transmitted
}

/// The same for each side: power, so without the change of radiance by refraction.
fn albedos(bsdf: &Bsdf<'_, 4>, wo: Vec3) -> [Spectral<4>; 2] {
    albedos_of::<{ 1 << 17 }>(bsdf, wo)
}

/// By `N` points of a three-dimensional lattice (of the plastic number's family): error below 2e-3 for 2¹⁷ points, 3e-4 for 2²⁰.
fn albedos_of<const N: u32>(bsdf: &Bsdf<'_, 4>, wo: Vec3) -> [Spectral<4>; 2] {
    let eta = if let Bsdf::Dielectric(dielectric) = bsdf { dielectric.eta() } else { 1.0 };
    let mut sums = [[0.0_f64; 4]; 2];
    for i in 0..N {
        let at = |k: f64| (0.5 + k * f64::from(i)).fract() as f32;
        let u = Vec2::new(at(0.819_172_513_396_164_4), at(0.671_043_606_703_789_2));
        if let Some(s) = bsdf.sample(wo, at(0.549_700_477_901_970_3), u) {
            let (side, power) = if s.wi.z > 0.0 { (0, s.weight) } else { (1, s.weight * (eta * eta)) };
            (0..4).for_each(|j| sums[side][j] += f64::from(power[j]));
        }
    }
    sums.map(|sum| Spectral(sum.map(|s| (s / f64::from(N)) as f32)))
}

#[test]
fn nothing_sends_on_more_than_arrives() {
    for (k, surface) in all_surfaces().into_iter().enumerate() {
        let seen_alike = !matches!(surface, Surface::Dielectric(_));
        let material_table = material_table(surface);
        let sides = if seen_alike {
            vec![bsdf(&material_table)]
        } else {
            vec![bsdf(&material_table), from_back(&material_table)]
        };
        for (side, bsdf) in sides.into_iter().enumerate() {
            for degrees in [0.0, 20.0, 40.0, 60.0, 75.0, 85.0, 89.0, 89.9, 89.99] {
                let albedo = albedo(&bsdf, at_degrees(degrees));
                assert!(albedo.is_finite() && albedo.max_value() <= 1.0 + 2e-3, "{k}/{side} at {degrees}: {albedo:?}");
            }
        }
    }
}

#[test]
fn a_smooth_paint_has_saundersons_albedo() {
    // Under a smooth coat, seen along the normal: F + (1 − F)(1 − F_ext) a / (n² (1 − a F_int)) with the textbook's
    // F = 0.04, F_ext = 0.0918, F_int = 0.5963.
    let material_table = material_table(paint(0.5, 1.5, 0.0));
    let expected = 0.04 + 0.96 * (1.0 - 0.0918) * 0.5 / (2.25 * (1.0 - 0.5 * 0.5963));
    let albedo = albedo(&bsdf(&material_table), Vec3::Z)[0];
    assert!((albedo - expected).abs() < 2e-3, "{albedo} {expected}");
}

#[test]
fn a_smooth_metal_mirrors_by_fresnel() {
    let material_table = material_table(metal_of("Al", 0.0));
    let index = metal::by_name("Al").expect("aluminium");
    let sample = bsdf(&material_table).sample(Vec3::Z, 0.0, Vec2::ZERO).expect("a mirror");
    assert!(sample.event == Event::Specular && sample.wi == Vec3::new(-0.0, -0.0, 1.0));
    let (n, k) = (index.n.at(520.0), index.k.at(520.0));
    let expected = ((n - 1.0) * (n - 1.0) + k * k) / ((n + 1.0) * (n + 1.0) + k * k);
    assert!((sample.weight[1] - expected).abs() < 1e-6);
    assert_eq!(bsdf(&material_table).evaluate(Vec3::Z, Vec3::Z), BsdfValue::ZERO);
}

#[test]
fn a_metal_that_is_hardly_rough_reflects_like_a_mirror() {
    for degrees in [0.0, 60.0, 85.0] {
        let (mirror, rough) =
            (material_table(metal_of("Cu", 0.0)), material_table(metal_of("Cu", 2.0 * f64::from(MIRROR_ALPHA))));
        let (a, b) = (albedo(&bsdf(&mirror), at_degrees(degrees)), albedo(&bsdf(&rough), at_degrees(degrees)));
        assert!((a - b).map(f32::abs).max_value() < 1e-3, "{degrees}: {a:?} {b:?}");
    }
}

#[test]
fn extreme_directions_give_numbers() {
    let edges =
        [Vec3::Z, Vec3::new(1.0, 0.0, 1e-7), Vec3::new(0.0, 1.0, 1e-20), Vec3::new(1.0, 0.0, f32::MIN_POSITIVE)];
    for surface in all_surfaces() {
        let material_table = material_table(surface);
        for (bsdf, wo) in
            [bsdf(&material_table), from_back(&material_table)].iter().flat_map(|b| edges.map(|wo| (b, wo)))
        {
            for wi in edges.into_iter().chain([-edges[0], Vec3::new(-1.0, 0.0, 1e-7), Vec3::new(-1.0, 0.0, -1e-7)]) {
                let value = bsdf.evaluate(wo, wi);
                assert!(value.value_cos.is_finite() && value.pdf.is_finite(), "{bsdf:?} {wo} {wi}");
            }
            for u in [0.0, 0.5, 0.999_999_94] {
                let sample = bsdf.sample(wo, u, Vec2::splat(u));
                assert!(sample.is_none_or(|s| s.weight.is_finite() && s.pdf.is_finite() && s.wi.is_finite()));
            }
        }
    }
}
