//! Fewer pixels: blocks of a whole number of columns and rows become one.
//!
//! Of light and other numbers a block has the mean of what is finite in it, and its standard error as if the pixels' errors were independent.
//! Of raws, lengths, identities, flow and vectors, which have no mean that is one of them, its middle pixel stands for it.

use crate::layer::{Layer, NamedPlane, Role, Samples};

/// The least factor by which a layer takes at most so many bytes.
pub(crate) fn factor(layer: &Layer, max_bytes: usize) -> usize {
    let (width, height) = layer.size;
    let bytes = |step: usize| width.div_ceil(step) * height.div_ceil(step) * layer.pixel_bytes();
    (1..).find(|step| bytes(*step) <= max_bytes || *step >= width.max(height)).unwrap_or(1)
}

/// The columns and rows of a layer by blocks of `step`².
pub(crate) fn size(layer: &Layer, step: usize) -> (usize, usize) {
    (layer.size.0.div_ceil(step), layer.size.1.div_ceil(step))
}

/// The planes of a layer by blocks of `step`².
pub(crate) fn planes(layer: &Layer, step: usize) -> Vec<NamedPlane> {
    if step == 1 {
        return layer.planes.clone();
    }
    let blocks = Blocks { size: layer.size, step };
    let binned = |plane: &NamedPlane| NamedPlane {
        samples: match (layer.kind.has_means(), plane.role) {
            (false, _) => blocks.thinned(&plane.samples),
            (true, Role::Value) => blocks.means(&plane.samples),
            (true, Role::Error) => blocks.errors(&plane.samples),
        },
        ..plane.clone()
    };
    layer.planes.iter().map(binned).collect()
}

struct Blocks {
    size: (usize, usize),
    step: usize,
}

impl Blocks {
    /// Of each block the places of its pixels.
    fn each(&self) -> impl Iterator<Item = impl Iterator<Item = usize>> {
        let ((width, height), step) = (self.size, self.step);
        (0..height).step_by(step).flat_map(move |y| {
            (0..width).step_by(step).map(move |x| {
                let rows = y..(y + step).min(height);
                rows.flat_map(move |y| (x..(x + step).min(width)).map(move |x| y * width + x))
            })
        })
    }

    /// Of each block the place of its middle.
    fn middles(&self) -> impl Iterator<Item = usize> {
        let ((width, height), step) = (self.size, self.step);
        let middle = move |from: usize, end: usize| (from + (from + step).min(end)) / 2;
        (0..height)
            .step_by(step)
            .flat_map(move |y| (0..width).step_by(step).map(move |x| middle(y, height) * width + middle(x, width)))
    }

    fn thinned(&self, samples: &Samples) -> Samples {
        fn at<T: Copy>(all: &[T], places: impl Iterator<Item = usize>) -> Vec<T> {
            places.map(|place| all[place]).collect()
        }
        match samples {
            Samples::Bytes(all) => Samples::Bytes(at(all, self.middles())),
            Samples::Words(all) => Samples::Words(at(all, self.middles())),
            Samples::Whole(all) => Samples::Whole(at(all, self.middles())),
            Samples::Exact(all) => Samples::Exact(at(all, self.middles())),
            Samples::Rounded(all) => Samples::Rounded(at(all, self.middles())),
        }
    }

    fn means(&self, samples: &Samples) -> Samples {
        let mean =
            |of: &dyn Fn(usize) -> f64| self.each().map(|block| mean_of_finite(block.map(of))).collect::<Vec<_>>();
        match samples {
            Samples::Bytes(all) => Samples::Bytes(mean(&|i| all[i].into()).iter().map(|v| v.round() as u8).collect()),
            Samples::Words(all) => Samples::Words(mean(&|i| all[i].into()).iter().map(|v| v.round() as u16).collect()),
            Samples::Whole(_) => self.thinned(samples),
            Samples::Exact(all) => Samples::Exact(mean(&|i| all[i].into()).iter().map(|v| *v as f32).collect()),
            Samples::Rounded(all) => Samples::Rounded(mean(&|i| all[i].into()).iter().map(|v| *v as f32).collect()),
        }
    }

    /// Standard errors of means of independent pixels.
    fn errors(&self, samples: &Samples) -> Samples {
        let of = |all: &[f32]| {
            let error = |block: &mut dyn Iterator<Item = usize>| {
                let (sum, count) = block
                    .fold((0.0, 0.0), |(sum, count), i| (sum + f64::from(all[i]) * f64::from(all[i]), count + 1.0));
                (sum.sqrt() / count) as f32
            };
            self.each().map(|mut block| error(&mut block)).collect()
        };
        match samples {
            Samples::Exact(all) => Samples::Exact(of(all)),
            Samples::Rounded(all) => Samples::Rounded(of(all)),
            whole => self.thinned(whole),
        }
    }
}

/// The mean of what is finite; the last of the numbers where none is.
fn mean_of_finite(numbers: impl Iterator<Item = f64>) -> f64 {
    let (mut sum, mut count, mut last) = (0.0, 0.0, f64::NAN);
    for number in numbers {
        last = number;
        if number.is_finite() {
            (sum, count) = (sum + number, count + 1.0);
        }
    }
    if count > 0.0 { sum / count } else { last }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layer::Kind;

    fn layer(kind: Kind, planes: Vec<NamedPlane>) -> Layer {
        Layer { name: "a".to_owned(), kind, unit: String::new(), meaning: String::new(), size: (5, 3), planes }
    }

    #[test]
    fn blocks_have_means_of_what_is_finite_and_the_last_ones_are_smaller() {
        let mut values: Vec<f32> = (0..15).map(|i| i as f32).collect();
        values[1] = f32::INFINITY;
        values[14] = f32::NAN;
        let error = NamedPlane { role: Role::Error, ..NamedPlane::value("v", Samples::Exact(vec![3.0; 15])) };
        let light = layer(Kind::Number, vec![NamedPlane::value("v", Samples::Exact(values)), error]);
        assert_eq!((size(&light, 2), light.pixel_bytes()), ((3, 2), 8));
        let [means, errors] = &planes(&light, 2)[..] else { panic!("two planes") };
        let Samples::Exact(means) = &means.samples else { panic!("exact") };
        assert_eq!(means[..5], [(0.0 + 5.0 + 6.0) / 3.0, 5.0, 6.5, 10.5, 12.5]);
        assert!(means[5].is_nan());
        // Of two errors of 3 the mean has √18 / 2.
        let of_two = 4.5_f64.sqrt() as f32;
        assert_eq!(errors.samples, Samples::Exact(vec![1.5, 1.5, of_two, of_two, of_two, 3.0]));
    }

    #[test]
    fn of_identities_the_middle_pixel_stands_for_its_block() {
        let ids = layer(
            Kind::Identity { names: Vec::new() },
            vec![NamedPlane::value("id", Samples::Whole((0..15).collect()))],
        );
        assert_eq!(planes(&ids, 3)[0].samples, Samples::Whole(vec![6, 9]));
        assert_eq!(planes(&ids, 2)[0].samples, Samples::Whole(vec![6, 8, 9, 11, 13, 14]));
    }

    #[test]
    fn a_layer_is_as_large_as_it_may_be() {
        let bytes = layer(Kind::Number, vec![NamedPlane::value("v", Samples::Exact(vec![0.0; 15]))]);
        assert_eq!([60, 59, 24, 23, 8, 4, 1].map(|most| factor(&bytes, most)), [1, 2, 2, 3, 3, 5, 5]);
    }
}
