//! What a sensor is, as the description says it. Each effect's own parameters stand in the effect's file.

use crate::cfa::Cfa;
use crate::check::{Checks, SensorError};
use crate::effects::angle_response::AngleResponse;
use crate::effects::converter::Converter;
use crate::effects::crosstalk::Crosstalk;
use crate::effects::dark_current::DarkCurrent;
use crate::effects::full_well::Blooming;
use crate::effects::inter_pixel_capacitance::InterPixelCapacitance;
use crate::effects::lag::Trap;
use crate::effects::offset_pattern::OffsetPattern;
use crate::effects::photo_response::PhotoResponse;
use crate::effects::read_noise::ReadNoise;
use crate::effects::response::Response;
use crate::effects::rts_noise::RtsNoise;
use crate::effects::smear::Smear;
use crate::exposure_control::ExposureControl;
use crate::hdr::HighDynamicRange;
use crate::layout::Layout;
use crate::operation::Operation;
use crate::state::OperatingPoint;
use etendue_spectra::Spectrum;

/// One kind of pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// Its name in results, such as `r` or `mono`.
    pub name: String,
    /// Electrons a photon, 0 to 1, with the colour filter in it.
    pub quantum_efficiency: Spectrum,
}

/// Geometry of a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pixel {
    /// Distance between the centres of neighbours, µm; pixels are square.
    pub pitch_um: f64,
    /// Share of the pixel's square that collects light, (0, 1].
    pub fill_factor: f64,
}

/// When light is collected.
#[derive(Clone, Debug, PartialEq)]
pub struct Exposure {
    /// Time of collection, s; zero is legal.
    pub exposure_s: f64,
    /// Time from frame to frame, s; needed by effects that count it.
    pub frame_period_s: Option<f64>,
    /// What sets exposure and gain from frame to frame; `None` where they stay.
    pub control: Option<ExposureControl>,
}

/// What light meets before it is counted.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Optics {
    /// Response of the micro-lenses over the angle of the light.
    pub angle_response: Option<AngleResponse>,
    /// Light that neighbours exchange.
    pub crosstalk: Option<Crosstalk>,
}

/// How pixels differ, frame after frame the same.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FixedPattern {
    /// Which specimen this is. `None`: the one of the camera's place in the job.
    pub seed: Option<u64>,
    /// Differences in response to light (PRNU).
    pub photo_response: PhotoResponse,
    /// Differences without light that do not grow with time (DSNU).
    pub offset: OffsetPattern,
    /// Share of pixels that hold no charge.
    pub dead_fraction: f64,
}

/// What happens to charge in its pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct Charge {
    /// Electrons that heat sets free.
    pub dark: DarkCurrent,
    /// Electrons that a pixel can hold.
    pub full_well_e: f64,
    /// Where charge above the full well goes; `None`: it is lost.
    pub blooming: Option<Blooming>,
    /// Light that charge meets on its way down the column.
    pub smear: Option<Smear>,
    /// Traps that keep charge from frame to frame.
    pub traps: Vec<Trap>,
    /// Shift of a pixel's border by its own charge, 1/e⁻.
    pub brighter_fatter_per_e: f64,
}

/// From charge to digital numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct ReadOut {
    /// Voltage over charge.
    pub response: Response,
    /// Voltage that neighbours exchange.
    pub capacitance: Option<InterPixelCapacitance>,
    /// Noise of the chain.
    pub noise: ReadNoise,
    /// Pixels whose noise has two levels.
    pub rts_noise: Option<RtsNoise>,
    /// Digital numbers an electron (EMVA's K) at an analogue gain of 1.
    pub gain_dn_e: f64,
    /// Factor on the voltage before the converter.
    pub analogue_gain: f64,
    /// Digital number of no charge, DN.
    pub black_level_dn: f64,
    /// Bits of the converter, 1 to 24.
    pub bits: u32,
    /// Factor on digital numbers above black.
    pub digital_gain: f64,
    /// Which pixels are read, and which are read together.
    pub layout: Layout,
}

