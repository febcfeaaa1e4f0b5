//! Photon transfer of groups of frames, each of one exposure time, of any number of frames: what a laboratory takes without a descriptor.
//!
//! Every group is a level of the curve. The fixed patterns are those of the largest group with light below saturation and of the dark one of its exposure time,
//! where both have three frames or more. The dark current is that of all dark groups; all else of those at the exposure times of the
//! groups with light, as long exposures have the noise of their dark current.

use super::found::{Fixed, Found};
use super::reading::{Reading, refused};
use crate::measure::pictures::Pictures;
use crate::measure::readings::Selection;
use etendue_core::observer::Observer;
use etendue_io::emva_descriptor::{DescribedLevel, EmvaDescriptor};
use etendue_io::failure::Error;
use etendue_metrology::photon_transfer::{Level, Pattern, Stack, TransferData, TransferError, nonuniformity};
use std::sync::atomic::AtomicUsize;

/// Frames of a fixed pattern.
const STACK: usize = 3;

/// A group that was read.
pub(crate) struct Group {
    pub(crate) level: Level,
    pub(crate) stack: Stack,
}

/// The frames of groups, read and added up.
///
/// # Errors
/// Where a picture cannot be used, or a group has one frame only.
pub(crate) fn groups(
    selection: &Selection,
    levels: &[DescribedLevel],
    observer: &dyn Observer,
) -> Result<Vec<Group>, Error> {
    let total = levels.iter().map(|level| level.files.len()).sum();
    let pictures = Pictures { heading: "photon transfer", done: AtomicUsize::new(0), total, observer };
    let descriptor = EmvaDescriptor { bits: 0, width: 0, height: 0, levels: Vec::new() };
    let reading = Reading { selection, descriptor: &descriptor, pictures };
    let group = |level: &DescribedLevel| {
        let stack = reading.stack(level)?;
        let statistics = stack.statistics().map_err(refused)?;
        Ok(Group { level: Level { exposure_s: level.exposure_s, photons: level.photons, statistics }, stack })
    };
    levels.iter().map(group).collect()
}

/// What groups with light and without tell.
///
/// # Errors
/// Where they do not determine the curve.
pub(crate) fn of_groups(groups: &[Group]) -> Result<Found, TransferError> {
    let lit = |group: &&Group| group.level.photons > 0.0;
    let times: Vec<f64> = groups.iter().filter(lit).map(|group| group.level.exposure_s).collect();
    let levels = |wanted: &dyn Fn(&Group) -> bool| -> Vec<Level> {
        groups.iter().filter(|group| wanted(group)).map(|group| group.level).collect()
    };
    let data = TransferData::new(&levels(&|group| lit(&group) || times.contains(&group.level.exposure_s)))?;
    let mut figures = data.figures()?;
    let all = TransferData::new(&levels(&|_| true))?.figures()?;
    figures.dark_current_mean_e_per_s = all.dark_current_mean_e_per_s;
    figures.dark_current_variance_e_per_s = all.dark_current_variance_e_per_s;
    let fixed = match stacks(groups, &data) {
        Some((dark, bright)) => {
            let patterns = nonuniformity(&Pattern::of(dark)?, &Pattern::of(bright)?, figures.gain_dn_per_e, &data)?;
            Some(Fixed { dark: dark.clone(), bright: bright.clone(), patterns })
        }
        None => None,
    };
    Ok(Found { data, figures, fixed, cuts: Vec::new() })
}

/// The stacks of the fixed patterns: without light and with it.
fn stacks<'a>(groups: &'a [Group], data: &TransferData) -> Option<(&'a Stack, &'a Stack)> {
    let saturation = data.bright()[data.saturation()].statistics.mean_dn.value;
    let below = |group: &&Group| group.level.photons > 0.0 && group.level.statistics.mean_dn.value < 0.9 * saturation;
    let many = |group: &&Group| group.stack.frames() >= STACK;
    let dark_of = |bright: &Group| {
        let dark = groups.iter().filter(|g| g.level.photons == 0.0 && g.level.exposure_s == bright.level.exposure_s);
        dark.filter(many).max_by_key(|group| group.stack.frames())
    };
    let pairs = groups.iter().filter(below).filter(many).filter_map(|bright| Some((dark_of(bright)?, bright)));
    let by_size = |(_, bright): &(&Group, &Group)| (bright.stack.frames(), bright.level.photons.to_bits());
    pairs.max_by_key(by_size).map(|(dark, bright)| (&dark.stack, &bright.stack))
}
