//! Passes over the array: rows one after another in f64, planes in f32 for effects between neighbours.
//!
//! The type of a pass states its quantity: mean electrons, charge or voltage. Consecutive effects on rows share one pass over the array, also across
//! a conversion to another quantity. A plane is stored only before an effect on planes or before a second reading: an ordinary sensor goes from means
//! to digital numbers row by row.

use core::marker::PhantomData;
use std::borrow::Cow;

use etendue_core::Plane;
use etendue_core::quantity::{Charge, DigitalNumber, MeanElectrons, Quantity, Voltage};
use rayon::prelude::*;

use crate::effect::{Action, Row, RowConversion, Stage, Traces};
use crate::signal_breakdown::{ChargeAccount, RowTally, SignalBreakdown, SignalComponent, SignalComponentRow};
use crate::{capture::SensorState, cfa::Cfa, effects::converter::Adc, layout::Binning};

/// A capture in progress: its image and the recorded breakdown.
pub(super) struct CapturePass<'a, Q> {
    source: ValueSource<'a>,
    /// The signal breakdown, if requested.
    pub(super) signal_breakdown: Option<SignalBreakdown>,
    /// Balance of charge at the full well.
    pub(super) account: Option<ChargeAccount>,
    quantity: PhantomData<Q>,
}

impl<'a> CapturePass<'a, MeanElectrons> {
    /// The means of the described exposure, times `light`.
    pub(super) fn new(means: &'a Plane<MeanElectrons>, light: f64, with_breakdown: bool) -> Self {
        let signal_breakdown = with_breakdown.then(|| SignalBreakdown::new(means.width(), means.height()));
        let source = ValueSource::from_plane(means, Some(light));
        Self { source, signal_breakdown, account: None, quantity: PhantomData }
    }
}

impl<'a, Q: Quantity<Sample = f32>> CapturePass<'a, Q> {
    /// Applies effects, or defers them.
    pub(super) fn run(&mut self, stages: Vec<Stage<Q>>, after: &mut SensorState) {
        for Stage { component, action } in stages {
            match action {
                Action::Rows(effect) => self.source.waiting.push(DeferredEffect {
                    component,
                    apply: Box::new(move |values, y, tally| effect.apply(&mut Row::new(values, y, tally))),
                }),
                Action::Plane(effect) => {
                    let before = self.take_plane();
                    let original = self.signal_breakdown.is_some().then(|| before.clone());
                    let plane = effect.apply(before, &mut Traces { after, account: &mut self.account });
                    if let (Some(signal_breakdown), Some(before)) = (&mut self.signal_breakdown, original) {
                        signal_breakdown.add_change(component, &before, &plane);
                    }
                    self.source = ValueSource::owned(plane);
                }
            }
        }
    }

    /// The image converted to another quantity; the same values without a conversion.
    pub(super) fn converted<C>(mut self, conversion: Option<C>) -> CapturePass<'a, C::Output>
    where
        C: RowConversion<Input = Q> + 'static,
    {
        self.source.waiting.extend(conversion.map(|conversion| DeferredEffect {
            component: C::COMPONENT,
            apply: Box::new(move |values, y, tally| {
                conversion.convert(Row::new(values, y, tally));
            }),
        }));
        let Self { source, signal_breakdown, account, .. } = self;
        CapturePass { source, signal_breakdown, account, quantity: PhantomData }
    }

    /// Applies the deferred effects.
    pub(super) fn apply_deferred(&mut self) {
        if self.source.waiting.is_empty() && matches!(self.source.samples, Cow::Owned(_)) {
            return;
        }
        let mut out: Plane<Q> = Plane::new(self.source.width, self.source.height);
        let store = |out: &mut [f32], row: &Row<'_, Q>, _: Option<&mut SignalComponentRow<'_>>| {
            out.iter_mut().zip(&*row.values).for_each(|(out, e)| *out = *e as f32);
        };
        let account = self.source.rows(out.samples_mut(), self.signal_breakdown.as_mut(), store);
        self.account = self.account.or(account);
        self.source = ValueSource::owned(out);
    }

    /// Applies the deferred effects and takes the plane; leaves an empty one in its place.
    fn take_plane(&mut self) -> Plane<Q> {
        self.apply_deferred();
        let ValueSource { samples, width, height, .. } =
            std::mem::replace(&mut self.source, ValueSource::owned(Plane::<Q>::new(0, 0)));
        Plane::from_samples(width, height, samples.into_owned()).expect("one sample per pixel")
    }
}

