//! Effective responsivities of the channels under uniform illumination, including the mixing of neighbours of other colours.
//!
//! Optical crosstalk and inter-pixel capacitance bring part of each pixel's signal from its neighbours, which have other filters: an image's red is
//! R' = Σ w_c R_c over the channels c. White balance and colour matrices use these responsivities, as they would if measured on the camera. The
//! weights of a channel are the mean over its pixels in the tile.

use etendue_spectra::Spectrum;

use crate::{cfa::Cfa, effects::neighbours::Neighbours, sensor::Sensor};

impl Sensor {
    /// Effective responsivities of all channels under uniform illumination, e⁻ per W·m⁻² during the exposure; during a second if that is zero, as
    /// colour computations accept any common scale.
    #[must_use]
    pub fn image_responsivities(&self) -> Vec<Spectrum> {
        let own = self.colour_responsivities();
        let mixed = |weights: &Vec<f64>| {
            Spectrum::from_fn(|nm| own.iter().zip(weights).map(|(r, weight)| weight * f64::from(r.at(nm as f32))).sum())
        };
        self.channel_weights().iter().map(mixed).collect()
    }

    /// Effective quantum efficiencies of all channels on a pixel's whole square under uniform illumination, at a wavelength, nm: the quantity that
    /// photon transfer measures.
    #[must_use]
    pub fn image_quantum_efficiencies(&self, nm: f64) -> Vec<f64> {
        let p = self.parameters();
        let own: Vec<f64> = p.channels.iter().map(|c| f64::from(c.quantum_efficiency.at(nm as f32))).collect();
        let mixed = |weights: &Vec<f64>| weights.iter().zip(&own).map(|(weight, own)| weight * own).sum::<f64>();
        self.channel_weights().iter().map(|weights| mixed(weights) * p.pixel.fill_factor).collect()
    }

    /// The weight of each channel's light (second index) in each channel's pixels (first).
    fn channel_weights(&self) -> Vec<Vec<f64>> {
        let p = self.parameters();
        let exchanges = [p.light.crosstalk.map(|c| c.0), p.voltage.capacitance.map(|c| c.0)];
        let one_hot = |channel: &usize| (0..p.channels.len()).map(|c| f64::from(u8::from(c == *channel))).collect();
        let tile: Vec<Vec<f64>> = p.cfa.channels().iter().map(one_hot).collect();
        let tile = exchanges.iter().flatten().fold(tile, |tile, neighbours| with_exchange(&p.cfa, &tile, neighbours));
        (0..p.channels.len()).map(|channel| mean_of(channel, &p.cfa, &tile)).collect()
    }
}

/// The weights of each tile position after an exchange with the eight neighbours.
fn with_exchange(cfa: &Cfa, tile: &[Vec<f64>], neighbours: &Neighbours) -> Vec<Vec<f64>> {
    let (width, height) = (cfa.width(), cfa.height());
    let place = |i: usize| {
        let mut sum = vec![0.0; tile[i].len()];
        for (dx, dy) in (0..9).map(|n| (n % 3, n / 3)) {
            let from = (i / width + dy + height - 1) % height * width + (i % width + dx + width - 1) % width;
            sum.iter_mut().zip(&tile[from]).for_each(|(to, weight)| *to += neighbours.weight(dx, dy) * weight);
        }
        sum
    };
    (0..tile.len()).map(place).collect()
}

/// The mean weights of the tile positions of a channel; its own alone if the tile has none.
fn mean_of(channel: usize, cfa: &Cfa, tile: &[Vec<f64>]) -> Vec<f64> {
    let places: Vec<&Vec<f64>> =
        cfa.channels().iter().zip(tile).filter(|(c, _)| **c == channel).map(|(_, w)| w).collect();
    let count = places.len().max(1) as f64;
    (0..tile[0].len()).map(|c| places.iter().map(|weights| weights[c]).sum::<f64>() / count).collect()
}