/// What a sensor is, as the description says it.
#[derive(Clone, Debug, PartialEq)]
pub struct SensorParameters {
    /// Geometry of a pixel.
    pub pixel: Pixel,
    /// The kinds of pixels.
    pub channels: Vec<Channel>,
    /// Which pixel is of which kind.
    pub cfa: Cfa,
    /// When light is collected.
    pub exposure: Exposure,
    /// What light meets before it is counted.
    pub optics: Optics,
    /// How pixels differ.
    pub pattern: FixedPattern,
    /// What happens to charge in its pixel.
    pub charge: Charge,
    /// From charge to digital numbers.
    pub read_out: ReadOut,
    /// Several captures a frame, or fewer bits by a curve.
    pub hdr: HighDynamicRange,
    /// Whether randomness from frame to frame is modelled. Without, a picture is the quantised mean; fixed patterns stay.
    pub noise: bool,
}

impl SensorParameters {
    /// The largest digital number of the converter.
    #[must_use]
    pub(crate) fn largest_dn(&self) -> f64 {
        f64::from((1_u32 << self.read_out.bits) - 1)
    }

    /// The digital number of a saturated pixel of one capture.
    pub(crate) fn capture_white_dn(&self, operation: &Operation) -> f64 {
        let charge_e = self.wells_read() * operation.full_well_e;
        Converter::of(self, operation).level_dn(self.read_out.response.voltage_e(charge_e))
    }

    /// How many pixels' charge is read together.
    pub(crate) fn wells_read(&self) -> f64 {
        self.read_out.layout.charge_binning().map_or(1, |b| b.columns * b.rows) as f64
    }

    /// The point of the smallest gain that the sensor can come to.
    pub(crate) fn least_point(&self) -> OperatingPoint {
        let point = OperatingPoint::described(self);
        let analogue_gain = self.exposure.control.map_or(point.analogue_gain, |control| control.analogue_gain[0]);
        OperatingPoint { analogue_gain, ..point }
    }

    /// All contradictions, in the order of the parameters.
    pub(crate) fn errors(&self) -> Vec<SensorError> {
        let mut checks = Checks::default();
        self.check_exposure(&mut checks);
        self.check_charge(&mut checks);
        self.check_read_out(&mut checks);
        self.check_channels(&mut checks);
        if checks.errors.is_empty() {
            self.hdr.check(self, &mut checks);
        }
        if checks.errors.is_empty() {
            self.check_range(&mut checks);
        }
        checks.errors
    }

    /// Whether light has numbers of its own.
    fn check_range(&self, checks: &mut Checks) {
        let white = self.hdr.white_level_dn(self, Operation::base(self, self.least_point()));
        checks.agree("gain_dn_per_e", white > self.read_out.black_level_dn, || {
            format!(
                "the gain is so small that a full pixel has the number of a dark one, {white} DN: give a larger one"
            )
        });
    }

    fn check_exposure(&self, checks: &mut Checks) {
        checks.positive("pixel_pitch_um", self.pixel.pitch_um);
        checks.share_above_0("fill_factor", self.pixel.fill_factor);
        checks.not_negative("exposure_s", self.exposure.exposure_s);
        if let Some(period_s) = self.exposure.frame_period_s {
            checks.positive("frame_period_s", period_s);
            checks.agree("frame_period_s", period_s >= self.exposure.exposure_s, || {
                format!("{period_s} s is shorter than exposure_s, {} s: give a longer one", self.exposure.exposure_s)
            });
        }
        if let Some(control) = &self.exposure.control {
            control.check(self, checks);
        }
        if let Some(response) = &self.optics.angle_response {
            response.check(checks);
        }
        if let Some(crosstalk) = &self.optics.crosstalk {
            crosstalk.check(checks);
        }
        self.pattern.photo_response.check(checks);
        self.pattern.offset.check(checks);
        checks.share("non_uniformity.dead_fraction", self.pattern.dead_fraction);
    }

    fn check_charge(&self, checks: &mut Checks) {
        let charge = &self.charge;
        charge.dark.check(checks);
        checks.positive("full_well_e", charge.full_well_e);
        if let Some(blooming) = &charge.blooming {
            blooming.check(checks);
        }
        if let Some(smear) = &charge.smear {
            smear.check(self, checks);
        }
        charge.traps.iter().for_each(|trap| trap.check(self, checks));
        crate::effects::lag::check_sum(&charge.traps, checks);
        crate::effects::brighter_fatter::check(self, checks);
    }

