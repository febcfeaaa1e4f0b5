//! From a descriptor's images to the curve and the fixed patterns.
//!
//! Photon transfer also takes groups of any number of frames, each of one exposure time, from a laboratory without a descriptor.
//!
//! Every group is a level of the curve. The fixed patterns come from the largest lit group below saturation and from the dark
//! group of its exposure time, if both have three frames or more. The dark current comes from all dark groups. Everything else
//! comes from the dark groups at the exposure times of the lit groups, as long exposures contain the noise of their dark current.

use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicUsize;

use etendue_core::observer::Observer;
use etendue_io::emva_descriptor::{DescribedLevel, EmvaDescriptor};
use etendue_io::failure::{Error, ErrorCode};
use etendue_metrology::Image;
use etendue_metrology::photon_transfer::{Figures, Level, Pattern, Stack, TransferData, TransferError, nonuniformity};
use rayon::prelude::*;

use super::request::{FixedPatterns, PtcResults};
use crate::measure::pictures::{Clipping, ImageProgress};
use crate::measure::readings::Selection;

/// Levels measured in parallel, and frames read ahead: twice as many images are in memory at a time.
const PARALLEL_LEVELS: usize = 4;

/// Reader of a descriptor's images.
pub(super) struct GroupReader<'a> {
    pub(super) selection: &'a Selection,
    pub(super) descriptor: &'a EmvaDescriptor,
    pub(super) pictures: ImageProgress<'a>,
}

pub(super) fn refused(error: TransferError) -> Error {
    Error::coded(ErrorCode::NotMeasurable, error.to_string())
}

/// Adds images to a stack; the first creates it.
fn add(stack: &mut Option<Stack>, images: &[(&Path, Image)]) -> Result<(), Error> {
    for (file, image) in images {
        let named =
            |error: TransferError| Error::coded(ErrorCode::MalformedFile, format!("{}: {error}", file.display()));
        let stack = stack.get_or_insert_with(|| Stack::new(image.width(), image.height()));
        stack.push(image).map_err(named)?;
    }
    Ok(())
}

