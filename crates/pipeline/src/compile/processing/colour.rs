//! Channels, white balance, demosaic and colour matrix.

use super::super::context::{Context, ErrorCode};
use super::super::spectrum::named_illuminant;
use etendue_isp::{
    Colour, ColourMatrix, Demosaic, Filter, Mosaic, NOISE_OF_OTHER_CHANNELS, WhiteBalance, fit_colour_matrix,
    white_balance_from_illuminant,
};
use etendue_scene::record;
use etendue_scene::record::processing as description;
use etendue_scene::{Place, Placed};
use etendue_sensor::Sensor;
use etendue_spectra::{Spectrum, reflectance};

/// The sensor's filters as processing represents them.
pub(super) fn mosaic(record: &record::Processing, sensor: &Sensor, context: &mut Context<'_>) -> Option<Mosaic> {
    if sensor.responsivities().len() == 1 {
        return Some(Mosaic::Mono);
    }
    let filters = filters(record, sensor, context)?;
    let cfa = &sensor.parameters().cfa;
    let tile = cfa.channels().iter().map(|channel| filters[*channel]).collect();
    context.accept(&record.place, Mosaic::tile(cfa.width(), cfa.height(), tile))
}

/// Filter of each of the sensor's channels, by its name.
fn filters(record: &record::Processing, sensor: &Sensor, context: &mut Context<'_>) -> Option<Vec<Filter>> {
    let filter = |name: &str| match name {
        "red" => Some(Filter::Red),
        "green" => Some(Filter::Green),
        "blue" => Some(Filter::Blue),
        "clear" | "white" => Some(Filter::Clear),
        "infrared" => Some(Filter::Infrared),
        "cyan" => Some(Filter::Cyan),
        "magenta" => Some(Filter::Magenta),
        "yellow" => Some(Filter::Yellow),
        _ => None,
    };
    let channels = &sensor.parameters().channels;
    if let Some(unusual) = channels.iter().find(|channel| filter(&channel.name).is_none()) {
        let problem = format!("the sensor's channel \"{}\" cannot be used in an image", unusual.name);
        context.error(
            ErrorCode::NotModelled,
            &record.place,
            problem,
            "remove \"isp\", or name a filter array of known colours",
        );
        return None;
    }
    Some(channels.iter().filter_map(|channel| filter(&channel.name)).collect())
}

/// Responsivities of the image's channels, in their order.
fn responsivities(sensor: &Sensor, mosaic: &Mosaic) -> Vec<Spectrum> {
    let (cfa, measured) = (&sensor.parameters().cfa, sensor.image_responsivities());
    let places = (0..cfa.channels().len()).map(|i| (i % cfa.width(), i / cfa.width()));
    let owner = |channel: usize| places.clone().find(|(x, y)| mosaic.channel_at(*x, *y) == channel);
    let of = |channel: usize| owner(channel).map(|(x, y)| measured[cfa.channel_at(x, y)].clone());
    (0..mosaic.channels()).filter_map(of).collect()
}

/// White balance and matrix; `None` for a monochrome image, or with the errors recorded.
pub(super) fn colour(
    record: &record::Processing,
    sensor: &Sensor,
    mosaic: &Mosaic,
    context: &mut Context<'_>,
) -> Option<Colour> {
    if *mosaic == Mosaic::Mono {
        refuse_colour(record, context);
        return None;
    }
    let measured = responsivities(sensor, mosaic);
    let channels: Vec<&Spectrum> = measured.iter().collect();
    let white_balance = white_balance(record, &channels, context);
    let matrix = colour_matrix(record, mosaic, &channels, context);
    Some(Colour { white_balance: white_balance?, matrix: matrix? })
}

/// Refuses colour settings for a monochrome image.
fn refuse_colour(record: &record::Processing, context: &mut Context<'_>) {
    if record.white_balance.is_some() || record.colour_matrix.is_some() {
        let problem = "\"white_balance\" and \"colour_matrix\" have no effect on a monochrome sensor";
        context.error(ErrorCode::NoEffect, &record.place, problem, "remove them");
    }
}

