//! Image filters of Gruyer, Grapinet, De Souza (2012).

use super::super::context::Context;
use super::tone::tone_curve;
use etendue_isp::paper::{
    self, Affine, ColourChange, ColourSpace, Drops, Filter, GaussianNoise, Glow, Operation, PulseNoise, Sensitivity,
    Stage, ToneMap, UniformNoise,
};
use etendue_scene::record::processing::GruyerFilter;
use etendue_scene::record::processing::filter as description;

pub(super) fn filters(records: &[GruyerFilter], context: &mut Context<'_>) -> Option<Vec<Filter>> {
    let filters: Vec<Filter> = records.iter().map(|record| filter(record, context)).collect::<Option<_>>()?;
    for (record, filter) in records.iter().zip(&filters) {
        context.accept(record.place(), filter.check())?;
    }
    let last = records.last().map(GruyerFilter::place);
    last.map_or(Some(()), |place| context.accept(place, paper::check(&filters)))?;
    Some(filters)
}

fn filter(record: &GruyerFilter, context: &mut Context<'_>) -> Option<Filter> {
    Some(match record {
        GruyerFilter::Glow(r) => Filter::Glow(Glow {
            percentile: r.percentile.value,
            target: r.target.value,
            threshold: r.threshold.value,
            radius_px: r.radius_px.value,
            strength: r.strength.value,
        }),
        GruyerFilter::ToneMap(r) => Filter::ToneMap(tone_map(r, context)?),
        GruyerFilter::Drops(r) => Filter::Drops(drops(r)),
        GruyerFilter::Colour(r) => Filter::Colour(colour(r)),
        GruyerFilter::PulseNoise(r) => {
            Filter::PulseNoise(PulseNoise { amplitude_dn: r.amplitude_dn.value, probability: r.probability.value })
        }
        GruyerFilter::GaussianNoise(r) => Filter::GaussianNoise(GaussianNoise { sigma_dn: r.sigma_dn.value }),
        GruyerFilter::UniformNoise(r) => Filter::UniformNoise(UniformNoise { range: r.range.value }),
    })
}

fn tone_map(record: &description::ToneMap, context: &mut Context<'_>) -> Option<ToneMap> {
    let sensitivity = match &record.curve {
        None => Sensitivity::Exponential,
        Some(curve) => Sensitivity::Curve(tone_curve(curve, context)?),
    };
    let gain = record.gain.as_ref().map_or(1.0, |g| g.value);
    Some(ToneMap { original_factor: record.original_factor.value, gain, sensitivity })
}

fn drops(record: &description::PaintedDrops) -> Drops {
    Drops {
        count: record.count.value as u32,
        radius_px: [record.min_radius_px.value, record.max_radius_px.value],
        scale: record.scale.value,
        blur_px: record.blur_px.value,
        flow_px_per_frame: record.flow_px_per_frame.as_ref().map_or(0.0, |f| f.value),
        fade_frames: record.fade_frames.as_ref().map(|f| f.value as u32),
    }
}

fn colour(record: &description::ColourChange) -> ColourChange {
    let stage = match record.on.as_ref().map(|on| on.value) {
        Some(description::Stage::Linear) => Stage::Linear,
        Some(description::Stage::Display) | None => Stage::Display,
    };
    ColourChange { stage, operations: record.operations.iter().map(operation).collect() }
}

fn operation(record: &description::Operation) -> Operation {
    match record {
        description::Operation::Scale(v) => Operation::Scale(v.value),
        description::Operation::Offset(v) => Operation::Offset(v.value),
        description::Operation::Brightness(b) => Operation::Brightness(b.value),
        description::Operation::Saturation(s) => Operation::Saturation(s.value),
        description::Operation::HueRotation(angle) => Operation::HueRotationDeg(angle.value),
        description::Operation::To(s) => Operation::To(space(s.value)),
        description::Operation::From(s) => Operation::From(space(s.value)),
        description::Operation::Matrix(rows) => Operation::Matrix(Affine(rows.value.each_ref().map(|row| row.value))),
    }
}

fn space(named: description::ColourSpace) -> ColourSpace {
    match named {
        description::ColourSpace::RgbNtsc => ColourSpace::RgbNtsc,
        description::ColourSpace::RgbPal => ColourSpace::RgbPal,
        description::ColourSpace::Yuv => ColourSpace::Yuv,
        description::ColourSpace::Yiq => ColourSpace::Yiq,
        description::ColourSpace::YCbCr => ColourSpace::YCbCr,
        description::ColourSpace::Cmy => ColourSpace::Cmy,
    }
}
