//! Private catalogues of CODE V files.
//!
//! ```text
//! PRV
//!   PWL 656.27 587.56 486.13
//!   'MINE' 1.514 1.5168 1.522
//! END
//! ```
//!
//! PWL gives wavelengths in nm; a line below it gives a glass with its index at each. The glass becomes one of n_d and V_d: those of Cauchy's n = A + B/λ² (+
//! C/λ⁴) through its first, middle and last index; one index is a medium without dispersion.

use etendue_scene::asset::GlassAsset;
use etendue_spectra::glass::{Dispersion, LINE_D_NM};

use super::text::Words;
use crate::Error;

/// Private glasses of a file, as far as it is read.
#[derive(Default)]
pub(super) struct PrivateGlasses {
    inside: bool,
    wavelengths_nm: Vec<f64>,
    list: Vec<(String, GlassAsset)>,
}

impl PrivateGlasses {
    /// Handles a command of a private catalogue; returns false for others.
    pub(super) fn reads(&mut self, w: &Words<'_>) -> Result<bool, Error> {
        match w.word(0).to_ascii_uppercase().as_str() {
            "PRV" => self.inside = true,
            _ if !self.inside => return Ok(false),
            "END" => self.inside = false,
            "PWL" => self.wavelengths_nm = w.numbers(1)?,
            _ => {
                let glass = self.glass(w)?;
                self.list.push((plain(w.word(0)), glass));
            }
        }
        Ok(true)
    }

    pub(super) fn find(&self, name: &str) -> Option<GlassAsset> {
        self.list.iter().find(|(known, _)| *known == plain(name)).map(|(_, glass)| glass.clone())
    }

    fn glass(&self, w: &Words<'_>) -> Result<GlassAsset, Error> {
        let indices = w.numbers(1)?;
        if indices.is_empty() || indices.len() != self.wavelengths_nm.len() {
            let (actual, expected) = (indices.len(), self.wavelengths_nm.len());
            return Err(w.error(format!(
                "the private glass has {actual} of {expected} indices; expected one for each wavelength of PWL"
            )));
        }
        let points = self.wavelengths_nm.iter().zip(indices).map(|(nm, index)| IndexSample { nm: *nm, index });
        let points: Vec<IndexSample> = points.collect();
        let (first, middle, last) = (points[0], points[points.len() / 2], points[points.len() - 1]);
        let curve = cauchy(first, middle, last).filter(|curve| points.len() > 1 && curve.abbe() > 0.0);
        Ok(curve.map_or(GlassAsset::Index(middle.index), |c| GlassAsset::Abbe {
            index: c.index(LINE_D_NM),
            abbe: c.abbe(),
        }))
    }
}

fn plain(name: &str) -> String {
    name.trim_matches(['\'', '"']).to_ascii_uppercase()
}

/// Refractive index at a wavelength.
#[derive(Clone, Copy, PartialEq)]
struct IndexSample {
    nm: f64,
    index: f64,
}

/// Cauchy's curve through three points, or through two if the middle one is an end.
fn cauchy(a: IndexSample, m: IndexSample, b: IndexSample) -> Option<Dispersion> {
    let x = |point: IndexSample| 1e6 / (point.nm * point.nm);
    let slope = |p: IndexSample, q: IndexSample| (q.index - p.index) / (x(q) - x(p));
    let bend = if m == a || m == b { 0.0 } else { (slope(m, b) - slope(a, m)) / (x(b) - x(a)) };
    let linear = slope(a, b) - bend * (x(a) + x(b));
    let curve = Dispersion::Cauchy { a: a.index - linear * x(a) - bend * x(a) * x(a), b_um2: linear, c_um4: bend };
    (a != b && linear.is_finite()).then_some(curve)
}
