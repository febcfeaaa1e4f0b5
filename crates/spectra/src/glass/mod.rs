//! Optical glasses: the refractive index as a smooth function of wavelength, in double precision.
//!
//! **Relative to air.** Catalogues state n relative to air at about 20 °C and 1 atm. A lens in air therefore has index 1 around it. Air's own
//! dispersion (3e-7 over the visible), temperature, pressure and absorption are left out.
//!
//! λ in µm:
//!
//! | form | equation | for |
//! | --- | --- | --- |
//! | [`Dispersion::Sellmeier`] | n² = 1 + Σ Bᵢ λ²/(λ² − Cᵢ) | catalogue glasses (Sellmeier 1871; Schott TIE-29) |
//! | [`Dispersion::Cauchy`] | n = A + B/λ² + C/λ⁴ | Cauchy 1836 |
//! | [`Dispersion::Conrady`] | n = A + B/λ + C/λ³·⁵ | Conrady 1929 |
//! | [`Dispersion::Series`] | n² = A + Σ Bᵢ λ²/(λ² − Cᵢ) + Σ aₖ λ²ᵏ | formulas of Zemax glass catalogues ([`agf`]) |
//! | [`Dispersion::Herzberger`] | n = A + B L + C L² + D λ² + E λ⁴ + F λ⁶, L = 1/(λ² − 0.028) | Herzberger 1959 |
//!
//! A glass given only by index and Abbe number ([`Dispersion::from_abbe`]) is a Conrady curve through n_d, with n_F − n_C = (n_d − 1)/V_d and the
//! partial dispersion of Schott's normal line, (n_g − n_F)/(n_F − n_C) = 0.6438 − 0.001682 V_d (Schott TIE-29). Ordinary glasses obey this third
//! condition to 1 %; fluor crowns and short flints deviate from it by design.

pub mod agf;
mod catalogue;
mod dispersion;
mod series;

pub use catalogue::{CatalogueGlass, GlassMatch, built_in, by_name, by_number, find, find_first, plain, successor};
pub use dispersion::{Dispersion, GlassError, LINE_C_NM, LINE_D_NM, LINE_F_NM, LINE_G_NM};
pub use series::DispersionSeries;

#[cfg(test)]
mod tests {
    use super::*;

    fn glass(name: &str) -> Dispersion {
        by_name(name).expect("a name of the catalogue").dispersion
    }

    #[test]
    fn catalogue_glasses_have_their_makers_index_and_abbe_number() {
        // Data sheets: n_d to 5 decimals, V_d to 2 (half a unit of the last place, and the fit's own 5e-6).
        for (name, n, v) in [("N-BK7", 1.516_80, 64.17), ("N-SF6", 1.805_18, 25.36), ("S-LAH58", 1.882_997, 40.76)] {
            assert!((glass(name).index(LINE_D_NM) - n).abs() < 1e-5, "{name} {}", glass(name).index(LINE_D_NM));
            assert!((glass(name).abbe() - v).abs() < 0.01, "{name} {}", glass(name).abbe());
        }
        assert_eq!(by_name("n-bk7").map(|g| g.name), Ok("N-BK7"), "capitals do not matter");
    }

    #[test]
    fn every_catalogue_glass_is_clear_and_disperses_normally() {
        for glass in built_in() {
            assert!(glass.dispersion.checked().is_ok(), "{}", glass.name);
            assert!(glass.dispersion.abbe() > 15.0 && glass.dispersion.disperses(), "{}", glass.name);
        }
    }

    #[test]
    fn index_and_abbe_number_give_a_curve_that_has_both() {
        for (n, v) in [(1.517, 64.2), (1.805, 25.4), (1.497, 81.6), (1.62, 36.3)] {
            let curve = Dispersion::from_abbe(n, v).expect("a glass");
            // Rounding of the two linear equations.
            assert!((curve.index(LINE_D_NM) - n).abs() < 1e-14);
            assert!((curve.abbe() / v - 1.0).abs() < 1e-12, "{}", curve.abbe());
        }
    }

    #[test]
    fn the_curve_of_an_abbe_number_follows_the_real_glass() {
        // Accuracy of the model over 400–700 nm: the root mean square over the whole catalogue, and the worst glass on the normal line.
        let (mut sum, mut count, mut worst) = (0.0, 0.0, 0.0_f64);
        for glass in built_in().iter().filter(|glass| ["schott", "ohara"].contains(&glass.maker)).take(378) {
            let real = glass.dispersion;
            let model = Dispersion::from_abbe(real.index(LINE_D_NM), real.abbe()).expect("a glass");
            for nm in (400..=700).step_by(10).map(f64::from) {
                let error = model.index(nm) - real.index(nm);
                sum += error * error;
                count += 1.0;
                if ["N-BK7", "F2"].contains(&glass.name) {
                    worst = worst.max(error.abs());
                }
            }
        }
        let rms = f64::sqrt(sum / count);
        assert!(rms < 4e-4, "{rms}");
        assert!(worst < 2e-4, "K7 and F2 define the normal line: {worst}");
    }

    #[test]
    fn other_forms_are_their_equations() {
        let cauchy = Dispersion::Cauchy { a: 1.5, b_um2: 0.004, c_um4: 1e-4 };
        assert!((cauchy.index(500.0) - (1.5 + 0.016 + 0.0016)).abs() < 1e-15);
        let conrady = Dispersion::Conrady { a: 1.5, b_um: 0.01, c_um35: 3e-4 };
        assert!((conrady.index(250.0) - (1.5 + 0.04 + 3e-4 * 128.0)).abs() < 1e-14);
        assert_eq!(Dispersion::AIR.index(400.0), 1.0);
    }

    #[test]
    fn faults_say_what_to_do() {
        let unknown = by_name("BK7X").expect_err("no such glass").to_string();
        assert!(unknown.starts_with("no glass is called `BK7X`; give a name"), "{unknown}");
        let old = by_name("LAK8").expect_err("an old name").to_string();
        assert!(old.contains("(similar: N-LAK8"), "{old}");
        assert!(Dispersion::from_abbe(0.9, 50.0).is_err() && Dispersion::from_abbe(1.5, f64::NAN).is_err());
        let in_nm = Dispersion::Cauchy { a: 1.5, b_um2: 4000.0, c_um4: 0.0 }.checked().expect_err("unit").to_string();
        assert!(in_nm.contains("check the coefficients' unit"), "{in_nm}");
    }
}
