//! Closed forms against mpmath over the whole ranges of their arguments (tests/oracles/closed_forms.py).

use etendue_core::maths::{f32 as single, f64 as double};
use etendue_spectra::colour::{Lab, ciede2000};
use etendue_spectra::illuminant::planck;
use etendue_spectra::{Spectrum, observer};
use etendue_testkit::page::{Row, check, worst as greatest};
use etendue_tracer::materials::fresnel;
use serde_json::Value;

pub(crate) fn figures() -> Value {
    let text = include_str!("../../../oracles/figures/closed_forms.json");
    serde_json::from_str(text).expect("JSON")
}

/// Arguments and their values: the nearest double and what is left.
pub(crate) struct KnownValues {
    pub(crate) arguments: Vec<f64>,
    pub(crate) values: Vec<[f64; 2]>,
}

pub(crate) fn known(rows: &Value) -> Vec<KnownValues> {
    let number = |value: &Value| value.as_f64().expect("a number");
    let flat = |value: &Value| match value.as_array() {
        Some(values) => values.iter().map(number).collect(),
        None => vec![number(value)],
    };
    let known_values = |row: &Value| KnownValues {
        arguments: row["at"].as_array().expect("arguments").iter().flat_map(flat).collect(),
        values: row["is"].as_array().expect("values").iter().map(|v| [number(&v[0]), number(&v[1])]).collect(),
    };
    let known: Vec<_> = rows.as_array().expect("rows").iter().map(known_values).collect();
    assert!(known.len() > 20, "figures are there");
    known
}

/// The distance to the next double from a number other than zero.
fn ulp(value: f64) -> f64 {
    let size = value.abs();
    f64::from_bits(size.to_bits() + 1) - size
}

pub(crate) fn ulp_single(value: f64) -> f64 {
    let size = (value as f32).abs();
    f64::from(f32::from_bits(size.to_bits() + 1)) - f64::from(size)
}

/// Of all rows the greatest distance, over `unit` of the true value, and where.
pub(crate) fn worst(
    rows: &[KnownValues],
    unit: fn(f64) -> f64,
    function: impl Fn(&[f64]) -> Vec<f64>,
) -> (f64, Vec<f64>) {
    let mut worst = (0.0, Vec::new());
    for KnownValues { arguments: at, values: is } in rows {
        for (actual, [value, rest]) in function(at).into_iter().zip(is) {
            let error = if *value == 0.0 {
                actual.abs() / f64::MIN_POSITIVE
            } else {
                ((actual - value) - rest).abs() / unit(*value)
            };
            // A result that is no number is the worst.
            if error.is_nan() || error > worst.0 {
                worst = (error, at.clone());
            }
        }
    }
    worst
}