pub(super) fn demosaic(
    record: Option<&Placed<description::Demosaic>>,
    mosaic: &Mosaic,
    context: &mut Context<'_>,
) -> Option<Demosaic> {
    let Some(named) = record else { return Some(Demosaic::Bilinear) };
    let bayer = matches!(mosaic, Mosaic::Tile(tile) if tile.is_bayer());
    match (named.value, mosaic) {
        (_, Mosaic::Mono) => {
            context.error(
                ErrorCode::NoEffect,
                &named.place,
                "\"demosaic\" has no effect on a monochrome sensor",
                "remove it",
            );
            None
        }
        (description::Demosaic::Bilinear, _) => Some(Demosaic::Bilinear),
        _ if !bayer => {
            context.error(
                ErrorCode::NotModelled,
                &named.place,
                "this demosaic requires a Bayer filter array",
                "give \"bilinear\"",
            );
            None
        }
        (description::Demosaic::Malvar, _) => Some(Demosaic::MalvarHeCutler),
        (description::Demosaic::HamiltonAdams, _) => Some(Demosaic::HamiltonAdams),
    }
}

fn white_balance(
    record: &record::Processing,
    channels: &[&Spectrum],
    context: &mut Context<'_>,
) -> Option<WhiteBalance> {
    match &record.white_balance {
        None => Some(WhiteBalance::Gains(vec![1.0; channels.len()])),
        Some(description::WhiteBalance::Factors(factors)) => self::factors(factors, channels.len(), context),
        Some(description::WhiteBalance::Named(name)) if name.value == description::WhiteBalance::GREY_WORLD => {
            Some(WhiteBalance::GreyWorld)
        }
        Some(description::WhiteBalance::Named(name)) => {
            let illuminant = named_illuminant(name, context)?;
            let gains = white_balance_from_illuminant(channels, &illuminant);
            context.accept(&name.place, gains).map(WhiteBalance::Gains)
        }
    }
}

fn factors(factors: &[Placed<f64>], channels: usize, context: &mut Context<'_>) -> Option<WhiteBalance> {
    let place = &factors.first()?.place;
    check_count("\"white_balance\"", factors.len(), channels, place, context)?;
    let values: Vec<f64> = factors.iter().map(|f| f.value).collect();
    if values.iter().any(|f| *f < 1.0) {
        let problem = format!("a factor of {values:?} is below 1 and would tint saturated pixels");
        context.error(ErrorCode::OutOfRange, place, problem, "divide all of them by the smallest");
        return None;
    }
    Some(WhiteBalance::Gains(values))
}

/// Checks for one number per channel.
fn check_count(name: &str, count: usize, channels: usize, place: &Place, context: &mut Context<'_>) -> Option<()> {
    if count == channels {
        return Some(());
    }
    let problem = format!("{name} has {count} numbers, but the sensor has {channels} channels");
    let order = "one per channel, in the order red, green, blue, clear, infrared, cyan, magenta, yellow";
    context.error(ErrorCode::WrongCount, place, problem, format!("give {order}"));
    None
}

fn colour_matrix(
    record: &record::Processing,
    mosaic: &Mosaic,
    channels: &[&Spectrum],
    context: &mut Context<'_>,
) -> Option<ColourMatrix> {
    match &record.colour_matrix {
        None if is_rgb(mosaic) => Some(ColourMatrix::identity()),
        None => {
            let problem = "the sensor's channels are not red, green and blue, and no \"colour_matrix\" is given";
            context.error(
                ErrorCode::MissingKey,
                &record.place,
                problem,
                "add one, for example colour_matrix = { fit = \"D65\" }",
            );
            None
        }
        Some(description::ColourMatrix::Rows(rows)) => {
            rows.value.iter().try_for_each(|row| {
                check_count("a row of \"colour_matrix\"", row.len(), channels.len(), &rows.place, context)
            })?;
            let rows_of = rows.value.each_ref().map(|row| row.iter().map(|m| m.value).collect());
            context.accept(&rows.place, ColourMatrix::new(rows_of))
        }
        Some(description::ColourMatrix::Fit(name)) => {
            let illuminant = named_illuminant(name, context)?;
            let patches = reflectance::colorchecker().iter().map(|patch| &patch.reflectance);
            let noise = if is_rgb(mosaic) { 0.0 } else { NOISE_OF_OTHER_CHANNELS };
            context.accept(&name.place, fit_colour_matrix(channels, &illuminant, patches, noise))
        }
    }
}

fn is_rgb(mosaic: &Mosaic) -> bool {
    matches!(mosaic, Mosaic::Tile(tile) if tile.filters() == [Filter::Red, Filter::Green, Filter::Blue])
}
