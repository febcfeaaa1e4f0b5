//! From charge to digital numbers: voltage, ADC, layout, captures.

use super::light::neighbours;
use crate::compile::stated::value_or;
use etendue_scene::record;
use etendue_scene::record::sensor::charge::NonUniformity;
use etendue_scene::record::sensor::{hdr as of_hdr, read_out as description};
use etendue_sensor::effects::neighbours::InterPixelCapacitance;
use etendue_sensor::effects::offset_pattern::OffsetPattern;
use etendue_sensor::effects::offset_pattern::ReadNoise;
use etendue_sensor::effects::response::{Knee, Response};
use etendue_sensor::effects::two_level::RtsNoise;
use etendue_sensor::effects::two_level::TwoLevel;
use etendue_sensor::hdr::companding::Companding;
use etendue_sensor::hdr::{Capture, HighDynamicRange};
use etendue_sensor::layout::{Binning, BinningMode, Layout, OpticalBlack, Region, Skipping};
use etendue_sensor::{ReadOut, VoltageEffects};

pub(super) fn voltage(e: &record::Electronics) -> VoltageEffects {
    VoltageEffects {
        capacitance: e.inter_pixel_capacitance.as_ref().map(|value| InterPixelCapacitance(neighbours(value))),
        offset: e.non_uniformity.as_ref().map(offset).unwrap_or_default(),
        noise: ReadNoise {
            white_e: e.read_noise_e.value,
            row_e: value_or(e.row_noise_e.as_ref(), 0.0),
            column_e: value_or(e.column_noise_e.as_ref(), 0.0),
        },
        rts_noise: e.rts_noise.as_ref().map(|t| {
            RtsNoise(TwoLevel { fraction: t.fraction.value, mean: t.mean_e.value, dwell_frames: t.dwell_frames.value })
        }),
    }
}

fn offset(n: &NonUniformity) -> OffsetPattern {
    OffsetPattern {
        white_e: value_or(n.dsnu_e.as_ref(), 0.0),
        row_e: value_or(n.dsnu_row_e.as_ref(), 0.0),
        column_e: value_or(n.dsnu_column_e.as_ref(), 0.0),
    }
}

pub(super) fn read_out(e: &record::Electronics) -> ReadOut {
    ReadOut {
        response: e.response.as_ref().map_or(Response::Linear, response),
        gain_dn_e: e.gain_dn_per_e.value,
        analogue_gain: value_or(e.analogue_gain.as_ref(), 1.0),
        black_level_dn: e.black_level_dn.value,
        bits: e.bits.value as u32,
        digital_gain: value_or(e.digital_gain.as_ref(), 1.0),
        layout: layout(e),
    }
}

fn response(record: &description::Response) -> Response {
    match record {
        description::Response::Knees(record) => {
            Response::Knees(record.knees.iter().map(|k| Knee { at_e: k.value[0], slope: k.value[1] }).collect())
        }
        description::Response::Logarithmic(record) => Response::Logarithmic { from_e: record.from_e.value },
    }
}

fn layout(e: &record::Electronics) -> Layout {
    let dark = e.optical_black.as_ref();
    let pixels = |key: Option<&etendue_scene::Placed<u64>>| key.map_or(0, |k| k.value as usize);
    Layout {
        optical_black: OpticalBlack {
            rows: pixels(dark.and_then(|d| d.rows_px.as_ref())),
            columns: pixels(dark.and_then(|d| d.columns_px.as_ref())),
        },
        region: e.roi_px.as_ref().map(|region| {
            let [x, y, width, height] = region.value.map(|v| v as usize);
            Region { x, y, width, height }
        }),
        binning: e.binning.as_ref().map(|b| Binning {
            columns: b.columns.value as usize,
            rows: b.rows.value as usize,
            of: match b.of.value {
                description::BinnedQuantity::Charge => BinningMode::Charge,
                description::BinnedQuantity::Numbers => BinningMode::Numbers,
            },
        }),
        skipping: e.skipping.as_ref().map(|s| {
            let tiles = |key: Option<&etendue_scene::Placed<u64>>| key.map_or(1, |k| k.value as usize);
            Skipping { columns: tiles(s.columns.as_ref()), rows: tiles(s.rows.as_ref()) }
        }),
    }
}

pub(super) fn hdr(e: &record::Electronics) -> HighDynamicRange {
    let captures = e.hdr.iter().flat_map(|hdr| &hdr.captures).map(capture).collect();
    let companding = e
        .companding
        .as_ref()
        .map(|c| Companding { knees: c.knees.iter().map(|knee| knee.value).collect(), bits: c.bits.value as u32 });
    HighDynamicRange {
        captures,
        transition_level: e.hdr.as_ref().and_then(|hdr| hdr.transition_level.as_ref()).map(|k| k.value),
        bits: e.hdr.as_ref().map(|hdr| hdr.merged_bits.value as u32),
        companding,
    }
}

fn capture(record: &of_hdr::Capture) -> Capture {
    Capture {
        exposure_ratio: value_or(record.exposure_ratio.as_ref(), 1.0),
        sensitivity_ratio: value_or(record.sensitivity_ratio.as_ref(), 1.0),
        gain_ratio: value_or(record.gain_ratio.as_ref(), 1.0),
        full_well_e: record.full_well_e.as_ref().map(|k| k.value),
        read_noise_e: record.read_noise_e.as_ref().map(|k| k.value),
        dual_conversion_gain: record.dual_conversion_gain.as_ref().is_some_and(|k| k.value),
    }
}
