//! What photon transfer finds.

use etendue_metrology::photon_transfer::{Figures, Nonuniformity, Stack, TransferData};

/// Everything that was found.
pub(crate) struct Found {
    pub(crate) data: TransferData,
    pub(crate) figures: Figures,
    pub(crate) fixed: Option<Fixed>,
    /// Notes of clipped images that enter the result.
    pub(crate) cuts: Vec<String>,
}

/// Of the stacks.
pub(crate) struct Fixed {
    pub(crate) dark: Stack,
    pub(crate) bright: Stack,
    pub(crate) patterns: Nonuniformity,
}
