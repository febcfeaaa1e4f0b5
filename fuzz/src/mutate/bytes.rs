//! Changes of bytes.

use super::material::{MAX_LENGTH, Material, part};
use super::numbers::{FLOATS, INTEGERS};
use crate::random::Random;

/// Changes `input` once.
pub(super) fn change(input: &mut Vec<u8>, material: Material<'_>, random: &mut Random) {
    match random.below(12) {
        0 | 1 => flip(input, random),
        2 => replace_byte(input, random),
        3..=5 => put_number(input, random),
        6 => input.truncate(random.below(input.len() + 1)),
        7 => drop(input.drain(part(input.len(), random))),
        8 => repeat(input, random),
        9 => splice(input, material, random),
        10 => move_part(input, random),
        _ => noise(input, random),
    }
}

fn flip(input: &mut [u8], random: &mut Random) {
    let at = random.below(input.len());
    if let Some(byte) = input.get_mut(at) {
        *byte ^= 1 << random.below(8);
    }
}

fn replace_byte(input: &mut [u8], random: &mut Random) {
    let at = random.below(input.len());
    if let Some(byte) = input.get_mut(at) {
        *byte = random.next() as u8;
    }
}

/// A number in the place of as many bytes, in either order.
fn put_number(input: &mut [u8], random: &mut Random) {
    let bytes = if random.one_in(4) {
        let float = *random.choose(&FLOATS);
        if random.one_in(2) { float.to_le_bytes().to_vec() } else { (float as f32).to_le_bytes().to_vec() }
    } else {
        let integer = *random.choose(&INTEGERS);
        let width = 1 << random.below(4);
        integer.to_le_bytes()[..width].to_vec()
    };
    let at = random.below(input.len());
    let Some(place) = input.get_mut(at..at + bytes.len()) else { return };
    place.copy_from_slice(&bytes);
    if random.one_in(2) {
        place.reverse();
    }
}

fn repeat(input: &mut Vec<u8>, random: &mut Random) {
    let part = part(input.len(), random);
    let copy = input[part.clone()].to_vec();
    let max_length = if random.one_in(64) { MAX_LENGTH } else { 4096 };
    let times = random.length(max_length / copy.len().max(1));
    let more = copy.repeat(times);
    input.splice(part.end..part.end, more);
}

/// The beginning of the input and the end of another, or a part of another within it.
fn splice(input: &mut Vec<u8>, material: Material<'_>, random: &mut Random) {
    let other = random.choose(material.inputs);
    if random.one_in(2) {
        input.truncate(random.below(input.len() + 1));
        input.extend_from_slice(&other[random.below(other.len() + 1)..]);
    } else {
        let (place, from) = (part(input.len(), random), part(other.len(), random));
        input.splice(place, other[from].iter().copied());
    }
}

fn move_part(input: &mut Vec<u8>, random: &mut Random) {
    let removed: Vec<u8> = input.drain(part(input.len(), random)).collect();
    let at = random.below(input.len() + 1);
    input.splice(at..at, removed);
}

fn noise(input: &mut Vec<u8>, random: &mut Random) {
    let at = random.below(input.len() + 1);
    let bytes: Vec<u8> = (0..random.length(64)).map(|_| random.next() as u8).collect();
    input.splice(at..at, bytes);
}
