//! Variations of a sample: a function of the seed, its number and the name of the varied key.

use etendue_core::maths::f64::{exp, ln};
use etendue_core::random::{NoiseStream, stream_of_name};
use etendue_scene::Placed;
use etendue_scene::record::variations::{Distribution, Normal, Variations};
use rand::RngExt as _;
use rand_distr::Distribution as _;
use serde::{Deserialize, Serialize};

use crate::request::{Change, choice_changes, choice_texts, number_text, value_changes};

/// Use of a sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Split {
    Train,
    Val,
}

impl Split {
    pub(crate) const ALL: [Self; 2] = [Self::Train, Self::Val];

    /// Its part of file names.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Train => "train",
            Self::Val => "val",
        }
    }
}

/// Varied settings of one sample.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct SampleVariation {
    pub(crate) split: Split,
    /// Seed of its light and its noise.
    pub(crate) seed: u64,
    /// Changes of the job, preset by preset and then variation by variation, in the order of the file: later ones override earlier ones.
    pub(crate) groups: Vec<Vec<Change>>,
}

impl SampleVariation {
    /// Returns the settings of a sample.
    pub(crate) fn new(variations: Option<&Variations>, seed: u64, sample: u32) -> Self {
        let stream = |name: &str| stream_of_name(seed, name, sample);
        let fraction = variations.and_then(|v| v.validation_fraction.as_ref()).map_or(0.0, |fraction| fraction.value);
        // Stream names that no key has: keys are not empty and have no trailing blank.
        let split = if stream(" split").unit_f64() < fraction { Split::Val } else { Split::Train };
        let mut groups = Vec::new();
        for preset in variations.map_or(&[][..], |v| &v.presets) {
            let choice = weighted(&preset.weights, preset.choices.len(), &mut stream(&preset_name(&preset.name)));
            groups.push(choice_changes(preset, choice));
        }
        for entry in variations.map_or(&[][..], |v| &v.vary) {
            let value = value(&entry.distribution, &mut stream(&entry.key[0].value));
            groups.push(value_changes(entry, &value).collect());
        }
        Self { split, seed: stream(" light").double_word() >> 1, groups }
    }

    /// The changes in the form of `--set`.
    pub(crate) fn set(&self) -> Vec<String> {
        self.groups.iter().flatten().map(|(change, _)| change.clone()).collect()
    }
}

fn preset_name(name: &str) -> String {
    format!(" preset {name}")
}

/// Samples a value, as TOML.
fn value(distribution: &Distribution, random: &mut NoiseStream) -> String {
    match distribution {
        Distribution::Uniform(range) => number_text(random.random_range(range.min.value..range.max.value)),
        Distribution::LogUniform(range) => {
            let (min, max) = (range.min.value, range.max.value);
            let part = random.random_range(0.0..1.0);
            // Rounding of the logarithms does not exceed the limits.
            number_text(exp(ln(min) + part * (ln(max) - ln(min))).clamp(min, max))
        }
        Distribution::Normal(normal) => number_text(truncated(normal, random)),
        Distribution::Integer(range) => random.random_range(range.min.value..=range.max.value).to_string(),
        Distribution::Choice(choice) => {
            let texts = choice_texts(choice);
            texts[weighted(&choice.weights, texts.len(), random)].clone()
        }
    }
}

/// Samples until a value is within the limits; the check of the file guarantees that at least one in some fifty is.
fn truncated(normal: &Normal, random: &mut NoiseStream) -> f64 {
    let distribution = rand_distr::Normal::new(normal.mean.value, normal.standard_deviation.value)
        .expect("a checked file has a positive deviation");
    let is_within = |value: f64| {
        normal.min.as_ref().is_none_or(|min| value >= min.value)
            && normal.max.as_ref().is_none_or(|max| value <= max.value)
    };
    loop {
        let value = distribution.sample(random);
        if is_within(value) {
            return value;
        }
    }
}

/// Samples one of `count` choices, by weights or uniformly.
fn weighted(weights: &[Placed<f64>], count: usize, random: &mut NoiseStream) -> usize {
    if weights.is_empty() {
        return random.random_range(0..count);
    }
    // Divided by the largest, so that their sum is finite.
    let greatest = weights.iter().map(|weight| weight.value).fold(0.0, f64::max);
    let parts: Vec<f64> = weights.iter().map(|weight| weight.value / greatest).collect();
    let mut remaining = random.random_range(0.0..parts.iter().sum());
    for (index, part) in parts.iter().enumerate() {
        if remaining < *part {
            return index;
        }
        remaining -= part;
    }
    // Rounding of the sum: the last choice of nonzero weight.
    weights.iter().rposition(|weight| weight.value > 0.0).expect("a checked file has a weight above 0")
}

#[cfg(test)]
mod tests {
    use super::*;
    use etendue_scene::load_variations;

