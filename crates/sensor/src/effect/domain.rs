//! The macro that writes a domain: the effects on one quantity, listed once.

/// A struct with the parameters of all effects on a quantity, in physical order, `field: Effect,` or, where the description may say
/// nothing of it, `field: Option<Effect>,`. Of the list are made the checks and what a plan says, by way of `show`, and what a
/// capture runs, so that an effect on the quantity cannot be in one and not in the other.
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
            /// Shows the effects.
            pub(crate) fn show(&self, visitor: &mut impl $crate::effect::Visitor) {
                $( visitor.visit(&self.$field); )*
            }

            /// The effects that a capture has, prepared.
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
