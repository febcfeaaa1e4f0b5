//! Passes over the array: rows one after another in f64, planes in f32 where neighbours matter.
//!
//! Effects on rows that follow each other share one pass, and a plane is stored only before an effect on planes, before a second
//! reading, and never where there is neither: an ordinary sensor goes from means to digital numbers row by row.

use super::chain::{RowEffect, Stage};
use crate::account::{ChargeAccount, RowTally};
use crate::effects::Effect;
use crate::effects::converter::Converter;
use crate::operation::Context;
use crate::signal_breakdown::{SignalBreakdown, SignalComponent, SignalComponentRow};
use etendue_core::Plane;
use etendue_core::quantity::{DigitalNumber, Electrons};
use rayon::prelude::*;
use std::borrow::Cow;

/// A capture on its way: its charge or voltage, and what is noted beside it.
#[derive(Clone, Debug)]
pub(super) struct Pass<'a> {
    /// Mean electrons that are not changed yet, or a plane of the pass's own.
    plane: Cow<'a, Plane<Electrons>>,
    /// Factor on the means, while the plane still is that of the means.
    light: Option<f64>,
    /// Effects on rows that wait for a pass.
    waiting: Vec<(Effect, RowEffect)>,
    /// What is noted, where it is asked for.
    pub(super) signal_breakdown: Option<SignalBreakdown>,
    /// Where charge went at the full well.
    pub(super) account: Option<ChargeAccount>,
}

impl<'a> Pass<'a> {
    pub(super) fn new(means: &'a Plane<Electrons>, light: f64, with_breakdown: bool) -> Self {
        let signal_breakdown = with_breakdown.then(|| SignalBreakdown::new(means.width(), means.height()));
        Self { plane: Cow::Borrowed(means), light: Some(light), waiting: Vec::new(), signal_breakdown, account: None }
    }

    /// A reading of this charge.
    pub(super) fn again(&self) -> Pass<'_> {
        Pass {
            plane: Cow::Borrowed(&self.plane),
            light: self.light,
            waiting: self.waiting.clone(),
            signal_breakdown: self.signal_breakdown.clone(),
            account: None,
        }
    }

    /// Runs stages, or lets them wait.
    pub(super) fn run(&mut self, stages: Vec<(Effect, Stage)>, context: &Context<'_>, trapped_e: &mut Vec<Vec<f32>>) {
        for (effect, stage) in stages {
            match stage {
                Stage::Row(row) => self.waiting.push((effect, row)),
                Stage::Plane(apply) => {
                    let before = self.store();
                    let kept = self.signal_breakdown.is_some().then(|| before.clone());
                    let after = apply.apply(context, before, trapped_e, &mut self.account);
                    if let (Some(signal_breakdown), Some(before)) = (self.signal_breakdown.take(), kept) {
                        self.signal_breakdown = Some(noted(signal_breakdown, effect, context, &before, &after));
                    }
                    self.plane = Cow::Owned(after);
                }
            }
        }
    }

    /// Runs what waits, so that the plane is that of the last effect; leaves an empty plane in its place.
    fn store(&mut self) -> Plane<Electrons> {
        self.settle();
        std::mem::replace(&mut self.plane, Cow::Owned(Plane::new(0, 0))).into_owned()
    }

    /// Runs what waits.
    pub(super) fn settle(&mut self) {
        if self.waiting.is_empty() && matches!(self.plane, Cow::Owned(_)) {
            return;
        }
        let (width, height) = (self.plane.width(), self.plane.height());
        let mut out = Plane::new(width, height);
        let source = Source { plane: &self.plane, light: self.light, effects: &self.waiting };
        let account = source.rows(out.samples_mut(), self.signal_breakdown.as_mut(), |out, electrons, _| {
            out.iter_mut().zip(electrons).for_each(|(out, e)| *out = *e as f32);
        });
        self.account = self.account.or(account);
        self.waiting.clear();
        (self.plane, self.light) = (Cow::Owned(out), None);
    }

    /// The digital numbers.
    pub(super) fn convert(&mut self, converter: &Converter, white_dn: f64) -> Plane<DigitalNumber> {
        let mut numbers = Plane::new(self.plane.width(), self.plane.height());
        let source = Source { plane: &self.plane, light: self.light, effects: &self.waiting };
        let account = source.rows(numbers.samples_mut(), self.signal_breakdown.as_mut(), |out, electrons, notes| {
            out.iter_mut().zip(electrons).for_each(|(dn, e)| *dn = converter.digital_number(*e));
            let Some(notes) = notes else { return };
            for (x, (dn, e)) in out.iter().zip(electrons).enumerate() {
                let dn = f64::from(*dn);
                notes.add(SignalComponent::Quantisation, x, converter.electrons(dn) - e);
                notes.add(SignalComponent::Saturated, x, f64::from(u8::from(dn >= white_dn.floor())));
            }
        });
        self.account = self.account.or(account);
        numbers
    }
}

