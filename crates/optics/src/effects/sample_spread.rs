//! A narrow point spread without the film's lattice: each sample's position on the sensor is displaced by a random offset from the spread's core.
//!
//! The light at x of the sensor is ∫ P(u) E(x − u) du: a sample at x looks along the ray of x − u, u sampled from P. This is exact for any width of
//! P, whereas a kernel on whole pixels must choose between too little contrast and negative light (`band.rs`). The wavelengths of a path share its
//! position. It is sampled from the density of one of them, and each is weighted by its own density over the mean of all of them (the balance
//! heuristic, Veach 1997, eq. 9.8). The weights sum to the number of wavelengths, so light over the whole spectrum has no added noise. Narrow bands
//! of uniform illumination have some if the spread is wider for longer wavelengths: for diffraction about 0.37 of a band's light, divided by the root
//! of the samples per pixel. If the spread is the same for all wavelengths, the weights are 1.
//!
//! Sampling adds noise to the light near a bright source, so only a core of 2.5 px is sampled: the rest, smooth and faint, is applied by the film
//! ([`FilmPart::Tails`](super::FilmPart)).
//!
//! If the function varies over the image, a pixel selects a patch at random, with the weights that the film's pixels use.

use etendue_core::random::Pixel;
use glam::DVec2;

use super::{core_table::CoreTable, patches::PatchWeights};

/// Random numbers of a displacement, in [0, 1).
#[derive(Clone, Copy, Debug)]
pub struct SpreadRandomNumbers {
    /// Selects the wavelength and the patch.
    pub choice: f64,
    /// Selects the position.
    pub place: DVec2,
}

/// The cores over a film.
#[derive(Clone, Debug)]
pub struct SampleSpread {
    low_nm: f64,
    step_nm: f64,
    /// Columns of patches; one, without weights, if the function is uniform.
    columns: Vec<PatchWeights>,
    rows: Vec<PatchWeights>,
    /// Tables of each patch, row by row, by wavelength.
    tables: Vec<Vec<CoreTable>>,
}

impl SampleSpread {
    /// Creates the cores from the patches' tables, row by row; the wavelengths of each are in equal steps of `step_nm` from `low_nm` on.
    pub(super) fn new(
        [columns, rows]: [Vec<PatchWeights>; 2],
        low_nm: f64,
        step_nm: f64,
        tables: Vec<Vec<CoreTable>>,
    ) -> Self {
        Self { low_nm, step_nm, columns, rows, tables }
    }

    /// The offset of the sample's light from a pixel (of the film), px; and the weights of the path's wavelengths.
    #[must_use]
    pub fn sample_offset<const N: usize>(
        &self,
        pixel: Pixel,
        wavelengths_nm: &[f32; N],
        random: SpreadRandomNumbers,
    ) -> (DVec2, [f32; N]) {
        let choice = random.choice * N as f64;
        let chosen = (choice as usize).min(N - 1);
        let tables = &self.tables[self.patch(pixel, choice - chosen as f64)];
        let of = wavelengths_nm.map(|nm| &tables[self.index(f64::from(nm)).min(tables.len() - 1)]);
        let offset_px = of[chosen].sample_offset(random.place);
        if tables.len() == 1 {
            return (offset_px, [1.0; N]);
        }
        let densities = of.map(|table| table.density(offset_px));
        let mean = densities.iter().sum::<f64>() / N as f64;
        (offset_px, densities.map(|density| if mean > 0.0 { (density / mean) as f32 } else { 1.0 }))
    }

    fn index(&self, nm: f64) -> usize {
        ((nm - self.low_nm) / self.step_nm).max(0.0) as usize
    }

    fn patch(&self, pixel: Pixel, u: f64) -> usize {
        if self.tables.len() == 1 {
            return 0;
        }
        let (column, u) = choose(&self.columns, pixel.x as usize, u);
        let (row, _) = choose(&self.rows, pixel.y as usize, u);
        row * self.columns.len() + column
    }
}

/// Selects one of the patches of a pixel's column or row by its weight there; returns the rescaled `u`.
fn choose(hats: &[PatchWeights], at: usize, u: f64) -> (usize, f64) {
    let mut left = u;
    let mut last = (0, 0.0);
    for (index, weight) in hats.iter().map(|hat| hat.weight(at)).enumerate().filter(|(_, weight)| *weight > 0.0) {
        if left < weight {
            return (index, left / weight);
        }
        left -= weight;
        last = (index, 1.0 - f64::EPSILON);
    }
    last
}
