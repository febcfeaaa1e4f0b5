//! Parameters of a sensor as described. The parameters of each effect are in the effect's file.

use etendue_spectra::Spectrum;

use crate::capture::{OperatingPoint, Operation};
use crate::effect::{Effect, SensorEffect, SensorFacts, SignalLevels, Visitor};
use crate::effects::converter::{self, Adc};
use crate::effects::{ChargeEffects, LightEffects, VoltageEffects};
use crate::{
    cfa::Cfa, effects::dark_current::DarkCurrent, effects::full_well::FullWell, effects::offset_pattern::ReadNoise,
    effects::response::Response, effects::shot_noise::ShotNoise, exposure_control::ExposureControl,
    hdr::HighDynamicRange, layout::Layout,
};

/// One channel: a kind of pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// Its name in results, such as `r` or `mono`.
    pub name: String,
    /// Electrons per photon, 0 to 1, including the colour filter.
    pub quantum_efficiency: Spectrum,
}

/// Geometry of a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pixel {
    /// Pixel pitch, µm; pixels are square.
    pub pitch_um: f64,
    /// Fraction of the pixel's square that collects light, (0, 1].
    pub fill_factor: f64,
}

/// Exposure of a frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Exposure {
    /// Exposure time, s; zero is legal.
    pub exposure_s: f64,
    /// Time from frame to frame, s; required by effects that use it.
    pub frame_period_s: Option<f64>,
    /// Automatic control of exposure and gain from frame to frame; `None`: both are constant.
    pub control: Option<ExposureControl>,
}

/// Read-out: from charge to digital numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct ReadOut {
    /// Voltage over charge.
    pub response: Response,
    /// Digital numbers per electron (EMVA's K) at an analogue gain of 1.
    pub gain_dn_e: f64,
    /// Factor on the voltage before the ADC.
    pub analogue_gain: f64,
    /// Digital number of zero charge, DN.
    pub black_level_dn: f64,
    /// Bits of the ADC, 1 to 24.
    pub bits: u32,
    /// Factor on digital numbers above black.
    pub digital_gain: f64,
    /// The pixels that are read, and those that are read together.
    pub layout: Layout,
}

/// Parameters of a sensor as described.
#[derive(Clone, Debug, PartialEq)]
pub struct SensorParameters {
    /// Geometry of a pixel.
    pub pixel: Pixel,
    /// Channels: the kinds of pixels.
    pub channels: Vec<Channel>,
    /// Colour filter array: the channel of each pixel.
    pub cfa: Cfa,
    /// Exposure of a frame.
    pub exposure: Exposure,
    /// Unit (individual sensor) of the fixed patterns. `None`: the one of the camera's place in the job.
    pub unit: Option<u64>,
    /// Effects on light before it is counted.
    pub light: LightEffects,
    /// Effects on charge in its pixel.
    pub charge: ChargeEffects,
    /// Effects on voltage before the ADC.
    pub voltage: VoltageEffects,
    /// Read-out: from charge to digital numbers.
    pub read_out: ReadOut,
    /// Several captures per frame, or fewer bits by a curve.
    pub hdr: HighDynamicRange,
    /// True if temporal noise is modelled. Without it, an image is the quantised mean; fixed patterns stay.
    pub noise: bool,
}

impl SensorParameters {
    /// The facts shared by all captures.
    pub(crate) fn facts(&self) -> SensorFacts {
        let captures = &self.hdr.captures;
        let dark = &self.read_out.layout.optical_black;
        SensorFacts {
            noise: self.noise,
            unit: self.unit,
            pitch_um: self.pixel.pitch_um,
            first_lit: [dark.columns, dark.rows],
            exposure_s: self.exposure.exposure_s,
            frame_period_s: self.exposure.frame_period_s,
            exposures: 1 + captures.iter().filter(|capture| !capture.dual_conversion_gain).count(),
            is_split_pixel: captures.iter().any(|capture| capture.sensitivity_ratio != 1.0),
            max_full_well_e: captures
                .iter()
                .filter_map(|capture| capture.full_well_e)
                .fold(self.charge.full_well.capacity_e, f64::max),
            gain_dn_e: self.read_out.gain_dn_e,
            analogue_gain: self.read_out.analogue_gain,
            converter_range_dn: converter::largest_dn(self.read_out.bits) - self.read_out.black_level_dn,
        }
    }

    /// Exposure and gain as described.
    pub(crate) fn described_point(&self) -> OperatingPoint {
        OperatingPoint { exposure_s: self.exposure.exposure_s, analogue_gain: self.read_out.analogue_gain }
    }

    /// The operating point of the smallest possible gain.
    pub(crate) fn min_operating_point(&self) -> OperatingPoint {
        let point = self.described_point();
        let analogue_gain = self.exposure.control.map_or(point.analogue_gain, |control| control.analogue_gain[0]);
        OperatingPoint { analogue_gain, ..point }
    }

    /// The operation of the first capture of a frame at an operating point.
    pub(crate) fn operation(&self, point: OperatingPoint) -> Operation {
        let described_s = self.exposure.exposure_s;
        let light = if point.exposure_s == described_s { 1.0 } else { point.exposure_s / described_s };
        Operation {
            exposure_s: point.exposure_s,
            light,
            full_well_e: self.charge.full_well.capacity_e,
            gain_dn_e: self.read_out.gain_dn_e * point.analogue_gain,
            read_noise_e: self.voltage.noise.white_e,
        }
    }

