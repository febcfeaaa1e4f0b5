//! What an effect is: its own parameters, whether it is modelled, and what it does to one quantity.
//!
//! An effect acts on mean electrons, on charge or on voltage ([`EffectOn`]), pixel by pixel along a row or on the whole plane
//! ([`Action`]). The three quantities are types, so that an effect cannot stand where the picture is something else: only counting makes
//! charge of mean electrons, and only the response makes voltage of charge ([`RowConversion`]).

mod context;
mod domain;
mod row;

pub(crate) use context::{Context, Memory, SensorFacts};
pub(crate) use domain::domain;
pub(crate) use row::Row;

use crate::charge_account::ChargeAccount;
use crate::check::Checks;
use crate::operation::Operation;
use crate::signal_breakdown::SignalComponent;
use crate::state::SensorState;
use etendue_core::quantity::Quantity;
use etendue_core::{EffectStatus, KeyChange, KnownError, Plane};

/// Why randomness is absent.
pub(crate) const NOISE_OFF: &str = "noise is switched off for this sensor";

/// An effect, as described: its own parameters.
pub(crate) trait Effect {
    /// Its name in a plan.
    const NAME: &'static str;

    /// The key of a camera file that describes it.
    const KEY: &'static str;

    /// Refuses parameters that are illegal, or contradict the sensor's.
    fn check(&self, facts: &SensorFacts, checks: &mut Checks);

    /// Whether a capture has the effect, and why.
    fn status(&self, facts: &SensorFacts, operation: &Operation) -> EffectStatus;

    /// The changes of keys that leave it out; none where a sensor cannot be without it.
    fn left_out_by(&self) -> Vec<KeyChange> {
        vec![KeyChange::removed(Self::KEY)]
    }

    /// The errors of a frame without it that have a closed form.
    fn errors_without(&self, _facts: &SensorFacts, _levels: &SignalLevels) -> Vec<KnownError> {
        Vec::new()
    }
}

/// Signals that errors are stated for.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct SignalLevels {
    /// A grey card in a well-exposed image, 18 % of the largest signal, e⁻.
    pub(crate) grey_e: f64,
    /// Variance without light, e⁻²: read noise, dark current, rounding.
    pub(crate) dark_variance_e2: f64,
}

/// An effect of a sensor, as a plan states it.
#[derive(Clone, Debug, PartialEq)]
pub struct SensorEffect {
    /// Its name.
    pub name: &'static str,
    /// The key of a camera file that describes it.
    pub key: &'static str,
    /// Whether the first capture as described has it, and why.
    pub status: EffectStatus,
    /// The changes of keys that leave it out; empty where a sensor cannot be without it.
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

/// Is shown the effects of a sensor one by one, in physical order: what it does, it does to all of them.
pub(crate) trait Visitor {
    fn visit<E: Effect>(&mut self, effect: &E);
}

/// An effect on one quantity.
pub(crate) trait EffectOn: Effect {
    /// The quantity.
    type On: Quantity<Sample = f32>;

    /// The component of the signal breakdown that has what the effect adds or takes.
    const COMPONENT: SignalComponent;

    /// The effect made ready for a capture that has it.
    fn prepare(&self, context: &Context, memory: &mut Memory) -> Action<Self::On>;
}

/// What an effect does, made ready for a capture.
pub(crate) enum Action<Q: Quantity> {
    /// To each pixel on its own, row by row in f64.
    Rows(Box<dyn RowEffect<Q>>),
    /// To the whole plane, where neighbours or a memory of pixels matter.
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

/// What effects on planes leave beside the picture.
pub(crate) struct Traces<'a> {
    /// What the sensor remembers after the frame.
    pub(crate) after: &'a mut SensorState,
    /// Where charge went at the full well.
    pub(crate) account: &'a mut Option<ChargeAccount>,
}

/// Makes one quantity of another, row by row.
pub(crate) trait RowConversion: Send + Sync {
    /// What there was.
    type From: Quantity<Sample = f32>;
    /// What there is then.
    type To: Quantity<Sample = f32>;

    /// The component of the signal breakdown that has the difference, in electrons.
    const COMPONENT: SignalComponent;

    fn convert<'a>(&self, row: Row<'a, Self::From>) -> Row<'a, Self::To>;
}

/// An effect that a capture has, made ready.
pub(crate) struct Stage<Q: Quantity> {
    pub(crate) component: SignalComponent,
    pub(crate) action: Action<Q>,
}

/// A member of a domain's list: an effect, or one that may be absent from the description.
pub(crate) trait Listed: Effect {
    type On: Quantity<Sample = f32>;

    /// The effect made ready; `None` where the capture does not have it.
    fn stage(&self, context: &Context, memory: &mut Memory) -> Option<Stage<Self::On>>;
}

impl<E: EffectOn> Listed for E {
    type On = E::On;

    fn stage(&self, context: &Context, memory: &mut Memory) -> Option<Stage<E::On>> {
        let modelled = self.status(&context.facts, &context.operation).is_modelled();
        modelled.then(|| Stage { component: E::COMPONENT, action: self.prepare(context, memory) })
    }
}

impl<E: EffectOn> Listed for Option<E> {
    type On = E::On;

    fn stage(&self, context: &Context, memory: &mut Memory) -> Option<Stage<E::On>> {
        self.as_ref()?.stage(context, memory)
    }
}
