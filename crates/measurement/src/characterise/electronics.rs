//! Gain, noise, dark current, fixed patterns and defective pixels: from frames without light and with uniform illumination.

use etendue_core::observer::Observer;
use etendue_io::emva_descriptor::DescribedLevel;
use etendue_io::failure::{Error, ErrorCode};
use etendue_metrology::patch_statistics::patch_statistics;
use etendue_metrology::photon_transfer::{
    DarkStack, Figures, MIN_OUTLIERS, Nonuniformity, Outliers, Pattern, dead_pixels, hot_pixels, nonuniformity,
};

use super::parameter::{Findings, ImageKind};
use super::{folder::Laboratory, shot::LaboratoryImage};
use crate::measure::ptc::{self, FrameGroup, PtcRequest, PtcResults};
use crate::{measure::Selection, report::Estimate};

/// Border, px: pixels there have fewer neighbours to exchange light with.
const BORDER_PX: usize = 2;
/// Photons per second where their number is not known: any unit of light serves.
const PLACEHOLDER_PHOTONS_PER_S: f64 = 1e6;
const QUANTITIES: &str = "gain, noise, dark current, capacity, DSNU, PRNU, defective pixels";

/// Sensor results.
#[derive(Clone, Debug)]
pub(super) struct Electronics {
    pub(super) figures: Figures,
    /// Its uncertainty includes the variation between units.
    pub(super) black_level_dn: Estimate,
    /// Excludes hot pixels.
    pub(super) dark_current_e_s: Option<Estimate>,
    /// True if the light reached saturation.
    pub(super) saturated: bool,
    pub(super) patterns: Option<Nonuniformity>,
    pub(super) hot: Option<Outliers>,
    pub(super) dead: Option<Outliers>,
    /// By channel, at a wavelength.
    pub(super) efficiency: Option<(Vec<(&'static str, Estimate)>, f64)>,
}

pub(super) fn measure(
    laboratory: &Laboratory,
    findings: &mut Findings,
    observer: &dyn Observer,
) -> Result<Option<Electronics>, Error> {
    let (dark, flat) = (laboratory.shots(ImageKind::Dark), laboratory.shots(ImageKind::Flat));
    for (shots, kind) in [(&dark, ImageKind::Dark), (&flat, ImageKind::Flat)] {
        if shots.is_empty() {
            findings.missing(QUANTITIES, kind);
            return Ok(None);
        }
    }
    let selection = selection(laboratory, &flat);
    let photons_per_s = laboratory.stated.flat.as_ref().map(|light| light.photons_per_s.value);
    let all_levels = levels(&dark, 0.0)
        .and_then(|dark| Ok([dark, levels(&flat, photons_per_s.unwrap_or(PLACEHOLDER_PHOTONS_PER_S))?].concat()));
    let groups_result = all_levels.and_then(|levels| ptc::groups(&selection, &levels, observer));
    let Some(groups) = findings.record(QUANTITIES, groups_result)? else { return Ok(None) };
    let Some(results) = findings.record(
        QUANTITIES,
        ptc::measure_groups(&groups).map_err(|error| Error::coded(ErrorCode::NotMeasurable, error.to_string())),
    )?
    else {
        return Ok(None);
    };
    let request =
        PtcRequest { relative_light: photons_per_s.is_none(), selection: selection.clone(), ..PtcRequest::new("") };
    findings.part("Photon transfer", ImageKind::Flat, ptc::report(&request, &results));
    let (hot, dead) = outliers(laboratory, &groups, &results);
    let patterns = findings.record("DSNU, PRNU", patterns(&results, &hot, &dead))?.flatten();
    let efficiency = match &laboratory.stated.flat {
        Some(light) => findings
            .record("quantum efficiency of the channels", efficiency(&selection, &flat, &results))?
            .map(|e| (e, light.wavelength_nm.value)),
        None => None,
    };
    let size = [groups[0].stack.width(), groups[0].stack.height()];
    let electronics = Electronics {
        figures: results.figures,
        black_level_dn: black_level(&results.figures, patterns.as_ref(), size),
        dark_current_e_s: results
            .figures
            .dark_current_mean_e_per_s
            .map(|mean| without_hot_pixels(mean, hot.as_ref(), groups[0].stack.width() * groups[0].stack.height())),
        saturated: results.data.saturation_reached(),
        patterns,
        hot,
        dead,
        efficiency,
    };
    electronics.report_results(findings);
    Ok(Some(electronics))
}

/// The pixels to measure: green ones of a mosaic, without the border.
fn selection(laboratory: &Laboratory, shots: &[&LaboratoryImage]) -> Selection {
    let region = shots.first().map(|shot| {
        let [x, y, width, height] = shot.picture_px;
        [x + BORDER_PX, y + BORDER_PX, width.saturating_sub(2 * BORDER_PX), height.saturating_sub(2 * BORDER_PX)]
    });
    let camera = &laboratory.camera;
    Selection { channel: camera.channel(), cfa: camera.stated_cfa.clone(), region, ..Selection::default() }
}

/// Groups frames by exposure time.
fn levels(shots: &[&LaboratoryImage], photons_per_s: f64) -> Result<Vec<DescribedLevel>, Error> {
    let mut levels: Vec<DescribedLevel> = Vec::new();
    for shot in shots {
        let exposure_s = shot.exposure_s.ok_or_else(|| {
            Error::coded(
                ErrorCode::NotStated,
                format!(
                    "{}: its exposure time is not stated by EXIF data, a side-car or exposures_s in laboratory.toml; add it to exposures_s",
                    shot.name()
                ),
            )
        })?;
        match levels.iter_mut().find(|level| level.exposure_s == exposure_s) {
            Some(level) => level.files.push(shot.file.clone()),
            None => {
                let photons = photons_per_s * exposure_s;
                levels.push(DescribedLevel { exposure_s, photons, files: vec![shot.file.clone()] });
            }
        }
    }
    if let Some(single) = levels.iter().find(|level| level.files.len() < 2) {
        return Err(Error::coded(
            ErrorCode::NotMeasurable,
            format!(
                "{}: the only frame of {} s in its folder; noise needs two or more frames per exposure time",
                single.files[0].display(),
                single.exposure_s
            ),
        ));
    }
    levels.sort_by(|a, b| a.exposure_s.total_cmp(&b.exposure_s));
    Ok(levels)
}

/// Hot and dead pixels.
fn outliers(
    laboratory: &Laboratory,
    groups: &[FrameGroup],
    results: &PtcResults,
) -> (Option<Outliers>, Option<Outliers>) {
    let dark = || groups.iter().filter(|group| group.level.photons == 0.0);
    let by_time = |a: &&FrameGroup, b: &&FrameGroup| a.level.exposure_s.total_cmp(&b.level.exposure_s);
    let hot = dark().min_by(by_time).zip(dark().max_by(by_time)).and_then(|(short, long)| {
        let [long, short] =
            [long, short].map(|group| DarkStack { frames: &group.stack, exposure_s: group.level.exposure_s });
        hot_pixels(&long, &short, results.figures.gain_dn_per_e.value, laboratory.camera.white_level_dn)
    });
    (hot, results.fixed.as_ref().map(|fixed| dead_pixels(&fixed.dark, &fixed.bright)))
}

/// Fixed patterns of the pixels that are neither hot nor dead: those have their own keys.
fn patterns(
    results: &PtcResults,
    hot: &Option<Outliers>,
    dead: &Option<Outliers>,
) -> Result<Option<Nonuniformity>, Error> {
    let Some(fixed) = &results.fixed else { return Ok(None) };
    let places: Vec<[usize; 2]> =
        [hot, dead].into_iter().flatten().flat_map(|outliers| outliers.positions.clone()).collect();
    let [dark, bright] = [&fixed.dark, &fixed.bright].map(|stack| Pattern::from_stack(&stack.replacing(&places)));
    let refused = |error: etendue_metrology::photon_transfer::TransferError| {
        Error::coded(ErrorCode::NotMeasurable, error.to_string())
    };
    let gain = results.figures.gain_dn_per_e;
    nonuniformity(&dark.map_err(refused)?, &bright.map_err(refused)?, gain, &results.data).map(Some).map_err(refused)
}

/// Returns the mean dark current without the contribution of hot pixels. The uncertainty includes the sampling of pixels of this
/// unit (variation between units).
fn without_hot_pixels(mean: Estimate, hot: Option<&Outliers>, pixels: usize) -> Estimate {
    let Some(hot) = hot else { return mean };
    let (u, unit_uncertainty) = (mean.standard_uncertainty, hot.spread_e_s / (pixels as f64).sqrt());
    Estimate::new(mean.value - hot.added_e_s, (u * u + unit_uncertainty * unit_uncertainty).sqrt())
}

/// Returns the mean without light. The uncertainty includes the variation of pixels, rows and columns between units.
fn black_level(figures: &Figures, patterns: Option<&Nonuniformity>, [columns, rows]: [usize; 2]) -> Estimate {
    let mean = figures.dark_level_dn;
    let Some(Nonuniformity { dsnu_dn, .. }) = patterns else { return mean };
    let part = |e: Estimate, count: usize| e.value * e.value / count as f64;
    let unit_term = part(dsnu_dn.pixel, columns * rows) + part(dsnu_dn.row, rows) + part(dsnu_dn.column, columns);
    let u = mean.standard_uncertainty;
    Estimate::new(mean.value, (u * u + unit_term).sqrt())
}

/// Quantum efficiency of each channel: that of the measured channel times the channel's relative signal in the brightest
/// unsaturated frames.
fn efficiency(
    selection: &Selection,
    flat: &[&LaboratoryImage],
    results: &PtcResults,
) -> Result<Vec<(&'static str, Estimate)>, Error> {
    let own = results.figures.quantum_efficiency;
    if selection.channel.is_none() {
        return Ok(vec![("mono", own)]);
    }
    let usable = flat.iter().filter(|shot| shot.saturated == 0.0);
    let brightest = usable.max_by(|a, b| a.exposure_s.unwrap_or(0.0).total_cmp(&b.exposure_s.unwrap_or(0.0)));
    let brightest =
        brightest.ok_or_else(|| Error::coded(ErrorCode::NotMeasurable, "every frame in flat/ has saturated pixels"))?;
    let all = Selection { channel: None, ..selection.clone() };
    let colours = all.colours(&brightest.file)?;
    let colours = colours.ok_or_else(|| {
        Error::coded(ErrorCode::NotMeasurable, format!("{}: has no red, green and blue", brightest.name()))
    })?;
    let black = results.figures.dark_level_dn.value;
    let [red, green, blue] = colours.each_ref().map(|c| {
        let mean = patch_statistics(&c.image, c.shared_px).mean;
        Estimate::new(mean.value - black, mean.standard_uncertainty)
    });
    let relative_efficiency = |c: Estimate| {
        let ratio = c.value / green.value;
        let parts = [c, green, own].map(|e| e.standard_uncertainty / e.value);
        let relative = parts.iter().map(|r| r * r).sum::<f64>().sqrt();
        Estimate::new(own.value * ratio, own.value * ratio * relative)
    };
    Ok(vec![("red", relative_efficiency(red)), ("green", own), ("blue", relative_efficiency(blue))])
}

impl Electronics {
    fn report_results(&self, findings: &mut Findings) {
        let f = &self.figures;
        let from = ImageKind::Flat;
        findings.add_parameter(from, "sensor.gain_dn_per_e", "system gain K", "DN/e⁻", f.gain_dn_per_e);
        findings.add_parameter(ImageKind::Dark, "sensor.read_noise_e", "read noise", "e⁻", f.dark_noise_e);
        findings.add_parameter(ImageKind::Dark, "sensor.black_level_dn", "black level", "DN", self.black_level_dn);
        match self.saturated {
            true => findings.add_parameter(from, "sensor.full_well_e", "saturation capacity", "e⁻", f.saturation_e),
            false => findings.unknown(
                "saturation capacity",
                "the variance does not fall at the brightest level in flat/, so \
                                                              saturation is at or above it; expose longer",
            ),
        }
        match self.dark_current_e_s {
            Some(current) => findings.add_parameter(
                ImageKind::Dark,
                "sensor.dark_current_e_s",
                "dark current of pixels that are not hot",
                "e⁻/s",
                current,
            ),
            None => findings.unknown("dark current", "frames in dark/ have fewer than three exposure times"),
        }
        match &self.efficiency {
            Some((channels, _)) => {
                for (channel, value) in channels {
                    let (key, label) =
                        (format!("sensor.quantum_efficiency.{channel}"), format!("quantum efficiency, {channel}"));
                    findings.add_parameter(from, &key, &label, "", *value);
                }
                findings.unknown("quantum efficiency at other wavelengths", "the light in flat/ has one wavelength");
            }
            None => findings.unknown(
                "quantum efficiency",
                "the number of photons of the light in flat/ is not stated; add [flat] to laboratory.toml",
            ),
        }
        self.patterns(findings);
        self.outliers(findings);
    }

    fn patterns(&self, findings: &mut Findings) {
        let Some(patterns) = &self.patterns else {
            let reason = "stacks of three frames or more at one exposure time are missing: one in dark/, one in flat/ at half of saturation";
            return findings.unknown("DSNU and PRNU", reason);
        };
        let mut add_parameter = |from: ImageKind, key: &str, label: &str, unit, value| {
            findings.add_parameter(from, &format!("sensor.non_uniformity.{key}"), label, unit, value);
        };
        let (dsnu, prnu) = (patterns.dsnu_e, patterns.prnu);
        add_parameter(ImageKind::Dark, "dsnu_e", "DSNU, pixels", "e⁻", dsnu.pixel);
        add_parameter(ImageKind::Dark, "dsnu_row_e", "DSNU, rows", "e⁻", dsnu.row);
        add_parameter(ImageKind::Dark, "dsnu_column_e", "DSNU, columns", "e⁻", dsnu.column);
        add_parameter(ImageKind::Flat, "prnu", "PRNU, pixels", "", prnu.pixel);
        add_parameter(ImageKind::Flat, "prnu_row", "PRNU, rows", "", prnu.row);
        add_parameter(ImageKind::Flat, "prnu_column", "PRNU, columns", "", prnu.column);
    }

    fn outliers(&self, findings: &mut Findings) {
        match &self.hot {
            None => findings.unknown("hot pixels", "frames in dark/ have one exposure time only"),
            Some(hot) => match hot.fraction.zip(hot.mean_e_s) {
                Some((fraction, mean)) => {
                    findings.add_parameter(
                        ImageKind::Dark,
                        "sensor.dark.hot.fraction",
                        "hot pixels, fraction",
                        "",
                        fraction,
                    );
                    findings.add_parameter(
                        ImageKind::Dark,
                        "sensor.dark.hot.mean_e_s",
                        "hot pixels, mean additional current",
                        "e⁻/s",
                        mean,
                    );
                }
                None => {
                    findings.unknown("hot pixels", outlier_list(hot, &format!("have more than {:.0} e⁻/s", hot.limit)));
                }
            },
        }
        if let Some(dead) = &self.dead {
            match dead.fraction {
                Some(fraction) => findings.add_parameter(
                    ImageKind::Flat,
                    "sensor.non_uniformity.dead_fraction",
                    "dead pixels, fraction",
                    "",
                    fraction,
                ),
                None => findings
                    .unknown("dead pixels", outlier_list(dead, "respond to light with less than half of the mean")),
            }
        }
    }
}

fn outlier_list(outliers: &Outliers, label: &str) -> String {
    let count = outliers.positions.len();
    let places: Vec<String> = outliers.positions.iter().map(|[x, y]| format!("{x},{y}")).collect();
    let at = if places.is_empty() {
        String::new()
    } else {
        format!(" (column, row of the measured area: {})", places.join("; "))
    };
    format!("{count} pixels {label}{at}: at least {MIN_OUTLIERS} are needed to determine a fraction")
}
