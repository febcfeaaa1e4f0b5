//! One number of a picture's several.

use etendue_spectra::colour::XYZ_FROM_SRGB;

/// Which number of a picture is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Channel {
    /// Red.
    Red,
    /// Green.
    Green,
    /// Blue.
    Blue,
    /// How opaque a texel is, of pictures that say so; 1 of others.
    Alpha,
    /// The luminance of the linear colour, 1 for white; of a grey picture, its grey.
    Luminance,
}

impl Channel {
    /// The channel of a colour.
    pub(super) fn of(self, [r, g, b]: [f32; 3]) -> f32 {
        match self {
            Self::Red => r,
            Self::Green => g,
            Self::Blue => b,
            Self::Alpha => 1.0,
            Self::Luminance => {
                let [wr, wg, wb] = XYZ_FROM_SRGB[1].map(|w| w as f32);
                // Rounding must not take white beyond 1.
                (wr * r + wg * g + wb * b).clamp(r.min(g).min(b), r.max(g).max(b))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn luminance_keeps_greys_and_weighs_colours() {
        for grey in [0.0, 0.2, 1.0, 1.0_f32.next_down()] {
            assert_eq!(Channel::Luminance.of([grey; 3]), grey);
        }
        // Y of the primaries: IEC 61966-2-1 with this crate's white, 0.2127, 0.7152, 0.0722.
        assert!((Channel::Luminance.of([0.0, 1.0, 0.0]) - 0.7152).abs() < 1e-4);
        assert_eq!(Channel::Blue.of([0.1, 0.2, 0.3]), 0.3);
    }
}
