//! Zemax's "Huygens PSF" and "FFT PSF".
//!
//! ```text
//! Listing of Huygens PSF Data                      Listing of FFT PSF Data
//! 0.5000 µm at 0.0000, 1.2250 (deg).               0.5000 µm at 0.0000, 1.2250 (deg).
//! Data spacing is 0.289 µm.                        Data spacing is 0.288 µm.
//! Image grid size: 64 by 64                        Reference Coordinates: 0.0E+00, 2.20488E+02
//! Center point is: 33, 33                          Image grid size: 64 by 64
//! Center coordinates : 0.0E+00, 2.20E+02 Millim…   Center point is: row 33, column 32
//! Values are relative intensity.                   Values are not normalized.
//! ```
//!
//! and rows of numbers, their columns with increasing x. **The first row has the largest y** in both. Of Huygens listings the centre's column counts from the left
//! and its row **from the last row** upwards, of FFT listings, which state "row" and "column", the row counts from the first. Determined from the listings in
//! the test data of batoid (github.com/jmeyers314/batoid, `tests/testdata/LSST_hpsf_*`, `LSST_fftpsf_*`, `HSC_huygensPSF.txt`): with this rule centroids agree
//! with those that the Huygens heads also state ("Centroid offset", +3.408 µm of y at 1.225°, +1.612 µm of x and y at 1.176° both ways) to 5 nm, those on the
//! axis are symmetric about the centre, and the FFT listings of the same fields agree; batoid's own functions agree after it flips the rows. Older versions
//! write one field, of y ("0.5500 µm at -27.38 deg.").
//!
//! Fields in mm are taken as positions in the image. Not read: Strehl ratio, pupil grid, area.

use etendue_scene::asset::{FieldPoint, PointSpreadAsset};

use super::listing::{Listing, ListingTable};
use crate::Error;

/// Ratio of border to largest value from which on a note states that the listing is truncated.
const CUT_OFF: f64 = 0.01;

/// Kind of analysis.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Analysis {
    Huygens,
    Fft,
}

pub(super) fn read(listing: &Listing<'_>) -> Result<PointSpreadAsset, Error> {
    let analysis = match ["huygens psf", "fft psf"].map(|words| listing.header_contains(words)) {
        [true, _] => Analysis::Huygens,
        [_, true] => Analysis::Fft,
        _ => {
            let problem =
                "not a listing of a point-spread function: its header mentions neither \"Huygens PSF\" nor \"FFT PSF\"";
            return Err(listing.error(0, problem));
        }
    };
    let [table] = &listing.tables[..] else {
        let second = listing.tables[1].rows[0].line;
        return Err(listing.error(second, "contains a second table; export one field position per file"));
    };
    let mut notes = Vec::new();
    let [width, height] = size(listing, table)?;
    let (wavelengths_nm, field) = field(listing)?;
    let spacing_um = spacing_um(listing)?;
    let place_mm = place_mm(listing, &mut notes);
    let point = point(listing, analysis, [width, height], &mut notes)?;
    let light = light(listing, table)?;
    if place_mm.is_none() && matches!(field, FieldPoint::Millimetres(_)) {
        notes.push("its field in mm is interpreted as an image position".to_owned());
    }
    let asset =
        PointSpreadAsset { field, place_mm, wavelengths_nm, spacing_um, width, light, point, notes, hash: [0; 32] };
    Ok(checked(asset, listing))
}

/// Columns and rows, checked against the header.
fn size(listing: &Listing<'_>, table: &ListingTable<'_>) -> Result<[usize; 2], Error> {
    let actual = [table.rows[0].numbers.len(), table.rows.len()];
    let stated = head_entry(listing, "image grid size").map(|(line, text)| (line, numbers(text)));
    match stated {
        Some((line, stated)) if stated.len() == 2 && stated != actual.map(|n| n as f64) => {
            let message = format!(
                "the header states {} by {} samples, but the file has {} rows of {}; save the whole listing",
                stated[0], stated[1], actual[1], actual[0]
            );
            Err(listing.error(line, message))
        }
        _ => Ok(actual),
    }
}

