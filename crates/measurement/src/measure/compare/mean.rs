//! Curves of measurements, the gaps between two of them, and the mean of several curves of one kind, such as those of edges all
//! over the field.
//!
//! The mean of curves: at each position where all have a point, the means of both sides, with uncertainties as of independent
//! curves. A declared curve is the same for all edges of a camera only if its lens is uniform over the field.
//!
//! The second curve is interpolated linearly at the positions of the first that it covers. For n points the largest |E_n| of two
//! equal curves exceeds 1 more often than for a single point. The limit is the value that a family of n independent points
//! exceeds as often as one point exceeds 1 (k = 2: 4.55 %), by Šidák's level; n counts the points of all curves of one kind, such
//! as those of all edges. Points of fitted curves share errors: there the limit is too lenient.

use etendue_metrology::Estimate;
use etendue_stats::chi_square::sidak_level;
use etendue_stats::normal::{quantile, two_sided_p};
use serde_json::Value;

/// A curve of one side with its gaps to the other.
pub(crate) type ComparedCurve = (Curve, Vec<CurveGap>);

/// Maximum number of curves drawn individually; more are drawn as their mean.
const MAX_SINGLE_CURVES: usize = 3;

/// Means of the curves of each table that has more than a few.
pub(crate) fn means(all: &[ComparedCurve]) -> Vec<ComparedCurve> {
    let table = |c: &ComparedCurve| c.0.kind().to_owned();
    let mut tables: Vec<String> = all.iter().map(table).collect();
    tables.dedup();
    let same_table = |name: &String| all.iter().filter(|c| table(c) == *name).collect::<Vec<_>>();
    tables.iter().map(same_table).filter(|some| some.len() > MAX_SINGLE_CURVES).map(|some| mean(&some)).collect()
}

fn mean(some: &[&ComparedCurve]) -> ComparedCurve {
    let at = |x: f64| some.iter().filter_map(move |(_, gaps)| gaps.iter().find(|g| g.x == x)).collect::<Vec<_>>();
    let (first, gaps) = some[0];
    let places = gaps.iter().map(|gap| at(gap.x)).filter(|values| values.len() == some.len());
    let gaps: Vec<CurveGap> = places.map(|values| combined(&values)).collect();
    let points = gaps.iter().map(|gap| (gap.x, gap.a)).collect();
    let word = first.kind();
    (Curve { name: format!("{word}, mean of {}", some.len()), points, ..first.clone() }, gaps)
}

fn combined(gaps: &[&CurveGap]) -> CurveGap {
    let count = gaps.len() as f64;
    let mean_side = |side: fn(&CurveGap) -> Estimate| {
        let value = gaps.iter().map(|g| side(g).value).sum::<f64>() / count;
        let squares = gaps.iter().map(|g| side(g).standard_uncertainty * side(g).standard_uncertainty).sum::<f64>();
        Estimate::new(value, squares.sqrt() / count)
    };
    CurveGap {
        x: gaps[0].x,
        a: mean_side(|g| g.a),
        b: mean_side(|g| g.b),
        significant: gaps.iter().all(|g| g.significant),
    }
}

/// Tables that are curves: table, abscissa, ordinate, and label of the ordinate.
const CURVE_TABLES: [(&str, &str, &str, &str); 7] = [
    ("curve", "field_percent", "ratio", "observed over ideal distance"),
    ("profile", "field_percent", "illumination_percent", "illumination, % of the centre"),
    ("rings", "field_percent", "radial_px", "radial displacement, px"),
    ("response", "cycles_per_px", "response", "response"),
    ("response", "reading_percent", "light_percent", "light, %"),
    ("points", "exposure", "reading", "reading"),
    ("temperatures", "celsius", "dark_current_e_per_s", "dark current, e⁻/s"),
];

/// A curve of a measurement.
#[derive(Clone, Debug)]
pub(crate) struct Curve {
    /// Table and the labels of its rows, such as the channel.
    pub name: String,
    /// Name of the abscissa.
    pub abscissa: &'static str,
    /// Description of the ordinate.
    pub ordinate: &'static str,
    /// In order of increasing x.
    pub points: Vec<(f64, Estimate)>,
    /// Standard deviation of single readings at each x, if stated.
    pub noise: Vec<(f64, f64)>,
}

/// An estimate of a table's cell.
fn estimate(cell: &Value) -> Option<Estimate> {
    Some(Estimate::new(cell["value"].as_f64()?, cell["standard_uncertainty"].as_f64()?))
}

