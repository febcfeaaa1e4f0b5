//! The luminous opening by the signs of its sizes (LM-63-2002, annex D): what is negative is round.

use etendue_scene::asset::{Opening, OpeningShape};

/// The opening of a width, length and height, m.
pub(super) fn of([width, length, height]: [f64; 3]) -> Opening {
    let round = [width < 0.0, length < 0.0, height < 0.0];
    let shape = match round {
        [false, false, _] if [width, length, height] == [0.0; 3] => OpeningShape::Point,
        [false, false, _] => OpeningShape::Rectangular,
        [true, true, true] => OpeningShape::Ball,
        [_, _, false] => OpeningShape::Round,
        [true, false, true] => OpeningShape::Lying,
        [false, true, true] => OpeningShape::LyingAcross,
    };
    // Editions before 2002 state a circle by its width alone.
    let length = if shape == OpeningShape::Round && length == 0.0 { width } else { length };
    Opening { shape, length_m: length.abs(), width_m: width.abs(), height_m: height.abs() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn signs_tell_the_shape() {
        let shapes = [
            ([0.0, 0.0, 0.0], OpeningShape::Point),
            ([1.0, 2.0, 0.0], OpeningShape::Rectangular),
            ([1.0, 2.0, 0.5], OpeningShape::Rectangular),
            ([-1.0, -1.0, 0.0], OpeningShape::Round),
            ([-1.0, 0.0, 0.0], OpeningShape::Round),
            ([-1.0, -2.0, 0.5], OpeningShape::Round),
            ([-1.0, -1.0, -1.0], OpeningShape::Ball),
            ([-1.0, 2.0, -1.0], OpeningShape::Lying),
            ([0.0, -1.0, -1.0], OpeningShape::LyingAcross),
        ];
        for (size, shape) in shapes {
            assert_eq!(of(size).shape, shape, "{size:?}");
        }
        let circle = of([-0.5, 0.0, 0.0]);
        assert_eq!((circle.width_m, circle.length_m, circle.height_m), (0.5, 0.5, 0.0));
    }
}
