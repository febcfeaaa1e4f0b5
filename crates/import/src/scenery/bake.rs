//! Our textures for trees: an image of the file where one suffices, else an image of the texture's values.

use std::rc::Rc;

use etendue_io::Provenance;
use etendue_io::exr::{ExrLayer, encode_layers};
use etendue_scene::record::Texture;
use etendue_scene::record::texture::{Encoding, Wrap};

use super::stage::SceneBuilder;
use super::surfaces::grey;
use super::texture::{
    ImageEncoding, ImageFormat, ImageLeaf, ImageWrap, Leaf, NumberImage, Pattern, PlacedTexture, Placement,
    TextureTree, TextureUse, number_image,
};

/// Sides of the square of a checkerboard's cell, and of an image of a pattern that does not repeat, pixels.
const CELL: usize = 256;
const SIDE: usize = 1024;
/// Maximum side of a written image, pixels.
const MAX_SIDE: usize = 4096;

/// Pixels of a written image, which lie at `scale` times the coordinates of the base plus `offset`.
struct Grid {
    placement: Placement,
    wrap: Wrap,
    columns: usize,
    rows: usize,
    /// Points along each side of a pixel whose mean it is.
    points: usize,
    /// True if it covers only the coordinates 0 to 1 of a texture that does not repeat.
    is_part: bool,
}

impl SceneBuilder {
    /// Our texture for one of pbrt.
    pub(crate) fn placed_texture(
        &mut self,
        name: &str,
        tree: &Rc<TextureTree>,
        usage: TextureUse,
    ) -> Result<PlacedTexture, String> {
        if let Some(value) = tree.constant() {
            return Ok(PlacedTexture::even(value));
        }
        let key = (Rc::as_ptr(tree).addr(), usage.key());
        if let Some((_, known)) = self.known.pictures.get(&key) {
            return Ok(known.clone());
        }
        let placed = match self.direct(name, tree, usage)? {
            Some(direct) => direct,
            None => self.written_texture(name, tree, usage)?,
        };
        self.known.pictures.insert(key, (tree.clone(), placed.clone()));
        Ok(placed)
    }

    /// Texture that refers to an image of the file, if that has the values of the tree.
    fn direct(&mut self, name: &str, tree: &TextureTree, usage: TextureUse) -> Result<Option<PlacedTexture>, String> {
        let Some((image, scale)) = scaled_image(tree) else { return Ok(None) };
        let format = ImageFormat::from_name(&image.file.path.to_string_lossy());
        let encoding = match image.file.encoding {
            ImageEncoding::Linear => Encoding::Linear,
            ImageEncoding::Srgb => Encoding::Srgb,
            ImageEncoding::Gamma(_) => return Ok(None),
        };
        let wrap = match image.wrap {
            ImageWrap::Repeat => Wrap::Repeat,
            ImageWrap::Clamp => Wrap::Clamp,
            ImageWrap::Black => return Ok(None),
        };
        let Placement { base, scale: uv_scale, offset } = &image.placement;
        let is_plain = format.is_ours() && !image.is_inverted && uv_scale.iter().all(|s| *s > 0.0);
        if !(is_plain && scale > 0.0 && scale <= 1.0) || usage == TextureUse::SquareRoots {
            return Ok(None);
        }
        let numbers = match usage {
            TextureUse::Numbers => number_image(&image.file.path)?,
            _ => NumberImage::Grey,
        };
        let is_opacity = numbers == NumberImage::Opacity;
        if usage == TextureUse::Numbers
            && !is_opacity
            && (encoding == Encoding::Srgb || numbers == NumberImage::Colours)
        {
            return Ok(None);
        }
        if !image.file.path.is_file() {
            return Err(format!("no such image file: `{}`; check the path", image.file.path.display()));
        }
        let own = self.names.take(name, "texture");
        let path = self.relative_path(&image.file.path);
        self.scene.textures.push(Texture {
            wrap: Some(wrap.into()),
            uv_scale: Some((*uv_scale).into()),
            uv_offset: Some((*offset).into()),
            ..Texture::new(own.as_str(), path.as_str(), encoding)
        });
        Ok(Some(PlacedTexture::picture(own, scale, is_opacity, base.clone())))
    }