/// The curves of a report's tables.
pub(crate) fn curves(tables: &Value) -> Vec<Curve> {
    let mut curves_found: Vec<Curve> = Vec::new();
    for (table, abscissa, ordinate, words) in CURVE_TABLES {
        for row in tables[table].as_array().into_iter().flatten() {
            let Some(y) = estimate(&row[ordinate]) else { continue };
            let Some(x) = row[abscissa].as_f64().or_else(|| row[abscissa]["value"].as_f64()) else { continue };
            let labels: Vec<&str> =
                row.as_object().into_iter().flatten().filter_map(|(_, cell)| cell.as_str()).collect();
            let name = [&[table], labels.as_slice()].concat().join(" ");
            let place = curves_found.iter().position(|c| c.name == name).unwrap_or_else(|| {
                curves_found.push(Curve { name, abscissa, ordinate: words, points: Vec::new(), noise: Vec::new() });
                curves_found.len() - 1
            });
            curves_found[place].points.push((x, y));
            curves_found[place].noise.extend(row["noise"].as_f64().map(|noise| (x, noise)));
        }
    }
    curves_found.iter_mut().for_each(|c| c.points.sort_by(|a, b| a.0.total_cmp(&b.0)));
    curves_found
}

impl Curve {
    /// The table that the curve comes from.
    pub(crate) fn kind(&self) -> &str {
        self.name.split(' ').next().unwrap_or_default()
    }

    /// The estimate at x, by linear interpolation; `None` beyond the ends.
    fn at(&self, x: f64) -> Option<Estimate> {
        let after = self.points.iter().position(|(abscissa, _)| *abscissa >= x)?;
        let (x1, y1) = self.points[after];
        if x1 == x {
            return Some(y1);
        }
        let (x0, y0) = self.points[after.checked_sub(1)?];
        let t = (x - x0) / (x1 - x0);
        let mix = |a: f64, b: f64| (1.0 - t) * a + t * b;
        Some(Estimate::new(mix(y0.value, y1.value), mix(y0.standard_uncertainty, y1.standard_uncertainty)))
    }
}

/// Two curves at a position of the first.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CurveGap {
    pub x: f64,
    pub a: Estimate,
    pub b: Estimate,
    /// True if the second curve is large enough for a relative error: 1 % of its maximum.
    pub significant: bool,
}

impl CurveGap {
    pub(crate) fn difference(&self) -> f64 {
        self.a.value - self.b.value
    }

    /// Relative to the second; `None` if that is close to zero.
    pub(crate) fn relative(&self) -> Option<f64> {
        self.significant.then(|| self.difference() / self.b.value.abs())
    }

    /// E_n, if an uncertainty is known.
    pub(crate) fn normalised(&self) -> Option<f64> {
        let known = self.a.standard_uncertainty + self.b.standard_uncertainty > 0.0;
        known.then(|| self.a.normalised_error(self.b))
    }
}

/// Gaps at the positions where both curves are defined.
pub(crate) fn gaps(a: &Curve, b: &Curve) -> Vec<CurveGap> {
    let largest = b.points.iter().map(|(_, y)| y.value.abs()).fold(0.0, f64::max);
    let gap = |(x, a): &(f64, Estimate)| {
        let b = b.at(*x)?;
        Some(CurveGap { x: *x, a: *a, b, significant: b.value.abs() > 0.01 * largest })
    };
    a.points.iter().filter_map(gap).collect()
}

/// Limit of the largest |E_n| for this number of points.
pub(crate) fn limit(points: usize) -> f64 {
    let level = sidak_level(two_sided_p(2.0), points.max(1));
    0.5 * quantile(1.0 - 0.5 * level)
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
            (curve, vec![CurveGap { x: 0.5, a, b, significant: true }])
        };
        assert!(means(&[0, 1, 2].map(curve)).is_empty());
        let [(mean, gaps)] = &means(&[0, 1, 2, 3].map(curve))[..] else { panic!("one table") };
        assert_eq!(mean.name, "response, mean of 4");
        // (1 + 2 + 3 + 4)/4 − 1.5, with 0.2/√4.
        assert!((gaps[0].difference() - 1.0).abs() < 1e-12 && (gaps[0].a.standard_uncertainty - 0.1).abs() < 1e-12);
    }

    fn line(points: &[(f64, f64)]) -> Curve {
        let points = points.iter().map(|(x, y)| (*x, Estimate::new(*y, 0.1))).collect();
        Curve { name: "curve".to_owned(), abscissa: "field_percent", ordinate: "ratio", points, noise: Vec::new() }
    }

    #[test]
    fn curves_meet_where_both_are() {
        let a = line(&[(0.0, 1.0), (1.0, 2.0), (5.0, 9.0)]);
        let b = line(&[(-1.0, 0.0), (3.0, 4.0)]);
        let gaps = gaps(&a, &b);
        assert_eq!(gaps.iter().map(|g| (g.x, g.b.value)).collect::<Vec<_>>(), [(0.0, 1.0), (1.0, 2.0)]);
        assert!(gaps.iter().all(|g| g.difference() == 0.0 && g.normalised() == Some(0.0)));
    }

    /// 1 − (1 − 0.0455)^(1/20) = 0.002326, two-sided at 3.045 standard deviations.
    #[test]
    fn many_points_may_show_more() {
        assert!((limit(1) - 1.0).abs() < 1e-9);
        assert!((limit(20) - 1.5225).abs() < 5e-4, "{}", limit(20));
    }
}
