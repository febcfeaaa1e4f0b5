//! Published lenses, each with its source (`data/lenses/`), as examples and for validation.

use etendue_spectra::glass::{Dispersion, by_name as catalogue};

use super::surface::Surface;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PublishedLens {
    /// Name in this list.
    pub name: &'static str,
    text: &'static str,
}

/// The list: double-gauss, wide-angle, fisheye, telephoto.
pub const LENSES: [PublishedLens; 4] = [
    PublishedLens { name: "double-gauss", text: include_str!("../../data/lenses/double_gauss.csv") },
    PublishedLens { name: "wide-angle", text: include_str!("../../data/lenses/wide_angle.csv") },
    PublishedLens { name: "fisheye", text: include_str!("../../data/lenses/fisheye.csv") },
    PublishedLens { name: "telephoto", text: include_str!("../../data/lenses/telephoto.csv") },
];

/// A published lens by its name.
#[must_use]
pub fn named(name: &str) -> Option<&'static PublishedLens> {
    LENSES.iter().find(|lens| lens.name == name)
}

impl PublishedLens {
    /// Description and source.
    #[must_use]
    pub fn source(&self) -> String {
        let lines = self.text.lines().filter_map(|line| line.strip_prefix("# "));
        lines.collect::<Vec<_>>().join("\n")
    }

    #[must_use]
    pub fn surfaces(&self) -> Vec<Surface> {
        self.text.lines().filter(|line| !line.starts_with('#')).skip(1).map(row).collect()
    }
}

fn row(line: &str) -> Surface {
    let fields: Vec<&str> = line.split(',').collect();
    let number = |text: &str| text.parse::<f64>().expect("a number in a file of the crate");
    let radius_mm = if ["", "stop"].contains(&fields[0]) { f64::INFINITY } else { number(fields[0]) };
    let thickness_mm = if fields[1].is_empty() { 0.0 } else { number(fields[1]) };
    let surface = Surface::sphere(radius_mm, thickness_mm, glass(fields[2]), number(fields[3]));
    Surface { stop: fields[0] == "stop", ..surface }
}

/// `air`, a catalogue name, or `n_d/V_d`.
fn glass(text: &str) -> Dispersion {
    match text.split_once('/') {
        _ if text == "air" => Dispersion::AIR,
        Some((n, v)) => {
            let [n, v] = [n, v].map(|t| t.parse().expect("a number in a file of the crate"));
            Dispersion::from_abbe(n, v).expect("a glass in a file of the crate")
        }
        None => catalogue(text).expect("a glass in a file of the crate").dispersion,
    }
}