/// Shortest and longest wavelength, nm, and the field: "0.4861 to 0.6563 µm at 0.0000, 14.0000 (deg).".
fn field(listing: &Listing<'_>) -> Result<([f64; 2], FieldPoint), Error> {
    let named = |text: &str| ["file", "title", "date"].iter().any(|word| text.to_lowercase().starts_with(word));
    let remaining = listing.head.iter().filter(|(_, text)| !named(text));
    let lines = remaining.filter_map(|(line, text)| Some((*line, text.split_once(" at ")?)));
    let stated = lines.map(|(line, (light, field))| (line, numbers(light), light, numbers(field), field));
    let Some((line, light, unit, field, words)) = stated
        .into_iter()
        .find(|(_, light, _, field, _)| (1..=2).contains(&light.len()) && (1..=2).contains(&field.len()))
    else {
        let problem = "its header does not state wavelength and field; expected a line such as \"0.5500 µm at 0.0000, 14.0000 (deg).\"";
        return Err(listing.error(0, problem));
    };
    let um =
        length_um(unit).ok_or_else(|| listing.error(line, "the wavelength is not in a unit of length; expected µm"))?;
    let nm = [light[0], light[light.len() - 1]].map(|value| (value * um * 1e9).round() / 1e6);
    if !nm.iter().all(|nm| (100.0..20_000.0).contains(nm)) || nm[0] > nm[1] {
        return Err(listing.error(
            line,
            format!("found wavelengths from {} to {} nm; expected 100 … 20 000 nm, increasing", nm[0], nm[1]),
        ));
    }
    // A single number is y.
    let at = if let [y] = field[..] { [0.0, y] } else { [field[0], field[1]] };
    let words = words.to_lowercase();
    let field = if words.contains("deg") {
        FieldPoint::Degrees(at)
    } else if words.contains("mm") || words.contains("millimet") {
        FieldPoint::Millimetres(at)
    } else {
        let problem = "the field is neither in degrees nor in mm; export with fields as angles or image heights";
        return Err(listing.error(line, problem));
    };
    Ok((nm, field))
}

fn spacing_um(listing: &Listing<'_>) -> Result<f64, Error> {
    let Some((line, text)) = head_entry(listing, "data spacing") else {
        return Err(listing.error(
            0,
            "its header does not state the sample spacing; expected a line such as \"Data spacing is 0.250 µm.\"",
        ));
    };
    let spacing = numbers(text).first().copied().zip(length_um(text)).map(|(number, um)| number * um);
    spacing.filter(|um| um.is_finite() && *um > 0.0).ok_or_else(|| {
        listing.error(
            line,
            "the sample spacing is not a length above 0 on the sensor; expected µm, of a lens that forms an image",
        )
    })
}

/// Position of the point on the sensor.
fn place_mm(listing: &Listing<'_>, notes: &mut Vec<String>) -> Option<[f64; 2]> {
    let (_, text) =
        head_entry(listing, "center coordinates").or_else(|| head_entry(listing, "reference coordinates"))?;
    let unit = lens_unit_mm(text);
    if unit.is_none() {
        notes.push("its coordinates on the sensor are assumed to be in mm".to_owned());
    }
    match numbers(text)[..] {
        [x, y] => Some([x, y].map(|value| value * unit.unwrap_or(1.0))),
        _ => None,
    }
}

/// Sample index of the point, from 0: column from the left, row from the first.
fn point(
    listing: &Listing<'_>,
    analysis: Analysis,
    [width, height]: [usize; 2],
    notes: &mut Vec<String>,
) -> Result<[usize; 2], Error> {
    let Some((line, text)) = head_entry(listing, "center point") else {
        notes.push("no centre is stated: the middle sample is used, as in listings that state one".to_owned());
        return Ok(match analysis {
            Analysis::Huygens => [width / 2, (height - 1) / 2],
            Analysis::Fft => [(width - 1) / 2, height / 2],
        });
    };
    let index_of = |value: f64, max: usize| (1..=max).find(|index| *index as f64 == value);
    let by_name = text.to_lowercase().contains("row");
    let position = match numbers(text)[..] {
        [row, column] if by_name => index_of(column, width).zip(index_of(row, height)),
        [column, row] => index_of(column, width).zip(index_of(row, height).map(|row| height + 1 - row)),
        _ => None,
    };
    let problem = || {
        listing.error(
            line,
            format!("the centre is not one of the {width} by {height} samples; expected whole numbers from 1"),
        )
    };
    position.map(|(column, row)| [column - 1, row - 1]).ok_or_else(problem)
}