impl GroupReader<'_> {
    /// Measures everything that the images determine.
    pub(super) fn results(&self) -> Result<PtcResults, Error> {
        let (pairs, stacks): (Vec<_>, Vec<_>) = self.descriptor.levels.iter().partition(|level| level.files.len() == 2);
        let mut levels = Vec::new();
        for some in pairs.chunks(PARALLEL_LEVELS) {
            levels.extend(some.par_iter().map(|level| self.pair(level)).collect::<Result<Vec<_>, Error>>()?);
        }
        let bright = |(level, marks): &(Level, Vec<u64>)| if level.photons > 0.0 { marks.clone() } else { Vec::new() };
        let mut marks: Vec<u64> = levels.iter().flat_map(bright).collect();
        marks.sort_unstable();
        if marks.windows(2).any(|pair| pair[0] == pair[1]) {
            return Err(refused(TransferError::Copies));
        }
        let levels: Vec<Level> = levels.into_iter().map(|(level, _)| level).collect();
        let data = TransferData::new(&levels).map_err(refused)?;
        let cuts = self.cuts(&pairs, &data)?;
        let figures = data.figures().map_err(refused)?;
        let fixed = self.fixed_patterns(&stacks, &data, &figures)?;
        Ok(PtcResults { data, figures, fixed, clippings: cuts })
    }

    /// Returns notes of clipped images that enter the result: dark levels, and levels up to 70 % of saturation. Above these, clipped images are part of the
    /// series, and the standard excludes them.
    fn cuts(&self, pairs: &[&DescribedLevel], data: &TransferData) -> Result<Vec<String>, Error> {
        let max_photons = data.bright()[data.sensitivity_end() - 1].photons;
        let full_scale = Some(self.descriptor.bits).filter(|bits| *bits > 0);
        let full_scale = full_scale.map(|bits| ((1_u64 << bits.min(32)) - 1) as f64);
        let used = pairs.iter().filter(|level| level.photons <= max_photons);
        let note = |level: &&&DescribedLevel| {
            let file = &level.files[0];
            let image = self.selection.raw(file)?.image;
            let cut = Clipping::from_region(&image, full_scale);
            Ok(cut.map(|cut| format!("{}: {}; the figures do not account for it", file.display(), cut.words())))
        };
        let notes = used.map(|level| note(&level)).collect::<Result<Vec<_>, Error>>()?;
        Ok(notes.into_iter().flatten().collect())
    }

    fn pair(&self, level: &DescribedLevel) -> Result<(Level, Vec<u64>), Error> {
        let stack = self.stack(level)?;
        let statistics = stack.statistics().map_err(refused)?;
        let marks = stack.fingerprints().to_vec();
        Ok((Level { exposure_s: level.exposure_s, photons: level.photons, statistics }, marks))
    }

    /// Reads the images of a level in order and adds them up, while the next are read.
    pub(super) fn stack(&self, level: &DescribedLevel) -> Result<Stack, Error> {
        let mut stack: Option<Stack> = None;
        let mut waiting = Vec::new();
        for files in level.files.chunks(PARALLEL_LEVELS) {
            let (added, read) = rayon::join(|| add(&mut stack, &waiting), || self.images(files));
            added?;
            waiting = read?;
        }
        add(&mut stack, &waiting)?;
        Ok(stack.expect("a described level has images"))
    }

    fn images<'f>(&self, files: &'f [PathBuf]) -> Result<Vec<(&'f Path, Image)>, Error> {
        files.par_iter().map(|file| Ok((file.as_path(), self.image(file)?))).collect()
    }

    fn image(&self, file: &Path) -> Result<Image, Error> {
        let readings = self.selection.raw(file)?;
        readings.independent(file, 1)?;
        let image = readings.image;
        let full_image = self.selection.region.is_none() && self.selection.channel.is_none();
        let (size, expected) = ((image.width(), image.height()), (self.descriptor.width, self.descriptor.height));
        if full_image && size != expected {
            return Err(Error::coded(
                ErrorCode::NotComparable,
                format!("{}: {}", file.display(), TransferError::Size { size, expected }),
            ));
        }
        self.check_bits(file, &image)?;
        self.pictures.step();
        Ok(image)
    }

    /// Refuses readings beyond the descriptor's bits; 0 bits mean unstated.
    fn check_bits(&self, file: &Path, image: &Image) -> Result<(), Error> {
        let bits = self.descriptor.bits;
        let full = ((1_u64 << bits.min(32)) - 1) as f64;
        let greatest = image.samples().iter().copied().fold(0.0, f32::max);
        if bits == 0 || f64::from(greatest) <= full {
            return Ok(());
        }
        let shifted = (1..=16 - bits.min(16)).rev().find(|shift| {
            let step = (1_u32 << shift) as f32;
            image.samples().iter().all(|sample| sample % step == 0.0)
        });
        let advice = match shifted {
            Some(shift) => format!(
                "all are multiples of {}; store the numbers in the lower {bits} bits, or write \"n {} …\" for numbers of {} bits",
                1 << shift,
                bits + shift,
                bits + shift
            ),
            None => "correct the bits of the line \"n\"".to_owned(),
        };
        Err(Error::coded(
            ErrorCode::Contradiction,
            format!(
                "{}: readings up to {greatest} exceed the {bits} bits of the descriptor, which end at {}; {advice}",
                file.display(),
                full
            ),
        ))
    }

    fn fixed_patterns(
        &self,
        stacks: &[&DescribedLevel],
        data: &TransferData,
        figures: &Figures,
    ) -> Result<Option<FixedPatterns>, Error> {
        let dark = stacks.iter().find(|level| level.photons == 0.0);
        let bright = stacks.iter().find(|level| level.photons > 0.0);
        let (dark, bright) = match (dark, bright) {
            (Some(dark), Some(bright)) => (dark, bright),
            (None, None) => return Ok(None),
            _ => {
                return Err(Error::coded(
                    ErrorCode::WrongCount,
                    "stacks of more than two images: expected one with light and one without, of equal exposure time",
                ));
            }
        };
        if stacks.len() > 2 || dark.exposure_s != bright.exposure_s {
            return Err(Error::coded(
                ErrorCode::WrongCount,
                "stacks of more than two images: expected two, of equal exposure time",
            ));
        }
        let (dark, bright) = (self.stack(dark)?, self.stack(bright)?);
        let pattern = |stack| Pattern::from_stack(stack).map_err(refused);
        let gain = figures.gain_dn_per_e;
        let patterns = nonuniformity(&pattern(&dark)?, &pattern(&bright)?, gain, data).map_err(refused)?;
        Ok(Some(FixedPatterns { dark, bright, patterns }))
    }
}