type UnaryFunction<T> = (&'static str, fn(T) -> T);
type BinaryFunction<T> = (&'static str, fn(T, T) -> T);

const DOUBLE: [UnaryFunction<f64>; 14] = [
    ("sin", double::sin),
    ("cos", double::cos),
    ("tan", double::tan),
    ("asin", double::asin),
    ("acos", double::acos),
    ("atan", double::atan),
    ("exp", double::exp),
    ("exp2", double::exp2),
    ("exp_m1", double::exp_m1),
    ("ln", double::ln),
    ("ln_1p", double::ln_1p),
    ("log2", double::log2),
    ("log10", double::log10),
    ("cbrt", double::cbrt),
];
const DOUBLE_BINARY: [BinaryFunction<f64>; 3] =
    [("pow", double::pow), ("atan2", double::atan2), ("hypot", double::hypot)];
const SINGLE: [UnaryFunction<f32>; 14] = [
    ("sin", single::sin),
    ("cos", single::cos),
    ("tan", single::tan),
    ("asin", single::asin),
    ("acos", single::acos),
    ("atan", single::atan),
    ("exp", single::exp),
    ("exp2", single::exp2),
    ("exp_m1", single::exp_m1),
    ("ln", single::ln),
    ("ln_1p", single::ln_1p),
    ("log2", single::log2),
    ("log10", single::log10),
    ("cbrt", single::cbrt),
];
const SINGLE_BINARY: [BinaryFunction<f32>; 3] =
    [("pow", single::pow), ("atan2", single::atan2), ("hypot", single::hypot)];

/// What the functions in double and in single precision promise, units in the last place: half a unit is what rounding alone leaves.
const DOUBLE_ULP: f64 = 2.0;
const SINGLE_ULP: f64 = 0.51;

fn row(name: &str, bits: u32, bound: f64, (error, at): &(f64, Vec<f64>)) -> Row {
    let at: Vec<_> = at.iter().map(|x| format!("{x:.3e}")).collect();
    Row {
        extreme: format!("`{name}`, {bits} bits"),
        expected: format!("≤ {bound} ULP"),
        actual: format!("{error:.2} at {}", at.join(", ")),
        holds: *error <= bound,
    }
}

#[test]
fn elementary_functions_keep_their_last_places() {
    let figures = figures();
    let mut rows = Vec::new();
    for (name, f) in DOUBLE {
        let known = known(&figures["double"][name]);
        rows.push(row(name, 64, DOUBLE_ULP, &worst(&known, ulp, |x| vec![f(x[0])])));
    }
    for (name, f) in DOUBLE_BINARY {
        let known = known(&figures["double"][name]);
        rows.push(row(name, 64, DOUBLE_ULP, &worst(&known, ulp, |x| vec![f(x[0], x[1])])));
    }
    for (name, f) in SINGLE {
        let known = known(&figures["single"][name]);
        rows.push(row(name, 32, SINGLE_ULP, &worst(&known, ulp_single, |x| vec![f(x[0] as f32).into()])));
    }
    for (name, f) in SINGLE_BINARY {
        let known = known(&figures["single"][name]);
        rows.push(row(name, 32, SINGLE_ULP, &worst(&known, ulp_single, |x| vec![f(x[0] as f32, x[1] as f32).into()])));
    }
    let introduction = "`core::maths`, with the same bits on every machine, compared with mpmath 1.4.1 at 60 digits (tests/oracles/closed_forms.py). Arguments: 10⁻³⁰⁰ to 10³⁰⁰ (32 bits: 10⁻³⁷ to 10³⁷), angles to 10⁵ and 10⁴, and more next to multiples of π/2, to 1 and to the ends of domains. Found: the largest error in units in the last place of the true value, and its arguments.";
    check("Elementary functions", introduction, &rows);
}

/// The greatest distance of tristimulus values over their sum, and of chromaticities x and y.
fn observer_error(rows: &[KnownValues], spectrum: impl Fn(&[f64]) -> Spectrum) -> f64 {
    greatest(rows.iter().flat_map(|KnownValues { arguments: at, values: is }| {
        let [x, y, z] = observer::xyz(&spectrum(at));
        let (sum, exact) = (x + y + z, is[0][0] + is[1][0] + is[2][0]);
        let actual = [x / exact, y / exact, z / exact, x / sum, y / sum];
        let scale = [exact, exact, exact, 1.0, 1.0];
        core::array::from_fn::<_, 5, _>(|i| (actual[i] - is[i][0] / scale[i]).abs())
    }))
}

/// As a relative error.
fn relative(value: f64) -> f64 {
    value.abs()
}

#[test]
fn closed_forms_keep_their_digits() {
    let figures = figures();
    let single = |name: &str, function: &dyn Fn(&[f32]) -> Vec<f32>| {
        let double_function = |at: &[f64]| {
            function(&at.iter().map(|v| *v as f32).collect::<Vec<_>>()).into_iter().map(f64::from).collect()
        };
        worst(&known(&figures[name]), relative, double_function).0
    };
    let dielectric = single("dielectric", &|at| fresnel::planes(at[0], at[1]).to_vec());
    let conductor = single("conductor", &|at| vec![fresnel::conductor(at[0], at[1], at[2])]);
    let black_body = worst(&known(&figures["planck"]), relative, |at| vec![planck(at[0], at[1])]).0;
    let lab = |at: &[f64]| Lab { l: at[0], a: at[1], b: at[2] };
    let difference =
        worst(&known(&figures["ciede2000"]), relative, |at| vec![ciede2000(lab(&at[..3]), lab(&at[3..]))]).0;
    let black_bodies = observer_error(&known(&figures["black_bodies"]), |at| Spectrum::from_fn(|nm| planck(nm, at[0])));
    let line = |at: &[f64], nm: f64| double::exp(-((nm - at[0]) / at[1]) * ((nm - at[0]) / at[1]));
    let lines = observer_error(&known(&figures["lines"]), |at| Spectrum::from_fn(|nm| line(at, nm)));
    let observed = "≤ 1.5·10⁻⁷ of X + Y + Z, and of x and y: spectra and observer have 32 bits (6·10⁻⁸ each)";
    let rows = [
        Row::at_most(
            "Fresnel, both planes, indices 1.0001 to 4, cosines 10⁻⁶ to 1, 32 bits",
            "≤ 2·10⁻⁶: about twenty roundings of 6·10⁻⁸, magnified only at Brewster's angle",
            dielectric,
            2e-6,
        ),
        Row::at_most("Fresnel, metals, n 0.03 to 6.3, k 0.1 to 10, 32 bits", "≤ 2·10⁻⁶", conductor, 2e-6),
        Row::at_most(
            "Planck's law, 10 to 10⁸ K, 300 to 1 100 nm, 64 bits",
            "≤ 10⁻¹²: the exponent, up to 700, is rounded by 10⁻¹⁶ of itself",
            black_body,
            1e-12,
        ),
        Row::at_most(
            "CIEDE2000, colours 10⁻⁶ to 30 apart, 64 bits",
            "≤ 10⁻⁸: differences of 10⁻⁶ keep ten of sixteen digits",
            difference,
            1e-8,
        ),
        Row::at_most(
            "CIE 1931 tristimulus values and chromaticities of black bodies, 10³ to 10⁶ K",
            observed,
            black_bodies,
            1.5e-7,
        ),
        Row::at_most("the same of Gaussian lines at 380 to 780 nm, 1 to 100 nm wide", observed, lines, 1.5e-7),
    ];
    let introduction = "Compared with mpmath as above; the largest relative error.";
    check("Closed forms", introduction, &rows);
}