impl CapturePass<'_, Charge> {
    /// Another reading of this charge, which is complete.
    pub(super) fn reborrow(&self) -> CapturePass<'_, Charge> {
        CapturePass {
            source: self.source.reborrow(),
            signal_breakdown: self.signal_breakdown.clone(),
            account: None,
            quantity: PhantomData,
        }
    }

    /// Adds the charge of pixels that are read together.
    pub(super) fn bin(&mut self, binning: Binning, cfa: &Cfa) {
        let plane = binning.added(cfa, &self.take_plane());
        self.source = ValueSource::owned(plane);
        self.signal_breakdown = self.signal_breakdown.take().map(|all| all.mapped(|layer| binning.added(cfa, layer)));
    }
}

impl CapturePass<'_, Voltage> {
    /// Converts to digital numbers.
    pub(super) fn convert(&mut self, converter: &Adc, white_dn: f64) -> Plane<DigitalNumber> {
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

/// True if a mean is valid as a mean of electrons.
pub(super) fn is_valid(mean: f32) -> bool {
    mean.is_finite() && mean >= 0.0
}

/// Acts on the values of a row, its index in the plane and its tally of charge.
type RowStep = dyn Fn(&mut [f64], u32, &mut Option<RowTally>) + Send + Sync;

/// A deferred effect on rows, without its quantity in the type: that of its pass applies.
struct DeferredEffect {
    component: SignalComponent,
    apply: Box<RowStep>,
}

/// Stored values, and the deferred effects on rows.
struct ValueSource<'a> {
    /// Unchanged mean electrons, or the pass's own values; row by row.
    samples: Cow<'a, [f32]>,
    width: usize,
    height: usize,
    /// Factor on the means; `None` if the values are those of a pass.
    light: Option<f64>,
    waiting: Vec<DeferredEffect>,
}

impl<'a> ValueSource<'a> {
    fn from_plane<Q: Quantity<Sample = f32>>(plane: &'a Plane<Q>, light: Option<f64>) -> Self {
        let (width, height) = (plane.width(), plane.height());
        Self { samples: Cow::Borrowed(plane.samples()), width, height, light, waiting: Vec::new() }
    }

    fn owned<Q: Quantity<Sample = f32>>(plane: Plane<Q>) -> Self {
        let (width, height) = (plane.width(), plane.height());
        Self { samples: Cow::Owned(plane.into_samples()), width, height, light: None, waiting: Vec::new() }
    }

    /// The same stored values without deferred effects.
    fn reborrow(&self) -> ValueSource<'_> {
        debug_assert!(self.waiting.is_empty(), "a charge that is read again is at rest");
        ValueSource { samples: Cow::Borrowed(&self.samples), waiting: Vec::new(), ..*self }
    }

    /// Processes all rows in the caller's rayon pool; `finish` stores each as the quantity of the last step. Returns the balance of charge if a full
    /// well is among the steps.
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
        let indexed = rows.zip(&mut tallies).enumerate();
        match signal_breakdown {
            None => indexed.for_each_init(
                || vec![0.0; self.width],
                |values, (y, ((out, source), tally))| {
                    let y = y as u32;
                    self.load(values, source);
                    self.waiting.iter().for_each(|step| (step.apply)(values, y, tally));
                    finish(out, &Row::new(values, y, tally), None);
                },
            ),
            Some(signal_breakdown) => {
                indexed.zip(signal_breakdown.rows().into_par_iter()).for_each(
                    |((y, ((out, source), tally)), mut notes)| {
                        let mut values = self.row_with_breakdown(source, y as u32, &mut notes, tally);
                        finish(out, &Row::new(&mut values, y as u32, tally), Some(&mut notes));
                    },
                );
            }
        }
        let tallies: Option<Vec<RowTally>> = tallies.into_iter().collect();
        tallies.map(|rows| ChargeAccount::from_rows(&rows))
    }

    /// Loads a row; an invalid mean counts as zero.
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

    /// A row after all steps, with the contribution of each.
    fn row_with_breakdown(
        &self,
        source: &[f32],
        y: u32,
        notes: &mut SignalComponentRow<'_>,
        tally: &mut Option<RowTally>,
    ) -> Vec<f64> {
        let mut values = vec![0.0; source.len()];
        self.load(&mut values, source);
        if self.light.is_some() {
            notes.add_change(SignalComponent::Signal, &vec![0.0; source.len()], &values);
        }
        for step in &self.waiting {
            let before = values.clone();
            (step.apply)(&mut values, y, tally);
            notes.add_change(step.component, &before, &values);
        }
        values
    }
}
