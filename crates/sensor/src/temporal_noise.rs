//! How much the number of a pixel fluctuates from frame to frame under steady light: shot noise of light and dark current, read
//! noise and quantisation (EMVA 1288, equation 10), in the electrons of the described exposure. Fixed patterns, blinking pixels
//! and what a sensor remembers of earlier frames are no part of it.

use crate::parameters::SensorParameters;
use crate::reading::{Reading, readings};
use crate::sensor::Sensor;
use crate::state::OperatingPoint;

/// The noise of one frame by the mean signal of a pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct TemporalNoise {
    /// Those of a frame, the most sensitive first.
    captures: Vec<CaptureNoise>,
    exposure_s: f64,
    counts: bool,
}

/// A capture as far as its noise goes.
#[derive(Clone, Copy, Debug, PartialEq)]
struct CaptureNoise {
    /// What it has of the described exposure's light.
    light: f64,
    /// Wells that are read together.
    wells: f64,
    /// Variance of all but the signal's shot noise, e⁻² of its own, at the signal 0.
    dark_e2: f64,
    /// Signal of a pixel up to which it is read, e⁻ of the described exposure: to white, or to the switch to the next one.
    up_to_e: f64,
}

impl Sensor {
    /// The noise of a frame as described; under exposure control that of the longest exposure and the largest gain, which is the
    /// least beside the light, and which no light saturates.
    #[must_use]
    pub fn temporal_noise(&self) -> TemporalNoise {
        let p = self.parameters();
        let point = most_sensitive(p);
        let wells = p.wells_read();
        let controlled = p.exposure.control.is_some();
        let of = |(reading, fraction): (&Reading<'_>, f64)| CaptureNoise {
            light: reading.light,
            wells,
            dark_e2: if p.noise { reading.dark_variance_e2(0.0) } else { reading.quantisation_e2() },
            up_to_e: if controlled { f64::INFINITY } else { reading.signal_e(fraction) / wells },
        };
        let readings = readings(p, point);
        let switches = std::iter::repeat_n(p.hdr.switch(), readings.len() - 1).chain([1.0]);
        let captures = readings.iter().zip(switches).map(of).collect();
        TemporalNoise { captures, exposure_s: p.exposure.exposure_s, counts: p.noise }
    }
}

fn most_sensitive(p: &SensorParameters) -> OperatingPoint {
    let described = p.described_point();
    p.exposure.control.map_or(described, |control| OperatingPoint {
        exposure_s: control.exposure_s[1],
        analogue_gain: control.analogue_gain[1],
    })
}

impl TemporalNoise {
    /// That of one capture of `exposure_s` with photon noise and a constant variance (e⁻²), white at `white_e` electrons.
    #[must_use]
    pub fn of_one_capture(exposure_s: f64, dark_e2: f64, white_e: f64) -> Self {
        Self {
            captures: vec![CaptureNoise { light: 1.0, wells: 1.0, dark_e2, up_to_e: white_e }],
            exposure_s,
            counts: true,
        }
    }

    /// The same of a sensor that no light saturates.
    #[must_use]
    pub fn never_white(mut self) -> Self {
        self.captures.iter_mut().for_each(|capture| capture.up_to_e = f64::INFINITY);
        self
    }

    /// Variance of the signal of a pixel of `mean_e` electrons of the described exposure (below 0: as 0), e⁻² of that exposure: that
    /// of the capture that is read there. Of pixels that are read together each has its share.
    #[must_use]
    pub fn variance_e2(&self, mean_e: f64) -> f64 {
        let mean_e = mean_e.max(0.0);
        let capture = self.captures.iter().find(|capture| mean_e < capture.up_to_e).or(self.captures.last());
        capture.map_or(0.0, |c| {
            let shot_e2 = if self.counts { mean_e * c.light } else { 0.0 };
            (shot_e2 + c.dark_e2 / c.wells) / (c.light * c.light)
        })
    }

    /// The signal of a pixel, e⁻ of the described exposure, from which on every capture is white.
    #[must_use]
    pub fn white_e(&self) -> f64 {
        self.captures.last().map_or(0.0, |capture| capture.up_to_e)
    }

    /// The described exposure, s.
    #[must_use]
    pub fn exposure_s(&self) -> f64 {
        self.exposure_s
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hdr::Capture;
    use crate::parameters::tests::ideal;

    #[test]
    fn one_capture_has_shot_read_and_quantisation_noise() {
        // 5 e⁻ of read noise and a quantisation of 16/12; white at 60 000 e⁻.
        let noise = Sensor::new(ideal()).expect("legal").temporal_noise();
        for mean_e in [0.0, 1.0, 500.0, 59_000.0] {
            assert!((noise.variance_e2(mean_e) - (mean_e + 25.0 + 16.0 / 12.0)).abs() < 1e-9);
        }
        assert!((noise.white_e() - 60_000.0).abs() < 1e-6 && noise.variance_e2(-3.0) == noise.variance_e2(0.0));
    }

    #[test]
    fn a_short_capture_is_noisier_in_the_light_of_the_first() {
        let mut p = ideal();
        p.hdr.captures = vec![Capture { exposure_ratio: 1.0 / 16.0, ..Capture::default() }];
        p.hdr.bits = Some(24);
        let noise = Sensor::new(p).expect("legal").temporal_noise();
        let dark_e2 = 25.0 + 16.0 / 12.0;
        assert!((noise.variance_e2(50_000.0) - (50_000.0 + dark_e2)).abs() < 1e-6);
        let bright_e = 160_000.0;
        assert!((noise.variance_e2(bright_e) - (bright_e / 16.0 + dark_e2) * 256.0).abs() < 1e-3);
        assert!((noise.white_e() - 960_000.0).abs() < 1e-3);
    }

    #[test]
    fn without_noise_numbers_are_only_rounded() {
        let mut p = ideal();
        p.noise = false;
        let noise = Sensor::new(p).expect("legal").temporal_noise();
        assert!((noise.variance_e2(1000.0) - 16.0 / 12.0).abs() < 1e-9);
    }
}
