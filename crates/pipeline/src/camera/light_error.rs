//! Why a film does not become light.

use etendue_optics::OpticsError;

/// Why a film does not become light.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LightError {
    /// The lens cannot be put on the film.
    #[error(transparent)]
    Optics(#[from] OpticsError),
    /// A scratch file cannot be written or read.
    #[error("{0}")]
    Scratch(String),
}