#[cfg(test)]
mod tests {
    use crate::Channel;
    use crate::cfa::{BayerPhase, Cfa};
    use crate::effects::neighbours::Crosstalk;
    use crate::effects::neighbours::InterPixelCapacitance;
    use crate::effects::neighbours::Neighbours;
    use crate::frame::tests::{ADDRESS, quiet, run};
    use crate::sensor::Sensor;
    use etendue_core::Plane;
    use etendue_spectra::Spectrum;

    fn bayer(phase: BayerPhase) -> crate::SensorParameters {
        let mut p = quiet();
        p.cfa = Cfa::bayer(phase);
        let channel = |name: &str, qe| Channel { name: name.into(), quantum_efficiency: Spectrum::constant(qe) };
        p.channels = vec![channel("red", 0.2), channel("green", 0.6), channel("blue", 0.4)];
        p
    }

    #[test]
    fn without_exchange_they_are_the_channels_own() {
        let sensor = Sensor::new(bayer(BayerPhase::Rggb)).expect("legal");
        assert_eq!(sensor.image_responsivities(), sensor.responsivities());
    }

    /// By hand for Bayer: red has four adjacent greens and four diagonal blues.
    #[test]
    fn red_takes_from_green_and_blue() {
        let mut p = bayer(BayerPhase::Gbrg);
        p.light.crosstalk = Some(Crosstalk(Neighbours { horizontal: 0.02, vertical: 0.03, corner: 0.01 }));
        let sensor = Sensor::new(p).expect("legal");
        let of = |c: usize| f64::from(sensor.responsivity(c).at(500.0));
        let red = f64::from(sensor.image_responsivities()[0].at(500.0));
        let expected = 0.86 * of(0) + 0.1 * of(1) + 0.04 * of(2);
        assert!((red / expected - 1.0).abs() < 1e-6, "{red} {expected}");
    }

    /// Equal to the numbers that the sensor delivers under uniform illumination, channel by channel.
    #[test]
    fn a_uniform_image_has_them() {
        let mut p = bayer(BayerPhase::Grbg);
        p.light.crosstalk = Some(Crosstalk(Neighbours { horizontal: 0.05, vertical: 0.02, corner: 0.004 }));
        p.voltage.capacitance =
            Some(InterPixelCapacitance(Neighbours { horizontal: 0.01, vertical: 0.01, corner: 0.0 }));
        (p.charge.full_well.capacity_e, p.read_out.bits) = (1e6, 20);
        let sensor = Sensor::new(p.clone()).expect("legal");
        let level = |r: &Spectrum| f64::from(r.at(500.0)) / f64::from(sensor.responsivity(1).at(500.0)) * 1e5;
        let mut means = Plane::new(8, 8);
        for i in 0..64 {
            means.set(i % 8, i / 8, level(sensor.responsivity(p.cfa.channel_at(i % 8, i / 8))) as f32);
        }
        let raw = run(&p, &means, ADDRESS);
        for (channel, mixed) in sensor.image_responsivities().iter().enumerate() {
            let inside = (2..6).flat_map(|y| (2..6).map(move |x| (x, y)));
            let of: Vec<f64> = inside
                .filter(|(x, y)| p.cfa.channel_at(*x, *y) == channel)
                .map(|(x, y)| f64::from(raw.plane.at(x, y)))
                .collect();
            let mean = of.iter().sum::<f64>() / of.len() as f64 - p.read_out.black_level_dn;
            // One digital number per electron: rounding.
            assert!((mean - level(mixed) * p.read_out.gain_dn_e).abs() < 0.6, "{channel}: {mean} {}", level(mixed));
            // The same as an efficiency: electrons over those of a channel of known efficiency.
            let own = f64::from(p.channels[1].quantum_efficiency.at(500.0)) * p.pixel.fill_factor;
            let efficiency = sensor.image_quantum_efficiencies(500.0)[channel];
            assert!((efficiency - own * level(mixed) / 1e5).abs() < 1e-6, "{channel}: {efficiency}");
        }
    }
}
