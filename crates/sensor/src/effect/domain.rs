//! The macro that writes a domain: the effects on one quantity, listed once.

/// A struct with the parameters of all effects on a quantity, in physical order, `field: Effect,` or, where the description may say
/// nothing of it, `field: Option<Effect>,`. The list is all there is: the checks, what a plan says and what a capture runs are made of it,
/// so that an effect cannot be in one and not in the other.
macro_rules! domain {
    (
        $(#[doc = $about:literal])*
        pub struct $name:ident on $quantity:ident {
            $( $(#[doc = $doc:literal])* $field:ident : $effect:ty, )*
        }
    ) => {
        $(#[doc = $about])*
        #[derive(Clone, Debug, Default, PartialEq)]
        pub struct $name {
            $( $(#[doc = $doc])* pub $field: $effect, )*
        }

        impl $name {
            /// Refuses what is illegal.
            pub(crate) fn check(&self, facts: &$crate::effect::SensorFacts, checks: &mut $crate::check::Checks) {
                $( $crate::effect::Effect::check(&self.$field, facts, checks); )*
            }

            /// The names of the effects, whether a capture has them, and why.
            pub(crate) fn statuses(
                &self,
                facts: &$crate::effect::SensorFacts,
                operation: &$crate::operation::Operation,
            ) -> Vec<(&'static str, etendue_core::EffectStatus)> {
                vec![$( $crate::effect::named_status(&self.$field, facts, operation) ),*]
            }

            /// The effects that a capture has, made ready.
            pub(crate) fn stages(
                &self,
                context: &$crate::effect::Context,
                memory: &mut $crate::effect::Memory,
            ) -> Vec<$crate::effect::Stage<$quantity>> {
                [$( $crate::effect::Listed::stage(&self.$field, context, memory) ),*].into_iter().flatten().collect()
            }
        }
    };
}

pub(crate) use domain;
