//! Charge in its pixel.

use crate::compile::stated::value_or;
use etendue_scene::record;
use etendue_scene::record::sensor::charge as description;
use etendue_sensor::ChargeEffects;
use etendue_sensor::effects::brighter_fatter::BrighterFatter;
use etendue_sensor::effects::dark_current::{DarkCurrent, DarkSpread, HotPixels, SpreadDistribution};
use etendue_sensor::effects::dead_pixels::DeadPixels;
use etendue_sensor::effects::full_well::{Blooming, FullWell};
use etendue_sensor::effects::lag::{Lag, Trap};
use etendue_sensor::effects::temperature::{Temperature, TemperatureLaw};
use etendue_sensor::effects::two_level::TwoLevel;

/// 0 °C, K.
const FREEZING_K: f64 = 273.15;

pub(super) fn charge(e: &record::Electronics) -> ChargeEffects {
    let trap = |t: &description::Trap| Trap { fraction: t.fraction.value, time_constant_s: t.time_constant_s.value };
    let dead = e.non_uniformity.as_ref().and_then(|n| n.dead_fraction.as_ref());
    ChargeEffects {
        dark: dark(e),
        lag: Lag { traps: e.lag.iter().map(trap).collect() },
        brighter_fatter: BrighterFatter { shift_per_e: value_or(e.brighter_fatter_per_e.as_ref(), 0.0) },
        full_well: FullWell { capacity_e: e.full_well_e.value, blooming: e.blooming.as_ref().map(blooming) },
        dead_pixels: DeadPixels { fraction: value_or(dead, 0.0) },
    }
}

fn dark(e: &record::Electronics) -> DarkCurrent {
    let uniform = DarkCurrent::uniform(value_or(e.dark_current_e_s.as_ref(), 0.0));
    let Some(d) = &e.dark else { return uniform };
    let distribution = match d.distribution.as_ref().map(|t| t.value) {
        Some(description::SpreadDistribution::LogNormal) => SpreadDistribution::LogNormal,
        Some(description::SpreadDistribution::Normal) | None => SpreadDistribution::Normal,
    };
    DarkCurrent {
        temperature: temperature(d),
        spread: DarkSpread {
            white: value_or(d.spread.as_ref(), 0.0),
            row: value_or(d.spread_row.as_ref(), 0.0),
            column: value_or(d.spread_column.as_ref(), 0.0),
            distribution,
        },
        hot: d.hot.as_ref().map(|hot| HotPixels { fraction: hot.fraction.value, mean_e_s: hot.mean_e_s.value }),
        dark_current_rts: d.dark_current_rts.as_ref().map(|b| TwoLevel {
            fraction: b.fraction.value,
            mean: b.mean_e_s.value,
            dwell_frames: b.dwell_frames.value,
        }),
        ..uniform
    }
}

fn temperature(d: &description::Dark) -> Option<Temperature> {
    let law = match &d.doubling_k {
        Some(step) => TemperatureLaw::Doubling { step_k: step.value },
        None => TemperatureLaw::BandGap { diffusion_fraction: value_or(d.diffusion_fraction.as_ref(), 0.0) },
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
