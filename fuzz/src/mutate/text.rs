//! Changes of texts: words, numbers, lines, nesting.

use super::material::{MAX_LENGTH, Material, part};
use super::numbers::TEXTS;
use crate::random::Random;
use std::ops::Range;

/// What opens and closes a level of nesting in one of the formats.
const NESTING: [(&str, &str); 8] =
    [("[", "]"), ("{", "}"), ("{a=", "}"), ("[[", "]]"), ("{\"a\":", "}"), ("- ", ""), ("a.", ""), ("(", ")")];

/// What editors, systems and mistakes leave in texts.
const UNUSUAL_BYTES: [&[u8]; 14] = [
    b"\n",
    b"\r\n",
    b"\t",
    b" ",
    b"\0",
    b"\xff",
    b"\xef\xbb\xbf",
    b"\\",
    b"\"",
    b"#",
    b"&",
    b"\x1b[2J",
    b"\xe2\x80\xae",
    b"%d",
];

/// Changes `input` once.
pub(super) fn change(input: &mut Vec<u8>, material: Material<'_>, random: &mut Random) {
    match random.below(12) {
        0..=3 => replace_word(input, material, random),
        4 => insert_word(input, material, random),
        5 => remove_line(input, random),
        6 => copy_line(input, random),
        7 => line_of_another(input, material, random),
        8 => nest(input, random),
        9 => insert_strange(input, random),
        10 => grow_number(input, random),
        _ => swap_words(input, random),
    }
}

fn is_part_of_word(byte: u8) -> bool {
    byte.is_ascii_alphanumeric() || matches!(byte, b'.' | b'-' | b'+' | b'_')
}

/// The word at or after a random place.
fn word(input: &[u8], random: &mut Random) -> Option<Range<usize>> {
    let from = random.below(input.len());
    let start = from + input[from..].iter().position(|b| is_part_of_word(*b))?;
    let start = input[..start].iter().rposition(|b| !is_part_of_word(*b)).map_or(0, |before| before + 1);
    let length = input[start..].iter().position(|b| !is_part_of_word(*b)).unwrap_or(input.len() - start);
    Some(start..start + length)
}

/// A number where one stood, mostly, or a word that the reader knows.
fn replacement<'a>(old: &[u8], material: Material<'a>, random: &mut Random) -> &'a str {
    let is_number = old.first().is_some_and(|b| b.is_ascii_digit() || matches!(b, b'-' | b'.'));
    let from_words = if is_number { random.one_in(6) } else { !random.one_in(4) };
    if from_words && !material.words.is_empty() {
        random.choose::<&str>(material.words)
    } else {
        random.choose::<&str>(&TEXTS)
    }
}

fn replace_word(input: &mut Vec<u8>, material: Material<'_>, random: &mut Random) {
    let Some(place) = word(input, random) else { return };
    if random.one_in(4) {
        let other = random.choose(material.inputs);
        let new = word(other, random).map_or_else(Vec::new, |word| other[word].to_vec());
        input.splice(place, new);
        return;
    }
    let new = replacement(&input[place.clone()], material, random);
    input.splice(place, new.bytes());
}

fn insert_word(input: &mut Vec<u8>, material: Material<'_>, random: &mut Random) {
    let at = word(input, random).map_or(0, |word| word.start);
    let new = replacement(b"", material, random);
    input.splice(at..at, new.bytes().chain([b' ']));
}

fn swap_words(input: &mut Vec<u8>, random: &mut Random) {
    let (Some(a), Some(b)) = (word(input, random), word(input, random)) else { return };
    let (a, b) = if a.start < b.start { (a, b) } else { (b, a) };
    if a.end > b.start {
        return;
    }
    let (first, second) = (input[a.clone()].to_vec(), input[b.clone()].to_vec());
    input.splice(b, first);
    input.splice(a, second);
}

/// A line with its end.
fn line(input: &[u8], random: &mut Random) -> Range<usize> {
    let at = random.below(input.len());
    let start = input[..at].iter().rposition(|b| *b == b'\n').map_or(0, |before| before + 1);
    let length = input[start..].iter().position(|b| *b == b'\n').map_or(input.len() - start, |n| n + 1);
    start..start + length
}

fn remove_line(input: &mut Vec<u8>, random: &mut Random) {
    input.drain(line(input, random));
}

fn copy_line(input: &mut Vec<u8>, random: &mut Random) {
    let place = line(input, random);
    let copy = input[place].to_vec();
    let max_copies = if random.one_in(64) { MAX_LENGTH / copy.len().max(1) } else { 8 };
    let times = 1 + random.length(max_copies);
    let to = line(input, random).start;
    input.splice(to..to, copy.repeat(times));
}

fn line_of_another(input: &mut Vec<u8>, material: Material<'_>, random: &mut Random) {
    let other = random.choose(material.inputs);
    let copy = other[line(other, random)].to_vec();
    let to = line(input, random).start;
    input.splice(to..to, copy);
}

fn nest(input: &mut Vec<u8>, random: &mut Random) {
    let (open, close) = random.choose(&NESTING);
    let deepest = if random.one_in(8) { 100_000 } else { 200 };
    let depth = 1 + random.length(deepest);
    let place = match random.one_in(2) {
        true => word(input, random).unwrap_or(0..0),
        false => part(input.len(), random),
    };
    let is_closed = !random.one_in(4);
    let inner = input[place.clone()].to_vec();
    let after = if is_closed { close.repeat(depth) } else { String::new() };
    input.splice(place, open.repeat(depth).into_bytes().into_iter().chain(inner).chain(after.into_bytes()));
}

fn insert_strange(input: &mut Vec<u8>, random: &mut Random) {
    let at = random.below(input.len() + 1);
    let strange = *random.choose(&UNUSUAL_BYTES);
    input.splice(at..at, strange.iter().copied());
}

/// More digits to a number or letters to a word.
fn grow_number(input: &mut Vec<u8>, random: &mut Random) {
    let Some(place) = word(input, random) else { return };
    let max_digits = if random.one_in(16) { 100_000 } else { 24 };
    let copy = input[place.end - 1];
    let times = random.length(max_digits);
    input.splice(place.end..place.end, std::iter::repeat_n(copy, times));
}
