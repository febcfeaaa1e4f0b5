//! Pictures: raws as their side-car states them, others as what their numbers are taken for.

use super::facts::SideCar;
use super::units;
use crate::found::FoundFile;
use crate::layer::{Kind, Layer, NamedPlane, Samples};
use etendue::Error;
use etendue_io::photograph::{Channel, Encoding, Photograph, read_photograph};

pub(super) fn layer(file: &FoundFile, side_car: &SideCar) -> Result<Layer, Error> {
    let photograph = read_photograph(&file.path).map_err(Error::input)?;
    let size = (photograph.width, photograph.height);
    let [quantity, stated] = side_car.entry(&file.name);
    let (kind, unit, meaning) = match (&photograph.raw, photograph.channels.len(), photograph.full_scale) {
        (Some(raw), ..) => {
            let filters =
                Some((raw.filters.columns, raw.filters.channels.clone())).filter(|(_, names)| names.len() > 1);
            let kind = Kind::Raw { black: raw.black_level_dn, white: raw.white_level_dn, filters };
            (kind, "DN".to_owned(), format!("exposure {} s", raw.exposure_s))
        }
        (None, 3.., None) => (Kind::Colour, units::written(stated), quantity.to_owned()),
        (None, _, None) => (Kind::Number, units::written(stated), quantity.to_owned()),
        // Depth and disparity as pictures.
        (None, 1 | 2, Some(_)) if !stated.is_empty() && !stated.ends_with("bits") => {
            (Kind::Number, stated.to_owned(), quantity.to_owned())
        }
        // A raw whose levels nobody states.
        (None, 1 | 2, Some(_)) if photograph.stated.encoding == Encoding::Linear => {
            (Kind::Number, "DN".to_owned(), format!("linear ({})", photograph.stated.reason))
        }
        (None, _, Some(full)) => {
            let stated = &photograph.stated;
            let kind = Kind::Picture { full, encoding: stated.encoding.name() };
            (kind, "DN".to_owned(), format!("{} ({})", stated.encoding.name(), stated.reason))
        }
    };
    Ok(Layer { name: file.stem.clone(), kind, unit, meaning, size, planes: planes(photograph) })
}

/// Colour, or the one channel; transparency is left out.
fn planes(photograph: Photograph) -> Vec<NamedPlane> {
    let full = photograph.full_scale;
    let shown = photograph.channels.into_iter().filter(|channel| channel.name != "A");
    let plane = |Channel { name, samples }: Channel| {
        let samples = match full {
            Some(full) if full <= 255.0 => Samples::Bytes(samples.iter().map(|v| *v as u8).collect()),
            Some(full) if full <= 65_535.0 => Samples::Words(samples.iter().map(|v| *v as u16).collect()),
            Some(_) => Samples::Whole(samples.iter().map(|v| *v as u32).collect()),
            None => Samples::Exact(samples),
        };
        NamedPlane::value(name, samples)
    };
    shown.map(plane).collect()
}