    /// Texture of an image that is written beside the scene.
    fn written_texture(&mut self, name: &str, tree: &TextureTree, usage: TextureUse) -> Result<PlacedTexture, String> {
        load(tree)?;
        let Some(grid) = Grid::new(tree)? else {
            let mean = mean(tree);
            self.report.note(format!("the texture \"{name}\" combines different mappings: its mean is used instead"));
            unload(tree);
            return Ok(PlacedTexture::even(mean));
        };
        let pixels = grid.pixels(tree, usage);
        unload(tree);
        let (columns, rows) = (grid.columns, grid.rows);
        self.report.note(match grid.is_part {
            true => format!(
                "the texture \"{name}\" becomes an image of {columns} by {rows} pixels for the coordinates 0 to 1, which is repeated beyond"
            ),
            false => format!("the texture \"{name}\" becomes an image of {columns} by {rows} pixels"),
        });
        let channel = |i: usize| -> Vec<f32> { pixels.iter().map(|p| p[i]).collect() };
        let [r, g, b] = [0, 1, 2].map(channel);
        let layers = [("B", &b), ("G", &g), ("R", &r)].map(|(layer, c)| (layer.to_owned(), ExrLayer::Float(c)));
        let bytes = encode_layers(columns, rows, &layers, &Provenance::default()).map_err(|e| e.to_string())?;
        let file = self.file_names.take(name, "texture");
        let path = self.add_file(format!("textures/{file}.exr"), bytes);
        self.check_size()?;
        let own = self.names.take(name, "texture");
        let encoding = if usage == TextureUse::Colours { Encoding::Linear } else { Encoding::Data };
        self.scene.textures.push(Texture {
            wrap: Some(grid.wrap.into()),
            uv_scale: Some(grid.placement.scale.into()),
            uv_offset: Some(grid.placement.offset.into()),
            ..Texture::new(own.as_str(), path.as_str(), encoding)
        });
        Ok(PlacedTexture::picture(own, 1.0, false, grid.placement.base))
    }

    /// Mean of a texture over the coordinates 0 to 1.
    pub(crate) fn texture_mean(tree: &TextureTree) -> Result<[f64; 3], String> {
        load(tree)?;
        let mean = mean(tree);
        unload(tree);
        Ok(mean)
    }
}

fn mean(tree: &TextureTree) -> [f64; 3] {
    const POINTS: usize = 256;
    let at = |i: usize| (i as f64 + 0.5) / POINTS as f64;
    let sum = (0..POINTS * POINTS).map(|i| tree.value([at(i % POINTS), at(i / POINTS)]));
    let sum = sum.fold([0.0; 3], |sum, value| std::array::from_fn(|i| sum[i] + value[i]));
    sum.map(|v| v / (POINTS * POINTS) as f64)
}

fn images(tree: &TextureTree) -> Vec<&ImageLeaf> {
    let image = |leaf| match leaf {
        Leaf::Image(image) => Some(image),
        Leaf::Pattern(..) => None,
    };
    tree.leaves().into_iter().filter_map(image).collect()
}

fn load(tree: &TextureTree) -> Result<(), String> {
    images(tree).into_iter().try_for_each(|image| image.load().map(drop))
}

fn unload(tree: &TextureTree) {
    images(tree).into_iter().for_each(|image| drop(image.pixels.take()));
}

/// Image, and the number that multiplies it.
fn scaled_image(tree: &TextureTree) -> Option<(&ImageLeaf, f64)> {
    match tree {
        TextureTree::Image(image) => Some((image, image.scale)),
        TextureTree::Product(a, b) => {
            let (part, factor) = match (a.constant(), b.constant()) {
                (None, Some(factor)) => (a, factor),
                (Some(factor), None) => (b, factor),
                _ => return None,
            };
            let (image, scale) = scaled_image(part)?;
            (!image.is_inverted).then_some((image, scale * grey(factor)?))
        }
        _ => None,
    }
}

/// Image size and period of the leaves of a texture.
struct LeafSummary {
    columns: usize,
    rows: usize,
    /// Wrap of the images; `None` without an image.
    wrap: Option<ImageWrap>,
    has_checkerboard: bool,
    /// True if all leaves repeat with the period 1 or 2 of the same coordinates, or all are images of one wrap there.
    is_periodic: bool,
}

