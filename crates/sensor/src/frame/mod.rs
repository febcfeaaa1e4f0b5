//! From mean electrons to a raw image, frame after frame.

mod pass;

use std::borrow::Cow;

use etendue_core::quantity::{Charge, DigitalNumber, MeanElectrons};
use etendue_core::{Plane, random::Pixel};

use crate::capture::{CaptureLight, FrameAddress, OperatingPoint, Operation, SensorState};
use crate::effect::{Context, Memory};
use crate::signal_breakdown::{ChargeAccount, SignalBreakdown};
use crate::{effects::shot_noise::ShotNoise, hdr::merge::MergedCaptures, raw::Raw, sensor::Sensor};
use pass::CapturePass;

/// The result of reading a capture's charge.
struct ReadingResult {
    numbers: Plane<DigitalNumber>,
    /// The digital number of a saturated pixel.
    white_dn: f64,
    signal_breakdown: Option<SignalBreakdown>,
    /// Balance of its charge at the full well, if the pass includes one.
    account: Option<ChargeAccount>,
}

/// The result of all captures of a frame.
struct CaptureResults {
    numbers: Plane<DigitalNumber>,
    signal_breakdown: Option<SignalBreakdown>,
    /// For each capture with its own charge: its index, and the balance of its charge if it overflows.
    accounts: Vec<(usize, ChargeAccount)>,
}

impl Sensor {
    /// Computes one frame: the raw image for `mean_electrons` (of photons, in the described exposure), and the state for the next frame.
    ///
    /// Runs in the rayon pool of the caller; the bits depend only on the state, `address` and the means.
    #[must_use]
    pub fn step(
        &self,
        state: SensorState,
        mean_electrons: &Plane<MeanElectrons>,
        address: FrameAddress,
    ) -> (SensorState, Raw) {
        self.step_captures(state, CaptureLight::steady(mean_electrons), address)
    }

    /// As [`Sensor::step`], for light that changes from capture to capture.
    #[must_use]
    pub fn step_captures(
        &self,
        state: SensorState,
        light: CaptureLight<'_>,
        address: FrameAddress,
    ) -> (SensorState, Raw) {
        let (state, raw, _) = self.frame(state, light, address, false);
        (state, raw)
    }

    /// The same, with the signal breakdown of each pixel.
    #[must_use]
    pub fn step_with_breakdown(
        &self,
        state: SensorState,
        mean_electrons: &Plane<MeanElectrons>,
        address: FrameAddress,
    ) -> (SensorState, Raw, SignalBreakdown) {
        self.step_captures_with_breakdown(state, CaptureLight::steady(mean_electrons), address)
    }

    /// As [`Sensor::step_with_breakdown`], for light that changes from capture to capture.
    #[must_use]
    pub fn step_captures_with_breakdown(
        &self,
        state: SensorState,
        light: CaptureLight<'_>,
        address: FrameAddress,
    ) -> (SensorState, Raw, SignalBreakdown) {
        let (state, raw, signal_breakdown) = self.frame(state, light, address, true);
        (state, raw, signal_breakdown.expect("they were asked for"))
    }

    fn frame(
        &self,
        state: SensorState,
        light: CaptureLight<'_>,
        address: FrameAddress,
        with_breakdown: bool,
    ) -> (SensorState, Raw, Option<SignalBreakdown>) {
        let p = self.parameters();
        let point = state.operating_point.unwrap_or_else(|| p.described_point());
        let after = SensorState { trapped_e: state.trapped_e.clone(), ..SensorState::default() };
        let mut memory = Memory { before: state, after };
        let arrays = self.arrays(light);
        let first = p.operation(point);
        let results = if p.hdr.captures.is_empty() {
            self.single(&arrays[0], first, address, &mut memory, with_breakdown)
        } else {
            self.merged(&arrays, first, address, &mut memory, with_breakdown)
        };
        let (raw, signal_breakdown) = self.raw(results, &arrays[0], point);
        let mut state = memory.after;
        state.operating_point = p.exposure.control.map(|control| control.next(&raw, point));
        (state, raw, signal_breakdown)
    }

