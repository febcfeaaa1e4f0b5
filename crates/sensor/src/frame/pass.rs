//! Passes over the array: rows one after another in f64, planes in f32 where neighbours matter.
//!
//! A pass says what its image is: mean electrons, charge or voltage. Effects on rows that follow each other share one pass over the
//! array, also where the image becomes another quantity between them, and a plane is stored only before an effect on planes, before a
//! second reading, and never where there is neither: an ordinary sensor goes from means to digital numbers row by row.

use core::marker::PhantomData;
use std::borrow::Cow;

use etendue_core::Plane;
use etendue_core::quantity::{Charge, DigitalNumber, MeanElectrons, Quantity, Voltage};
use rayon::prelude::*;

use crate::effect::{Action, Row, RowConversion, Stage, Traces};
use crate::signal_breakdown::{ChargeAccount, RowTally, SignalBreakdown, SignalComponent, SignalComponentRow};
use crate::{capture::SensorState, cfa::Cfa, effects::converter::Converter, layout::Binning};

/// A capture on its way: its image, and what is noted beside it.
pub(super) struct Pass<'a, Q> {
    source: Source<'a>,
    /// What is noted, where it is requested.
    pub(super) signal_breakdown: Option<SignalBreakdown>,
    /// Where charge went at the full well.
    pub(super) account: Option<ChargeAccount>,
    quantity: PhantomData<Q>,
}

impl<'a> Pass<'a, MeanElectrons> {
    /// The means of the described exposure, times `light`.
    pub(super) fn new(means: &'a Plane<MeanElectrons>, light: f64, with_breakdown: bool) -> Self {
        let signal_breakdown = with_breakdown.then(|| SignalBreakdown::new(means.width(), means.height()));
        let source = Source::of(means, Some(light));
        Self { source, signal_breakdown, account: None, quantity: PhantomData }
    }
}

impl<'a, Q: Quantity<Sample = f32>> Pass<'a, Q> {
    /// Runs effects, or lets them wait.
    pub(super) fn run(&mut self, stages: Vec<Stage<Q>>, after: &mut SensorState) {
        for Stage { component, action } in stages {
            match action {
                Action::Rows(effect) => self.source.waiting.push(Step {
                    component,
                    apply: Box::new(move |values, y, tally| effect.apply(&mut Row::new(values, y, tally))),
                }),
                Action::Plane(effect) => {
                    let before = self.take_plane();
                    let kept = self.signal_breakdown.is_some().then(|| before.clone());
                    let plane = effect.apply(before, &mut Traces { after, account: &mut self.account });
                    if let (Some(signal_breakdown), Some(before)) = (&mut self.signal_breakdown, kept) {
                        signal_breakdown.note(component, &before, &plane);
                    }
                    self.source = Source::owned(plane);
                }
            }
        }
    }

    /// The image as the quantity that a conversion makes of it; the same numbers where there is none.
    pub(super) fn converted<C>(mut self, conversion: Option<C>) -> Pass<'a, C::To>
    where
        C: RowConversion<From = Q> + 'static,
    {
        self.source.waiting.extend(conversion.map(|conversion| Step {
            component: C::COMPONENT,
            apply: Box::new(move |values, y, tally| {
                conversion.convert(Row::new(values, y, tally));
            }),
        }));
        let Self { source, signal_breakdown, account, .. } = self;
        Pass { source, signal_breakdown, account, quantity: PhantomData }
    }

    /// Runs what waits.
    pub(super) fn settle(&mut self) {
        if self.source.waiting.is_empty() && matches!(self.source.samples, Cow::Owned(_)) {
            return;
        }
        let mut out: Plane<Q> = Plane::new(self.source.width, self.source.height);
        let store = |out: &mut [f32], row: &Row<'_, Q>, _: Option<&mut SignalComponentRow<'_>>| {
            out.iter_mut().zip(&*row.values).for_each(|(out, e)| *out = *e as f32);
        };
        let account = self.source.rows(out.samples_mut(), self.signal_breakdown.as_mut(), store);
        self.account = self.account.or(account);
        self.source = Source::owned(out);
    }

    /// Runs what waits, so that the plane is that of the last effect; leaves an empty one in its place.
    fn take_plane(&mut self) -> Plane<Q> {
        self.settle();
        let Source { samples, width, height, .. } =
            std::mem::replace(&mut self.source, Source::owned(Plane::<Q>::new(0, 0)));
        Plane::from_samples(width, height, samples.into_owned()).expect("a sample a pixel")
    }
}

impl Pass<'_, Charge> {
    /// A reading of this charge, which is at rest.
    pub(super) fn again(&self) -> Pass<'_, Charge> {
        Pass {
            source: self.source.again(),
            signal_breakdown: self.signal_breakdown.clone(),
            account: None,
            quantity: PhantomData,
        }
    }

    /// Adds the charge of pixels that are read together.
    pub(super) fn bin(&mut self, binning: Binning, cfa: &Cfa) {
        let plane = binning.added(cfa, &self.take_plane());
        self.source = Source::owned(plane);
        self.signal_breakdown = self.signal_breakdown.take().map(|all| all.mapped(|layer| binning.added(cfa, layer)));
    }
}

