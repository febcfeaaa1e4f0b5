//! OpenEXR files: spectral images, ground truth, planes of one quantity.
//!
//! Everything is written as one part of scan lines, ZIP16 compression, increasing line order, channels sorted by name and header records sorted by name: the
//! same values give the same bytes, in any process and on any number of threads (blocks are compressed on the caller's thread pool). 32-bit floats and unsigned
//! integers pass unchanged, NaN and infinities included.
//!
//! A file is written some rows at a time. A large image is an [`ExrImage`] first: it is written without being in memory as a whole, and its bands may be on the
//! disk ([`SpectralBands`]).
//!
//! | writer | channels |
//! | --- | --- |
//! | [`encode_spectral`] | `S0.550,000000nm` …, `variance.S0.550,000000nm` …, preview `R`, `G`, `B` |
//! | [`encode_radiance`] | the same, at the pupil `distance.Z` and `depth.Z` |
//! | [`encode_ground_truth`] | `depth.Z`, `distance.Z`, `N.X/Y/Z`, `P.X/Y/Z`, far from the origin `P_low.X/Y/Z`, `instance.ID`, `semantic.ID`, `material.ID` |
//! | [`encode_motion`] | `flow.forward.X/Y`, `visibility.forward.ID`, `scene_flow.forward.X/Y/Z`, the same `.backward.`, `motion_vector.X/Y`, `velocity.X/Y/Z`, `time.T` |
//! | [`encode_disparity`] | `disparity.X`, `visibility.ID` |
//! | [`rays_image`] | `origin.X/Y/Z`, `direction.X/Y/Z`, `ray.ID` |
//! | [`cryptomatte_image`] | `CryptoObject00.R/G/B/A`, `CryptoObject01.R/G/B/A` …, the same of materials |
//! | [`encode_layers`] | as named |
//! | [`encode_plane`] | the quantity's name, `variance.` and the quantity's name |

mod channel;
mod colour_space;
mod cryptomatte;
mod encode;
mod ground_truth;
mod layers;
mod motion;
mod read;
mod spectral;
mod spectral_read;
#[cfg(test)]
pub(crate) mod tests_support;

pub use channel::EncodeError;
pub use colour_space::{SpectralChannel, Stokes, channel_name, parse_channel_name};
pub use cryptomatte::{CryptomatteLayer, cryptomatte_id, cryptomatte_image};
pub use encode::{ExrImage, WAITING_BYTES};
pub use ground_truth::{
    GroundTruth, GroundTruthRows, encode_ground_truth, ground_truth_from_planes, ground_truth_image, rays_image,
};
pub use layers::{ExrLayer, encode_layers, encode_plane, layers_image, plane_image};
pub use motion::{MotionTruth, NeighbourTruth, VISIBILITY, encode_disparity, encode_motion};
pub use read::{ExrChannel, ExrFile, ExrSamples, read_exr, read_exr_within};
pub use spectral::{
    LengthPlanes, SpectralBands, band_weights, encode_radiance, encode_spectral, radiance_image, spectral_image,
};
pub use spectral_read::{CubeWithVariance, SpectralFile, SpectralImage, read_spectral, spectral_of};

pub(crate) use colour_space::to_rec_709;
pub(crate) use read::{decode_exr, decode_exr_as_stored};
pub(crate) use spectral::linear_srgb;
