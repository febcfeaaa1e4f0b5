//! Selection of the readings of an image file.

use std::path::Path;

use clap::Args;
use etendue_arguments::{region, tile};
use etendue_io::failure::{Error, ErrorCode};
use etendue_io::photograph::{FilterTile, Photograph, SourcedEncoding};
use etendue_metrology::Image;
use etendue_spectra::colour::BT709;

use super::balanced_mosaic::balanced_mosaic;
use super::encoding::{EncodingChoice, LightConversion};

/// In place of a colour's name: the mosaic's colours balanced to one grey, one reading per pixel.
pub(crate) const BALANCED: &str = "balanced";

/// Selection of a part of an image.
#[derive(Args, Clone, Debug, Default)]
pub struct Selection {
    /// Channel to measure: R, G, B or Y of an image (an EXR channel by its full name), a colour of a raw mosaic [default: the only
    /// one, or the luminance]
    #[arg(long, value_name = "NAME")]
    pub channel: Option<String>,
    /// Colour filters of a raw image without a side-car: a tile of two by two from the top left, row by row, e.g. RGGB
    #[arg(long, value_name = "TILE", value_parser = tile)]
    pub cfa: Option<String>,
    /// Part to measure: left column, top row, width and height, pixels of the file
    #[arg(long, value_name = "X,Y,W,H", value_parser = region)]
    pub region: Option<[usize; 4]>,
    /// Conversion from numbers to light.
    #[command(flatten)]
    pub encoding: EncodingChoice,
}

/// The readings of an image in proportion to light, as far as the file states: luminance if it is in colour and no channel is
/// named.
pub(crate) struct Readings {
    pub image: Image,
    /// Largest reading that the file can hold, in the readings' own unit.
    pub full_scale: Option<f64>,
    /// Reading without light, if a side-car states it.
    pub black: Option<f64>,
    /// Columns and rows of the file from one reading to the next: those of a mosaic's tile, otherwise 1.
    pub period: (usize, usize),
    /// Column and row of the first reading within the image.
    pub first: (usize, usize),
    /// Columns and rows of the image, of all colours.
    pub picture_px: (usize, usize),
    /// Conversion from the numbers of the file to light.
    pub stated: SourcedEncoding,
    /// Side of the blocks of readings with possibly equal errors (path reuse); 1: none.
    pub shared_px: usize,
}

impl Readings {
    pub(crate) fn size(&self) -> (usize, usize) {
        (self.image.width(), self.image.height())
    }

    /// Position among the readings of a point of the image, both in raster coordinates.
    pub(crate) fn place(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let along = |at: f64, first: usize, period: usize| (at - first as f64 - 0.5) / period as f64 + 0.5;
        [along(x, self.first.0, self.period.0), along(y, self.first.1, self.period.1)]
    }

    /// Position in the image of a point among the readings: the inverse of [`place`](Self::place).
    pub(crate) fn in_image(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let along = |at: f64, first: usize, period: usize| (at - 0.5) * period as f64 + first as f64 + 0.5;
        [along(x, self.first.0, self.period.0), along(y, self.first.1, self.period.1)]
    }

    /// The readings of a part that an argument states; `field` is the argument's name.
    pub(crate) fn part_of(&self, field: &str, region: [usize; 4]) -> Result<Image, Error> {
        self.part(region, &format!("`{field}`")).map_err(|error| error.with_field(field))
    }

    /// The readings of a part of the image, which must be inside it.
    pub(crate) fn part(&self, region: [usize; 4], name: &str) -> Result<Image, Error> {
        let [x, y, width, height] = region;
        let (columns, rows) = self.picture_px;
        if x.saturating_add(width) > columns || y.saturating_add(height) > rows {
            let message = format!("{name}: outside the {columns} × {rows} pixels that are measured");
            return Err(Error::coded(ErrorCode::OutOfRange, message));
        }
        let at = self.tile_region(region);
        let none = || {
            Error::coded(
                ErrorCode::NotMeasurable,
                format!("{name}: {width} × {height} pixels contain none of this colour"),
            )
        };
        at.map(|[x, y, width, height]| self.image.part(x, y, width, height)).ok_or_else(none)
    }

