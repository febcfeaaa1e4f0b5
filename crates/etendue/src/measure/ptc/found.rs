//! What photon transfer finds.

use etendue_metrology::photon_transfer::{Figures, Nonuniformity, Stack, TransferData};

/// Everything that was found.
pub(super) struct Found {
    pub(super) data: TransferData,
    pub(super) figures: Figures,
    pub(super) fixed: Option<Fixed>,
}

/// Of the stacks.
pub(super) struct Fixed {
    pub(super) dark: Stack,
    pub(super) bright: Stack,
    pub(super) patterns: Nonuniformity,
}