impl Pass<'_, Voltage> {
    /// The digital numbers.
    pub(super) fn convert(&mut self, converter: &Converter, white_dn: f64) -> Plane<DigitalNumber> {
        let mut numbers = Plane::new(self.source.width, self.source.height);
        let finish = |out: &mut [u32], row: &Row<'_, Voltage>, notes: Option<&mut SignalComponentRow<'_>>| {
            converter.convert(row, out);
            let Some(notes) = notes else { return };
            for (x, (dn, e)) in out.iter().zip(&*row.values).enumerate() {
                let dn = f64::from(*dn);
                notes.add(SignalComponent::Quantisation, x, converter.electrons(dn) - e);
                notes.add(SignalComponent::Saturated, x, f64::from(u8::from(dn >= white_dn.floor())));
            }
        };
        let account = self.source.rows(numbers.samples_mut(), self.signal_breakdown.as_mut(), finish);
        self.account = self.account.or(account);
        numbers
    }
}

/// True if a mean can be a mean of electrons.
pub(super) fn is_valid(mean: f32) -> bool {
    mean.is_finite() && mean >= 0.0
}

/// Acts on the numbers of a row, its place in the plane and its tally of charge.
type RowStep = dyn Fn(&mut [f64], u32, &mut Option<RowTally>) + Send + Sync;

/// An effect on rows that waits for a pass, whatever its quantity: the pass that it waits in has it.
struct Step {
    component: SignalComponent,
    apply: Box<RowStep>,
}

/// Stored numbers, and the effects on rows that wait for a pass over them.
struct Source<'a> {
    /// Mean electrons that are not changed yet, or numbers of the pass's own; row by row.
    samples: Cow<'a, [f32]>,
    width: usize,
    height: usize,
    /// Factor on the means; `None` if the numbers are those of a pass.
    light: Option<f64>,
    waiting: Vec<Step>,
}

impl<'a> Source<'a> {
    fn of<Q: Quantity<Sample = f32>>(plane: &'a Plane<Q>, light: Option<f64>) -> Self {
        let (width, height) = (plane.width(), plane.height());
        Self { samples: Cow::Borrowed(plane.samples()), width, height, light, waiting: Vec::new() }
    }

    fn owned<Q: Quantity<Sample = f32>>(plane: Plane<Q>) -> Self {
        let (width, height) = (plane.width(), plane.height());
        Self { samples: Cow::Owned(plane.into_samples()), width, height, light: None, waiting: Vec::new() }
    }

    /// The same stored numbers; nothing waits.
    fn again(&self) -> Source<'_> {
        debug_assert!(self.waiting.is_empty(), "a charge that is read again is at rest");
        Source { samples: Cow::Borrowed(&self.samples), waiting: Vec::new(), ..*self }
    }

    /// Runs all rows in the caller's rayon pool; `finish` stores each, of the quantity that the last step makes. Answers where charge
    /// went, if a full well is among the steps.
    fn rows<T: Send, Q>(
        &self,
        out: &mut [T],
        signal_breakdown: Option<&mut SignalBreakdown>,
        finish: impl Fn(&mut [T], &Row<'_, Q>, Option<&mut SignalComponentRow<'_>>) + Sync,
    ) -> Option<ChargeAccount> {
        if self.width == 0 {
            return None;
        }
        let mut tallies = vec![None; self.height];
        let rows = out.par_chunks_mut(self.width).zip(self.samples.par_chunks(self.width));
        let whole = rows.zip(&mut tallies).enumerate();
        match signal_breakdown {
            None => whole.for_each_init(
                || vec![0.0; self.width],
                |values, (y, ((out, source), tally))| {
                    let y = y as u32;
                    self.load(values, source);
                    self.waiting.iter().for_each(|step| (step.apply)(values, y, tally));
                    finish(out, &Row::new(values, y, tally), None);
                },
            ),
            Some(signal_breakdown) => {
                whole.zip(signal_breakdown.rows().into_par_iter()).for_each(
                    |((y, ((out, source), tally)), mut notes)| {
                        let mut values = self.noted_row(source, y as u32, &mut notes, tally);
                        finish(out, &Row::new(&mut values, y as u32, tally), Some(&mut notes));
                    },
                );
            }
        }
        let tallies: Option<Vec<RowTally>> = tallies.into_iter().collect();
        tallies.map(|rows| ChargeAccount::of_rows(&rows))
    }

    /// Fetches a row; what is no mean counts as none.
    fn load(&self, values: &mut [f64], source: &[f32]) {
        match self.light {
            None => values.iter_mut().zip(source).for_each(|(e, q)| *e = f64::from(*q)),
            Some(light) => {
                for (e, mean) in values.iter_mut().zip(source) {
                    *e = if is_valid(*mean) { f64::from(*mean) * light } else { 0.0 };
                }
            }
        }
    }

    /// A row after all steps, each with what it added.
    fn noted_row(
        &self,
        source: &[f32],
        y: u32,
        notes: &mut SignalComponentRow<'_>,
        tally: &mut Option<RowTally>,
    ) -> Vec<f64> {
        let mut values = vec![0.0; source.len()];
        self.load(&mut values, source);
        if self.light.is_some() {
            notes.note(SignalComponent::Signal, &vec![0.0; source.len()], &values);
        }
        for step in &self.waiting {
            let before = values.clone();
            (step.apply)(&mut values, y, tally);
            notes.note(step.component, &before, &values);
        }
        values
    }
}
