//! The camera file of the results: keys with their standard uncertainties. Required keys that no measurement determines are
//! placeholders, marked as such, or are left to a base file.

use etendue_core::maths::f64::{hypot, log10};
use etendue_pipeline::stated_projection;
use etendue_scene::written::{File, Table};

use super::spread::{Spread, is_significant};
use super::{
    colour::Colour, electronics::Electronics, fall_off::FallOff, folder::Laboratory, identity::PLACEHOLDER_PITCH_UM,
    point_picture::PointSpreadImage,
};
use crate::measure::views::CalibratedViews as Geometry;
use crate::report::{Estimate, with_uncertainty};

/// Placeholder.
const F_NUMBER: f64 = 4.0;
const FIELD_OF_VIEW_DEG: f64 = 60.0;
const EXPOSURE_S: f64 = 0.01;
const EFFICIENCY: f64 = 0.5;
const BITS: u64 = 12;
const FULL_WELL_E: f64 = 10_000.0;
const PLACEHOLDER: &str = "a placeholder: not measured";
const SETTING_COMMENT: &str = "a setting, not measured";

/// All results.
#[derive(Default)]
pub(super) struct CharacterisationResults {
    pub(super) electronics: Option<Electronics>,
    pub(super) fall_off: Option<FallOff>,
    pub(super) geometry: Option<Geometry>,
    pub(super) spread: Option<Spread>,
    pub(super) colour: Option<Colour>,
    /// Exposure time of the lens images, s.
    pub(super) exposure_s: Option<f64>,
}

/// A camera file, and which of its values are placeholders.
pub(super) struct CameraFile {
    pub(super) text: String,
    pub(super) placeholders: Vec<String>,
}

/// Keys as they are collected, with comments.
struct CameraFileBuilder<'a> {
    laboratory: &'a Laboratory,
    results: &'a CharacterisationResults,
    /// True if a base file supplies what is not known.
    has_base: bool,
    comments: Vec<(String, String)>,
    placeholders: Vec<String>,
}

/// Returns the camera file; `base` is the file that it extends, `picture` the name of the image of the point spread.
pub(super) fn camera_file(
    laboratory: &Laboratory,
    results: &CharacterisationResults,
    base: Option<&str>,
    image: Option<(&str, &PointSpreadImage)>,
) -> CameraFile {
    let mut builder = CameraFileBuilder {
        laboratory,
        results,
        has_base: base.is_some(),
        comments: Vec::new(),
        placeholders: Vec::new(),
    };
    let mut table = Table::new();
    let (lens, effects, sensor, isp) = (builder.lens(), builder.effects(image), builder.sensor(), builder.isp());
    if let Some(base) = base {
        table.put("base", base);
    }
    for (key, part) in [("lens", lens), ("effects", effects), ("sensor", sensor), ("isp", isp)] {
        if let Some(part) = part {
            table.put(key, part);
        }
    }
    let name = laboratory.camera.name.as_ref().map_or_else(String::new, |name| format!(": {name}"));
    let head = format!(
        "Measured by etendue characterise from {} images{name}. ± is one standard uncertainty.",
        laboratory.count()
    );
    let file = File::new(table).head(head);
    let file = builder.comments.iter().fold(file, |file, (key, comment)| file.beside(key, comment.clone()));
    CameraFile { text: file.to_string(), placeholders: builder.placeholders }
}

/// Rounds a number to a hundredth of its standard uncertainty.
fn rounded(e: Estimate) -> f64 {
    let (value, u) = (e.value, e.standard_uncertainty);
    if !(u > 0.0 && u.is_finite()) {
        return value;
    }
    let decimals = (2.0 - log10(u).floor()).clamp(0.0, 17.0) as usize;
    format!("{value:.decimals$}").parse().unwrap_or(value)
}