    fn tile_region(&self, [x, y, width, height]: [usize; 4]) -> Option<[usize; 4]> {
        let low = [x, y].map(|v| v as f64);
        self.between(low, [low[0] + width as f64, low[1] + height as f64])
    }

    /// Column and row of a [`part`](Self::part)'s first reading.
    pub(crate) fn first_of(&self, region: [usize; 4]) -> [usize; 2] {
        self.tile_region(region).map_or([0, 0], |[x, y, ..]| [x, y])
    }

    /// The readings whose pixels are entirely between two corners of the image: left column, top row, width, height.
    pub(crate) fn between(&self, low: [f64; 2], high: [f64; 2]) -> Option<[usize; 4]> {
        let along = |k: usize, first: usize, period: usize, count: usize| {
            let (first, period) = (first as f64, period as f64);
            let from = ((low[k] - first) / period).ceil().max(0.0) as usize;
            let end = ((high[k] - 1.0 - first) / period).floor() + 1.0;
            let end = (end.max(0.0) as usize).min(count);
            (end > from).then(|| (from, end - from))
        };
        let (width, height) = self.size();
        let (left, columns) = along(0, self.first.0, self.period.0, width)?;
        let (top, rows) = along(1, self.first.1, self.period.1, height)?;
        Some([left, top, columns, rows])
    }
}

/// Blocks consist of pixels of one colour: as many for raw readings, up to twice as wide for other images.
fn shared_px(photograph: &Photograph) -> usize {
    let side = f64::from(photograph.correlated_block_px).sqrt().ceil() as usize;
    if side > 1 && photograph.raw.is_none() { 2 * side } else { side }
}

impl Readings {
    /// Creates one reading for every measured pixel of an image.
    fn from_image(image: Image, photograph: &Photograph, light: &LightConversion) -> Self {
        let facts = photograph.raw.as_ref();
        Self {
            full_scale: facts.map_or(light.full_scale(photograph), |f| Some(light.number(f.white_level_dn))),
            black: facts.map(|f| light.number(f.black_level_dn)),
            period: (1, 1),
            first: (0, 0),
            picture_px: (image.width(), image.height()),
            stated: photograph.stated.clone(),
            shared_px: shared_px(photograph),
            image,
        }
    }

    /// Refuses readings whose errors are shared by more than `most` neighbours along a row.
    pub(crate) fn independent(&self, file: &Path, max_block_px: usize) -> Result<(), Error> {
        if self.shared_px <= max_block_px {
            return Ok(());
        }
        Err(Error::coded(
            ErrorCode::UnsuitableFile,
            format!(
                "{}: its errors are correlated in blocks of up to {1} × {1} readings because paths were shared (path_reuse_px), \
                 but this measurement assumes independent errors; render without sharing",
                file.display(),
                self.shared_px
            ),
        ))
    }

    /// Kind of the readings: raw or not, by the side-car.
    pub(crate) fn kind(&self) -> &'static str {
        if self.black.is_some() { "raw" } else { "picture" }
    }
}

impl Selection {
    /// One channel's readings as stored.
    pub(crate) fn stored(&self, file: &Path) -> Result<Readings, Error> {
        let photograph = self.encoding.stored(file)?;
        if self.channel.is_none() && photograph.channel("R").is_some() {
            let names = photograph.names().join(", ");
            let file = file.display();
            return Err(Error::coded(
                ErrorCode::NotStated,
                format!("{file}: choose the channel to measure with `channel`: {names}"),
            ));
        }
        self.read(file, &photograph)
    }

    /// The readings of an image's channel. For a mosaic, those of every place of the colour in the tile, separately, or for
    /// [`BALANCED`] of all pixels, with the colours of a tile of two by two balanced.
    pub(crate) fn planes(&self, file: &Path, photograph: &Photograph) -> Result<Vec<Readings>, Error> {
        let tile = self.mosaic(photograph).filter(|_| self.channel.as_deref() == Some(BALANCED));
        if tile.is_some_and(|tile| tile.columns == 2 && tile.channels.len() == 4) {
            return Ok(vec![self.balanced(file, photograph)?]);
        }
        let named = |tile: FilterTile| {
            let name = self.channel.clone().unwrap_or_default();
            tile.channels.iter().filter(|c| is_colour(c, &name)).count()
        };
        let count = self.mosaic(photograph).map_or(1, named).max(1);
        (0..count).map(|nth| self.nth(file, photograph, nth)).collect()
    }