/// Minimum number of frames for a fixed pattern.
const MIN_STACK_FRAMES: usize = 3;

/// A group of frames, read.
pub(crate) struct FrameGroup {
    pub(crate) level: Level,
    pub(crate) stack: Stack,
}

/// Reads and adds up the frames of groups.
///
/// # Errors
/// If an image cannot be used, or a group has only one frame.
pub(crate) fn groups(
    selection: &Selection,
    levels: &[DescribedLevel],
    observer: &dyn Observer,
) -> Result<Vec<FrameGroup>, Error> {
    let total = levels.iter().map(|level| level.files.len()).sum();
    let progress = ImageProgress { heading: "photon transfer", done: AtomicUsize::new(0), total, observer };
    let descriptor = EmvaDescriptor { bits: 0, width: 0, height: 0, levels: Vec::new() };
    let reading = GroupReader { selection, descriptor: &descriptor, pictures: progress };
    let group = |level: &DescribedLevel| {
        let stack = reading.stack(level)?;
        let statistics = stack.statistics().map_err(refused)?;
        Ok(FrameGroup { level: Level { exposure_s: level.exposure_s, photons: level.photons, statistics }, stack })
    };
    levels.iter().map(group).collect()
}

/// Results from lit and dark groups.
///
/// # Errors
/// If they do not determine the curve.
pub(crate) fn measure_groups(groups: &[FrameGroup]) -> Result<PtcResults, TransferError> {
    let lit = |group: &&FrameGroup| group.level.photons > 0.0;
    let times: Vec<f64> = groups.iter().filter(lit).map(|group| group.level.exposure_s).collect();
    let levels = |includes: &dyn Fn(&FrameGroup) -> bool| -> Vec<Level> {
        groups.iter().filter(|group| includes(group)).map(|group| group.level).collect()
    };
    let data = TransferData::new(&levels(&|group| lit(&group) || times.contains(&group.level.exposure_s)))?;
    let mut figures = data.figures()?;
    let all = TransferData::new(&levels(&|_| true))?.figures()?;
    figures.dark_current_mean_e_per_s = all.dark_current_mean_e_per_s;
    figures.dark_current_variance_e_per_s = all.dark_current_variance_e_per_s;
    let fixed = match stacks(groups, &data) {
        Some((dark, bright)) => {
            let patterns = nonuniformity(
                &Pattern::from_stack(dark)?,
                &Pattern::from_stack(bright)?,
                figures.gain_dn_per_e,
                &data,
            )?;
            Some(FixedPatterns { dark: dark.clone(), bright: bright.clone(), patterns })
        }
        None => None,
    };
    Ok(PtcResults { data, figures, fixed, clippings: Vec::new() })
}

/// The stacks of the fixed patterns: dark and lit.
fn stacks<'a>(groups: &'a [FrameGroup], data: &TransferData) -> Option<(&'a Stack, &'a Stack)> {
    let saturation = data.bright()[data.saturation()].statistics.mean_dn.value;
    let below =
        |group: &&FrameGroup| group.level.photons > 0.0 && group.level.statistics.mean_dn.value < 0.9 * saturation;
    let many = |group: &&FrameGroup| group.stack.frames() >= MIN_STACK_FRAMES;
    let dark_of = |bright: &FrameGroup| {
        let dark = groups.iter().filter(|g| g.level.photons == 0.0 && g.level.exposure_s == bright.level.exposure_s);
        dark.filter(many).max_by_key(|group| group.stack.frames())
    };
    let pairs = groups.iter().filter(below).filter(many).filter_map(|bright| Some((dark_of(bright)?, bright)));
    let by_size = |(_, bright): &(&FrameGroup, &FrameGroup)| (bright.stack.frames(), bright.level.photons.to_bits());
    pairs.max_by_key(by_size).map(|(dark, bright)| (&dark.stack, &bright.stack))
}
