//! A house: its measures, and what closes it above and below.

/// What the ground floor is used for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Ground {
    /// Flats: windows and a door.
    Home,
    /// A shop under a board.
    Shop,
}

/// What closes a house above.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Roof {
    /// A ridge along the street and this many dormers.
    Pitched(usize),
    /// Flat, behind a parapet.
    Flat,
}

/// A house.
#[derive(Clone, Copy, Debug)]
pub(super) struct House {
    /// Length of the front, m.
    pub(super) width: f64,
    /// Depth, m.
    pub(super) depth: f64,
    /// Storeys with the ground floor.
    pub(super) storeys: usize,
    /// Windows a storey.
    pub(super) bays: usize,
    /// Width and height of a window, m.
    pub(super) window: [f64; 2],
    /// Whether windows have raised surrounds.
    pub(super) surrounds: bool,
    /// Whether the upper storeys have balconies in every second bay.
    pub(super) balconies: bool,
    /// The ground floor.
    pub(super) ground: Ground,
    /// The roof.
    pub(super) roof: Roof,
    /// Key of the random curtains and shutters.
    pub(super) key: u32,
}

/// Height of the ground floor, m.
pub(super) const GROUND_M: f64 = 3.6;

/// Height of the other storeys, m.
pub(super) const STOREY_M: f64 = 3.0;

impl House {
    /// Height of the eaves, m.
    #[must_use]
    pub(super) fn eaves(&self) -> f64 {
        GROUND_M + (self.storeys - 1) as f64 * STOREY_M + 0.35
    }
}