    /// True if an image has a channel of this name, or its mosaic that colour.
    pub(crate) fn has(&self, photograph: &Photograph, name: &str) -> bool {
        match self.mosaic(photograph) {
            Some(tile) => tile.channels.iter().any(|c| is_colour(c, name)),
            None => photograph.channel(name).is_some(),
        }
    }

    /// One channel's readings, linearised if the file is display-encoded.
    pub(crate) fn linear(&self, file: &Path) -> Result<Readings, Error> {
        self.read(file, &self.encoding.photograph(file)?)
    }

    /// Red, green and blue of a colour image, linearised; `None` if it is not in colour.
    pub(crate) fn colours(&self, file: &Path) -> Result<Option<[Readings; 3]>, Error> {
        let photograph = self.encoding.photograph(file)?;
        if self.channel.is_some() || !["R", "G", "B"].into_iter().all(|name| self.has(&photograph, name)) {
            return Ok(None);
        }
        let one = |name: &str| {
            let channel = Some(name.to_owned());
            Self { channel, ..self.clone() }.read(file, &photograph)
        };
        Ok(Some([one("R")?, one("G")?, one("B")?]))
    }

    fn read(&self, file: &Path, photograph: &Photograph) -> Result<Readings, Error> {
        self.nth(file, photograph, 0)
    }

    /// For a mosaic, the readings of the colour's nth place in the tile.
    fn nth(&self, file: &Path, photograph: &Photograph, nth: usize) -> Result<Readings, Error> {
        self.check_cfa(file, photograph)?;
        let light = LightConversion::from_photograph(file, photograph)?;
        let linear = |name: &str| photograph.channel(name).map(|c| light.channel_light(c));
        let samples = match (&self.channel, self.mosaic(photograph)) {
            (_, Some(_)) => light.channel_light(&photograph.channels[0]),
            (Some(name), None) => linear(name).ok_or_else(|| no_channel(file, name, &photograph.names()))?,
            (None, None) => luminance(file, photograph, &light)?,
        };
        self.part(file, photograph, samples, &light, nth)
    }

    /// One channel's readings as stored, of a raw image.
    pub(crate) fn raw(&self, file: &Path) -> Result<Readings, Error> {
        let photograph = self.encoding.photograph(file)?;
        let colours: Vec<_> = photograph.channels.iter().filter(|c| c.name != "A").collect();
        let [only] = colours[..] else {
            let names = photograph.names().join(", ");
            let error = format!(
                "{}: a colour image ({names}), whose channels are processed; expected linear raw frames of one channel",
                file.display()
            );
            return Err(Error::coded(ErrorCode::UnsuitableFile, error));
        };
        let samples = only.samples.clone();
        let photograph = self.encoding.raw(file, photograph)?;
        self.check_cfa(file, &photograph)?;
        if let (Some(name), None) = (&self.channel, self.mosaic(&photograph)) {
            let error = format!(
                "{}: `channel` {name}: the colour filters of the pixels are not stated; give `cfa`, or leave `channel` out",
                file.display()
            );
            return Err(Error::coded(ErrorCode::NotStated, error));
        }
        self.part(file, &photograph, samples, &LightConversion::Stored, 0)
    }

    fn part(
        &self,
        file: &Path,
        photograph: &Photograph,
        samples: Vec<f32>,
        light: &LightConversion,
        nth: usize,
    ) -> Result<Readings, Error> {
        let area = self.area(photograph);
        let every = Readings::from_image(cropped(file, full_image(photograph, samples), area)?, photograph, light);
        let Some(tile) = self.mosaic(photograph) else { return Ok(every) };
        let period = (tile.columns, tile.channels.len() / tile.columns);
        let (image, first) = self.sites(file, &every.image, &tile, area, nth)?;
        Ok(Readings { image, period, first, ..every })
    }

