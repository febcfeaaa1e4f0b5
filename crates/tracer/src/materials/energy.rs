//! Energy: albedos of surfaces, and the refusal of surfaces that reflect more than arrives.
//!
//! The albedo (directional-hemispherical reflectance) of a lobe is tabulated over the incidence when a material is built: E(θ) = ∫ f(θ, ωᵢ) cos θᵢ
//! dωᵢ. A material's albedo at a wavelength is the sum of its lobes' tables, each times its spectrum; it is checked at every node of the tables and
//! at every nanometre.

use etendue_spectra::Spectrum;

use super::{error::EnergyGain, parameter::Reflectance, slopes::GAUSS};

/// Segments of the tables of albedos.
const SEGMENTS: usize = 128;

/// Maximum albedo: a margin for rounding, and for the error of the quadratures behind the tables.
const MAX_ALBEDO: f64 = 1.0 + 5e-4;

/// A function of the cosine of incidence, at cosines (i/N)⁴, i = 0 ..= N: dense towards grazing, where surfaces of roughness α curve at
/// cosines of α.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct CosineTable<const N: usize>(Box<[f32]>);

/// A lobe's albedo.
pub(super) type AlbedoTable = CosineTable<SEGMENTS>;

impl<const N: usize> CosineTable<N> {
    pub(super) fn new(of_cos: impl Fn(f32) -> f64) -> Self {
        Self((0..=N).map(|i| of_cos(node_cos(i, N)) as f32).collect())
    }

    /// The value at a cosine of incidence.
    pub(super) fn at(&self, cos: f32) -> f32 {
        let x = cos.clamp(0.0, 1.0).sqrt().sqrt() * N as f32;
        let i = (x as usize).min(N - 1);
        self.0[i] + (self.0[i + 1] - self.0[i]) * (x - i as f32)
    }

    pub(super) fn max_value(&self) -> f32 {
        self.0.iter().copied().fold(0.0, f32::max)
    }

    /// 2 ∫ E μ dμ = 8 ∫ E t⁷ dt with μ = t⁴: the mean under uniform light. Exact for the piecewise linear function of t.
    pub(super) fn mean(&self) -> f32 {
        let segment = |i: usize| -> f64 {
            let (low, high) = (f64::from(self.0[i]), f64::from(self.0[i + 1]));
            let point = |x: f64| {
                let t = (i as f64 + x) / N as f64;
                let cube = t * t * t;
                (low + (high - low) * x) * cube * cube * t
            };
            GAUSS.iter().map(|(x, w)| w * point(*x)).sum()
        };
        (8.0 / N as f64 * (0..N).map(segment).sum::<f64>()) as f32
    }
}

fn node_cos(i: usize, segments: usize) -> f32 {
    let t = i as f32 / segments as f32;
    (t * t) * (t * t)
}

/// A lobe and its weight.
#[derive(Clone, Copy)]
pub(super) struct WeightedLobe<'a> {
    pub(super) weight: &'a Spectrum,
    /// Albedo at the weight 1.
    pub(super) albedo: &'a AlbedoTable,
}

/// Refuses a surface of diffuse reflectance `base` and lobes (spectrum, albedo at spectrum 1) that gains energy anywhere.
pub(super) fn check(base: &Spectrum, lobes: &[WeightedLobe<'_>]) -> Result<(), EnergyGain> {
    let maximum =
        (0..=SEGMENTS).map(|i| max_gain(base, lobes, i)).reduce(|a, b| if b.albedo > a.albedo { b } else { a });
    match maximum {
        Some(gain) if gain.albedo > MAX_ALBEDO => Err(gain),
        _ => Ok(()),
    }
}

fn max_gain(base: &Spectrum, lobes: &[WeightedLobe<'_>], node: usize) -> EnergyGain {
    let albedo = |k: usize| -> f64 {
        let lobe = |lobe: &WeightedLobe<'_>| f64::from(lobe.weight.nodes()[k] * lobe.albedo.0[node]);
        f64::from(base.nodes()[k]) + lobes.iter().map(lobe).sum::<f64>()
    };
    let (k, albedo) = (0..base.nodes().len())
        .map(|k| (k, albedo(k)))
        .fold((0, f64::NEG_INFINITY), |best, next| if next.1 > best.1 { next } else { best });
    let incidence_deg = f64::from(etendue_core::maths::f32::acos(node_cos(node, SEGMENTS)).to_degrees());
    EnergyGain { albedo, incidence_deg, wavelength_nm: 300 + k as u16 }
}

/// A reflectance's spectrum; black for a texture, whose range the material_table checks when it has the images.
pub(super) fn known(reflectance: &Reflectance) -> Spectrum {
    match reflectance {
        Reflectance::Spectrum(spectrum) => spectrum.clone(),
        Reflectance::Texture(_) => Spectrum::constant(0.0),
    }
}

/// True if every value of a spectrum is a number of 0 or more.
pub(super) fn is_weight(spectrum: &Spectrum) -> bool {
    spectrum.nodes().iter().all(|v| v.is_finite() && *v >= 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_hold_their_nodes_and_follow_between() {
        let table = AlbedoTable::new(|cos| f64::from(1.0 - cos * cos));
        assert_eq!((table.at(0.0), table.at(1.0), table.max_value()), (1.0, 0.0, 1.0));
        // 2 ∫ (1 − μ²) μ dμ = 1/2.
        assert!((table.mean() - 0.5).abs() < 4e-4, "{}", table.mean());
        // The piecewise linear function errs by h²/8 · f'' (t⁸ has 56) at h = 1/128: 4.3e-4 at most.
        assert!((table.at(0.3) - 0.91).abs() < 4.3e-4);
    }

    #[test]
    fn a_gain_is_found_where_it_is() {
        let base =
            Spectrum::from_points(&[(400.0, 0.2), (600.0, 0.6)], etendue_spectra::Extrapolation::Hold).expect("points");
        let table = AlbedoTable::new(|cos| f64::from(1.0 - cos));
        assert_eq!(check(&base, &[WeightedLobe { weight: &Spectrum::constant(0.4), albedo: &table }]), Ok(()));
        let gain =
            check(&base, &[WeightedLobe { weight: &Spectrum::constant(0.5), albedo: &table }]).expect_err("it gains");
        assert_eq!((gain.wavelength_nm, gain.incidence_deg), (600, 90.0));
        assert!((gain.albedo - 1.1).abs() < 1e-6);
        assert!(gain.to_string().contains("90.0°") && gain.to_string().contains("0.9091"), "{gain}");
    }
}
