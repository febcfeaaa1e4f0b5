//! `etendue measure ptc`: photon transfer after EMVA 1288.

mod defects;
mod plots;
mod told;

use super::readings::Selection;
use super::report::{CameraOut, Telling};
use crate::failure::Failure;
use crate::progress::PictureBar;
use clap::Args;
use etendue_io::emva_descriptor::{DescribedLevel, EmvaDescriptor, read_emva_descriptor};
use etendue_io::photograph::Stated;
use etendue_metrology::Image;
use etendue_metrology::photon_transfer::{
    Figures, Level, Nonuniformity, Pattern, Stack, TransferData, TransferError, nonuniformity,
};
use rayon::prelude::*;
use std::path::{Path, PathBuf};

/// `etendue measure ptc`
#[derive(Debug, Args)]
pub struct Ptc {
    /// A descriptor file of the EMVA 1288 reference program: levels of light with their pictures, two a level for the curve, more
    /// for DSNU and PRNU
    #[arg(value_name = "DESCRIPTOR.txt")]
    pub descriptor: PathBuf,
    /// The descriptor's photons are relative: leave out what needs their number
    #[arg(long)]
    pub relative_light: bool,
    #[command(flatten)]
    pub selection: Selection,
    #[command(flatten)]
    pub telling: Telling,
    #[command(flatten)]
    pub out: CameraOut,
}

impl Ptc {
    /// A measurement that is not told by itself.
    pub(super) fn of(descriptor: PathBuf, selection: &Selection) -> Self {
        let telling = Telling { json: false, plot: None };
        Self { descriptor, relative_light: true, selection: selection.clone(), telling, out: CameraOut::default() }
    }
}

/// Levels measured side by side, and frames read ahead: twice as many pictures are in memory at a time.
const AT_A_TIME: usize = 4;

/// Reading of a descriptor's pictures.
struct Reading<'a> {
    selection: &'a Selection,
    descriptor: &'a EmvaDescriptor,
    bar: PictureBar,
}

/// Everything that was found.
struct Found {
    data: TransferData,
    figures: Figures,
    fixed: Option<Fixed>,
}

/// Of the stacks.
struct Fixed {
    dark: Stack,
    bright: Stack,
    patterns: Nonuniformity,
}

pub(super) fn run(arguments: &Ptc) -> Result<(), Failure> {
    let descriptor = read_emva_descriptor(&arguments.descriptor).map_err(Failure::input)?;
    let found = measure(arguments, &descriptor)?;
    let mut report = told::report(arguments, &found);
    report.encoding(&stated(&arguments.selection, &descriptor)?);
    report.tell_with_camera(&arguments.telling, &arguments.out)
}

/// What the numbers of a descriptor's pictures are taken for, by the first of them.
fn stated(selection: &Selection, descriptor: &EmvaDescriptor) -> Result<Stated, Failure> {
    let first = descriptor.levels.iter().find_map(|level| level.files.first()).expect("a descriptor has pictures");
    let photograph = selection.encoding.photograph(first)?;
    Ok(selection.encoding.raw(first, photograph)?.stated)
}

/// The curve's figures, and what the pictures' numbers are taken for.
pub(super) fn measured(arguments: &Ptc) -> Result<(Figures, Stated), Failure> {
    let descriptor = read_emva_descriptor(&arguments.descriptor).map_err(Failure::input)?;
    Ok((measure(arguments, &descriptor)?.figures, stated(&arguments.selection, &descriptor)?))
}

fn measure(arguments: &Ptc, descriptor: &EmvaDescriptor) -> Result<Found, Failure> {
    let pictures = descriptor.levels.iter().map(|level| level.files.len()).sum();
    let bar = PictureBar::new("photon transfer", pictures);
    let reading = Reading { selection: &arguments.selection, descriptor, bar };
    let found = reading.found();
    reading.bar.finish();
    found
}

fn refused(error: TransferError) -> Failure {
    Failure::input(error)
}

/// Adds pictures to a stack, which the first begins.
fn add(stack: &mut Option<Stack>, images: &[(&Path, Image)]) -> Result<(), Failure> {
    for (file, image) in images {
        let named = |error: TransferError| Failure::input(format!("{}: {error}", file.display()));
        let stack = stack.get_or_insert_with(|| Stack::new(image.width(), image.height()));
        stack.push(image).map_err(named)?;
    }
    Ok(())
}