    /// The operation of the first capture as described.
    pub(crate) fn described_operation(&self) -> Operation {
        self.operation(self.described_point())
    }

    /// The ADC at the gain of a capture.
    pub(crate) fn converter(&self, operation: &Operation) -> Adc {
        let ReadOut { black_level_dn, bits, digital_gain, .. } = self.read_out;
        Adc { gain_dn_e: operation.gain_dn_e, black_level_dn, bits, digital_gain }
    }

    /// Number of pixels whose charge is read together.
    pub(crate) fn wells_read(&self) -> f64 {
        self.read_out.layout.charge_binning().map_or(1, |b| b.columns * b.rows) as f64
    }

    /// The digital number of a saturated pixel of one capture.
    pub(crate) fn capture_white_dn(&self, operation: &Operation) -> f64 {
        let charge_e = self.wells_read() * operation.full_well_e;
        self.converter(operation).level_dn(self.read_out.response.voltage_e(charge_e))
    }

    /// The digital number of a saturated pixel after merging, at an operating point.
    pub(crate) fn merged_white_dn(&self, point: OperatingPoint) -> f64 {
        let last = self.hdr.captures.len();
        let operation = &self.hdr.operations(self.operation(point))[last];
        self.read_out.black_level_dn + self.merged_range_dn(last, operation)
    }

    /// Merged numbers from black to the saturation of capture `k`, taken by `operation`.
    pub(crate) fn merged_range_dn(&self, k: usize, operation: &Operation) -> f64 {
        self.hdr.scale(k) * (self.capture_white_dn(operation) - self.read_out.black_level_dn)
    }

    /// The exposure, s, that smear adds to every pixel of a uniformly and steadily lit image of this number of rows. Shielded rows take their time as
    /// well and add nothing.
    #[must_use]
    pub fn uniform_smear_s(&self, rows: usize) -> f64 {
        let all = rows + self.read_out.layout.optical_black.rows;
        self.light.smear.map_or(0.0, |smear| smear.uniform_smear_s(self.exposure.frame_period_s, rows, all))
    }

    /// Visits all effects in physical order, with the ADC at the gain of the first capture as described. Checks and plans are built from this list,
    /// so every listed effect is both checked and reported.
    pub(crate) fn show(&self, visitor: &mut impl Visitor) {
        visitor.visit(&self.exposure.control);
        self.light.show(visitor);
        visitor.visit(&ShotNoise);
        self.charge.show(visitor);
        visitor.visit(&self.read_out.layout);
        visitor.visit(&self.read_out.response);
        self.voltage.show(visitor);
        visitor.visit(&self.converter(&self.described_operation()));
        visitor.visit(&self.hdr);
        visitor.visit(&self.hdr.companding);
    }

    /// All effects of the first capture as described, in physical order.
    pub(crate) fn effects(&self, levels: SignalLevels) -> Vec<SensorEffect> {
        let (facts, operation) = (self.facts(), self.described_operation());
        let mut list = EffectList { facts, operation, levels, effects: Vec::new() };
        self.show(&mut list);
        list.effects
    }
}

/// The effects of a capture.
struct EffectList {
    facts: SensorFacts,
    operation: Operation,
    levels: SignalLevels,
    effects: Vec<SensorEffect>,
}

impl Visitor for EffectList {
    fn visit<E: Effect>(&mut self, effect: &E) {
        self.effects.push(SensorEffect {
            name: E::NAME,
            key: E::KEY,
            status: effect.status(&self.facts, &self.operation),
            left_out_by: effect.left_out_by(),
            errors: effect.errors_without(&self.facts, &self.levels),
        });
    }
}

impl ChargeEffects {
    /// Charge with a well and a uniform dark current, and nothing else.
    #[must_use]
    pub fn plain(full_well_e: f64, dark_current_e_s: f64) -> Self {
        Self {
            dark: DarkCurrent::uniform(dark_current_e_s),
            full_well: FullWell { capacity_e: full_well_e, blooming: None },
            ..Self::default()
        }
    }
}

impl VoltageEffects {
    /// White read noise, e⁻, and nothing else.
    #[must_use]
    pub fn plain(read_noise_e: f64) -> Self {
        let noise = ReadNoise { white_e: read_noise_e, ..ReadNoise::default() };
        Self { noise, ..Self::default() }
    }
}

impl ReadOut {
    /// A linear read-out, each pixel on its own.
    #[must_use]
    pub fn linear(gain_dn_e: f64, black_level_dn: f64, bits: u32) -> Self {
        Self {
            response: Response::Linear,
            gain_dn_e,
            analogue_gain: 1.0,
            black_level_dn,
            bits,
            digital_gain: 1.0,
            layout: Layout::default(),
        }
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// A mono sensor of quantum efficiency 1 with 5 e⁻ read noise and 0.25 DN/e⁻; nothing else.
    pub(crate) fn ideal() -> SensorParameters {
        SensorParameters {
            pixel: Pixel { pitch_um: 3.0, fill_factor: 1.0 },
            channels: vec![Channel { name: "mono".into(), quantum_efficiency: Spectrum::constant(1.0) }],
            cfa: Cfa::mono(),
            exposure: Exposure { exposure_s: 0.01, frame_period_s: None, control: None },
            unit: None,
            light: LightEffects::default(),
            charge: ChargeEffects::plain(60_000.0, 0.0),
            voltage: VoltageEffects::plain(5.0),
            read_out: ReadOut::linear(0.25, 100.0, 16),
            hdr: HighDynamicRange::default(),
            noise: true,
        }
    }
}