    /// The means of the whole array, optical black included: one per capture, or a single one if all see the same light.
    fn arrays<'a>(&self, light: CaptureLight<'a>) -> Vec<Cow<'a, Plane<MeanElectrons>>> {
        let layout = &self.parameters().read_out.layout;
        let array = |k: usize| {
            let means = light.capture(k);
            layout.with_optical_black(means).map_or(Cow::Borrowed(means), Cow::Owned)
        };
        (0..=light.further.len()).map(array).collect()
    }

    fn context(&self, array: &Plane<MeanElectrons>, operation: Operation, address: FrameAddress) -> Context {
        let facts = self.parameters().facts();
        Context { facts, operation, address, width: array.width(), height: array.height() }
    }

    /// The charge of a capture.
    fn charge<'a>(
        &self,
        array: &'a Plane<MeanElectrons>,
        context: &Context,
        memory: &mut Memory,
        with_breakdown: bool,
    ) -> CapturePass<'a, Charge> {
        let p = self.parameters();
        let mut means = CapturePass::new(array, context.operation.light, with_breakdown);
        means.run(p.light.stages(context, memory), &mut memory.after);
        let mut charge = means.converted(ShotNoise.prepare(context));
        charge.run(p.charge.stages(context, memory), &mut memory.after);
        charge
    }

    /// The digital numbers of a charge, and their breakdown. `context` has the size of the array.
    fn reading(&self, mut charge: CapturePass<'_, Charge>, context: &Context, memory: &mut Memory) -> ReadingResult {
        let p = self.parameters();
        let mut context = *context;
        if let Some(binning) = p.read_out.layout.charge_binning() {
            charge.bin(binning, &p.cfa);
            (context.width, context.height) = (context.width / binning.columns, context.height / binning.rows);
        }
        let mut voltage = charge.converted(p.read_out.response.prepare());
        voltage.run(p.voltage.stages(&context, memory), &mut memory.after);
        let white_dn = p.capture_white_dn(&context.operation);
        let numbers = voltage.convert(&p.converter(&context.operation), white_dn);
        ReadingResult { numbers, white_dn, signal_breakdown: voltage.signal_breakdown, account: voltage.account }
    }

    /// A single capture, from means to digital numbers.
    fn single(
        &self,
        array: &Plane<MeanElectrons>,
        operation: Operation,
        address: FrameAddress,
        memory: &mut Memory,
        with_breakdown: bool,
    ) -> CaptureResults {
        let context = self.context(array, operation, address);
        let charge = self.charge(array, &context, memory, with_breakdown);
        let ReadingResult { numbers, signal_breakdown, account, .. } = self.reading(charge, &context, memory);
        let accounts = account.map(|account| (0, account)).into_iter().collect();
        CaptureResults { numbers: self.companded(numbers), signal_breakdown, accounts }
    }

    /// Companding of a single capture.
    fn companded(&self, numbers: Plane<DigitalNumber>) -> Plane<DigitalNumber> {
        match &self.parameters().hdr.companding {
            None => numbers,
            Some(curve) => numbers.map(|dn| curve.companded(f64::from(dn)).round_ties_even() as u32),
        }
    }

    /// Several captures, merged.
    fn merged(
        &self,
        arrays: &[Cow<'_, Plane<MeanElectrons>>],
        first: Operation,
        address: FrameAddress,
        memory: &mut Memory,
        with_breakdown: bool,
    ) -> CaptureResults {
        let p = self.parameters();
        let mut merged = MergedCaptures::new(p.read_out.black_level_dn);
        let (mut held, mut accounts): (Option<CapturePass<'_, Charge>>, _) = (None, Vec::new());
        for (k, operation) in p.hdr.operations(first).into_iter().enumerate() {
            let array = &*arrays[if arrays.len() > 1 { k } else { 0 }];
            let address = FrameAddress { capture: address.capture + k as u32, ..address };
            let context = self.context(array, operation, address);
            if k == 0 || !p.hdr.captures[k - 1].dual_conversion_gain {
                let mut charge = self.charge(array, &context, memory, with_breakdown);
                charge.apply_deferred();
                accounts.extend(charge.account.map(|account| (k, account)));
                held = Some(charge);
            }
            let Some(charge) = &held else { continue };
            let reading = self.reading(charge.reborrow(), &context, memory);
            let black_dn = p.read_out.black_level_dn;
            let switch_dn = black_dn + p.hdr.transition_level_or_default() * (reading.white_dn - black_dn);
            let factor = p.hdr.scale(k) * operation.gain_dn_e / first.gain_dn_e;
            let signal_breakdown = reading.signal_breakdown.as_ref().map(|layers| (layers, factor));
            merged.take(&reading.numbers, p.hdr.scale(k), switch_dn, signal_breakdown);
        }
        CaptureResults { numbers: self.rounded(&merged), signal_breakdown: merged.into_breakdown(), accounts }
    }

    /// Merged numbers, companded if there is a curve, rounded once.
    fn rounded(&self, merged: &MergedCaptures) -> Plane<DigitalNumber> {
        let hdr = &self.parameters().hdr;
        let largest = f64::from((1_u32 << self.delivered_bits()) - 1);
        let curve = |v: f64| hdr.companding.as_ref().map_or(v, |c| c.companded(v));
        let number = |v: &f32| curve(f64::from(*v)).round_ties_even().clamp(0.0, largest) as u32;
        let samples = merged.values().iter().map(number).collect();
        let (width, height) = merged.size();
        Plane::from_samples(width, height, samples).expect("whole rows")
    }

    /// The raw of the captures: binned numbers, the region that is read, invalid means.
    fn raw(
        &self,
        results: CaptureResults,
        array: &Plane<MeanElectrons>,
        point: OperatingPoint,
    ) -> (Raw, Option<SignalBreakdown>) {
        let p = self.parameters();
        let layout = &p.read_out.layout;
        let CaptureResults { mut numbers, mut signal_breakdown, accounts } = results;
        if let Some(binning) = layout.number_binning() {
            numbers = binning.averaged(&p.cfa, &numbers);
            signal_breakdown = signal_breakdown.map(|c| c.mapped(|layer| binning.mean(&p.cfa, layer)));
        }
        if let Some(skipping) = layout.skipping {
            numbers = skipping.read(&p.cfa, &numbers);
            signal_breakdown = signal_breakdown.map(|c| c.mapped(|layer| skipping.read(&p.cfa, layer)));
        }
        if let Some(part) = layout.read_part() {
            numbers = part.crop(&numbers);
            signal_breakdown = signal_breakdown.map(|c| c.mapped(|layer| part.crop(layer)));
        }
        let invalid = invalid_pixels(array);
        let places = invalid.iter().filter_map(|i| layout.raw_of_array(&p.cfa, i.x as usize, i.y as usize));
        for (x, y) in places.collect::<Vec<_>>() {
            numbers.set(x, y, 0);
        }
        let raw = Raw {
            image: layout.image_in_raw(numbers.width(), numbers.height()),
            plane: numbers,
            black_level_dn: self.black_level_dn(),
            white_level_dn: self.white_level_at(point),
            bits: self.delivered_bits(),
            companding: p.hdr.companding.clone(),
            operating_point: point,
            accounts,
            invalid,
        };
        (raw, signal_breakdown)
    }
}

fn invalid_pixels(means: &Plane<MeanElectrons>) -> Vec<Pixel> {
    let width = means.width();
    let wrong = means.samples().iter().enumerate().filter(|(_, m)| !pass::is_valid(**m));
    wrong.map(|(i, _)| Pixel { x: (i % width) as u32, y: (i / width) as u32 }).collect()
}

#[cfg(test)]
mod extremes;
#[cfg(test)]
pub(crate) mod tests;
