//! Drawings of planes that are no light: flow, identities, lengths, vectors, boxes.
//!
//! | plane | drawn as |
//! | --- | --- |
//! | optical flow, image velocity | colour wheel of Baker et al. 2011 ([`mod@flow_wheel`]): hue by direction, saturation by length; black: not known |
//! | identities | a colour each, the same in every file ([`mod@identity_colour`]); black: 0, the background |
//! | depth, distance, disparity | viridis ([`viridis`]) by the logarithm of lengths, evenly for disparity; white: infinite, magenta: NaN |
//! | vectors | x, y and z as red, green and blue about grey; magenta: NaN |
//! | boxes | outlines in the objects' identity colours ([`outline`]) |

mod flow_wheel;
mod identity_colour;
mod outline;
mod percentile;
mod vectors;
mod viridis;

pub use flow_wheel::flow_wheel;
pub(super) use flow_wheel::of_flow;
pub use identity_colour::identity_colour;
pub(super) use identity_colour::of_identities;
pub(super) use outline::draw_boxes;
pub(super) use vectors::of_vectors;
pub use viridis::VIRIDIS;
pub(super) use viridis::{of_differences, of_lengths};
