//! From mean electrons to a raw picture, frame after frame.

use crate::effects::converter::Converter;
use crate::effects::{self, ChargeEffect, Row};
use crate::sensor::Sensor;
use etendue_core::Plane;
use etendue_core::quantity::{DigitalNumber, Electrons};
use etendue_core::random::{NoiseDraw, NoiseStream, Pixel};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// The part of a random address that a raw picture's pixels share.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameAddress {
    /// The job's seed.
    pub seed: u64,
    /// The camera's place in the job.
    pub camera: u32,
    /// The frame.
    pub frame: u32,
    /// The capture within the frame.
    pub capture: u32,
}

impl FrameAddress {
    /// The random words of one draw of one pixel.
    pub(crate) fn stream(&self, x: usize, y: u32, draw: NoiseDraw) -> NoiseStream {
        NoiseStream::new(self.seed, self.camera, self.frame, self.capture, Pixel { x: x as u32, y }, draw)
    }
}

/// What a sensor remembers from frame to frame: nothing yet. Effects with memory (lag, exposure control, telegraph noise)
/// will live here; the fold already passes it on.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SensorState {}

/// A raw picture, with what development needs to know.
#[derive(Clone, Debug, PartialEq)]
pub struct Raw {
    /// Digital numbers.
    pub plane: Plane<DigitalNumber>,
    /// Digital number of no charge.
    pub black_level_dn: f64,
    /// Digital number of a saturated pixel.
    pub white_level_dn: f64,
    /// Bits of the converter.
    pub bits: u32,
    /// Pixels whose mean electrons were not a number, infinite or negative, in raster order. Their digital number is 0,
    /// and means nothing.
    pub invalid: Vec<Pixel>,
}

impl Sensor {
    /// One frame: the raw picture that `mean_electrons` (of photons) become, and the state for the next frame.
    ///
    /// Rows run in the rayon pool of the caller; the bits depend on `address` and the means alone.
    #[must_use]
    pub fn step(
        &self,
        state: SensorState,
        mean_electrons: &Plane<Electrons>,
        address: FrameAddress,
    ) -> (SensorState, Raw) {
        let (charge, converter) = effects::chain(self.parameters());
        let width = mean_electrons.width();
        let mut plane = Plane::new(width, mean_electrons.height());
        if width > 0 {
            let rows = plane.samples_mut().par_chunks_mut(width).zip(mean_electrons.samples().par_chunks(width));
            rows.enumerate().for_each_init(
                || vec![0.0; width],
                |buffer, (y, (dn, means))| {
                    expose_row(&charge, &converter, Row { address, y: y as u32 }, means, buffer, dn);
                },
            );
        }
        (state, self.raw(plane, invalid_pixels(mean_electrons)))
    }

    fn raw(&self, plane: Plane<DigitalNumber>, invalid: Vec<Pixel>) -> Raw {
        let p = self.parameters();
        let white_level_dn = self.white_level_dn();
        Raw { plane, black_level_dn: p.black_level_dn, white_level_dn, bits: p.bits, invalid }
    }
}

/// Whether a mean can be a mean of electrons.
fn is_valid(mean: f32) -> bool {
    mean.is_finite() && mean >= 0.0
}

fn expose_row(
    charge: &[ChargeEffect],
    converter: &Converter,
    row: Row,
    means: &[f32],
    electrons: &mut [f64],
    dn: &mut [u32],
) {
    for (e, mean) in electrons.iter_mut().zip(means) {
        *e = if is_valid(*mean) { f64::from(*mean) } else { 0.0 };
    }
    for effect in charge {
        effect.apply(electrons, row);
    }
    for ((dn, e), mean) in dn.iter_mut().zip(electrons).zip(means) {
        *dn = if is_valid(*mean) { converter.digital_number(*e) } else { 0 };
    }
}

