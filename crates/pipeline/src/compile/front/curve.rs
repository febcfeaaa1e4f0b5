//! Shares of light over the wavelength.

use crate::compile::context::Context;
use crate::compile::material::share;
use etendue_optics::front::Curve;
use etendue_scene::record::Colour;

/// A share of light over the wavelength.
pub(super) fn curve(colour: &Colour, context: &mut Context<'_>) -> Option<Curve> {
    match colour {
        Colour::Grey(share) => Some(Curve::Constant(share.value)),
        _ => share(colour, context).map(|spectrum| Curve::Table(Box::new(spectrum))),
    }
}