impl CameraFileBuilder<'_> {
    fn comment(&mut self, key: &str, comment: impl Into<String>) {
        self.comments.push((key.to_owned(), comment.into()));
    }

    /// Writes a measured number that cannot be negative.
    fn measured(&mut self, table: &mut Table, section: &str, key: &str, e: Estimate) {
        table.put(key, rounded(Estimate::new(e.value.max(0.0), e.standard_uncertainty)));
        self.comment(&format!("{section}.{key}"), format!("± {:.1e}", e.standard_uncertainty));
    }

    /// Writes a measured number, or a placeholder if no base has it.
    fn measured_or_placeholder(
        &mut self,
        table: &mut Table,
        section: &str,
        key: &str,
        e: Option<Estimate>,
        placeholder: f64,
    ) {
        match e {
            Some(e) => self.measured(table, section, key, e),
            None => self.placeholder(table, section, key, placeholder),
        }
    }

    /// Writes a setting of the camera, or a placeholder for it.
    fn setting(&mut self, table: &mut Table, section: &str, key: &str, known: Option<f64>, placeholder: f64) {
        match known {
            Some(known) => {
                table.put(key, known);
                self.comment(&format!("{section}.{key}"), SETTING_COMMENT);
            }
            None => self.placeholder(table, section, key, placeholder),
        }
    }

    fn placeholder(&mut self, table: &mut Table, section: &str, key: &str, value: f64) {
        if !self.has_base {
            table.put(key, value);
            self.comment(&format!("{section}.{key}"), PLACEHOLDER);
            self.placeholders.push(format!("{section}.{key}"));
        }
    }

    fn lens(&mut self) -> Option<Table> {
        let results = self.results;
        let mut lens = Table::new();
        match &results.geometry {
            Some(geometry) => {
                lens.put("type", "calibrated");
                lens.put("projection", stated_projection(&geometry.camera.calibration).to_table().in_line());
                let each =
                    geometry.camera.parameters.iter().map(|p| format!("{} {}", p.name, with_uncertainty(p.estimate)));
                self.comment("lens.projection", each.collect::<Vec<_>>().join(", "));
            }
            None if self.has_base => {}
            None => {
                lens.put("type", "calibrated");
                let projection = Table::new().with("type", "rectilinear").with("field_of_view_deg", FIELD_OF_VIEW_DEG);
                lens.put("projection", projection.in_line());
                self.comment("lens.projection", PLACEHOLDER);
                self.placeholders.push("lens.projection".to_owned());
            }
        }
        // The base states a lens of another type.
        if results.geometry.is_none() && self.has_base {
            return None;
        }
        // The lens is stated again, and so is its f-number.
        let based = std::mem::replace(&mut self.has_base, false);
        self.setting(&mut lens, "lens", "f_number", self.laboratory.camera.f_number, F_NUMBER);
        self.has_base = based;
        if let Some(fall_off) = &results.fall_off {
            let [radius_mm, ratio] = self.illumination(fall_off);
            let list = |values: &[f64]| {
                values.iter().map(|v| format!("{v:.6}").parse::<f64>().unwrap_or(*v)).collect::<Vec<_>>()
            };
            let table = Table::new().with("radius_mm", list(&radius_mm)).with("ratio", list(&ratio));
            lens.put("relative_illumination", table);
            self.comment("lens.relative_illumination.ratio", format!("± {:.1e} at the corner", fall_off.corner_u));
        }
        Some(lens)
    }

    /// Radii, mm, and ratios, out to the corner farthest from the principal point.
    fn illumination(&self, fall_off: &FallOff) -> [Vec<f64>; 2] {
        let (mut radii, mut ratios) = (fall_off.radius_mm.clone(), fall_off.ratio.clone());
        let Some(geometry) = &self.results.geometry else { return [radii, ratios] };
        let (matrix, size) = (geometry.camera.calibration.matrix(), self.laboratory.camera.size_px.map(|n| n as f64));
        let farthest = |at: f64, length: f64| at.max(length - at);
        let corner_px = hypot(farthest(matrix.cx, size[0]), farthest(matrix.cy, size[1]));
        let corner_mm = 0.001 * self.laboratory.camera.pixel_pitch_um.unwrap_or(PLACEHOLDER_PITCH_UM) * corner_px;
        if radii.last().is_some_and(|last| corner_mm >= *last) {
            radii.push(1.001 * corner_mm);
            ratios.extend(fall_off.ratio.last());
        }
        [radii, ratios]
    }

    fn effects(&mut self, image: Option<(&str, &PointSpreadImage)>) -> Option<Table> {
        let (name, image) = image?;
        let psf = Table::new().with("image", std::path::Path::new(name)).with("image_pitch_um", image.pitch_um);
        self.comment("effects.psf.image", image.about());
        Some(Table::new().with("psf", psf))
    }

    fn sensor(&mut self) -> Option<Table> {
        let [width, height] = self.laboratory.camera.size_px;
        let mut sensor = Table::new().with("width_px", width as u64).with("height_px", height as u64);
        let pitch_um = self.laboratory.camera.pixel_pitch_um;
        self.setting(&mut sensor, "sensor", "pixel_pitch_um", pitch_um, PLACEHOLDER_PITCH_UM);
        let results = self.results;
        if let Some(electronics) = &results.electronics {
            self.electronics(&mut sensor, electronics);
        }
        Some(sensor)
    }

    fn electronics(&mut self, sensor: &mut Table, electronics: &Electronics) {
        let f = electronics.figures;
        self.setting(sensor, "sensor", "exposure_s", self.results.exposure_s, EXPOSURE_S);
        match self.laboratory.camera.cfa.clone() {
            Some(cfa) => sensor.put("cfa", cfa),
            None if self.has_base => {}
            None => {
                sensor.put("cfa", "mono");
                self.comment("sensor.cfa", PLACEHOLDER);
                self.placeholders.push("sensor.cfa".to_owned());
            }
        }
        self.efficiency(sensor, electronics);
        let full_well = Some(f.saturation_e).filter(|_| electronics.saturated);
        let fallback = f.saturation_e.value.max(FULL_WELL_E);
        self.measured_or_placeholder(sensor, "sensor", "full_well_e", full_well, fallback);
        self.measured(sensor, "sensor", "read_noise_e", f.dark_noise_e);
        self.measured_or_placeholder(sensor, "sensor", "dark_current_e_s", electronics.dark_current_e_s, 0.0);
        self.measured(sensor, "sensor", "gain_dn_per_e", f.gain_dn_per_e);
        self.measured(sensor, "sensor", "black_level_dn", electronics.black_level_dn);
        match self.laboratory.camera.bits {
            Some(bits) => sensor.put("bits", bits),
            None if self.has_base => {}
            None => {
                sensor.put("bits", BITS);
                self.comment("sensor.bits", PLACEHOLDER);
                self.placeholders.push("sensor.bits".to_owned());
            }
        }
        self.crosstalk(sensor);
        if let Some(patterns) = &electronics.patterns {
            let mut table = Table::new();
            let (prnu, dsnu) = (patterns.prnu, patterns.dsnu_e);
            for (key, e) in [
                ("prnu", prnu.pixel),
                ("prnu_row", prnu.row),
                ("prnu_column", prnu.column),
                ("dsnu_e", dsnu.pixel),
                ("dsnu_row_e", dsnu.row),
                ("dsnu_column_e", dsnu.column),
            ] {
                self.measured(&mut table, "sensor.non_uniformity", key, e);
            }
            if let Some(fraction) = electronics.dead.as_ref().and_then(|dead| dead.fraction) {
                self.measured(&mut table, "sensor.non_uniformity", "dead_fraction", fraction);
            }
            sensor.put("non_uniformity", table);
        }
        if let Some((fraction, mean)) = electronics.hot.as_ref().and_then(|hot| hot.fraction.zip(hot.mean_e_s)) {
            let mut hot = Table::new();
            self.measured(&mut hot, "sensor.dark.hot", "fraction", fraction);
            self.measured(&mut hot, "sensor.dark.hot", "mean_e_s", mean);
            sensor.put("dark", Table::new().with("hot", hot));
        }
    }

    fn efficiency(&mut self, sensor: &mut Table, electronics: &Electronics) {
        match &electronics.efficiency {
            Some((channels, wavelength_nm)) => {
                let values: Vec<f64> = channels.iter().map(|(_, e)| rounded(*e)).collect();
                let each: Vec<String> =
                    channels.iter().map(|(_, e)| format!("± {:.1e}", e.standard_uncertainty)).collect();
                match values[..] {
                    [only] => sensor.put("quantum_efficiency", only),
                    _ => sensor.put("quantum_efficiency", values),
                }
                let note = format!("{}; measured at {wavelength_nm} nm, used for all wavelengths", each.join(", "));
                self.comment("sensor.quantum_efficiency", note);
            }
            None => self.placeholder(sensor, "sensor", "quantum_efficiency", EFFICIENCY),
        }
    }

    /// Crosstalk between neighbours; for a mosaic, that of the neighbours of green pixels.
    fn crosstalk(&mut self, sensor: &mut Table) {
        let Some(spread) = self.results.spread else { return };
        let exchange = |blur: Option<etendue_metrology::sfr::Blur>| blur.map(|blur| blur.exchange);
        let Some((across, along)) = exchange(spread.along_rows).zip(exchange(spread.along_columns)) else { return };
        if !(is_significant(across) || is_significant(along)) {
            return;
        }
        let [side, below] = self.neighbours_over_green();
        let mut table = Table::new();
        self.measured(&mut table, "sensor.crosstalk", "horizontal", across.scaled(1.0 / side));
        self.measured(&mut table, "sensor.crosstalk", "vertical", along.scaled(1.0 / below));
        sensor.put("crosstalk", table);
    }

    /// Light of the pixels to the right of and below the first green one, relative to its own.
    fn neighbours_over_green(&self) -> [f64; 2] {
        let camera = &self.laboratory.camera;
        let (Some(cfa), Some(colour)) = (camera.cfa.as_ref().filter(|_| camera.is_mosaic()), &self.results.colour)
        else {
            return [1.0; 2];
        };
        let tile = cfa.as_bytes();
        let Some(at) = tile.iter().position(|letter| *letter == b'g').filter(|_| tile.len() == 4) else {
            return [1.0; 2];
        };
        let light = |at: usize| match tile[at] {
            b'r' => colour.white_balance[1].value / colour.white_balance[0].value,
            b'b' => colour.white_balance[1].value / colour.white_balance[2].value,
            _ => 1.0,
        };
        [light(at ^ 1), light(at ^ 2)]
    }

    fn isp(&mut self) -> Option<Table> {
        let colour = self.results.colour?;
        let mut isp = Table::new();
        let list = |row: [Estimate; 3]| row.map(rounded).to_vec();
        let uncertainties = |row: [Estimate; 3]| row.map(|e| format!("{:.1e}", e.standard_uncertainty)).join(", ");
        isp.put("white_balance", list(colour.white_balance));
        self.comment("isp.white_balance", format!("± {}", uncertainties(colour.white_balance)));
        if let Some(matrix) = colour.matrix {
            isp.put("colour_matrix", matrix.map(list).to_vec());
            self.comment("isp.colour_matrix", format!("± {}", matrix.map(uncertainties).join("; ")));
        }
        // These keys belong to spectral responsivities, which only a base has.
        self.has_base.then_some(isp)
    }
}
