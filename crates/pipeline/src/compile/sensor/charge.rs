//! What happens to charge in its pixel, and how pixels differ.

use super::or;
use etendue_scene::Place;
use etendue_scene::record;
use etendue_scene::record::sensor::charge as description;
use etendue_sensor::effects::dark_current::{DarkCurrent, DarkSpread, Hot, SpreadDistribution};
use etendue_sensor::effects::full_well::Blooming;
use etendue_sensor::effects::lag::Trap;
use etendue_sensor::effects::offset_pattern::OffsetPattern;
use etendue_sensor::effects::photo_response::PhotoResponse;
use etendue_sensor::effects::smear::Smear;
use etendue_sensor::effects::temperature::{Temperature, TemperatureLaw};
use etendue_sensor::effects::two_level::TwoLevel;
use etendue_sensor::{Charge, FixedPattern};

/// 0 °C, K.
const FREEZING_K: f64 = 273.15;

pub(super) fn pattern(e: &record::Electronics) -> FixedPattern {
    let Some(n) = &e.non_uniformity else { return FixedPattern::default() };
    FixedPattern {
        seed: n.seed.as_ref().map(|seed| seed.value),
        photo_response: PhotoResponse {
            white: or(n.prnu.as_ref(), 0.0),
            row: or(n.prnu_row.as_ref(), 0.0),
            column: or(n.prnu_column.as_ref(), 0.0),
        },
        offset: OffsetPattern {
            white_e: or(n.dsnu_e.as_ref(), 0.0),
            row_e: or(n.dsnu_row_e.as_ref(), 0.0),
            column_e: or(n.dsnu_column_e.as_ref(), 0.0),
        },
        dead_fraction: or(n.dead_fraction.as_ref(), 0.0),
    }
}

pub(super) fn charge(e: &record::Electronics) -> Charge {
    let trap = |t: &description::Trap| Trap { share: t.share.value, time_constant_s: t.time_constant_s.value };
    Charge {
        dark: dark(e),
        full_well_e: e.full_well_e.value,
        blooming: e.blooming.as_ref().map(blooming),
        smear: e.smear.as_ref().map(smear),
        traps: e.lag.iter().map(trap).collect(),
        brighter_fatter_per_e: or(e.brighter_fatter_per_e.as_ref(), 0.0),
    }
}

fn dark(e: &record::Electronics) -> DarkCurrent {
    let even = DarkCurrent::even(e.dark_current_e_s.value);
    let Some(d) = &e.dark else { return even };
    let distribution = match d.distribution.as_ref().map(|t| t.value) {
        Some(description::SpreadDistribution::LogNormal) => SpreadDistribution::LogNormal,
        Some(description::SpreadDistribution::Normal) | None => SpreadDistribution::Normal,
    };
    DarkCurrent {
        temperature: temperature(d),
        spread: DarkSpread {
            white: or(d.spread.as_ref(), 0.0),
            row: or(d.spread_row.as_ref(), 0.0),
            column: or(d.spread_column.as_ref(), 0.0),
            distribution,
        },
        hot: d.hot.as_ref().map(|hot| Hot { share: hot.share.value, mean_e_s: hot.mean_e_s.value }),
        dark_current_rts: d.dark_current_rts.as_ref().map(|b| TwoLevel {
            share: b.share.value,
            mean: b.mean_e_s.value,
            dwell_frames: b.dwell_frames.value,
        }),
        ..even
    }
}

fn temperature(d: &description::Dark) -> Option<Temperature> {
    let law = match &d.doubling_k {
        Some(step) => TemperatureLaw::Doubling { step_k: step.value },
        None => TemperatureLaw::BandGap { diffusion_fraction: or(d.diffusion_fraction.as_ref(), 0.0) },
    };
    let (sensor, reference) = (d.temperature_c.as_ref()?, d.reference_c.as_ref()?);
    Some(Temperature { sensor_k: sensor.value + FREEZING_K, reference_k: reference.value + FREEZING_K, law })
}

fn blooming(record: &description::Blooming) -> Blooming {
    let overflow_fraction = record.overflow_fraction.value;
    match record.direction.value {
        description::Direction::Column => Blooming::Column { overflow_fraction },
        description::Direction::Around => Blooming::Around { overflow_fraction },
    }
}

fn smear(record: &description::Smear) -> Smear {
    match record {
        description::Smear::Interline(smear) => Smear::Interline {
            smear_db: smear.smear_db.value,
            measured_exposure_ratio: or(smear.measured_exposure_ratio.as_ref(), 1.0),
        },
        description::Smear::FrameTransfer(smear) => Smear::FrameTransfer { line_shift_s: smear.line_shift_s.value },
    }
}

pub(super) fn smear_place(record: &description::Smear) -> &Place {
    match record {
        description::Smear::Interline(smear) => &smear.place,
        description::Smear::FrameTransfer(smear) => &smear.place,
    }
}