    fn check_read_out(&self, checks: &mut Checks) {
        let read_out = &self.read_out;
        read_out.response.check(checks);
        if let Some(capacitance) = &read_out.capacitance {
            capacitance.check(checks);
        }
        read_out.noise.check(checks);
        if let Some(rts_noise) = &read_out.rts_noise {
            rts_noise.check(checks);
        }
        checks.positive("gain_dn_per_e", read_out.gain_dn_e);
        checks.positive("analogue_gain", read_out.analogue_gain);
        checks.positive("digital_gain", read_out.digital_gain);
        let bits = read_out.bits;
        let largest_dn = if bits <= 24 { f64::from((1_u32 << bits) - 1) } else { f64::INFINITY };
        let black = read_out.black_level_dn;
        let black_is_legal = black >= 0.0 && black < largest_dn;
        checks.legal("black_level_dn", black, black_is_legal, "a number from 0 to below the converter's largest");
        checks.legal("bits", f64::from(bits), (1..=24).contains(&bits), "a whole number from 1 to 24");
    }

    fn check_channels(&self, checks: &mut Checks) {
        for (i, channel) in self.channels.iter().enumerate() {
            let (low, high) = (channel.quantum_efficiency.min_value(), channel.quantum_efficiency.max_value());
            if !(low >= 0.0 && high <= 1.0) {
                checks.errors.push(SensorError::Efficiency { channel: channel.name.clone(), low, high });
            }
            if !self.cfa.channels().contains(&i) {
                checks.errors.push(SensorError::UnusedChannel(channel.name.clone()));
            }
        }
        let largest = self.cfa.channels().iter().copied().max().unwrap_or(0);
        if largest >= self.channels.len() {
            checks.errors.push(SensorError::NoSuchChannel { channel: largest, channels: self.channels.len() });
        }
    }
}

impl Charge {
    /// Charge with a well and an even dark current, and nothing else.
    #[must_use]
    pub fn plain(full_well_e: f64, dark_current_e_s: f64) -> Self {
        Self {
            dark: DarkCurrent::even(dark_current_e_s),
            full_well_e,
            blooming: None,
            smear: None,
            traps: Vec::new(),
            brighter_fatter_per_e: 0.0,
        }
    }
}

impl ReadOut {
    /// A linear chain with white noise and nothing else.
    #[must_use]
    pub fn linear(gain_dn_e: f64, black_level_dn: f64, bits: u32, noise_e: f64) -> Self {
        Self {
            response: Response::Linear,
            capacitance: None,
            noise: ReadNoise { white_e: noise_e, row_e: 0.0, column_e: 0.0 },
            rts_noise: None,
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
            optics: Optics::default(),
            pattern: FixedPattern::default(),
            charge: Charge::plain(60_000.0, 0.0),
            read_out: ReadOut::linear(0.25, 100.0, 16, 5.0),
            hdr: HighDynamicRange::default(),
            noise: true,
        }
    }

    #[test]
    fn every_contradiction_is_told() {
        let mut p = ideal();
        p.exposure.exposure_s = -1.0;
        p.read_out.noise.white_e = f64::NAN;
        p.read_out.bits = 33;
        p.channels[0].quantum_efficiency = Spectrum::constant(1.5);
        p.channels.push(Channel { name: "r".into(), quantum_efficiency: Spectrum::constant(0.5) });
        let errors = p.errors();
        assert_eq!(errors.len(), 5, "{errors:?}");
        assert_eq!(errors[0].to_string(), "exposure_s is -1, but a finite number of at least 0 is needed");
        let mut p = ideal();
        p.read_out.gain_dn_e = 1e-30;
        assert!(p.errors()[0].to_string().starts_with("gain_dn_per_e: the gain is so small"), "{:?}", p.errors());
        let mut p = ideal();
        p.cfa = Cfa::tile(2, 1, vec![0, 3]).expect("a rectangle");
        assert_eq!(p.errors().len(), 1);
    }
}
