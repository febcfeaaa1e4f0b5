//! How much memory films may take.

use etendue_core::scratch::ScratchStore;
use std::sync::Arc;

/// How much memory the bands of a film may take, and where those are kept that take more. No result depends on it.
#[derive(Clone, Debug)]
pub struct FilmLimit {
    /// Most bytes of the means and variances of one film.
    pub bytes: u64,
    /// Where larger ones are kept.
    pub store: Arc<dyn ScratchStore>,
}
