//! A row of pixels on its way through the effects.

use crate::charge_account::RowTally;
use core::marker::PhantomData;
use etendue_core::quantity::{Charge, MeanElectrons, Voltage};

/// A row of pixels of one quantity, e⁻, in f64.
pub(crate) struct Row<'a, Q> {
    /// One number a pixel.
    pub(crate) values: &'a mut [f64],
    /// The row's number in its plane.
    pub(crate) y: u32,
    /// Charge of the row at the full well; `None` before it, and where it is met on planes.
    pub(crate) tally: &'a mut Option<RowTally>,
    quantity: PhantomData<Q>,
}

impl<'a, Q> Row<'a, Q> {
    /// The numbers of row `y`, which are of the quantity.
    pub(crate) fn new(values: &'a mut [f64], y: u32, tally: &'a mut Option<RowTally>) -> Self {
        Self { values, y, tally, quantity: PhantomData }
    }
}

impl<'a> Row<'a, MeanElectrons> {
    /// The same numbers as charge: they have been counted.
    pub(crate) fn counted(self) -> Row<'a, Charge> {
        Row::new(self.values, self.y, self.tally)
    }
}

impl<'a> Row<'a, Charge> {
    /// The same numbers as voltage: they have been put through the response.
    pub(crate) fn sensed(self) -> Row<'a, Voltage> {
        Row::new(self.values, self.y, self.tally)
    }
}
