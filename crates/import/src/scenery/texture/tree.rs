//! Textures of pbrt as trees: constants, images and patterns of texture coordinates, and their combinations.

use std::cell::RefCell;
use std::rc::Rc;

use super::super::projection::TextureBase;
use super::image::{ImageFile, ImageUse, ImageWrap, LinearImage};
use super::noise::is_in_dot;

/// Texture.
pub(crate) enum TextureTree {
    Constant([f64; 3]),
    Image(ImageLeaf),
    Pattern(Pattern, Placement),
    /// The weight of the second is the third.
    Mix(Rc<TextureTree>, Rc<TextureTree>, Rc<TextureTree>),
    Product(Rc<TextureTree>, Rc<TextureTree>),
}

/// Image with its use.
pub(crate) struct ImageLeaf {
    pub(crate) file: ImageFile,
    pub(crate) usage: ImageUse,
    pub(crate) wrap: ImageWrap,
    pub(crate) scale: f64,
    pub(crate) is_inverted: bool,
    pub(crate) placement: Placement,
    pub(crate) pixels: RefCell<Option<Rc<LinearImage>>>,
}

/// Pattern of texture coordinates.
pub(crate) enum Pattern {
    /// The first in the cell at the origin.
    Checkerboard(Rc<TextureTree>, Rc<TextureTree>),
    /// Inside and outside.
    Dots(Rc<TextureTree>, Rc<TextureTree>),
    /// Values at (0, 0), (1, 0), (0, 1), (1, 1).
    Bilinear([[f64; 3]; 4]),
}

/// Texture coordinates of an image or a pattern: `scale` times those of the base, plus `offset`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Placement {
    pub(crate) base: TextureBase,
    pub(crate) scale: [f64; 2],
    pub(crate) offset: [f64; 2],
}

impl Placement {
    pub(crate) fn coordinates(&self, uv: [f64; 2]) -> [f64; 2] {
        std::array::from_fn(|i| self.scale[i] * uv[i] + self.offset[i])
    }

    pub(crate) fn inverse(&self, st: [f64; 2]) -> [f64; 2] {
        std::array::from_fn(|i| (st[i] - self.offset[i]) / self.scale[i])
    }
}

/// Leaf that depends on texture coordinates.
pub(crate) enum Leaf<'a> {
    Image(&'a ImageLeaf),
    Pattern(&'a Pattern, &'a Placement),
}

impl Leaf<'_> {
    pub(crate) fn placement(&self) -> &Placement {
        match self {
            Self::Image(image) => &image.placement,
            Self::Pattern(_, placement) => placement,
        }
    }
}

impl ImageLeaf {
    /// Reads the image, unless it is in memory.
    pub(crate) fn load(&self) -> Result<Rc<LinearImage>, String> {
        if let Some(pixels) = &*self.pixels.borrow() {
            return Ok(pixels.clone());
        }
        let image = Rc::new(LinearImage::read(&self.file.path, self.file.encoding, self.usage)?);
        *self.pixels.borrow_mut() = Some(image.clone());
        Ok(image)
    }

    /// Value of pbrt: the scale is before the inversion.
    fn value(&self, uv: [f64; 2]) -> [f64; 3] {
        let pixels = self.pixels.borrow();
        let Some(image) = &*pixels else { return [0.0; 3] };
        let scaled = image.at(self.placement.coordinates(uv), self.wrap).map(|v| self.scale * v);
        if self.is_inverted { scaled.map(|v| (1.0 - v).max(0.0)) } else { scaled }
    }
}

impl TextureTree {
    /// Value at the coordinates of the base; images must be in memory.
    pub(crate) fn value(&self, uv: [f64; 2]) -> [f64; 3] {
        match self {
            Self::Constant(value) => *value,
            Self::Image(image) => image.value(uv),
            Self::Pattern(Pattern::Checkerboard(first, second), placement) => {
                let [s, t] = placement.coordinates(uv).map(f64::floor);
                let part = if (s + t).rem_euclid(2.0) == 0.0 { first } else { second };
                part.value(uv)
            }
            Self::Pattern(Pattern::Dots(inside, outside), placement) => {
                if is_in_dot(placement.coordinates(uv)) {
                    inside.value(uv)
                } else {
                    outside.value(uv)
                }
            }
            Self::Pattern(Pattern::Bilinear(corners), placement) => {
                let [s, t] = placement.coordinates(uv);
                let weights = [(1.0 - s) * (1.0 - t), s * (1.0 - t), (1.0 - s) * t, s * t];
                std::array::from_fn(|i| (0..4).map(|k| weights[k] * corners[k][i]).sum())
            }
            Self::Mix(first, second, weight) => {
                let (a, b, w) = (first.value(uv), second.value(uv), weight.value(uv)[0]);
                std::array::from_fn(|i| (1.0 - w) * a[i] + w * b[i])
            }
            Self::Product(first, second) => {
                let (a, b) = (first.value(uv), second.value(uv));
                std::array::from_fn(|i| a[i] * b[i])
            }
        }
    }

    /// Value of a texture that is the same everywhere.
    pub(crate) fn constant(&self) -> Option<[f64; 3]> {
        self.leaves().is_empty().then(|| self.value([0.0; 2]))
    }

    /// Leaves that depend on texture coordinates, in order.
    pub(crate) fn leaves(&self) -> Vec<Leaf<'_>> {
        let mut leaves = Vec::new();
        self.add_leaves(&mut leaves);
        leaves
    }

    fn add_leaves<'a>(&'a self, leaves: &mut Vec<Leaf<'a>>) {
        match self {
            Self::Constant(_) => {}
            Self::Image(image) => leaves.push(Leaf::Image(image)),
            Self::Pattern(pattern, placement) => {
                leaves.push(Leaf::Pattern(pattern, placement));
                if let Pattern::Checkerboard(a, b) | Pattern::Dots(a, b) = pattern {
                    a.add_leaves(leaves);
                    b.add_leaves(leaves);
                }
            }
            Self::Mix(a, b, weight) => [a, b, weight].into_iter().for_each(|part| part.add_leaves(leaves)),
            Self::Product(a, b) => [a, b].into_iter().for_each(|part| part.add_leaves(leaves)),
        }
    }
}