/// Whether a mean can be a mean of electrons.
pub(super) fn is_valid(mean: f32) -> bool {
    mean.is_finite() && mean >= 0.0
}

/// Notes what an effect on planes did.
fn noted(
    mut signal_breakdown: SignalBreakdown,
    effect: Effect,
    context: &Context<'_>,
    before: &Plane<Electrons>,
    after: &Plane<Electrons>,
) -> SignalBreakdown {
    match context.p.read_out.layout.charge_binning() {
        Some(binning) if effect == Effect::Layout => {
            signal_breakdown.mapped(|layer| binning.added(&context.p.cfa, layer))
        }
        _ => {
            signal_breakdown.note(effect.cause(), before, after);
            signal_breakdown
        }
    }
}

/// Rows to run through effects.
struct Source<'a> {
    plane: &'a Plane<Electrons>,
    /// Factor on means; `None` for charge and voltages.
    light: Option<f64>,
    effects: &'a [(Effect, RowEffect)],
}

impl Source<'_> {
    /// Runs all rows in the caller's rayon pool; `finish` stores each. Answers where charge went, if a full well is among the
    /// effects.
    fn rows<T: Send>(
        &self,
        out: &mut [T],
        signal_breakdown: Option<&mut SignalBreakdown>,
        finish: impl Fn(&mut [T], &[f64], Option<&mut SignalComponentRow<'_>>) + Sync,
    ) -> Option<ChargeAccount> {
        let width = self.plane.width();
        if width == 0 {
            return None;
        }
        let mut tallies = vec![RowTally::default(); self.plane.height()];
        let rows = out.par_chunks_mut(width).zip(self.plane.samples().par_chunks(width));
        let whole = rows.zip(&mut tallies).enumerate();
        match signal_breakdown {
            None => whole.for_each_init(
                || vec![0.0; width],
                |electrons, (y, ((out, source), tally))| {
                    self.load(electrons, source);
                    self.effects.iter().for_each(|(_, effect)| effect.apply(electrons, y as u32, tally));
                    finish(out, electrons, None);
                },
            ),
            Some(signal_breakdown) => {
                whole.zip(signal_breakdown.rows().into_par_iter()).for_each(
                    |((y, ((out, source), tally)), mut notes)| {
                        let electrons = self.noted_row(source, y as u32, &mut notes, tally);
                        finish(out, &electrons, Some(&mut notes));
                    },
                );
            }
        }
        let has_well = self.effects.iter().any(|(effect, _)| *effect == Effect::FullWell);
        has_well.then(|| ChargeAccount::of_rows(&tallies))
    }

    /// Fetches a row; what is no mean counts as none.
    fn load(&self, electrons: &mut [f64], source: &[f32]) {
        match self.light {
            None => electrons.iter_mut().zip(source).for_each(|(e, q)| *e = f64::from(*q)),
            Some(light) => {
                for (e, mean) in electrons.iter_mut().zip(source) {
                    *e = if is_valid(*mean) { f64::from(*mean) * light } else { 0.0 };
                }
            }
        }
    }

    fn noted_row(&self, source: &[f32], y: u32, notes: &mut SignalComponentRow<'_>, tally: &mut RowTally) -> Vec<f64> {
        let mut electrons = vec![0.0; source.len()];
        self.load(&mut electrons, source);
        if self.light.is_some() {
            notes.note(SignalComponent::Signal, &vec![0.0; source.len()], &electrons);
        }
        for (effect, apply) in self.effects {
            let before = electrons.clone();
            apply.apply(&mut electrons, y, tally);
            notes.note(effect.cause(), &before, &electrons);
        }
        electrons
    }
}
