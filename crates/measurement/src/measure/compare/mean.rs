//! Several curves of one kind, such as those of edges all over the field, as their mean.
//!
//! At each place where all have a point: means of both sides, uncertainties as of independent curves. What is declared is the same for all
//! edges of a camera only where its lens is the same over the field.

use super::curve::{Curve, Gap};
use etendue_metrology::Estimate;

/// A curve of one side with its gaps to the other.
pub(crate) type Compared = (Curve, Vec<Gap>);

/// More curves than this are drawn as their mean.
pub(crate) const FEW: usize = 3;

/// The mean of the curves of each table that has more than a few.
pub(crate) fn means(all: &[Compared]) -> Vec<Compared> {
    let table = |c: &Compared| c.0.kind().to_owned();
    let mut tables: Vec<String> = all.iter().map(table).collect();
    tables.dedup();
    let of = |name: &String| all.iter().filter(|c| table(c) == *name).collect::<Vec<_>>();
    tables.iter().map(of).filter(|some| some.len() > FEW).map(|some| mean(&some)).collect()
}

fn mean(some: &[&Compared]) -> Compared {
    let at = |x: f64| some.iter().filter_map(move |(_, gaps)| gaps.iter().find(|g| g.x == x)).collect::<Vec<_>>();
    let (first, gaps) = some[0];
    let places = gaps.iter().map(|gap| at(gap.x)).filter(|there| there.len() == some.len());
    let gaps: Vec<Gap> = places.map(|there| together(&there)).collect();
    let points = gaps.iter().map(|gap| (gap.x, gap.a)).collect();
    let word = first.kind();
    (Curve { name: format!("{word}, mean of {}", some.len()), points, ..first.clone() }, gaps)
}

fn together(gaps: &[&Gap]) -> Gap {
    let count = gaps.len() as f64;
    let of = |side: fn(&Gap) -> Estimate| {
        let value = gaps.iter().map(|g| side(g).value).sum::<f64>() / count;
        let squares = gaps.iter().map(|g| side(g).standard_uncertainty * side(g).standard_uncertainty).sum::<f64>();
        Estimate::new(value, squares.sqrt() / count)
    };
    Gap { x: gaps[0].x, a: of(|g| g.a), b: of(|g| g.b), significant: gaps.iter().all(|g| g.significant) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mean_knows_more_than_its_parts() {
        let curve = |i: usize| {
            let (a, b) = (Estimate::new(1.0 + i as f64, 0.2), Estimate::new(1.5, 0.0));
            let name = format!("response {i}");
            let curve = Curve {
                name,
                abscissa: "cycles_per_px",
                ordinate: "response",
                points: vec![(0.5, a)],
                noise: Vec::new(),
            };
            (curve, vec![Gap { x: 0.5, a, b, significant: true }])
        };
        assert!(means(&[0, 1, 2].map(curve)).is_empty());
        let [(mean, gaps)] = &means(&[0, 1, 2, 3].map(curve))[..] else { panic!("one table") };
        assert_eq!(mean.name, "response, mean of 4");
        // (1 + 2 + 3 + 4)/4 − 1.5, with 0.2/√4.
        assert!((gaps[0].difference() - 1.0).abs() < 1e-12 && (gaps[0].a.standard_uncertainty - 0.1).abs() < 1e-12);
    }
}
