//! Drawings of planes that are no light: flow, identities, lengths, vectors, boxes.
//!
//! | plane | drawn as |
//! | --- | --- |
//! | optical flow, image velocity | colour wheel of Baker et al. 2011 ([`flow_wheel`]): hue by direction, saturation by length; black: not known |
//! | identities | a colour each, the same in every file ([`identity_colour`]); black: 0, the background |
//! | depth, distance, disparity | viridis ([`viridis`]) by the logarithm of lengths, evenly for disparity; white: infinite, magenta: NaN |
//! | vectors | x, y and z as red, green and blue about grey; magenta: NaN |
//! | boxes | outlines in the objects' identity colours ([`outline`]) |

mod flow_wheel;
mod identity_colour;
mod outline;
mod vectors;
mod viridis;

pub(super) use flow_wheel::of_flow;
pub(super) use identity_colour::of_identities;
pub(super) use outline::draw_boxes;
pub(super) use vectors::of_vectors;
pub(super) use viridis::{of_differences, of_lengths};

/// The value of which `percent` of the finite values are not greater; `None` where no value is finite.
fn percentile(values: impl Iterator<Item = f32>, percent: usize) -> Option<f32> {
    let mut finite: Vec<f32> = values.filter(|v| v.is_finite()).collect();
    let rank = finite.len().checked_sub(1)? * percent / 100;
    Some(*finite.select_nth_unstable_by(rank, f32::total_cmp).1)
}