    /// The readings of all pixels of a mosaic, with its colours balanced.
    fn balanced(&self, file: &Path, photograph: &Photograph) -> Result<Readings, Error> {
        self.check_cfa(file, photograph)?;
        let light = LightConversion::from_photograph(file, photograph)?;
        let samples = light.channel_light(&photograph.channels[0]);
        let mosaic = cropped(file, full_image(photograph, samples), self.area(photograph))?;
        let readings = Readings::from_image(mosaic, photograph, &light);
        Ok(Readings { image: balanced_mosaic(&readings.image, readings.full_scale), ..readings })
    }

    /// Refuses colour filters for images of more than one channel.
    fn check_cfa(&self, file: &Path, photograph: &Photograph) -> Result<(), Error> {
        match &self.cfa {
            Some(cfa) if photograph.channels.len() != 1 => {
                let names = photograph.names().join(", ");
                let error = format!(
                    "{}: `cfa` {cfa} has no effect on an image of the channels {names}, only on raw mosaics; leave it out",
                    file.display()
                );
                Err(Error::coded(ErrorCode::NoEffect, error))
            }
            _ => Ok(()),
        }
    }

    /// The colour filters: as stated by the user, or by the side-car; `None` if there is only one colour.
    fn mosaic(&self, photograph: &Photograph) -> Option<FilterTile> {
        let stated =
            self.cfa.as_ref().map(|text| FilterTile { columns: 2, channels: text.chars().map(String::from).collect() });
        let tile = stated.or_else(|| photograph.raw.as_ref().map(|facts| facts.filters.clone()))?;
        (photograph.channels.len() == 1 && tile.channels.len() > 1).then_some(tile)
    }

    /// The measured part: as stated by the user, otherwise the image area of the side-car, without dark rows and columns.
    fn area(&self, photograph: &Photograph) -> Option<[usize; 4]> {
        self.region.or_else(|| Some(photograph.raw.as_ref()?.frame.as_ref()?.picture_px))
    }

    /// The pixels under one colour of a mosaic, the nth of its name in the tile, and the column and row of the first of them.
    fn sites(
        &self,
        file: &Path,
        image: &Image,
        tile: &FilterTile,
        area: Option<[usize; 4]>,
        nth: usize,
    ) -> Result<(Image, (usize, usize)), Error> {
        let Some(name) = &self.channel else {
            let file = file.display();
            let names = tile.channels.join(", ");
            return Err(Error::coded(
                ErrorCode::NotStated,
                format!("{file}: a raw mosaic of the colours {names}; choose the one to measure with `channel`"),
            ));
        };
        let at = (0..tile.channels.len()).filter(|i| is_colour(&tile.channels[*i], name)).nth(nth);
        let names: Vec<&str> = tile.channels.iter().map(String::as_str).collect();
        let at = at.ok_or_else(|| no_channel(file, name, &names))?;
        let (columns, rows) = (tile.columns, tile.channels.len() / tile.columns);
        // A region that starts within a tile starts at another colour.
        let [left, top, ..] = area.unwrap_or_default();
        let first = |at: usize, start: usize, period: usize| (at + period - start % period) % period;
        let (x, y) = (first(at % columns, left, columns), first(at / columns, top, rows));
        let every = |first: usize, step: usize, end: usize| (first..end).step_by(step);
        let (width, height) = (every(x, columns, image.width()).count(), every(y, rows, image.height()).count());
        let rows = every(y, rows, image.height());
        let samples = rows.flat_map(|row| every(x, columns, image.width()).map(move |column| image.at(column, row)));
        Ok((Image::from_samples(width, height, samples.collect()).expect("counted"), (x, y)))
    }
}

/// One channel's numbers as an image.
fn full_image(photograph: &Photograph, samples: Vec<f32>) -> Image {
    Image::from_samples(photograph.width, photograph.height, samples).expect("a photograph's channels fill it")
}

/// True if a filter has this name, or the other usual one of its colour.
fn is_colour(filter: &str, name: &str) -> bool {
    let common_names = [("R", "red"), ("G", "green"), ("B", "blue")];
    filter == name || common_names.iter().any(|(a, b)| (filter, name) == (a, b) || (filter, name) == (b, a))
}