fn invalid_pixels(means: &Plane<Electrons>) -> Vec<Pixel> {
    let width = means.width();
    let wrong = means.samples().iter().enumerate().filter(|(_, m)| !is_valid(**m));
    wrong.map(|(i, _)| Pixel { x: (i % width) as u32, y: (i / width) as u32 }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sensor::SensorParameters;
    use crate::sensor::tests::ideal;
    use etendue_stats::Moments;

    const ADDRESS: FrameAddress = FrameAddress { seed: 5, camera: 1, frame: 2, capture: 0 };

    fn expose(p: SensorParameters, mean: f32, size: usize) -> Raw {
        let sensor = Sensor::new(p).expect("legal");
        sensor.step(SensorState::default(), &Plane::filled(size, size, mean), ADDRESS).1
    }

    fn moments(raw: &Raw) -> Moments {
        Moments::of(raw.plane.samples().iter().map(|dn| f64::from(*dn) - raw.black_level_dn))
    }

    #[test]
    fn signal_to_noise_is_that_of_emva_1288() {
        for (mean, want) in [(100.0, 8.897), (1000.0, 31.21), (10_000.0, 99.87)] {
            let m = moments(&expose(ideal(), mean, 512));
            let snr = m.mean() / m.variance().expect("many").sqrt();
            // A standard deviation of 512² numbers is known to 1/√(2n) = 0.14 %; four of those.
            assert!((snr / want - 1.0).abs() < 0.0055, "{mean}: {snr}");
        }
    }

    #[test]
    fn the_photon_transfer_curve_gives_the_gain_back() {
        // Slope of variance over mean by least squares, weights 1/variance² (the variance of s² is 2σ⁴/n).
        let points: Vec<(f64, f64)> = [0.0_f32, 2000.0, 8000.0, 20_000.0, 40_000.0]
            .into_iter()
            .map(|mean| moments(&expose(ideal(), mean, 256)))
            .map(|m| (m.mean(), m.variance().expect("many")))
            .collect();
        let sum = |f: &dyn Fn(f64, f64) -> f64| points.iter().map(|(m, v)| f(*m, *v) / (v * v)).sum::<f64>();
        let (w, x, y) = (sum(&|_, _| 1.0), sum(&|m, _| m), sum(&|_, v| v));
        let (xx, xy) = (sum(&|m, _| m * m), sum(&|m, v| m * v));
        let determinant = w * xx - x * x;
        let slope = (w * xy - x * y) / determinant;
        let dark_variance = (xx * y - x * xy) / determinant;
        let standard_error = (w / determinant * 2.0 / 65_536.0).sqrt();
        assert!((slope - 0.25).abs() < 4.0 * standard_error && standard_error < 1e-3, "{slope} ± {standard_error}");
        // K²σ² + 1/12 = 1.646; its standard error is that of s² at the dark point, 0.55 %.
        assert!((dark_variance / (0.0625 * 25.0 + 1.0 / 12.0) - 1.0).abs() < 4.0 * 0.0056, "{dark_variance}");
    }

    #[test]
    fn dark_current_has_its_own_shot_noise() {
        let mut p = ideal();
        (p.dark_current_e_s, p.exposure_s, p.read_noise_e, p.gain_dn_e) = (400.0, 0.1, 0.0, 1.0);
        let m = moments(&expose(p, 0.0, 512));
        assert!((m.mean() - 40.0).abs() < 4.0 * (40.0_f64 / 262_144.0).sqrt());
        assert!((m.variance().expect("many") / 40.0 - 1.0).abs() < 4.0 * (2.03_f64 / 262_144.0).sqrt());
    }

    #[test]
    fn without_noise_a_picture_is_its_mean() {
        let mut p = ideal();
        (p.noise, p.dark_current_e_s) = (false, 400.0);
        assert!(expose(p.clone(), 100.0, 8).plane.samples().iter().all(|dn| *dn == 126));
        assert!(expose(p, 1e9, 8).plane.samples().iter().all(|dn| *dn == 15_100));
    }

    #[test]
    fn the_well_clips_before_the_read_noise() {
        let raw = expose(ideal(), 1e6, 128);
        let m = moments(&raw);
        assert!((m.mean() - 15_000.0).abs() < 0.1);
        // Only K²σ² + 1/12 is left.
        assert!((m.variance().expect("many") / 1.6458 - 1.0).abs() < 0.05);
    }

    #[test]
    fn extremes_have_an_answer() {
        let dn = |p: SensorParameters, mean| expose(p, mean, 16).plane.samples().to_vec();
        let mut zero = ideal();
        zero.exposure_s = 0.0;
        assert!(dn(zero, 0.0).iter().all(|dn| (90..=110).contains(dn)));
        let mut one = ideal();
        (one.full_well_e, one.read_noise_e, one.gain_dn_e) = (1.0, 0.0, 1.0);
        assert!(dn(one.clone(), 0.7).iter().all(|dn| *dn == 100 || *dn == 101));
        assert!(dn(one, 1e12).iter().all(|dn| *dn == 101));
        let mut long = ideal();
        (long.exposure_s, long.dark_current_e_s) = (1e6, 1e9);
        assert!(dn(long, 3e38).iter().all(|dn| (15_080..=15_120).contains(dn)));
    }

    #[test]
    fn means_that_are_none_are_counted_and_harm_no_neighbour() {
        let sensor = Sensor::new(ideal()).expect("legal");
        let mut means = Plane::filled(4, 3, 500.0_f32);
        let clean = sensor.step(SensorState::default(), &means, ADDRESS).1;
        for (x, y, mean) in [(1, 0, f32::NAN), (3, 1, f32::INFINITY), (0, 2, -1.0)] {
            means.set(x, y, mean);
        }
        let raw = sensor.step(SensorState::default(), &means, ADDRESS).1;
        assert_eq!(raw.invalid, [(1, 0), (3, 1), (0, 2)].map(|(x, y)| Pixel { x, y }));
        for (i, (a, b)) in raw.plane.samples().iter().zip(clean.plane.samples()).enumerate() {
            assert_eq!(*a, if [1, 7, 8].contains(&i) { 0 } else { *b });
        }
    }

    #[test]
    fn threads_change_no_bit_and_addresses_change_all() {
        let mut p = ideal();
        p.dark_current_e_s = 50.0;
        let sensor = Sensor::new(p).expect("legal");
        let means = Plane::from_samples(97, 61, (0..97 * 61).map(|i| (i * 7 % 5000) as f32).collect()).expect("filled");
        let with = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
            pool.install(|| sensor.step(SensorState::default(), &means, ADDRESS).1)
        };
        assert_eq!(with(1), with(3));
        let other = sensor.step(SensorState::default(), &means, FrameAddress { frame: 3, ..ADDRESS }).1;
        let same = other.plane.samples().iter().zip(with(1).plane.samples()).filter(|(a, b)| a == b).count();
        assert!(same < means.samples().len() / 5, "{same} pixels alike");
    }

    #[test]
    fn bits_are_pinned() {
        let mut p = ideal();
        p.dark_current_e_s = 700.0;
        let raw = expose(p, 1234.0, 3);
        assert_eq!(raw.plane.samples(), PINNED, "changed bits change every raw picture: is it meant?");
    }

    const PINNED: [u32; 9] = [404, 399, 400, 400, 408, 417, 416, 418, 421];
}
