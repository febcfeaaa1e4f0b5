//! An effect: its own parameters, whether it is modelled, and its action on one quantity.
//!
//! An effect acts on mean electrons, on charge or on voltage ([`QuantityEffect`]), pixel by pixel along a row or on the whole plane ([`Action`]). The three
//! quantities are types, so an effect can only be applied to its own quantity: only counting converts mean electrons to charge, and only the response
//! converts charge to voltage ([`RowConversion`]).

mod domain;

use core::marker::PhantomData;

use etendue_core::quantity::{Charge, MeanElectrons, Quantity, Voltage};
use etendue_core::random::{NoiseDraw, NoiseKey};
use etendue_core::{EffectStatus, KeyChange, KnownError, Plane};

use crate::capture::{FrameAddress, Operation, SensorState};
use crate::check::Checks;
use crate::signal_breakdown::{ChargeAccount, RowTally, SignalComponent};

pub(crate) use domain::domain;

/// Reason why temporal noise is absent.
pub(crate) const NOISE_OFF: &str = "noise is switched off for this sensor";

/// An effect as described, with its own parameters.
pub(crate) trait Effect {
    /// Name in a plan.
    const NAME: &'static str;

    /// The key of a camera file that describes it.
    const KEY: &'static str;

    /// Refuses parameters that are illegal, or contradict the sensor's.
    fn check(&self, facts: &SensorFacts, checks: &mut Checks);

    /// Status of the effect for a capture (present or not) with the reason.
    fn status(&self, facts: &SensorFacts, operation: &Operation) -> EffectStatus;

    /// The key changes that disable it; none if a sensor always has it.
    fn left_out_by(&self) -> Vec<KeyChange> {
        vec![KeyChange::removed(Self::KEY)]
    }

    /// The errors of a frame without it that have a closed form.
    fn errors_without(&self, _facts: &SensorFacts, _levels: &SignalLevels) -> Vec<KnownError> {
        Vec::new()
    }
}

/// Signals at which errors are stated.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct SignalLevels {
    /// A grey card in a well-exposed image, 18 % of the largest signal, e⁻.
    pub(crate) grey_e: f64,
    /// Variance without light, e⁻²: read noise, dark current, rounding.
    pub(crate) dark_variance_e2: f64,
}

/// An effect of a sensor, as reported by a plan.
#[derive(Clone, Debug, PartialEq)]
pub struct SensorEffect {
    pub name: &'static str,
    /// The key of a camera file that describes it.
    pub key: &'static str,
    /// Status for the first capture as described, with the reason.
    pub status: EffectStatus,
    /// The key changes that disable it; empty if a sensor always has it.
    pub left_out_by: Vec<KeyChange>,
    /// The errors of a frame without it that have a closed form.
    pub errors: Vec<KnownError>,
}

impl<E: Effect> Effect for Option<E> {
    const NAME: &'static str = E::NAME;
    const KEY: &'static str = E::KEY;

    fn check(&self, facts: &SensorFacts, checks: &mut Checks) {
        if let Some(effect) = self {
            effect.check(facts, checks);
        }
    }

    fn status(&self, facts: &SensorFacts, operation: &Operation) -> EffectStatus {
        self.as_ref().map_or(EffectStatus::NotDescribed, |effect| effect.status(facts, operation))
    }

    fn left_out_by(&self) -> Vec<KeyChange> {
        self.as_ref().map_or_else(Vec::new, Effect::left_out_by)
    }

    fn errors_without(&self, facts: &SensorFacts, levels: &SignalLevels) -> Vec<KnownError> {
        self.as_ref().map_or_else(Vec::new, |effect| effect.errors_without(facts, levels))
    }
}

/// Visits the effects of a sensor one by one, in physical order.
pub(crate) trait Visitor {
    fn visit<E: Effect>(&mut self, effect: &E);
}

/// An effect on one quantity.
pub(crate) trait QuantityEffect: Effect {
    /// The quantity.
    type Signal: Quantity<Sample = f32>;

    /// The component of the signal breakdown to which the effect's change belongs.
    const COMPONENT: SignalComponent;

    /// The effect prepared for a capture.
    fn prepare(&self, context: &Context, memory: &mut Memory) -> Action<Self::Signal>;
}

/// The action of an effect, prepared for a capture.
pub(crate) enum Action<Q: Quantity> {
    /// On each pixel separately, row by row in f64.
    Rows(Box<dyn RowEffect<Q>>),
    /// On the whole plane, for effects between neighbours or with a memory per pixel.
    Plane(Box<dyn PlaneEffect<Q>>),
}

impl<Q: Quantity> Action<Q> {
    pub(crate) fn rows(effect: impl RowEffect<Q> + 'static) -> Self {
        Self::Rows(Box::new(effect))
    }

    pub(crate) fn plane(effect: impl PlaneEffect<Q> + 'static) -> Self {
        Self::Plane(Box::new(effect))
    }
}

/// Acts on the pixels of a row.
pub(crate) trait RowEffect<Q>: Send + Sync {
    fn apply(&self, row: &mut Row<'_, Q>);
}

/// Acts on a plane.
pub(crate) trait PlaneEffect<Q: Quantity> {
    /// The plane afterwards.
    fn apply(&self, plane: Plane<Q>, traces: &mut Traces<'_>) -> Plane<Q>;
}

/// Additional outputs of effects on planes.
pub(crate) struct Traces<'a> {
    /// State of the sensor after the frame.
    pub(crate) after: &'a mut SensorState,
    /// Balance of charge at the full well.
    pub(crate) account: &'a mut Option<ChargeAccount>,
}

/// Converts one quantity to another, row by row.
pub(crate) trait RowConversion: Send + Sync {
    /// Quantity before.
    type Input: Quantity<Sample = f32>;
    /// Quantity after.
    type Output: Quantity<Sample = f32>;