fn light(listing: &Listing<'_>, table: &ListingTable<'_>) -> Result<Vec<f32>, Error> {
    if let Some((line, text)) =
        head_entry(listing, "values are").filter(|(_, text)| text.to_lowercase().contains("log"))
    {
        return Err(listing.error(line, format!("found \"Values are{text}\"; export with the type \"Linear\"")));
    }
    let mut light = Vec::with_capacity(table.rows.len() * table.rows[0].numbers.len());
    for row in &table.rows {
        if let Some(wrong) = row.numbers.iter().find(|value| **value < 0.0) {
            return Err(
                listing.error(row.line, format!("found the value {wrong}; expected 0 or more (the type \"Linear\")"))
            );
        }
        light.extend(row.numbers.iter().map(|value| *value as f32));
    }
    if light.iter().all(|value| *value == 0.0) {
        return Err(listing.error(table.rows[0].line, "all values are 0; expected values above 0"));
    }
    Ok(light)
}

/// Adds notes on missing light, and on samples that disagree with the header.
fn checked(mut asset: PointSpreadAsset, listing: &Listing<'_>) -> PointSpreadAsset {
    let (width, height) = (asset.width, asset.light.len() / asset.width);
    let (mut sum, mut centroid, mut peak, mut border) = (0.0, [0.0; 2], 0.0_f32, 0.0_f32);
    for (i, light) in asset.light.iter().enumerate() {
        let (x, y) = (i % width, i / width);
        peak = peak.max(*light);
        if x == 0 || y == 0 || x + 1 == width || y + 1 == height {
            border = border.max(*light);
        }
        let light = f64::from(*light);
        sum += light;
        centroid[0] += light * (x as f64 - asset.point[0] as f64);
        centroid[1] += light * (asset.point[1] as f64 - y as f64);
    }
    let border = f64::from(border / peak);
    if border > CUT_OFF {
        asset.notes.push(format!(
            "the value at its border is {:.1} % of the maximum: light beyond the border is omitted",
            100.0 * border
        ));
    }
    let computed = centroid.map(|moment| moment / sum * asset.spacing_um);
    let stated =
        head_entry(listing, "centroid offset").map(|(_, text)| (numbers(text), lens_unit_mm(text).unwrap_or(1.0)));
    if let Some((stated, mm)) = stated.filter(|(stated, _)| stated.len() == 2) {
        let stated = [stated[0], stated[1]].map(|value| value * mm * 1e3);
        if computed.iter().zip(stated).any(|(coordinate, stated)| (coordinate - stated).abs() > asset.spacing_um) {
            asset.notes.push(format!(
                "the centroid is {:.2}, {:.2} µm from the centre, but the header states {:.2}, {:.2} µm: the order of the rows may differ from the \
                 expected one",
                computed[0], computed[1], stated[0], stated[1]
            ));
        }
    }
    asset
}

/// Header line that begins with some words, in lower case, and the text after them.
fn head_entry<'a>(listing: &Listing<'a>, words: &str) -> Option<(usize, &'a str)> {
    listing.head.iter().find_map(|(line, text)| {
        let begins = text.get(..words.len()).is_some_and(|begin| begin.eq_ignore_ascii_case(words));
        begins.then(|| (*line, &text[words.len()..]))
    })
}

/// The numbers among the words of a line.
fn numbers(text: &str) -> Vec<f64> {
    let words = text.split([' ', '\t', ',', ':', '(', ')']).map(|word| word.strip_suffix('.').unwrap_or(word));
    words.filter_map(|word| word.parse().ok()).filter(|number: &f64| number.is_finite()).collect()
}

/// Micrometres per unit that a line names.
fn length_um(text: &str) -> Option<f64> {
    let words = text.split([' ', '\t']).map(|word| word.trim_end_matches(['.', ',']).to_lowercase());
    words
        .filter_map(|word| match &word[..] {
            "mm" | "millimeters" | "millimetres" => Some(1e3),
            "nm" | "nanometers" => Some(1e-3),
            "um" | "microns" | "micrometers" | "micrometres" => Some(1.0),
            // Micro: two letters of Unicode, or a damaged form of them.
            word if word.ends_with('m') && word.chars().count() == 2 && !word.is_ascii() => Some(1.0),
            _ => None,
        })
        .next()
}

/// Millimetres per lens unit that a line names.
fn lens_unit_mm(text: &str) -> Option<f64> {
    let units = [("millimet", 1.0), ("centimet", 10.0), ("inch", 25.4), ("meter", 1e3), ("metre", 1e3)];
    let text = text.to_lowercase();
    units.into_iter().find(|(name, _)| text.contains(name)).map(|(_, mm)| mm)
}