impl Reading<'_> {
    fn found(&self) -> Result<Found, Failure> {
        let (pairs, stacks): (Vec<_>, Vec<_>) = self.descriptor.levels.iter().partition(|level| level.files.len() == 2);
        let mut levels = Vec::new();
        for some in pairs.chunks(AT_A_TIME) {
            levels.extend(some.par_iter().map(|level| self.pair(level)).collect::<Result<Vec<_>, Failure>>()?);
        }
        let bright = |(level, marks): &(Level, Vec<u64>)| if level.photons > 0.0 { marks.clone() } else { Vec::new() };
        let mut marks: Vec<u64> = levels.iter().flat_map(bright).collect();
        marks.sort_unstable();
        if marks.windows(2).any(|pair| pair[0] == pair[1]) {
            return Err(refused(TransferError::Copies));
        }
        let levels: Vec<Level> = levels.into_iter().map(|(level, _)| level).collect();
        let data = TransferData::new(&levels).map_err(refused)?;
        let figures = data.figures().map_err(refused)?;
        let fixed = self.fixed_patterns(&stacks, &data, &figures)?;
        Ok(Found { data, figures, fixed })
    }

    fn pair(&self, level: &DescribedLevel) -> Result<(Level, Vec<u64>), Failure> {
        let stack = self.stack(level)?;
        let statistics = stack.statistics().map_err(refused)?;
        let marks = stack.fingerprints().to_vec();
        Ok((Level { exposure_s: level.exposure_s, photons: level.photons, statistics }, marks))
    }

    /// A level's pictures, added up in their order while the next are read.
    fn stack(&self, level: &DescribedLevel) -> Result<Stack, Failure> {
        let mut stack: Option<Stack> = None;
        let mut waiting = Vec::new();
        for files in level.files.chunks(AT_A_TIME) {
            let (added, read) = rayon::join(|| add(&mut stack, &waiting), || self.images(files));
            added?;
            waiting = read?;
        }
        add(&mut stack, &waiting)?;
        Ok(stack.expect("a described level has pictures"))
    }

    fn images<'f>(&self, files: &'f [PathBuf]) -> Result<Vec<(&'f Path, Image)>, Failure> {
        files.par_iter().map(|file| Ok((file.as_path(), self.image(file)?))).collect()
    }

    fn image(&self, file: &Path) -> Result<Image, Failure> {
        let readings = self.selection.raw(file)?;
        readings.independent(file, 1)?;
        let image = readings.image;
        let whole = self.selection.region.is_none() && self.selection.channel.is_none();
        let (size, expected) = ((image.width(), image.height()), (self.descriptor.width, self.descriptor.height));
        if whole && size != expected {
            return Err(Failure::input(format!("{}: {}", file.display(), TransferError::Size { size, expected })));
        }
        self.bar.step();
        Ok(image)
    }

    fn fixed_patterns(
        &self,
        stacks: &[&DescribedLevel],
        data: &TransferData,
        figures: &Figures,
    ) -> Result<Option<Fixed>, Failure> {
        let dark = stacks.iter().find(|level| level.photons == 0.0);
        let bright = stacks.iter().find(|level| level.photons > 0.0);
        let (dark, bright) = match (dark, bright) {
            (Some(dark), Some(bright)) => (dark, bright),
            (None, None) => return Ok(None),
            _ => {
                return Err(Failure::input(
                    "stacks of more than two pictures: expected one with light and one without, of one exposure time",
                ));
            }
        };
        if stacks.len() > 2 || dark.exposure_s != bright.exposure_s {
            return Err(Failure::input("stacks of more than two pictures: expected two, of one exposure time"));
        }
        let (dark, bright) = (self.stack(dark)?, self.stack(bright)?);
        let pattern = |stack| Pattern::of(stack).map_err(refused);
        let gain = figures.gain_dn_per_e;
        let patterns = nonuniformity(&pattern(&dark)?, &pattern(&bright)?, gain, data).map_err(refused)?;
        Ok(Some(Fixed { dark, bright, patterns }))
    }
}