    /// The component of the signal breakdown that receives the difference, in electrons.
    const COMPONENT: SignalComponent;

    fn convert<'a>(&self, row: Row<'a, Self::Input>) -> Row<'a, Self::Output>;
}

/// A prepared effect of a capture.
pub(crate) struct Stage<Q: Quantity> {
    pub(crate) component: SignalComponent,
    pub(crate) action: Action<Q>,
}

/// A member of a domain's list: an effect, or one that may be absent from the description.
pub(crate) trait ListedEffect: Effect {
    type Signal: Quantity<Sample = f32>;

    /// The prepared effect; `None` if the capture does not have it.
    fn stage(&self, context: &Context, memory: &mut Memory) -> Option<Stage<Self::Signal>>;
}

impl<E: QuantityEffect> ListedEffect for E {
    type Signal = E::Signal;

    fn stage(&self, context: &Context, memory: &mut Memory) -> Option<Stage<E::Signal>> {
        let modelled = self.status(&context.facts, &context.operation).is_modelled();
        modelled.then(|| Stage { component: E::COMPONENT, action: self.prepare(context, memory) })
    }
}

impl<E: QuantityEffect> ListedEffect for Option<E> {
    type Signal = E::Signal;

    fn stage(&self, context: &Context, memory: &mut Memory) -> Option<Stage<E::Signal>> {
        self.as_ref()?.stage(context, memory)
    }
}

/// A row of pixels of one quantity, e⁻, in f64.
pub(crate) struct Row<'a, Q> {
    /// One value per pixel.
    pub(crate) values: &'a mut [f64],
    /// The row's index in its plane.
    pub(crate) y: u32,
    /// Charge of the row at the full well; `None` before it, and if it is applied on planes.
    pub(crate) tally: &'a mut Option<RowTally>,
    quantity: PhantomData<Q>,
}

impl<'a, Q> Row<'a, Q> {
    /// Wraps the values of row `y` as this quantity.
    pub(crate) fn new(values: &'a mut [f64], y: u32, tally: &'a mut Option<RowTally>) -> Self {
        Self { values, y, tally, quantity: PhantomData }
    }
}

impl<'a> Row<'a, MeanElectrons> {
    /// The same values as charge, after counting.
    pub(crate) fn counted(self) -> Row<'a, Charge> {
        Row::new(self.values, self.y, self.tally)
    }
}

impl<'a> Row<'a, Charge> {
    /// The same values as voltage, after the response.
    pub(crate) fn sensed(self) -> Row<'a, Voltage> {
        Row::new(self.values, self.y, self.tally)
    }
}

/// The facts shared by all captures of a sensor.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SensorFacts {
    /// True if temporal noise is modelled.
    pub(crate) noise: bool,
    /// Seed of the unit; `None`: that of the camera's place in the job.
    pub(crate) unit: Option<u64>,
    /// Pixel pitch, µm.
    pub(crate) pitch_um: f64,
    /// Columns and rows before the first lit pixel.
    pub(crate) first_lit: [usize; 2],
    /// Exposure time as described, s.
    pub(crate) exposure_s: f64,
    /// Time from frame to frame, s; `None` if not described.
    pub(crate) frame_period_s: Option<f64>,
    /// Number of consecutive exposures of a frame: captures that do not read the charge of the one before.
    pub(crate) exposures: usize,
    /// True if captures have their own photodiodes.
    pub(crate) is_split_pixel: bool,
    /// The largest full well of all captures, e⁻.
    pub(crate) max_full_well_e: f64,
    /// Digital numbers per electron at an analogue gain of 1.
    pub(crate) gain_dn_e: f64,
    /// Factor on the voltage before the ADC, as described.
    pub(crate) analogue_gain: f64,
    /// Digital numbers from black to the ADC's maximum.
    pub(crate) converter_range_dn: f64,
}

/// One capture: the sensor's facts, its operation, its random address, the size of the array.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Context {
    pub(crate) facts: SensorFacts,
    pub(crate) operation: Operation,
    pub(crate) address: FrameAddress,
    pub(crate) width: usize,
    pub(crate) height: usize,
}

/// Seed of the patterns of cameras that are distinguished only by their place in the job.
const UNIT_SEED: u64 = 0x7061_7474_6572_6e73;

impl Context {
    /// The key of random numbers that differ from capture to capture.
    pub(crate) fn noise(&self, purpose: NoiseDraw) -> NoiseKey {
        let FrameAddress { seed, camera, frame, capture } = self.address;
        NoiseKey::new(seed, camera, frame, capture, purpose)
    }

    /// The key of random numbers that differ from frame to frame and are the same in all captures of a frame.
    pub(crate) fn frame_noise(&self, purpose: NoiseDraw) -> NoiseKey {
        NoiseKey::new(self.address.seed, self.address.camera, self.address.frame, 0, purpose)
    }

    /// The key of random numbers of the unit: the same in every frame and capture of every job.
    pub(crate) fn pattern(&self, purpose: NoiseDraw) -> NoiseKey {
        match self.facts.unit {
            Some(seed) => NoiseKey::new(seed, 0, 0, 0, purpose),
            None => NoiseKey::new(UNIT_SEED, self.address.camera, 0, 0, purpose),
        }
    }
}

/// State of a sensor after the last frame and after this frame.
#[derive(Clone, Debug)]
pub(crate) struct Memory {
    pub(crate) before: SensorState,
    pub(crate) after: SensorState,
}
