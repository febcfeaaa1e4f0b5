//! The needed effects of a capture, prepared, in physical order.

use super::Memory;
use crate::account::{ChargeAccount, RowTally};
use crate::effects::angle_response::AngleFactors;
use crate::effects::brighter_fatter::PreparedBrighterFatter;
use crate::effects::dark_current::DarkElectrons;
use crate::effects::dead_pixels::DeadPixels;
use crate::effects::full_well::{Clip, Overflow};
use crate::effects::lag::Traps;
use crate::effects::neighbours::Neighbours;
use crate::effects::offset_pattern::Offsets;
use crate::effects::photo_response::ResponsePattern;
use crate::effects::read_noise::PreparedReadNoise;
use crate::effects::response::Response;
use crate::effects::rts_noise::PreparedRts;
use crate::effects::shot_noise::ShotNoise;
use crate::effects::smear::ColumnSmear;
use crate::effects::two_level::{self, Draws, Site};
use crate::effects::{Effect, Verdict};
use crate::layout::Binning;
use crate::operation::Context;
use etendue_core::Plane;
use etendue_core::quantity::Electrons;
use etendue_core::random::NoiseDraw;

/// An effect on each pixel of a row, prepared.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum RowEffect {
    Angle(AngleFactors),
    PhotoResponse(ResponsePattern),
    Shot(ShotNoise),
    Dark(DarkElectrons),
    Clip(Clip),
    Dead(DeadPixels),
    Response(Response),
    Offsets(Offsets),
    Read(PreparedReadNoise),
    RtsNoise(PreparedRts),
}

impl RowEffect {
    /// Full wells note the row's charge in `tally`.
    pub(super) fn apply(&self, electrons: &mut [f64], y: u32, tally: &mut RowTally) {
        match self {
            Self::Angle(effect) => effect.apply(electrons, y),
            Self::PhotoResponse(effect) => effect.apply(electrons, y),
            Self::Shot(effect) => effect.apply(electrons, y),
            Self::Dark(effect) => effect.apply(electrons, y),
            Self::Clip(effect) => effect.apply(electrons, tally),
            Self::Dead(effect) => effect.apply(electrons, y),
            Self::Response(effect) => effect.apply(electrons),
            Self::Offsets(effect) => effect.apply(electrons, y),
            Self::Read(effect) => effect.apply(electrons, y),
            Self::RtsNoise(effect) => effect.apply(electrons, y),
        }
    }
}

/// An effect on a whole plane, prepared.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum PlaneEffect {
    Neighbours(Neighbours),
    Smear(ColumnSmear),
    Lag(Traps),
    BrighterFatter(PreparedBrighterFatter),
    Overflow(Overflow),
    Binning(Binning),
}

impl PlaneEffect {
    /// The plane afterwards. Lag changes the traps, overflow says where charge went.
    pub(super) fn apply(
        &self,
        context: &Context<'_>,
        mut plane: Plane<Electrons>,
        trapped_e: &mut Vec<Vec<f32>>,
        account: &mut Option<ChargeAccount>,
    ) -> Plane<Electrons> {
        match self {
            Self::Neighbours(shares) => return shares.exchange(&plane),
            Self::BrighterFatter(effect) => return effect.apply(&plane),
            Self::Binning(binning) => return binning.added(&context.p.cfa, &plane),
            Self::Smear(effect) => effect.apply(&mut plane),
            Self::Lag(effect) => effect.apply(&mut plane, trapped_e),
            Self::Overflow(effect) => *account = Some(effect.apply(&mut plane)),
        }
        plane
    }
}

/// An effect, prepared.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Stage {
    Row(RowEffect),
    Plane(PlaneEffect),
}

/// The effects until charge lies in its pixels, at rest.
const ON_CHARGE: [Effect; 10] = [
    Effect::AngleResponse,
    Effect::Crosstalk,
    Effect::PhotoResponse,
    Effect::Smear,
    Effect::ShotNoise,
    Effect::DarkCurrent,
    Effect::Lag,
    Effect::BrighterFatter,
    Effect::FullWell,
    Effect::DeadPixels,
];

/// The effects from there to the converter.
const ON_READING: [Effect; 6] = [
    Effect::Layout,
    Effect::Response,
    Effect::InterPixelCapacitance,
    Effect::OffsetPattern,
    Effect::ReadNoise,
    Effect::RtsNoise,
];

/// The stages that make charge of means.
pub(super) fn charge(context: &Context<'_>, memory: &mut Memory) -> Vec<(Effect, Stage)> {
    stages(&ON_CHARGE, context, memory)
}

