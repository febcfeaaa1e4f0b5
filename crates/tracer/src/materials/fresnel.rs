//! Reflectance of smooth interfaces for unpolarised light.
//!
//! Exact Fresnel equations (Born & Wolf, *Principles of Optics*, ch. 1.5 and 14.2), light arriving from air or vacuum (index 1) unless stated
//! otherwise. `cos_i` is the cosine of the angle of incidence, in [0, 1]. Polarisation is left out: the mean of both planes is used at every
//! interface.

/// Reflectance of a dielectric of index `n` ≥ 1 seen from outside; 0 for an index of 1.
#[must_use]
pub fn dielectric(cos_i: f32, n: f32) -> f32 {
    let [s, p] = planes(cos_i, n);
    0.5 * (s + p)
}

/// The same for light polarised perpendicular to the plane of incidence, and in it.
#[must_use]
pub fn planes(cos_i: f32, n: f32) -> [f32; 2] {
    if n == 1.0 {
        return [0.0; 2];
    }
    let c = cos_i.clamp(0.0, 1.0);
    let n_cos_t = cos_square(c, n).sqrt();
    // (c − n cos θₜ)/(c + n cos θₜ) and (n² c − n cos θₜ)/(n² c + n cos θₜ), numerator and denominator multiplied by the denominator: the
    // differences, of nearly equal numbers if n is close to 1, become products.
    let (difference, n2) = ((n - 1.0) * (n + 1.0), n * n);
    let (s_sum, p_sum) = (c + n_cos_t, n2 * c + n_cos_t);
    let s = difference / (s_sum * s_sum);
    let p = difference * ((n2 + 1.0) * c * c - 1.0) / (p_sum * p_sum);
    [s * s, p * p]
}

/// The square of n cos θₜ, n² − sin² θ, without loss of digits if n is close to 1; negative beyond the critical angle.
pub(super) fn cos_square(cos_i: f32, n: f32) -> f32 {
    (n - 1.0) * (n + 1.0) + cos_i * cos_i
}

/// Reflectance of an interface into a medium of `eta` times the index of the medium that light comes from; 1 beyond the critical angle.
#[must_use]
pub fn interface(cos_i: f32, eta: f32) -> f32 {
    if eta != 1.0 && cos_square(cos_i, eta) <= 0.0 { 1.0 } else { dielectric(cos_i, eta) }
}

/// Reflectance of a conductor of complex index n + i·k (n² + k² > 0) seen from outside.
#[must_use]
pub fn conductor(cos_i: f32, n: f32, k: f32) -> f32 {
    // At exactly grazing incidence a substance of the index of air would give 0/0: the cosine is kept above 0.
    let c = cos_i.clamp(1e-6, 1.0);
    let (c2, s2) = (c * c, 1.0 - c * c);
    let t = n * n - k * k - s2;
    let sum = (t * t + 4.0 * n * n * k * k).sqrt();
    let a = (0.5 * (sum + t)).max(0.0).sqrt();
    let rs = (sum + c2 - 2.0 * a * c) / (sum + c2 + 2.0 * a * c);
    let (base, cross) = (sum * c2 + s2 * s2, 2.0 * a * c * s2);
    let rp = rs * (base - cross) / (base + cross);
    (0.5 * (rs + rp)).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normal_incidence_has_its_closed_form() {
        for (n, k) in [(0.13, 3.99), (1.0, 6.7), (2.9, 3.1), (0.27, 2.78), (1.5, 0.0)] {
            let expected = ((n - 1.0) * (n - 1.0) + k * k) / ((n + 1.0) * (n + 1.0) + k * k);
            assert!((conductor(1.0, n, k) - expected).abs() < 2e-6, "{n} {k}");
        }
        assert!((dielectric(1.0, 1.5) - 0.04).abs() < 1e-7);
    }

    #[test]
    fn grazing_incidence_reflects_all() {
        assert!((dielectric(0.0, 1.5) - 1.0).abs() < 1e-6);
        assert!((conductor(0.0, 0.2, 3.0) - 1.0).abs() < 1e-4);
    }

    #[test]
    fn a_conductor_without_absorption_is_a_dielectric() {
        for i in 1..=100 {
            let c = i as f32 / 100.0;
            // The conductor's form subtracts nearly equal numbers near Brewster's angle: 1e-6 absolute.
            assert!((conductor(c, 1.5, 0.0) - dielectric(c, 1.5)).abs() < 1e-5, "{c}");
        }
    }

    #[test]
    fn brewsters_angle_extinguishes_one_plane() {
        // tan θ = n; there R = ((n² − 1)/(n² + 1))² / 2.
        let n = 1.5_f32;
        let c = 1.0 / (1.0 + n * n).sqrt();
        let expected = 0.5 * ((n * n - 1.0) / (n * n + 1.0)) * ((n * n - 1.0) / (n * n + 1.0));
        assert!((dielectric(c, n) - expected).abs() < 1e-6);
    }

    #[test]
    fn an_interface_reflects_alike_from_both_sides() {
        for i in 10..=100 {
            let outside = i as f32 / 100.0;
            let inside = (1.0 - (1.0 - outside * outside) / (1.5 * 1.5)).sqrt();
            let (there, back) = (interface(outside, 1.5), interface(inside, 1.0 / 1.5));
            // The cosine inside is rounded by 6e-8: 1e-6 of the one outside at 0.1, where the slope is 5.
            assert!((there - back).abs() < 1e-5, "{outside}: {there} {back}");
        }
        assert_eq!((interface(0.74, 1.0 / 1.5), interface(0.0, 1.5)), (1.0, 1.0), "critical cosine 0.7454");
    }

    #[test]
    fn no_index_gives_a_number_outside_zero_to_one() {
        for i in 0..=50 {
            for (n, k) in [(1.0, 0.0), (1e-3, 1e-3), (0.05, 20.0), (10.0, 0.0), (1.0, 1e-4)] {
                let r = conductor(i as f32 / 50.0, n, k);
                assert!((0.0..=1.0).contains(&r), "{i} {n} {k}: {r}");
            }
        }
    }
}
