//! Conversion between tone curves and their form in files.

use etendue_io::photograph::Encoding;
use etendue_isp::{Oecf, SCurve, Table, ToneCurve, ToneError};

/// A tone curve in the form of files.
pub fn encoding(curve: &ToneCurve) -> Encoding {
    match curve {
        ToneCurve::Srgb => Encoding::Srgb,
        ToneCurve::Gamma(1.0) => Encoding::Linear,
        ToneCurve::Gamma(gamma) => Encoding::Gamma(*gamma),
        ToneCurve::SCurve(curve) => Encoding::Contrast { contrast: curve.contrast(), midpoint: curve.midpoint() },
        ToneCurve::Table(table) => Encoding::Table(table.points().to_vec()),
        ToneCurve::Oecf(oecf) => Encoding::Oecf { points: oecf.points(), largest_output: Some(1.0) },
    }
}

/// The tone curve of a file for numbers up to `full_scale`.
///
/// # Errors
/// Its numbers are not a valid curve.
pub fn tone_curve(encoding: &Encoding, full_scale: f64) -> Result<ToneCurve, ToneError> {
    match encoding {
        Encoding::Linear => Ok(ToneCurve::Gamma(1.0)),
        Encoding::Srgb => Ok(ToneCurve::Srgb),
        Encoding::Gamma(gamma) => ToneCurve::gamma(*gamma),
        Encoding::Contrast { contrast, midpoint } => SCurve::new(*contrast, *midpoint).map(ToneCurve::SCurve),
        Encoding::Table(points) => Table::new(points.clone()).map(ToneCurve::Table),
        Encoding::Oecf { points, largest_output } => {
            Oecf::new(points.clone(), largest_output.unwrap_or(full_scale)).map(ToneCurve::Oecf)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_come_back_from_their_statement() {
        let s_curve = SCurve::new(1.5, 0.4).expect("legal");
        let table = Table::new(vec![(0.0, 0.1), (0.5, 0.8), (1.0, 0.9)]).expect("legal");
        for curve in [
            ToneCurve::Srgb,
            ToneCurve::Gamma(1.0),
            ToneCurve::Gamma(2.2),
            ToneCurve::SCurve(s_curve),
            ToneCurve::Table(table),
        ] {
            assert_eq!(tone_curve(&encoding(&curve), 255.0), Ok(curve));
        }
        let oecf = ToneCurve::Oecf(Oecf::new(vec![(2.0, 10.0), (32.0, 200.0)], 255.0).expect("legal"));
        let repeated = tone_curve(&encoding(&oecf), 255.0).expect("legal");
        for y in [0.01, 0.1, 0.4, 0.78] {
            assert!((repeated.decode(y) - oecf.decode(y)).abs() < 1e-6, "{y}");
        }
    }
}
