//! A camera wherever it stands: lens, effects, sensor, processing.

use super::context::Context;
use super::effects::effects;
use super::front::front;
use super::lens::lens;
use super::sensor::{fill_factor, sensor};
use super::spectrum::named_illuminant;
use crate::plan::{CameraBody, Development};
use etendue_isp::{
    Colour, Filter, Mosaic, Processing, WhiteBalance as Balance, fit_colour_matrix, white_balance_from_illuminant,
};
use etendue_scene::record::processing::{ColourMatrix, WhiteBalance};
use etendue_scene::record::{self, Camera};
use etendue_sensor::Sensor;
use etendue_spectra::{Spectrum, chart};

/// The camera's models; `None` with the faults noted.
pub(super) fn body(camera: &Camera, context: &mut Context<'_>) -> Option<CameraBody> {
    let before = context.faults.len();
    let lens = lens(camera, context);
    let sensor = sensor(&camera.sensor, context);
    let development = match (&camera.processing, &sensor) {
        (Some(processing), Some(sensor)) => development(processing, sensor, context),
        _ => None,
    };
    let aperture_px = fill_factor(&camera.sensor).sqrt();
    let place = camera.sensor.place.clone();
    let (lens, raster) = lens?;
    let effects = effects(camera.effects.as_ref(), &lens, &raster, context)?;
    let front = camera.front.as_ref().and_then(|record| front(record, &lens, &raster, context));
    let body = CameraBody { place, raster, lens, front, effects, aperture_px, sensor, development };
    (context.faults.len() == before).then_some(body)
}

fn development(record: &record::Processing, sensor: &Sensor, context: &mut Context<'_>) -> Option<Development> {
    let exposure_gain = record.exposure_gain.as_ref().map_or(1.0, |g| g.value);
    let [red, green, blue] = sensor.responsivities() else {
        refuse_colour(record, context);
        let processing = Processing { exposure_gain, ..Processing::plain(None) };
        return Some(Development { mosaic: Mosaic::Mono, processing });
    };
    let channels = [red, green, blue];
    let white_balance = white_balance(record, channels, context)?;
    let matrix = colour_matrix(record, channels, context)?;
    let colour = Colour { white_balance: Balance::Gains(white_balance), matrix };
    let processing = Processing { exposure_gain, ..Processing::plain(Some(colour)) };
    Some(Development { mosaic: context.accept(&record.place, mosaic(sensor))?, processing })
}

/// A monochrome picture has no colour to process.
fn refuse_colour(record: &record::Processing, context: &mut Context<'_>) {
    if record.white_balance.is_some() || record.colour_matrix.is_some() {
        let problem = "\"white_balance\" and \"colour_matrix\" have no effect on a monochrome sensor";
        context.fault(&record.place, problem, "remove them");
    }
}

fn mosaic(sensor: &Sensor) -> Result<Mosaic, etendue_isp::MosaicError> {
    let cfa = &sensor.parameters().cfa;
    let filter = |channel: &usize| [Filter::Red, Filter::Green, Filter::Blue][*channel];
    Mosaic::tile(cfa.width(), cfa.height(), cfa.channels().iter().map(filter).collect())
}

fn white_balance(record: &record::Processing, channels: [&Spectrum; 3], context: &mut Context<'_>) -> Option<Vec<f64>> {
    match &record.white_balance {
        None => Some(vec![1.0; 3]),
        Some(WhiteBalance::Factors(factors)) => {
            if factors.value.iter().any(|f| *f < 1.0) {
                let problem = format!("a factor of {:?} is below 1 and would tint saturated pixels", factors.value);
                context.fault(&factors.place, problem, "divide all three by the smallest");
                return None;
            }
            Some(factors.value.to_vec())
        }
        Some(WhiteBalance::Illuminant(name)) => {
            let illuminant = named_illuminant(name, context)?;
            context.accept(&name.place, white_balance_from_illuminant(&channels, &illuminant))
        }
    }
}

fn colour_matrix(
    record: &record::Processing,
    channels: [&Spectrum; 3],
    context: &mut Context<'_>,
) -> Option<etendue_isp::ColourMatrix> {
    match &record.colour_matrix {
        None => Some(etendue_isp::ColourMatrix::identity()),
        Some(ColourMatrix::Rows(rows)) => {
            let matrix = etendue_isp::ColourMatrix::new(rows.each_ref().map(|row| row.value.to_vec()));
            context.accept(&record.place, matrix)
        }
        Some(ColourMatrix::Fit(name)) => {
            let illuminant = named_illuminant(name, context)?;
            let patches = chart::colorchecker().iter().map(|patch| &patch.reflectance);
            context.accept(&name.place, fit_colour_matrix(&channels, &illuminant, patches, 0.0))
        }
    }
}
