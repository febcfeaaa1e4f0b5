//! What lies beyond the edge of a picture.

/// What a texture shows outside 0–1 along one axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Wrap {
    /// The picture again.
    #[default]
    Repeat,
    /// The texels of the edge.
    Clamp,
    /// The picture mirrored, and again.
    Mirror,
}

impl Wrap {
    /// A coordinate brought into [0, 1].
    pub(super) fn fold(self, x: f32) -> f32 {
        match self {
            Self::Repeat => x - x.floor(),
            Self::Clamp => x.clamp(0.0, 1.0),
            Self::Mirror => {
                let turn = x - 2.0 * (0.5 * x).floor();
                if turn > 1.0 { 2.0 - turn } else { turn }
            }
        }
    }

    /// A coordinate, however large, as one near 0 that shows the same.
    pub(super) fn near(self, x: f64) -> f32 {
        match self {
            Self::Repeat | Self::Mirror => (x - 2.0 * (0.5 * x).floor()) as f32,
            Self::Clamp => x as f32,
        }
    }

    /// A texel index of −1 to `count`, brought into 0 to `count` − 1. A mirrored picture's neighbour at the edge is the
    /// edge itself.
    pub(super) fn neighbour(self, i: i32, count: u32) -> usize {
        let last = count as i32 - 1;
        let i = match self {
            Self::Repeat if i < 0 => last,
            Self::Repeat if i > last => 0,
            _ => i.clamp(0, last),
        };
        i as usize
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_rule_has_its_pattern() {
        let at = |wrap: Wrap| [-1.25, -0.25, 0.25, 1.25, 2.25].map(|x| wrap.fold(x));
        assert_eq!(at(Wrap::Repeat), [0.75, 0.75, 0.25, 0.25, 0.25]);
        assert_eq!(at(Wrap::Clamp), [0.0, 0.0, 0.25, 1.0, 1.0]);
        assert_eq!(at(Wrap::Mirror), [0.75, 0.25, 0.25, 0.75, 0.25]);
    }

    #[test]
    fn neighbours_of_the_edge_follow_the_rule() {
        assert_eq!((Wrap::Repeat.neighbour(-1, 4), Wrap::Repeat.neighbour(4, 4)), (3, 0));
        assert_eq!((Wrap::Clamp.neighbour(-1, 4), Wrap::Clamp.neighbour(4, 4)), (0, 3));
        assert_eq!((Wrap::Mirror.neighbour(-1, 4), Wrap::Mirror.neighbour(4, 4)), (0, 3));
    }
}
