//! A choice of words.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use etendue_core::Word as FormatWord;

/// Parser of a choice of the format, with its words and their help.
pub fn word<T: FormatWord>() -> impl TypedValueParser<Value = T> {
    let words = T::WORDS.iter().zip(T::ABOUT);
    choice(words.map(|((word, value), description)| (*value, *word, description.trim().trim_end_matches('.'))))
}

/// Value of a word, the word, and its line of help.
pub type Word<T> = (T, &'static str, &'static str);

/// Parser of one of a closed list of words.
pub fn choice<T>(words: impl IntoIterator<Item = Word<T>>) -> impl TypedValueParser<Value = T>
where
    T: Copy + Send + Sync + 'static,
{
    let words: Vec<Word<T>> = words.into_iter().collect();
    let listed: Vec<PossibleValue> =
        words.iter().map(|(_, word, help)| PossibleValue::new(*word).help(*help)).collect();
    let meant = move |typed: String| words.iter().find(|(_, word, _)| *word == typed).map(|(value, ..)| *value);
    PossibleValuesParser::new(listed).map(move |typed| meant(typed).expect("clap accepts listed words only"))
}
