//! The sensors that are measured.

use etendue_sensor::cfa::Cfa;
use etendue_sensor::effects::angle_response::AngleResponse;
use etendue_sensor::effects::dark_current::{DarkCurrent, DarkSpread, HotPixels, SpreadDistribution};
use etendue_sensor::effects::full_well::Blooming;
use etendue_sensor::effects::lag::Trap;
use etendue_sensor::effects::neighbours::Crosstalk;
use etendue_sensor::effects::neighbours::InterPixelCapacitance;
use etendue_sensor::effects::neighbours::Neighbours;
use etendue_sensor::effects::offset_pattern::OffsetPattern;
use etendue_sensor::effects::offset_pattern::ReadNoise;
use etendue_sensor::effects::photo_response::PhotoResponse;
use etendue_sensor::effects::response::{Knee, Response};
use etendue_sensor::effects::smear::Smear;
use etendue_sensor::effects::two_level::RtsNoise;
use etendue_sensor::effects::two_level::TwoLevel;
use etendue_sensor::hdr::{Capture, HighDynamicRange};
use etendue_sensor::{
    Channel, ChargeEffects, Exposure, LightEffects, Pixel, ReadOut, SensorParameters, VoltageEffects,
};
use etendue_spectra::Spectrum;

/// Electrons that a pixel holds.
pub(super) const FULL_WELL_E: f64 = 20_000.0;

