//! The macro that writes a domain: the effects on one quantity, listed once.

/// Declares a struct with the parameters of all effects on a quantity, in physical order, `field: Effect,` or, if the description may omit it,
/// `field: Option<Effect>,`. The list generates the checks and the plan's entries (by `show`) and the stages of a capture, so an effect on the
/// quantity is always in all of them.
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
            /// Visits the effects.
            pub(crate) fn show(&self, visitor: &mut impl $crate::effect::Visitor) {
                $( visitor.visit(&self.$field); )*
            }

            /// The prepared effects of a capture.
            pub(crate) fn stages(
                &self,
                context: &$crate::effect::Context,
                memory: &mut $crate::effect::Memory,
            ) -> Vec<$crate::effect::Stage<$quantity>> {
                [$( $crate::effect::ListedEffect::stage(&self.$field, context, memory) ),*].into_iter().flatten().collect()
            }
        }
    };
}

pub(crate) use domain;
