//! White balance: gains that make a grey surface grey.
//!
//! Gains are normalised so that the smallest is 1. A saturated pixel is then at least 1 in every channel and, clipped at
//! 1 **before** demosaic and colour matrix, white: without the clip, highlights turn magenta.
//!
//! | rule | gains |
//! | --- | --- |
//! | [`WhiteBalance::Gains`] | as given, or [from an illuminant](white_balance_from_illuminant) |
//! | [`WhiteBalance::GreyWorld`] | those that make the picture's mean grey |

mod grey_world;
mod illuminant;

pub(crate) use grey_world::grey_world;
pub(crate) use illuminant::response;
pub use illuminant::{NoResponse, white_balance_from_illuminant};

/// What makes grey grey.
#[derive(Clone, Debug, PartialEq)]
pub enum WhiteBalance {
    /// Gains of the channels, each at least 1.
    Gains(Vec<f64>),
    /// The mean of each picture is grey.
    GreyWorld,
}

/// The gains with which channels of these strengths are alike; the smallest is 1. `None` where a channel has none.
fn balancing(strengths: &[f64]) -> Option<Vec<f64>> {
    let largest = strengths.iter().copied().fold(0.0, f64::max);
    strengths.iter().all(|s| *s > 0.0).then(|| strengths.iter().map(|s| largest / s).collect())
}
