//! `[isp]`: from the record to the settings of processing.

mod colour;
mod correction;
mod filter;
mod tone;

use correction::DeliveredImage;

use super::context::{Context, ErrorCode};
use crate::plan::{Development, PictureFormat};
use etendue_isp::{Bilateral, NoiseReduction, Processing, ToneCurve, UnsharpMask};
use etendue_projection::Raster;
use etendue_scene::record;
use etendue_scene::record::processing::detail::NoiseReductionKind;
use etendue_scene::record::processing::{self as description, output};
use etendue_sensor::Sensor;

/// Returns the development of the raw images of a sensor whose pixels are `scale` times as large as described; `None`, with the errors recorded, if it fails.
pub(super) fn development(
    record: &record::Processing,
    sensor: &Sensor,
    raster: &Raster,
    scale: u64,
    context: &mut Context<'_>,
) -> Option<Development> {
    let before = context.errors.len();
    let image = DeliveredImage::new(sensor, raster, scale);
    let black_level = correction::black_level(record.black_level.as_ref(), sensor, context);
    let defects = correction::defects(record, &image, context);
    let shading = correction::shading(record.shading.as_ref(), &image, context);
    let mosaic = colour::mosaic(record, sensor, context);
    let colour = mosaic.as_ref().and_then(|mosaic| colour::colour(record, sensor, mosaic, context));
    let tone = record.tone_curve.as_ref().map_or(Some(ToneCurve::Srgb), |curve| tone::tone_curve(curve, context));
    let image_filters = filter::filters(&record.image_filters, context);
    let mosaic = mosaic?;
    let demosaic = colour::demosaic(record.demosaic.as_ref(), &mosaic, context);
    if context.errors.len() > before {
        return None;
    }
    let processing = Processing {
        black_level: black_level?,
        defects: defects?,
        shading: shading?,
        demosaic: demosaic?,
        noise_reduction: record.noise_reduction.as_ref().map(noise_reduction),
        colour,
        exposure_gain: record.exposure_gain.as_ref().map_or(1.0, |g| g.value),
        tone: tone?,
        sharpening: record.sharpening.as_ref().map(sharpening),
        image_filters: image_filters?,
    };
    // Settings accepted here do not fail in any frame.
    context.accept(&record.place, processing.check(&mosaic, image.width, image.height))?;
    Some(Development { mosaic, processing, format: format(record, &image, context)? })
}

fn noise_reduction(record: &description::NoiseReduction) -> NoiseReduction {
    match &record.kind {
        NoiseReductionKind::Median(radius) => NoiseReduction::Median { radius_px: radius.value as usize },
        NoiseReductionKind::Bilateral(radius) => NoiseReduction::Bilateral(Bilateral {
            radius_px: radius.value,
            range: record.range.as_ref().map_or(1.0, |r| r.value),
        }),
    }
}

fn sharpening(record: &description::Sharpening) -> UnsharpMask {
    UnsharpMask {
        amount: record.amount.value,
        radius_px: record.radius_px.value,
        threshold: record.threshold.as_ref().map_or(0.0, |t| t.value),
    }
}

/// Maximum columns or rows of a JPEG (ISO/IEC 10918-1, B.2.2).
const JPEG_PX: usize = 65_535;

fn format(record: &record::Processing, image: &DeliveredImage, context: &mut Context<'_>) -> Option<PictureFormat> {
    match &record.picture_format {
        Some(key) if key.value == output::PictureFormat::Jpeg => {
            if image.width.max(image.height) > JPEG_PX {
                let problem = format!("a JPEG has at most {JPEG_PX} columns and rows");
                context.error(ErrorCode::UnsupportedOutput, &key.place, problem, "give picture_format = \"png\"");
                return None;
            }
            Some(PictureFormat::Jpeg { quality: record.jpeg_quality.as_ref().map_or(90, |q| q.value as u8) })
        }
        _ => Some(PictureFormat::Png { bits: record.picture_bits.as_ref().map_or(8, |b| b.value as u32) }),
    }
}
