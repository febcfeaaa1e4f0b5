//! Shares of light, 0 … 1.

use super::stage::Scenery;
use etendue_scene::record::Colour;

/// The number that three equal ones are.
pub(crate) fn grey(values: [f64; 3]) -> Option<f64> {
    (values[0] == values[1] && values[1] == values[2]).then_some(values[0])
}

impl Scenery {
    /// A share of light of a parameter called `name`, cut off at 0 and 1, which is said.
    pub(crate) fn cut(&mut self, name: &str, share: f64) -> f64 {
        let legal = share.clamp(0.0, 1.0);
        if legal != share {
            self.report.note(format!("\"{name}\" beyond 0 … 1 is cut off there"));
        }
        legal
    }

    /// The same of linear sRGB.
    pub(crate) fn share_of_rgb(&mut self, name: &str, rgb: [f64; 3]) -> Colour {
        let legal = rgb.map(|v| self.cut(name, v));
        grey(legal).map_or(Colour::LinearSrgb(legal.into()), |v| Colour::Grey(v.into()))
    }
}