/// A name in the table, and its sensor.
type NamedSensor = (&'static str, SensorParameters);

/// The converter alone, with the well that every sensor has.
pub(super) fn bare() -> SensorParameters {
    SensorParameters {
        pixel: Pixel { pitch_um: 3.0, fill_factor: 1.0 },
        channels: vec![Channel { name: "mono".into(), quantum_efficiency: Spectrum::constant(0.5) }],
        cfa: Cfa::mono(),
        exposure: Exposure { exposure_s: 0.01, frame_period_s: Some(0.04), control: None },
        unit: None,
        light: LightEffects::default(),
        charge: ChargeEffects::plain(FULL_WELL_E, 0.0),
        voltage: VoltageEffects::default(),
        read_out: ReadOut::linear(0.7, 100.0, 14),
        hdr: HighDynamicRange::default(),
        noise: true,
    }
    .quiet()
}

/// Changes of a sensor, in words that read well.
trait Change: Sized {
    fn quiet(self) -> Self;
    fn with(self, change: impl FnOnce(&mut Self)) -> Self;
}

impl Change for SensorParameters {
    fn quiet(self) -> Self {
        self.with(|p| p.noise = false)
    }

    fn with(mut self, change: impl FnOnce(&mut Self)) -> Self {
        change(&mut self);
        self
    }
}

/// All sensors, in the order of the table.
pub(super) fn kinds() -> Vec<NamedSensor> {
    let all = |p: &mut SensorParameters| {
        noises(p);
        remaining_additions(p);
    };
    let together = [
        ("bare converter", bare()),
        ("described, without strength", bare().with(silent)),
        ("all noises", bare().with(noises)),
        ("all effects", bare().with(all)),
        ("four captures, all noises", bare().with(captures)),
    ];
    together.into_iter().chain(ADDITIONS.map(|(name, change)| (name, bare().with(change)))).collect()
}

/// A name in the table, and what a sensor has beside the bare converter.
type Addition = (&'static str, fn(&mut SensorParameters));

const ADDITIONS: [Addition; 18] = [
    ("shot noise", |p| p.noise = true),
    ("angle response", angle),
    ("crosstalk", |p| p.light.crosstalk = Some(Crosstalk(NEIGHBOUR_FRACTIONS))),
    ("photo-response pattern", |p| p.light.photo_response = PhotoResponse { white: 0.01, row: 0.002, column: 0.002 }),
    ("smear", |p| p.light.smear = Some(Smear::Interline { smear_db: -100.0, measured_exposure_ratio: 1.0 })),
    ("dark current, even", |p| p.charge.dark = DarkCurrent::uniform(500.0)),
    ("dark current with pattern", |p| p.charge.dark = patterned_dark()),
    ("lag", |p| p.charge.lag.traps = vec![Trap { fraction: 0.02, time_constant_s: 0.1 }]),
    ("brighter-fatter", |p| p.charge.brighter_fatter.shift_per_e = 1e-6),
    ("blooming along the column", |p| p.charge.full_well.blooming = Some(Blooming::Column { overflow_fraction: 0.9 })),
    ("blooming around", |p| p.charge.full_well.blooming = Some(Blooming::Around { overflow_fraction: 0.6 })),
    ("dead pixels", |p| p.charge.dead_pixels.fraction = 1e-4),
    ("response, two knees", |p| p.read_out.response = knees()),
    ("capacitance", |p| p.voltage.capacitance = Some(InterPixelCapacitance(NEIGHBOUR_FRACTIONS))),
    ("offset pattern", |p| p.voltage.offset = OffsetPattern { white_e: 2.0, row_e: 1.0, column_e: 1.0 }),
    ("shot and read noise", |p| (p.noise, p.voltage.noise) = (true, READ_NOISE)),
    ("shot and RTS noise", |p| (p.noise, p.voltage.rts_noise) = (true, Some(RtsNoise(TWO_LEVEL)))),
    ("digital gain", |p| p.read_out.digital_gain = 1.5),
];

const NEIGHBOUR_FRACTIONS: Neighbours = Neighbours { horizontal: 0.01, vertical: 0.01, corner: 0.002 };
const READ_NOISE: ReadNoise = ReadNoise { white_e: 5.0, row_e: 0.5, column_e: 0.5 };
const TWO_LEVEL: TwoLevel = TwoLevel { fraction: 0.001, mean: 20.0, dwell_frames: 5.0 };

fn noises(p: &mut SensorParameters) {
    (p.noise, p.voltage.noise) = (true, READ_NOISE);
    p.voltage.rts_noise = Some(RtsNoise(TWO_LEVEL));
    p.charge.dark = patterned_dark();
    p.light.photo_response = PhotoResponse { white: 0.01, row: 0.002, column: 0.002 };
    p.voltage.offset = OffsetPattern { white_e: 2.0, row_e: 1.0, column_e: 1.0 };
    p.charge.dead_pixels.fraction = 1e-4;
}

fn remaining_additions(p: &mut SensorParameters) {
    angle(p);
    p.light.crosstalk = Some(Crosstalk(NEIGHBOUR_FRACTIONS));
    p.light.smear = Some(Smear::Interline { smear_db: -100.0, measured_exposure_ratio: 1.0 });
    p.charge.lag.traps = vec![Trap { fraction: 0.02, time_constant_s: 0.1 }];
    p.charge.brighter_fatter.shift_per_e = 1e-6;
    p.charge.full_well.blooming = Some(Blooming::Around { overflow_fraction: 0.6 });
    p.read_out.response = knees();
    p.voltage.capacitance = Some(InterPixelCapacitance(NEIGHBOUR_FRACTIONS));
    p.read_out.digital_gain = 1.5;
}

/// Everything described, nothing with strength.
fn silent(p: &mut SensorParameters) {
    p.charge.dark = DarkCurrent { spread: spread(), ..DarkCurrent::uniform(0.0) };
    p.voltage.noise = READ_NOISE;
    p.voltage.rts_noise = Some(RtsNoise(TWO_LEVEL));
    p.light.photo_response = PhotoResponse::default();
    p.voltage.offset = OffsetPattern::default();
}

fn captures(p: &mut SensorParameters) {
    noises(p);
    let like = Capture::default();
    let second_capture = Capture { gain_ratio: 1.0 / 16.0, dual_conversion_gain: true, ..like };
    let small = Capture { sensitivity_ratio: 0.01, gain_ratio: 0.5, ..like };
    p.hdr.captures = vec![second_capture, small, Capture { gain_ratio: 1.0 / 8.0, ..second_capture }];
    p.hdr.bits = Some(24);
}

fn angle(p: &mut SensorParameters) {
    let table = vec![[0.0, 1.0], [10.0, 0.97], [20.0, 0.88], [30.0, 0.7]];
    p.light.angle_response = Some(AngleResponse { table, exit_pupil_mm: 8.0, principal_px: [960.0, 540.0] });
}

fn spread() -> DarkSpread {
    DarkSpread { white: 0.4, row: 0.02, column: 0.02, distribution: SpreadDistribution::LogNormal }
}

fn patterned_dark() -> DarkCurrent {
    DarkCurrent {
        spread: spread(),
        hot: Some(HotPixels { fraction: 1e-4, mean_e_s: 1e5 }),
        dark_current_rts: Some(TwoLevel { mean: 1e4, ..TWO_LEVEL }),
        ..DarkCurrent::uniform(500.0)
    }
}

fn knees() -> Response {
    Response::Knees(vec![Knee { at_e: 10_000.0, slope: 0.5 }, Knee { at_e: 15_000.0, slope: 0.2 }])
}