fn cropped(file: &Path, image: Image, area: Option<[usize; 4]>) -> Result<Image, Error> {
    let Some([x, y, width, height]) = area else { return Ok(image) };
    let (columns, rows) = (image.width(), image.height());
    if x.saturating_add(width) > columns || y.saturating_add(height) > rows {
        let (file, region_text) = (file.display(), format!("{x},{y},{width},{height}"));
        return Err(Error::coded(
            ErrorCode::OutOfRange,
            format!("{file}: the region {region_text} is outside the image's {columns} × {rows} pixels"),
        ));
    }
    Ok(image.part(x, y, width, height))
}

fn luminance(file: &Path, photograph: &Photograph, light: &LightConversion) -> Result<Vec<f32>, Error> {
    let linear = |name: &str| photograph.channel(name).map(|c| light.channel_light(c));
    if let Some(grey) = linear("Y") {
        return Ok(grey);
    }
    if let [only] = &photograph.channels[..] {
        return Ok(light.channel_light(only));
    }
    let Some(((r, g), b)) = linear("R").zip(linear("G")).zip(linear("B")) else {
        return Err(Error::coded(
            ErrorCode::NotStated,
            format!(
                "{}: choose the channel to measure with `channel`: {}",
                file.display(),
                photograph.names().join(", ")
            ),
        ));
    };
    let [red, green, blue] = BT709.map(|weight| weight as f32);
    // If one of them is clipped, the luminance is too: it is set to full scale.
    let full = light.full_scale(photograph).map(|full| full as f32);
    let mixed = |((r, g), b): ((&f32, &f32), &f32)| match full.filter(|full| r.max(*g).max(*b) >= *full) {
        Some(full) => full,
        None => red * r + green * g + blue * b,
    };
    Ok(r.iter().zip(&g).zip(&b).map(mixed).collect())
}

fn no_channel(file: &Path, name: &str, names: &[&str]) -> Error {
    Error::coded(
        ErrorCode::UnknownName,
        format!("{}: no channel '{name}'; it has {}", file.display(), names.join(", ")),
    )
}

/// Meaning of an image's numbers, where the file does not state it.
#[derive(Args, Clone, Debug, Default)]
pub struct SignalLevels {
    /// Reading without light, as stored; 0 to 1 for an image decoded from an encoding [default: the side-car's, or 0]
    #[arg(long, value_name = "READING", allow_negative_numbers = true)]
    pub black: Option<f64>,
    /// Reading of a saturated pixel, in the same unit [default: the side-car's, or the largest that the file can hold]
    #[arg(long, value_name = "READING", allow_negative_numbers = true)]
    pub full_scale: Option<f64>,
}

impl SignalLevels {
    pub(crate) fn black(&self, readings: &Readings) -> f64 {
        self.black.or(readings.black).unwrap_or(0.0)
    }

    pub(crate) fn full_scale(&self, readings: &Readings) -> Option<f64> {
        self.full_scale.or(readings.full_scale)
    }
}

/// The pixels of an image that are entirely between two corners: left column, top row, width, height; `None` if these are outside
/// it.
pub(crate) fn pixels(low: [f64; 2], high: [f64; 2], columns: usize, rows: usize) -> Option<[usize; 4]> {
    let start = low.map(f64::ceil);
    let end = high.map(f64::floor);
    let within = start[0] >= 0.0 && start[1] >= 0.0 && end[0] <= columns as f64 && end[1] <= rows as f64;
    let some = end[0] > start[0] && end[1] > start[1];
    (within && some).then(|| [start[0], start[1], end[0] - start[0], end[1] - start[1]].map(|v| v as usize))
}

/// Distance of a part's centre from the image centre, relative to the half diagonal.
pub(crate) fn field_position(at: &[usize; 4], width: usize, height: usize) -> f64 {
    let from = |start: usize, length: usize, full: usize| start as f64 + 0.5 * length as f64 - 0.5 * full as f64;
    let (x, y) = (from(at[0], at[2], width), from(at[1], at[3], height));
    let (w, h) = (0.5 * width as f64, 0.5 * height as f64);
    ((x * x + y * y) / (w * w + h * h)).sqrt()
}
