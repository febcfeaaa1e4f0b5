//! Choices of the format: enums whose values a file spells as one word each.
//!
//! This file holds the choices that several crates need: spelling and help lines, but nothing that depends on the choice.

use std::fmt;

/// An enum of the format whose values are words.
pub trait Word: Copy + PartialEq + Send + Sync + 'static {
    /// Every word with its value, in the order of the format.
    const WORDS: &'static [(&'static str, Self)];
    /// One line of help for each word, in the same order.
    const ABOUT: &'static [&'static str];

    /// Returns the word of a value.
    fn word(self) -> &'static str {
        Self::WORDS.iter().find(|(_, value)| *value == self).map_or("", |(word, _)| *word)
    }

    /// Returns the value of a word; `None` for an unknown word.
    fn from_word(word: &str) -> Option<Self> {
        Self::WORDS.iter().find(|(known, _)| *known == word).map(|(_, value)| *value)
    }

    /// All words.
    fn words() -> Vec<&'static str> {
        Self::WORDS.iter().map(|(word, _)| *word).collect()
    }
}

/// Declares an enum of words: `"word" => Variant`, each below its documentation; `pub enum Name = Variant` makes that variant the default.
#[macro_export]
macro_rules! words {
    (
        $(#[$meta:meta])*
        pub enum $name:ident $(= $default:ident)? { $( $(#[doc = $doc:literal])* $word:literal => $variant:ident, )* }
    ) => {
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum $name { $( $(#[doc = $doc])* $variant, )* }

        impl $crate::words::Word for $name {
            const WORDS: &'static [(&'static str, Self)] = &[$( ($word, Self::$variant) ),*];
            const ABOUT: &'static [&'static str] = &[$( concat!($($doc),*) ),*];
        }

        $(impl Default for $name {
            fn default() -> Self {
                Self::$default
            }
        })?
    };
}

/// Setting, with the key of the format that states it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setting {
    /// The key, without its table.
    pub key: &'static str,
    pub value: SettingValue,
    /// True if it has an effect only with path tracing.
    pub is_path_only: bool,
}

/// The value of a setting. Displays as TOML spells it.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
#[serde(untagged)]
pub enum SettingValue {
    /// True or false.
    Flag(bool),
    /// A whole number.
    Whole(u64),
    /// A word of the format.
    Word(&'static str),
}

impl Setting {
    /// Returns a setting that has an effect with every integrator.
    #[must_use]
    pub fn new(key: &'static str, value: SettingValue) -> Self {
        Self { key, value, is_path_only: false }
    }

    /// Returns a setting that has an effect only with path tracing.
    #[must_use]
    pub fn path_only(key: &'static str, value: SettingValue) -> Self {
        Self { key, value, is_path_only: true }
    }
}

impl fmt::Display for SettingValue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Flag(flag) => write!(f, "{flag}"),
            Self::Whole(number) => write!(f, "{number}"),
            Self::Word(word) => write!(f, "\"{word}\""),
        }
    }
}

impl From<bool> for SettingValue {
    fn from(flag: bool) -> Self {
        Self::Flag(flag)
    }
}

impl From<u32> for SettingValue {
    fn from(number: u32) -> Self {
        Self::Whole(number.into())
    }
}

/// Serialises values of reports and requests as their words.
macro_rules! serde_words {
    ($($name:ident),*) => { $(
        impl serde::Serialize for $name {
            fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                serializer.serialize_str(self.word())
            }
        }

        impl<'de> serde::Deserialize<'de> for $name {
            fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                let word = <std::borrow::Cow<'de, str>>::deserialize(deserializer)?;
                Self::from_word(&word).ok_or_else(|| serde::de::Error::unknown_variant(&word, &[]))
            }
        }
    )* };
}

words! {
    /// Light paths that are simulated: a trade-off between time and accuracy. Surfaces are the same for all: depth and identities do not depend on it.
    pub enum Integrator = Path {
        /// Local shading by lamps, suns and sky, without shadows.
        "flat" => Flat,
        /// The same with shadows.
        "direct" => Direct,
        /// Everything, by path tracing.
        "path" => Path,
    }
}

words! {
    /// Quantity to which a light's probability of being sampled at a surface is proportional. No mean depends on it.
    pub enum LightSampling = Gloss {
        /// Its irradiance, and the part of it that the surface's narrow lobes scatter back along the path.
        "gloss" => Gloss,
        /// Its irradiance alone: cheaper at glossy surfaces, and noisier where they mirror lamps.
        "irradiance" => Irradiance,
    }
}

words! {
    /// Work that is spent on acceleration structures. Every choice gives the same answers to rays.
    pub enum Accelerator = Default {
        /// The least time to build: one pass from the top down.
        "fast" => Fast,
        /// The same with large triangles split, and better places for the largest subtrees.
        "default" => Default,
        /// The same for half of all subtrees: the least time a ray.
        "best" => Best,
    }
}

words! {
    /// Presets of samples and bounces, for what a job file leaves open.
    pub enum Quality {
        /// 16 samples a pixel, 4 bounces: to frame and expose.
        "draft" => Draft,
        /// 64 samples a pixel, 16 bounces.
        "standard" => Standard,
        /// 1024 samples a pixel, 64 bounces.
        "reference" => Reference,
    }
}

words! {
    /// File format of digital numbers.
    pub enum RawFormat = Png {
        /// 16-bit PNG.
        "png" => Png,
        /// TIFF of 16 bits, of 32 bits for more.
        "tiff" => Tiff,
        /// Digital Negative, for raw readers.
        "dng" => Dng,
    }
}

serde_words!(Integrator, LightSampling, Accelerator, Quality);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_and_values_belong_together() {
        assert_eq!(Integrator::words(), ["flat", "direct", "path"]);
        assert_eq!(Integrator::from_word("direct"), Some(Integrator::Direct));
        assert_eq!(Integrator::from_word("Direct"), None);
        assert!(Accelerator::WORDS.iter().all(|(word, value)| value.word() == *word));
        assert_eq!(Quality::ABOUT.len(), Quality::WORDS.len());
    }
}