/// The stages that make voltages of charge; `context` has the size of the array, the stages that of what is read.
pub(super) fn reading(context: &Context<'_>, memory: &mut Memory) -> Vec<(Effect, Stage)> {
    let (n, m) = context.p.read_out.layout.charge_binning().map_or((1, 1), |b| (b.columns, b.rows));
    let read = Context { width: context.width / n, height: context.height / m, ..*context };
    stages(&ON_READING, &read, memory)
}

fn stages(effects: &[Effect], context: &Context<'_>, memory: &mut Memory) -> Vec<(Effect, Stage)> {
    let needed = effects.iter().filter(|e| e.need(context.p, &context.operation).0 != Verdict::Skipped);
    needed.filter_map(|e| Some((*e, stage(*e, context, memory)?))).collect()
}

/// An effect, prepared; `None` where it is none on charge or voltage.
fn stage(effect: Effect, context: &Context<'_>, memory: &mut Memory) -> Option<Stage> {
    let p = context.p;
    let row = |effect: RowEffect| Some(Stage::Row(effect));
    let plane = |effect: PlaneEffect| Some(Stage::Plane(effect));
    match effect {
        Effect::AngleResponse => row(RowEffect::Angle(AngleFactors::new(p.optics.angle_response.as_ref()?, context))),
        Effect::Crosstalk => plane(PlaneEffect::Neighbours(p.optics.crosstalk?.0)),
        Effect::PhotoResponse => row(RowEffect::PhotoResponse(ResponsePattern::new(context))),
        Effect::Smear => plane(PlaneEffect::Smear(ColumnSmear::new(p.charge.smear.as_ref()?, context))),
        Effect::ShotNoise => row(RowEffect::Shot(ShotNoise::new(context))),
        Effect::DarkCurrent => row(RowEffect::Dark(DarkElectrons::new(context, &blinking(context, memory)))),
        Effect::Lag => plane(PlaneEffect::Lag(Traps::new(context))),
        Effect::BrighterFatter => plane(PlaneEffect::BrighterFatter(PreparedBrighterFatter::new(context))),
        Effect::FullWell => match p.charge.blooming {
            None => row(RowEffect::Clip(Clip::new(context))),
            Some(blooming) => plane(PlaneEffect::Overflow(Overflow::new(blooming, context))),
        },
        Effect::DeadPixels => row(RowEffect::Dead(DeadPixels::new(context))),
        Effect::Layout => plane(PlaneEffect::Binning(p.read_out.layout.charge_binning()?)),
        Effect::Response => row(RowEffect::Response(p.read_out.response.clone())),
        Effect::InterPixelCapacitance => plane(PlaneEffect::Neighbours(p.read_out.capacitance?.0)),
        Effect::OffsetPattern => row(RowEffect::Offsets(Offsets::new(context))),
        Effect::ReadNoise => row(RowEffect::Read(PreparedReadNoise::new(context))),
        Effect::RtsNoise => row(RowEffect::RtsNoise(rts_noise(context, memory)?)),
        Effect::ExposureControl | Effect::Converter | Effect::Merge | Effect::Companding => None,
    }
}

/// The blinking pixels at their upper level. Without noise from frame to frame none is.
fn blinking(context: &Context<'_>, memory: &mut Memory) -> Vec<Site> {
    let Some(two) = context.p.charge.dark.dark_current_rts.filter(|_| context.p.noise) else { return Vec::new() };
    let draws = Draws { which: NoiseDraw::Blinking, flip: NoiseDraw::BlinkingFlip };
    let size = (context.width, context.height);
    let (sites, high) =
        two_level::next(&two, (context.p, draws), context.address, size, &memory.before.dark_current_rts_high);
    let up = sites.into_iter().zip(&high).filter(|(_, high)| **high).map(|(site, _)| site).collect();
    memory.after.dark_current_rts_high = high;
    up
}

fn rts_noise(context: &Context<'_>, memory: &mut Memory) -> Option<PreparedRts> {
    let two = context.p.read_out.rts_noise?.0;
    let draws = Draws { which: NoiseDraw::Telegraph, flip: NoiseDraw::TelegraphFlip };
    let size = (context.width, context.height);
    let (sites, high) = two_level::next(&two, (context.p, draws), context.address, size, &memory.before.rts_noise_high);
    let jumps = PreparedRts::new(&sites, &high);
    memory.after.rts_noise_high = high;
    Some(jumps)
}
