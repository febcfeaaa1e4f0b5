//! Names that say what a thing is: types, functions, constants and variables of the crates, and the first words of comments.

use crate::circles::tokens::{self, Token};
use crate::texts;

/// Type names that are a participle, an adverb or an image: a type is a noun phrase.
const TYPES: &[&str] = &[
    "Among", "Along", "Carriage", "Coated", "Found", "Followed", "Given", "Heroes", "Hollow", "Journey", "Kept",
    "Laid", "Made", "Met", "Moving", "Remark", "Rung", "Said", "Seen", "Shelf", "SoFar", "Sought", "Stint", "Taken",
    "Told", "Way", "Ways", "Web", "Without",
];

/// Last words of a type name that leave it without its noun.
const LAST_WORDS: &[&str] = &["At", "By", "For", "From", "Into", "Of", "On", "To", "With"];

/// Type names of one word in "ed" that stay: a value with its place in a file (as rustc's `Spanned`), and the unified camera model of Geyer and
/// Mei.
const PARTICIPLES: &[&str] = &["Placed", "Unified"];

/// Names of variables, fields and functions that say how a value came about in place of what it is.
const HABIT_WORDS: &[&str] = &[
    "told", "said", "asked", "met", "kept", "made", "laid", "found", "given", "taken", "seen", "sought", "way", "ways",
    "whole", "share", "matt",
];

/// Words that turn a comment into a question.
const OPENERS: &[&str] = &["What", "Whether", "How", "Where"];

/// The sources of the crates: paths and texts.
fn sources() -> Vec<(String, String)> {
    let is_source = |name: &str| name.starts_with("crates/") && name.contains("/src/");
    texts(&[".rs"]).into_iter().filter(|(name, _)| is_source(name)).collect()
}

/// The words that follow one of `keywords`.
fn defined<'t>(tokens: &'t [Token], keywords: &[&str]) -> Vec<&'t str> {
    let pairs = tokens.windows(2).filter(|pair| keywords.iter().any(|keyword| pair[0].is(keyword)));
    pairs.filter_map(|pair| pair[1].word()).collect()
}

/// The last word of a name in upper camel case.
fn last_word(name: &str) -> &str {
    name.rfind(char::is_uppercase).map_or(name, |at| &name[at..])
}

/// Types, traits and associated types that are not named by a noun phrase.
fn types(text: &str) -> Vec<String> {
    let (tokens, _) = tokens::read(text);
    let is_listed = |name: &str| {
        let is_participle = name.rfind(char::is_uppercase) == Some(0) && name.ends_with("ed");
        TYPES.contains(&name) || LAST_WORDS.contains(&last_word(name)) || is_participle && !PARTICIPLES.contains(&name)
    };
    let names = defined(&tokens, &["struct", "enum", "union", "trait", "type"]);
    names.into_iter().filter(|name| is_listed(name)).map(str::to_owned).collect()
}

/// Functions `of` and `of_…`.
fn functions(text: &str) -> Vec<String> {
    let (tokens, _) = tokens::read(text);
    let names = defined(&tokens, &["fn"]).into_iter();
    names.filter(|name| *name == "of" || name.starts_with("of_")).map(str::to_owned).collect()
}

/// Limits that are not named `MAX_…` or `MIN_…`.
fn constants(text: &str) -> Vec<String> {
    let (tokens, _) = tokens::read(text);
    let names = defined(&tokens, &["const", "static"]).into_iter();
    names.filter(|name| matches!(name.split('_').next(), Some("MOST" | "LEAST"))).map(str::to_owned).collect()
}

/// Habit words as identifiers: variables, parameters, fields and functions.
fn identifiers(text: &str) -> Vec<String> {
    let (tokens, _) = tokens::read(text);
    tokens.iter().filter_map(Token::word).filter(|word| HABIT_WORDS.contains(word)).map(str::to_owned).collect()
}

/// First lines of comments that open with a question word.
fn openers(text: &str) -> Vec<String> {
    let mut lines = Vec::new();
    let mut is_within = false;
    for line in text.lines().map(str::trim_start) {
        let is_comment = line.starts_with("//");
        let first =
            line.trim_start_matches(['/', '!']).split(|c: char| !c.is_alphabetic()).find(|word| !word.is_empty());
        if is_comment && !is_within && first.is_some_and(|word| OPENERS.contains(&word)) {
            lines.push(line.to_owned());
        }
        is_within = is_comment;
    }
    lines
}

/// Asserts that a rule finds nothing in the crates.
#[track_caller]
fn check(rule: fn(&str) -> Vec<String>) {
    let mut violations = Vec::new();
    for (name, text) in sources() {
        violations.extend(rule(&text).into_iter().map(|violation| format!("{name}: {violation}")));
    }
    assert!(violations.is_empty(), "{} violations: {violations:#?}", violations.len());
}

#[test]
fn types_are_noun_phrases() {
    check(types);
}

#[test]
fn constructors_are_new_or_from() {
    check(functions);
}

#[test]
fn limits_are_max_or_min() {
    check(constants);
}

#[test]
fn identifiers_say_what_they_hold() {
    check(identifiers);
}

#[test]
fn comments_open_with_the_thing_itself() {
    check(openers);
}

#[test]
fn types_without_a_noun_are_found() {
    let text =
        "pub(crate) struct Told<'a>(&'a str); enum Listed { Found } trait EffectOn { type On; } type RowsOf = fn();";
    assert_eq!(types(text), ["Told", "Listed", "EffectOn", "On", "RowsOf"]);
    assert_eq!(types("struct Placed<T>(T); struct FoundLight; enum Option { Some, None } // struct Told;\n"), [""; 0]);
}

#[test]
fn functions_of_are_found() {
    let text =
        "impl A { pub(super) const fn of(a: u8) -> Self { a } } fn of_plan() {} fn offset() { let of = |x| x; of(1); }";
    assert_eq!(functions(text), ["of", "of_plan"]);
}

#[test]
fn limits_most_and_least_are_found() {
    let text = "const MOST: u8 = 1; pub static LEAST_M: f64 = 0.1; const MAX_M: f64 = 1.0; const ALMOST: u8 = 0;";
    assert_eq!(constants(text), ["MOST", "LEAST_M"]);
}

#[test]
fn habit_words_are_found() {
    let text = "fn a(told: u8, x: u8) { let (mut met, share) = (1, 2); b(|seen| seen.kept); } // asked\n";
    assert_eq!(identifiers(text), ["told", "met", "share", "seen", "seen", "kept"]);
    assert_eq!(identifiers("fn a(shared: u8) { let ways_out = \"whole\"; let halfway = 'w'; }"), [""; 0]);
}

#[test]
fn question_words_that_open_comments_are_found() {
    let text = "//! What it is.\nuse a;\n/// Returns x.\n/// Where y is.\nfn a() {\n    // How.\n    b(); // Whether\n}\n\n/// `Where`\nfn c() {}\n";
    assert_eq!(openers(text), ["//! What it is.", "// How.", "/// `Where`"]);
}
