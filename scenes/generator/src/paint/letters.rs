//! Letters and digits drawn with strokes of one width, for signs and number plates.

use super::segment_distance;
use glam::DVec2;

/// Advance of a letter in letter heights.
const ADVANCE: f64 = 0.78;

/// The strokes of a letter as chains of points on a grid 4 wide and 6 high: pairs of digits "xy", chains parted by a
/// space.
fn strokes(letter: char) -> &'static str {
    match letter {
        'A' => "002640 1232",
        'B' => "00063645443303 03334241301000",
        'C' => "4536160501103041",
        'D' => "00062645412000",
        'E' => "46060040 0333",
        'F' => "000646 0333",
        'G' => "45361605011030414323",
        'H' => "0006 4046 0343",
        'I' => "2026",
        'K' => "0006 460340",
        'L' => "060040",
        'M' => "0006234640",
        'N' => "00064046",
        'O' => "051636454130100105",
        'P' => "00063645443303",
        'R' => "00063645443303 2340",
        'S' => "453616050413334241301001",
        'T' => "0646 2026",
        'U' => "060110304146",
        'V' => "062046",
        'Z' => "06460040",
        '0' => "051636454130100105",
        '1' => "142620",
        '2' => "05163645440040",
        '3' => "0516364544334241301001 1333",
        '4' => "360242 3430",
        '5' => "460603334241301001",
        '6' => "4536160501103041423303",
        '7' => "064610",
        '8' => "13040516364544331302011030414233",
        '9' => "433313040516364541301001",
        _ => "",
    }
}

fn grid(chain: &str) -> Vec<DVec2> {
    let digits: Vec<f64> = chain.bytes().map(|byte| f64::from(byte - b'0')).collect();
    digits.chunks_exact(2).map(|xy| DVec2::new(xy[0] / 4.0 * 0.56, xy[1] / 6.0)).collect()
}

/// Whether `p` (in letter heights, from the lower left corner of the text) lies on a stroke of width `weight`.
#[must_use]
pub fn inked(text: &str, p: DVec2, weight: f64) -> bool {
    let index = (p.x / ADVANCE).floor();
    let near = |shift: f64| {
        let at = index + shift;
        let letter = if at >= 0.0 { text.chars().nth(at as usize) } else { None };
        letter.is_some_and(|letter| on_letter(letter, DVec2::new(p.x - at * ADVANCE - 0.11, p.y), weight))
    };
    near(0.0) || near(-1.0) || near(1.0)
}

fn on_letter(letter: char, p: DVec2, weight: f64) -> bool {
    strokes(letter).split(' ').any(|chain| {
        let points = grid(chain);
        points.windows(2).any(|pair| segment_distance(p, pair[0], pair[1]) < weight / 2.0)
    })
}

/// Width of a text in letter heights.
#[must_use]
pub fn width(text: &str) -> f64 {
    text.chars().count() as f64 * ADVANCE
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_i_is_one_stroke_in_its_middle() {
        assert!(inked("I", DVec2::new(ADVANCE / 2.0, 0.5), 0.14));
        assert!(!inked("I", DVec2::new(0.1, 0.5), 0.14));
    }
}
