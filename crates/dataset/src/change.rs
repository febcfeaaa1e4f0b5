//! What varies, as changes of keys at places of a file; and whether a job takes all of them.

use etendue::{Error, JobRequest};
use etendue_scene::Place;
use etendue_scene::record::variations::{ChoiceOf, Distribution, Preset, Variation, Variations};

/// A change `key=value` as `--set` takes it, and where the file states it.
pub(crate) type Change = (String, Place);

/// The changes that give all keys of a variation a value.
pub(crate) fn of_value<'a>(entry: &'a Variation, value: &'a str) -> impl Iterator<Item = Change> + 'a {
    entry.key.iter().map(move |key| (format!("{}={value}", key.value), key.place.clone()))
}

/// The changes of a preset's choice.
pub(crate) fn of_choice(preset: &Preset, choice: usize) -> Vec<Change> {
    preset.choices[choice].iter().map(|change| (change.value.clone(), change.place.clone())).collect()
}

/// Refuses keys that are not there and values that they do not take, by the ends of every distribution and all values and choices, one at a time in the place of
/// what a sample has drawn: all faults before anything is rendered. `groups` are the sample's: of each preset, then of each variation.
pub(crate) fn check(variations: &Variations, groups: &[Vec<Change>], job: &JobRequest) -> Result<(), Error> {
    // What is wrong without any change is told of the job alone.
    job.check_changes(&[])?;
    let mut faults = Vec::new();
    for (place, alternatives) in alternatives(variations).iter().enumerate() {
        for alternative in alternatives {
            let mut all = groups.to_vec();
            all[place].clone_from(alternative);
            match job.check_changes(&all.concat()) {
                Err(Error::Input(found)) => faults.extend(found),
                other => other?,
            }
        }
    }
    faults.sort_by(|a, b| (&a.file, a.line, a.column, &a.message).cmp(&(&b.file, b.line, b.column, &b.message)));
    faults.dedup();
    if faults.is_empty() { Ok(()) } else { Err(Error::Input(faults)) }
}

/// The choices of each preset, then the ends of each variation.
fn alternatives(variations: &Variations) -> Vec<Vec<Vec<Change>>> {
    let choices = |preset: &Preset| (0..preset.choices.len()).map(|choice| of_choice(preset, choice)).collect();
    let ends =
        |entry: &Variation| ends(&entry.distribution).iter().map(|value| of_value(entry, value).collect()).collect();
    variations.presets.iter().map(choices).chain(variations.vary.iter().map(ends)).collect()
}

/// The least and the greatest value, or all.
fn ends(distribution: &Distribution) -> Vec<String> {
    let numbers = |numbers: &[f64]| numbers.iter().map(|number| number_text(*number)).collect();
    match distribution {
        Distribution::Uniform(range) => numbers(&[range.min.value, range.max.value]),
        Distribution::LogUniform(range) => numbers(&[range.min.value, range.max.value]),
        Distribution::Normal(normal) => {
            let bounds = [Some(&normal.mean), normal.min.as_ref(), normal.max.as_ref()];
            numbers(&bounds.into_iter().flatten().map(|bound| bound.value).collect::<Vec<_>>())
        }
        Distribution::Integer(range) => vec![range.min.value.to_string(), range.max.value.to_string()],
        Distribution::Choice(choice) => choice_texts(choice),
    }
}

/// The values of a choice as TOML.
pub(crate) fn choice_texts(choice: &ChoiceOf) -> Vec<String> {
    choice.values.iter().map(etendue_scene::written::Item::in_one_line).collect()
}

/// A number as TOML: the shortest that reads back to the same bits.
pub(crate) fn number_text(number: f64) -> String {
    etendue_scene::written::Item::from(number).in_one_line()
}
