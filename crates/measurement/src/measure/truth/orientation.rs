//! Whether a picture shows a chart as its camera sees it, or mirrored, turned, or another chart.
//!
//! What tells is the rank correlation (Spearman 1904) of the readings of the patches with their luminances, which no tone curve changes: where the places of the truth give less than
//! 0.9, and those of a mirrored or turned picture 0.9 or more, the picture is one of these; where they give less than 0.6, and none of those does better, it shows
//! something else. (Half of the patches saturated leave 0.87.) Fewer than four patches tell nothing, nor do readings that are all one.

use super::Readings;
use super::place::Patch;

/// Ranks that agree, and that are those of something else.
const AGREES: f64 = 0.9;
const UNLIKE: f64 = 0.6;
/// The least number of patches that tell.
const MIN_PATCHES: usize = 4;

/// Where a part of the picture is in a picture that is mirrored or turned, both of a size.
type Turned = fn([usize; 4], (usize, usize)) -> [usize; 4];

/// What was done to a picture, in words, and what undoes it. Those that exchange columns and rows are of square pictures; others no longer have their size.
const UPRIGHT: [(&str, Turned); 3] = [
    ("mirrored left to right", |[x, y, w, h], (width, _)| [width - x - w, y, w, h]),
    ("mirrored top to bottom", |[x, y, w, h], (_, height)| [x, height - y - h, w, h]),
    ("turned by 180°", |[x, y, w, h], (width, height)| [width - x - w, height - y - h, w, h]),
];
const SQUARE: [(&str, Turned); 4] = [
    ("turned by 90° clockwise", |[x, y, w, h], (width, _)| [width - y - h, x, h, w]),
    ("turned by 90° anticlockwise", |[x, y, w, h], (_, height)| [y, height - x - w, h, w]),
    ("mirrored about its diagonal", |[x, y, w, h], _| [y, x, h, w]),
    ("mirrored about its other diagonal", |[x, y, w, h], (width, height)| [width - y - h, height - x - w, h, w]),
];

/// What is wrong with a picture of these patches; `None` where it is as it should be, or does not tell.
pub(super) fn wrong(patches: &[Patch], readings: &Readings) -> Option<String> {
    if patches.len() < MIN_PATCHES {
        return None;
    }
    let size = readings.picture_px;
    let agreement = |turned: &dyn Fn([usize; 4]) -> [usize; 4]| {
        let mean = |patch: &Patch| {
            let part = readings.part(turned(patch.at), "a patch").ok()?;
            Some(part.samples().iter().map(|s| f64::from(*s)).sum::<f64>() / part.samples().len() as f64)
        };
        let means: Vec<f64> = patches.iter().map(mean).collect::<Option<_>>()?;
        correlation(&ranks(&means), &ranks(&patches.iter().map(|p| p.luminance_cd_m2).collect::<Vec<_>>()))
    };
    let own = agreement(&|at| at)?;
    if own >= AGREES {
        return None;
    }
    let square = if size.0 == size.1 { &SQUARE[..] } else { &[] };
    let others =
        UPRIGHT.iter().chain(square).filter_map(|(words, turned)| Some((words, agreement(&|at| turned(at, size))?)));
    let best = others.reduce(|a, b| if b.1 > a.1 { b } else { a });
    match best {
        Some((words, other)) if other >= AGREES => Some(format!(
            "is {words}: only so do its patches rise with the luminances of the chart's truth; give the picture as the camera takes it"
        )),
        _ if own < UNLIKE => Some(
            "does not show this chart: its readings at the places of the patches do not rise with the luminances of the chart's truth; give the picture that belongs \
             to it"
                .to_owned(),
        ),
        _ => None,
    }
}

/// Ranks, equal values at the mean of theirs.
fn ranks(values: &[f64]) -> Vec<f64> {
    let below = |v: f64| values.iter().filter(|other| **other < v).count() as f64;
    let alike = |v: f64| values.iter().filter(|other| **other == v).count() as f64;
    values.iter().map(|v| below(*v) + 0.5 * (alike(*v) - 1.0)).collect()
}

/// `None` where one of them is all one value, or no number.
fn correlation(a: &[f64], b: &[f64]) -> Option<f64> {
    let mean = |v: &[f64]| v.iter().sum::<f64>() / v.len() as f64;
    let (mean_a, mean_b) = (mean(a), mean(b));
    let sum = |f: &dyn Fn(f64, f64) -> f64| a.iter().zip(b).map(|(x, y)| f(x - mean_a, y - mean_b)).sum::<f64>();
    let (aa, bb, ab) = (sum(&|x, _| x * x), sum(&|_, y| y * y), sum(&|x, y| x * y));
    (aa > 0.0 && bb > 0.0).then(|| ab / (aa * bb).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranks_of_equal_values_are_their_mean() {
        assert_eq!(ranks(&[3.0, 1.0, 3.0, 0.0]), [2.5, 1.0, 2.5, 0.0]);
        assert_eq!(correlation(&[0.0, 1.0, 2.0], &[4.0, 2.0, 0.0]), Some(-1.0));
        assert_eq!(correlation(&[1.0, 1.0], &[0.0, 1.0]), None);
    }

    /// A pixel and where it is in each turned picture: the words say what is done to the pictures.
    #[test]
    fn places_are_those_of_the_turned_picture() {
        let at = |words: &str| {
            let all = UPRIGHT.iter().chain(&SQUARE).find(|(other, _)| *other == words).expect("known");
            (all.1)([1, 2, 3, 4], (20, 20))
        };
        assert_eq!(at("mirrored left to right"), [16, 2, 3, 4]);
        // Clockwise: the top row becomes the last column.
        assert_eq!(at("turned by 90° clockwise"), [14, 1, 4, 3]);
        assert_eq!(at("turned by 90° anticlockwise"), [2, 16, 4, 3]);
    }
}