    const TEXT: &str = "format = 1\nvalidation_fraction = 0.25\n\
        [[vary]]\nkey = [\"a\", \"b\"]\ntype = \"uniform\"\nmin = -2\nmax = 3\n\
        [[vary]]\nkey = \"n\"\ntype = \"normal\"\nmean = 5\nstandard_deviation = 2\n\
        [[vary]]\nkey = \"t\"\ntype = \"normal\"\nmean = 5\nstandard_deviation = 2\nmin = 4.9\nmax = 5.2\n\
        [[vary]]\nkey = \"l\"\ntype = \"log_uniform\"\nmin = 0.01\nmax = 100\n\
        [[vary]]\nkey = \"i\"\ntype = \"integer\"\nmin = 2\nmax = 4\n\
        [[vary]]\nkey = \"c\"\ntype = \"choice\"\nvalues = [\"x\", 1.5, { k = [1, 2] }]\nweights = [1, 0, 3]\n\
        [[presets]]\nname = \"weather\"\nchoices = [[], [\"fog=1\", \"rain=null\"]]\n";

    fn file(text: &str) -> Variations {
        load_variations("variations.toml".as_ref(), &|_| Ok(text.to_owned())).expect("a legal file")
    }

    fn texts(drawn: &SampleVariation) -> Vec<&str> {
        drawn.groups.iter().flatten().map(|(text, _)| text.as_str()).collect()
    }

    /// Values of a key over some samples.
    fn values(key: &str, samples: u32) -> Vec<String> {
        let file = file(TEXT);
        let variation_of = |sample| SampleVariation::new(Some(&file), 7, sample);
        let value = |drawn: &SampleVariation| {
            texts(drawn).iter().find_map(|text| text.strip_prefix(&format!("{key}=")).map(str::to_owned))
        };
        (0..samples).map(|sample| value(&variation_of(sample)).expect("it is drawn")).collect()
    }

    fn numbers(key: &str) -> Vec<f64> {
        values(key, 4000).iter().map(|value| value.parse().expect("a number")).collect()
    }

    /// Mean and standard deviation.
    fn moments(numbers: &[f64]) -> (f64, f64) {
        let count = numbers.len() as f64;
        let mean = numbers.iter().sum::<f64>() / count;
        (mean, (numbers.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / (count - 1.0)).sqrt())
    }

    #[test]
    fn a_sample_is_the_same_alone_and_whatever_else_is_varied() {
        let varied = SampleVariation::new(Some(&file(TEXT)), 7, 70_000);
        assert_eq!(varied, SampleVariation::new(Some(&file(TEXT)), 7, 70_000));
        let alone = file("format = 1\n[[vary]]\nkey = \"n\"\ntype = \"normal\"\nmean = 5\nstandard_deviation = 2\n");
        let alone = SampleVariation::new(Some(&alone), 7, 70_000);
        assert!(texts(&varied).contains(&texts(&alone)[0]), "{:?} {:?}", texts(&varied), texts(&alone));
        assert_eq!(varied.seed, alone.seed);
        assert_ne!(varied, SampleVariation::new(Some(&file(TEXT)), 8, 70_000));
    }

    // Five standard errors of 4 000 samples.
    #[test]
    fn numbers_have_the_moments_of_their_distributions() {
        let (mean, deviation) = moments(&numbers("a"));
        assert!((mean - 0.5).abs() < 5.0 * 5.0 / 12_f64.sqrt() / 4000_f64.sqrt(), "{mean}");
        assert!((deviation - 5.0 / 12_f64.sqrt()).abs() < 0.08, "{deviation}");
        let (mean, deviation) = moments(&numbers("n"));
        assert!(
            (mean - 5.0).abs() < 5.0 * 2.0 / 4000_f64.sqrt() && (deviation - 2.0).abs() < 0.12,
            "{mean} {deviation}"
        );
        let logarithms: Vec<_> = numbers("l").into_iter().map(|x| ln(x) / ln(10.0)).collect();
        let (mean, deviation) = moments(&logarithms);
        assert!(mean.abs() < 0.1 && (deviation - 4.0 / 12_f64.sqrt()).abs() < 0.06, "{mean} {deviation}");
        assert!(numbers("t").iter().all(|x| (4.9..=5.2).contains(x)));
        assert!(numbers("a").iter().zip(numbers("b")).all(|(a, b)| *a == b && (-2.0..3.0).contains(a)));
    }

    #[test]
    fn choices_come_as_often_as_they_weigh() {
        let count = |values: &[String], value: &str| values.iter().filter(|v| *v == value).count();
        let sampled = values("c", 4000);
        let (x, table) = (count(&sampled, "\"x\""), count(&sampled, "{ k = [1, 2] }"));
        // A quarter is 1 000: five standard deviations are 137.
        assert!(x + table == 4000 && x.abs_diff(1000) < 137, "{x} {table}");
        let sampled = values("i", 4000);
        assert!(["2", "3", "4"].iter().all(|value| count(&sampled, value).abs_diff(1333) < 150));
        let file = file(TEXT);
        let drawn: Vec<_> = (0..4000).map(|sample| SampleVariation::new(Some(&file), 7, sample)).collect();
        let fog = drawn.iter().filter(|drawn| texts(drawn).starts_with(&["fog=1", "rain=null"])).count();
        let val = drawn.iter().filter(|drawn| drawn.split == Split::Val).count();
        assert!(fog.abs_diff(2000) < 159 && val.abs_diff(1000) < 137, "{fog} {val}");
    }
}
