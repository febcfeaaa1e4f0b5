//! Facts about the camera from its images and from the laboratory file.

use etendue_io::failure::{Error, ErrorCode};
use etendue_scene::record;

use super::shot::LaboratoryImage;

/// Placeholder for the pixel pitch, µm, if nothing states it.
pub(super) const PLACEHOLDER_PITCH_UM: f64 = 5.0;

/// Facts about the camera.
#[derive(Clone, Debug, Default)]
pub(super) struct CameraFacts {
    /// Maker, model and number, as far as EXIF data state them.
    pub(super) name: Option<String>,
    pub(super) size_px: [usize; 2],
    pub(super) pixel_pitch_um: Option<f64>,
    pub(super) bits: Option<u64>,
    pub(super) f_number: Option<f64>,
    /// Colour filters as a camera file names them; "mono" if side-cars state that there are none.
    pub(super) cfa: Option<String>,
    /// Filters that raw images do not state themselves, in the form that measurements accept.
    pub(super) stated_cfa: Option<String>,
    /// Reading of a saturated pixel, DN, if stated.
    pub(super) white_level_dn: Option<f64>,
}

impl CameraFacts {
    pub(super) fn from_shots(shots: &[LaboratoryImage], stated: &record::Laboratory) -> Result<Self, Error> {
        let first = |fact: fn(&LaboratoryImage) -> Option<f64>| shots.iter().find_map(fact);
        let stated_cfa = stated.cfa.as_ref().map(|cfa| cfa.value.clone());
        let exif_filters = shots.iter().find_map(|shot| shot.exif.filters.clone());
        let exif_filters =
            exif_filters.filter(|(columns, tile)| *columns == 2 && tile.len() == 4).map(|(_, tile)| tile);
        let side_car_channels = shots.iter().find_map(|shot| shot.raw.as_ref().map(|raw| &raw.filters.channels));
        if let (Some(stated_cfa), Some(channels)) = (&stated_cfa, side_car_channels) {
            return Err(Error::coded(
                ErrorCode::NoEffect,
                format!(
                    "laboratory.toml: cfa = \"{stated_cfa}\" has no effect: side-cars state the filters {}; remove it",
                    channels.join(", ")
                ),
            ));
        }
        let known_cfa = stated_cfa.or(exif_filters);
        let letters = |channels: &Vec<String>| match channels.len() {
            1 => "mono".to_owned(),
            _ => channels.iter().filter_map(|channel| channel.chars().next()).collect(),
        };
        let cfa = side_car_channels.map(letters).or(known_cfa.clone()).map(|cfa| cfa.to_ascii_lowercase());
        let words = |shot: &LaboratoryImage| {
            let parts =
                [&shot.exif.make, &shot.exif.model, &shot.exif.serial].map(|part| part.clone().unwrap_or_default());
            Some(parts.join(" ").split_whitespace().collect::<Vec<_>>().join(" ")).filter(|name| !name.is_empty())
        };
        Ok(Self {
            name: shots.iter().find_map(words),
            size_px: shots.first().map_or([0, 0], |shot| shot.size_px),
            pixel_pitch_um: stated
                .pixel_pitch_um
                .as_ref()
                .map(|p| p.value)
                .or_else(|| first(|shot| shot.side_car.pixel_pitch_um)),
            bits: stated.bits.as_ref().map(|bits| bits.value).or_else(|| shots.iter().find_map(|s| s.side_car.bits)),
            f_number: (stated.f_number.as_ref().map(|p| p.value))
                .or_else(|| first(|shot| shot.side_car.f_number))
                .or_else(|| first(|shot| shot.exif.f_number)),
            white_level_dn: first(|shot| shot.raw.as_ref().map(|raw| raw.white_level_dn))
                .or_else(|| first(|shot| shot.exif.white_level_dn)),
            cfa,
            stated_cfa: known_cfa,
        })
    }

    /// True if pixels have colour filters.
    pub(super) fn is_mosaic(&self) -> bool {
        self.cfa.as_ref().is_some_and(|cfa| cfa != "mono")
    }

    /// The channel that represents the camera: green of a mosaic.
    pub(super) fn channel(&self) -> Option<String> {
        self.is_mosaic().then(|| "green".to_owned())
    }
}
