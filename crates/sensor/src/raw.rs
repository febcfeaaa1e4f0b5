//! A raw image, with the data needed for development.

use std::borrow::Cow;

use etendue_core::{Plane, quantity::DigitalNumber, random::Pixel};

use crate::{capture::OperatingPoint, hdr::companding::Companding, layout::Region, signal_breakdown::ChargeAccount};

/// A raw image, with the data needed for development.
#[derive(Clone, Debug, PartialEq)]
pub struct Raw {
    /// Digital numbers.
    pub plane: Plane<DigitalNumber>,
    /// Digital number of zero charge.
    pub black_level_dn: f64,
    /// Digital number of a saturated pixel.
    pub white_level_dn: f64,
    /// Bits of a number.
    pub bits: u32,
    /// The companding curve of the numbers.
    pub companding: Option<Companding>,
    /// The lit part of the plane.
    pub image: Region,
    /// Exposure time and gain of the frame.
    pub operating_point: OperatingPoint,
    /// Balance of charge at the full well: for each capture with its own charge, with its index.
    pub accounts: Vec<(usize, ChargeAccount)>,
    /// Pixels whose mean electrons were not a number, infinite or negative, in raster order of the array. The digital numbers that include them are 0
    /// and meaningless.
    pub invalid: Vec<Pixel>,
}

/// The lit part, in numbers proportional to the merged reading.
#[derive(Clone, Debug, PartialEq)]
pub struct LinearRaw<'a> {
    /// Digital numbers.
    pub plane: Cow<'a, Plane<DigitalNumber>>,
    /// Digital number of zero charge.
    pub black_level_dn: f64,
    /// Digital number of a saturated pixel.
    pub white_level_dn: f64,
    /// The optical-black rows above the image, or else the columns left of it, if there are any.
    pub optical_black: Option<Plane<DigitalNumber>>,
}

impl Raw {
    /// The rows above the image, or else the columns left of it.
    fn shielded(&self) -> Option<Region> {
        let Region { x, y, width, height } = self.image;
        let above = Region { x, y: 0, width, height: y };
        let side_columns = Region { x: 0, y, width: x, height };
        [above, side_columns].into_iter().find(|region| region.width > 0 && region.height > 0)
    }

    /// The image without optical black and without companding.
    #[must_use]
    pub fn linear(&self) -> LinearRaw<'_> {
        let is_uncropped = (self.image.width, self.image.height) == (self.plane.width(), self.plane.height());
        let part = if is_uncropped { Cow::Borrowed(&self.plane) } else { Cow::Owned(self.image.crop(&self.plane)) };
        let optical_black = self.shielded().map(|region| region.crop(&self.plane));
        let Some(curve) = &self.companding else {
            let (black_level_dn, white_level_dn) = (self.black_level_dn, self.white_level_dn);
            return LinearRaw { plane: part, black_level_dn, white_level_dn, optical_black };
        };
        let linear = |dn: u32| curve.linear(f64::from(dn)).round_ties_even() as u32;
        let table: Vec<u32> = (0..1_u32 << self.bits).map(linear).collect();
        let expanded = |plane: &Plane<DigitalNumber>| plane.map(|dn| table[dn as usize]);
        LinearRaw {
            plane: Cow::Owned(expanded(&part)),
            black_level_dn: curve.linear(self.black_level_dn),
            white_level_dn: curve.linear(self.white_level_dn),
            optical_black: optical_black.as_ref().map(expanded),
        }
    }
}
