//! Damages files: most bytes stay, so that a reader gets far.

use rand::{RngExt, rngs::Xoshiro256PlusPlus};

/// Words that numbers and structures of text are made of.
const WORDS: [&str; 16] =
    ["-1", "0", "1e39", "-1e39", "NaN", "inf", "99999999999", "0.0", "(", ")", "[", "]", ",", ":", "\"", "1e-45"];

/// A file with some bytes changed, doubled, lost or cut off.
pub fn damaged(bytes: &[u8], random: &mut Xoshiro256PlusPlus) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    for _ in 0..random.random_range(1..5) {
        if bytes.is_empty() {
            break;
        }
        // Most of what matters is at the beginning.
        let reach = if random.random() { bytes.len() } else { bytes.len().min(400) };
        let at = random.random_range(0..reach);
        match random.random_range(0..5) {
            0 => bytes[at] = random.random(),
            1 => bytes[at] ^= 1 << random.random_range(0..8),
            2 => {
                let end = (at + random.random_range(1..9)).min(bytes.len());
                bytes.drain(at..end);
            }
            3 => {
                let end = (at + random.random_range(1..17)).min(bytes.len());
                let copy = bytes[at..end].to_vec();
                bytes.splice(at..at, copy);
            }
            _ => bytes.truncate(if random.random_range(0..4) == 0 { at } else { bytes.len() }),
        }
    }
    bytes
}

/// A text in which numbers and marks have become others.
pub fn damaged_text(text: &str, random: &mut Xoshiro256PlusPlus) -> String {
    if random.random_range(0..3) == 0 {
        return String::from_utf8_lossy(&damaged(text.as_bytes(), random)).into_owned();
    }
    let mut text = text.to_string();
    for _ in 0..random.random_range(1..4) {
        let numbers: Vec<usize> = text
            .char_indices()
            .filter(|(at, letter)| letter.is_ascii_digit() && !text[..*at].ends_with(|c: char| c.is_ascii_digit()))
            .map(|(at, _)| at)
            .collect();
        if numbers.is_empty() {
            break;
        }
        let at = numbers[random.random_range(0..numbers.len())];
        let rest =
            text[at..].find(|c: char| !(c.is_ascii_digit() || c == '.')).map_or(text.len(), |length| at + length);
        text.replace_range(at..rest, WORDS[random.random_range(0..WORDS.len())]);
    }
    text
}