impl LeafSummary {
    fn new(leaves: &[Leaf<'_>]) -> Result<Self, String> {
        let mut summary = Self { columns: 0, rows: 0, wrap: None, has_checkerboard: false, is_periodic: true };
        let first = leaves[0].placement();
        for leaf in leaves {
            summary.is_periodic &= leaf.placement() == first;
            match leaf {
                Leaf::Image(image) => {
                    let pixels = image.load()?;
                    summary.is_periodic &= summary.wrap.is_none_or(|wrap| wrap == image.wrap);
                    summary.wrap = Some(image.wrap);
                    let [across, down] = leaf.placement().scale.map(f64::abs);
                    summary.columns = summary.columns.max((pixels.columns as f64 * across).ceil() as usize);
                    summary.rows = summary.rows.max((pixels.rows as f64 * down).ceil() as usize);
                }
                Leaf::Pattern(Pattern::Checkerboard(..), _) => summary.has_checkerboard = true,
                Leaf::Pattern(..) => summary.is_periodic = false,
            }
        }
        summary.is_periodic &= first.scale.iter().all(|s| *s != 0.0);
        summary.is_periodic &= !summary.has_checkerboard || summary.wrap.is_none_or(|wrap| wrap == ImageWrap::Repeat);
        Ok(summary)
    }
}

impl Grid {
    /// `None` if the leaves of the texture have different bases.
    fn new(tree: &TextureTree) -> Result<Option<Self>, String> {
        let leaves = tree.leaves();
        let first = leaves[0].placement();
        if leaves.iter().any(|leaf| leaf.placement().base != first.base) {
            return Ok(None);
        }
        let summary = LeafSummary::new(&leaves)?;
        if !summary.is_periodic {
            let side = |pixels: usize| if pixels == 0 { SIDE } else { pixels.clamp(16, MAX_SIDE).max(SIDE) };
            let placement = Placement { scale: [1.0; 2], offset: [0.0; 2], ..first.clone() };
            let (columns, rows) = (side(summary.columns), side(summary.rows));
            return Ok(Some(Self { placement, wrap: Wrap::Repeat, columns, rows, points: 2, is_part: true }));
        }
        let sizes = images(tree).into_iter().map(ImageLeaf::load).collect::<Result<Vec<_>, _>>()?;
        let columns = sizes.iter().map(|image| image.columns).max();
        let rows = sizes.iter().map(|image| image.rows).max();
        let (period, border, wrap) = match (summary.has_checkerboard, summary.wrap) {
            (true, _) => (2.0, 0, Wrap::Repeat),
            (false, Some(ImageWrap::Black)) => (1.0, 1, Wrap::Clamp),
            (false, Some(ImageWrap::Clamp)) => (1.0, 0, Wrap::Clamp),
            (false, _) => (1.0, 0, Wrap::Repeat),
        };
        let side = |pixels: Option<usize>| match summary.has_checkerboard {
            true => (2 * pixels.unwrap_or(CELL).max(CELL)).min(MAX_SIDE),
            false => pixels.unwrap_or(CELL),
        };
        let (columns, rows) = (side(columns), side(rows));
        let placement = covering(first, period, [columns, rows], border);
        Ok(Some(Self {
            placement,
            wrap,
            columns: columns + 2 * border,
            rows: rows + 2 * border,
            points: 1,
            is_part: false,
        }))
    }

    fn pixels(&self, tree: &TextureTree, usage: TextureUse) -> Vec<[f32; 3]> {
        let n = self.points;
        let part = |i: usize| (i as f64 + 0.5) / n as f64;
        let pixel = |i: usize| {
            let (column, row) = ((i % self.columns) as f64, (i / self.columns) as f64);
            let mut sum = [0.0; 3];
            for k in 0..n * n {
                let st = [(column + part(k % n)) / self.columns as f64, 1.0 - (row + part(k / n)) / self.rows as f64];
                let value = tree.value(self.placement.inverse(st));
                sum = std::array::from_fn(|c| sum[c] + value[c]);
            }
            sum.map(|v| usage.mapped(v / (n * n) as f64).clamp(0.0, 1.0) as f32)
        };
        (0..self.columns * self.rows).map(pixel).collect()
    }
}

/// Placement of an image that covers `period` of the coordinates and has a border of as many pixels; negative scales are mirrored in it.
fn covering(placement: &Placement, period: f64, size: [usize; 2], border: usize) -> Placement {
    let mut covering = placement.clone();
    for (i, pixels) in size.into_iter().enumerate() {
        let (scale, offset) = (placement.scale[i] / period, placement.offset[i] / period);
        let (scale, offset) = if scale < 0.0 { (-scale, 1.0 - offset) } else { (scale, offset) };
        let pixels = pixels as f64;
        let padded = pixels + 2.0 * border as f64;
        covering.scale[i] = scale * pixels / padded;
        covering.offset[i] = (offset * pixels + border as f64) / padded;
    }
    covering
}
