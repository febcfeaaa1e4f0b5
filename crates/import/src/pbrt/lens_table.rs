//! Lens tables of pbrt's camera `realistic`: rows of radius, thickness, index and diameter in mm, from the scene to the film.
//!
//! A row of radius 0 is the aperture stop. An index of 0 or 1 is air; behind a stop 0 is the medium before it. The word in the place of an index may be a glass
//! of a catalogue. First-order quantities follow from the product of the matrices of refraction and translation (Gauss).

use std::path::Path;

use etendue_io::source::{decode_text, read_bytes};
use etendue_scene::record::lens::prescription::{
    Coating, Glass, GlassConstants, GlassNumbers, Surface, SurfaceListSource,
};
use etendue_scene::record::lens::{FocusDistance, Prescription};
use etendue_spectra::glass::{self, LINE_D_NM};

/// Medium behind a surface.
#[derive(Clone, Debug, PartialEq)]
enum LensMedium {
    Index(f64),
    /// Name of a glass and its index n_d.
    Glass(String, f64),
}

impl LensMedium {
    fn index(&self) -> f64 {
        match self {
            Self::Index(index) | Self::Glass(_, index) => *index,
        }
    }
}

/// Row of a table, lengths in mm.
#[derive(Clone, Debug)]
struct LensRow {
    /// 0 for the stop.
    radius_mm: f64,
    thickness_mm: f64,
    medium: LensMedium,
    diameter_mm: f64,
}

/// Lens of a table.
#[derive(Debug)]
pub(super) struct LensTable {
    rows: Vec<LensRow>,
    stop: usize,
}

/// First-order quantities, mm.
#[derive(Clone, Copy, Debug)]
pub(super) struct FirstOrder {
    pub(super) focal_length: f64,
    /// Distance of the focal points outside the first and the last vertex.
    front_focus: f64,
    back_focus: f64,
    /// Distance from the first to the last vertex.
    length: f64,
    /// Distance of the entrance pupil behind the first vertex.
    entrance_pupil: f64,
}

/// Lens in focus, distances in m.
#[derive(Clone, Copy, Debug)]
pub(super) struct FocusedLens {
    /// From the film to the entrance pupil.
    pub(super) film_to_pupil_m: f64,
    /// From the entrance pupil to the plane in focus.
    pub(super) focus_m: f64,
}

impl LensTable {
    /// Reads a table; `opened_mm` is the diameter of the stop, limited to the table's.
    pub(super) fn read(file: &Path, opened_mm: f64) -> Result<Self, String> {
        let bytes = read_bytes(file, "lens").map_err(|e| e.to_string())?;
        let text = decode_text(file, &bytes).map_err(|e| e.to_string())?;
        Self::parse(text, opened_mm).map_err(|problem| format!("{}{problem}", file.display()))
    }

    /// The error begins with the line, or with a colon.
    fn parse(text: &str, opened_mm: f64) -> Result<Self, String> {
        let lines = text.lines().enumerate().map(|(i, line)| (i + 1, line.split('#').next().unwrap_or_default()));
        let words: Vec<(usize, &str)> =
            lines.flat_map(|(line, content)| content.split_whitespace().map(move |word| (line, word))).collect();
        let (rows, []) = words.as_chunks::<4>() else {
            return Err(format!(": {} numbers; expected rows of radius, thickness, index and diameter", words.len()));
        };
        let mut before = LensMedium::Index(1.0);
        let mut list = Vec::with_capacity(rows.len());
        for row in rows {
            let row = LensRow::parse(row, &before)?;
            before = row.medium.clone();
            list.push(row);
        }
        if before.index() != 1.0 {
            return Err(format!(": the last row has the index {}; expected air, 1", before.index()));
        }
        let stops: Vec<usize> = (0..list.len()).filter(|i| list[*i].radius_mm == 0.0).collect();
        let [stop] = stops[..] else {
            return Err(format!(": {} rows of radius 0; expected one, the aperture stop", stops.len()));
        };
        list[stop].diameter_mm = list[stop].diameter_mm.min(opened_mm);
        Ok(Self { rows: list, stop })
    }

    pub(super) fn surface_count(&self) -> usize {
        self.rows.len()
    }

    pub(super) fn stop_diameter_mm(&self) -> f64 {
        self.rows[self.stop].diameter_mm
    }

    /// Returns true if the stop lies in glass: pbrt then takes the space behind it as air.
    pub(super) fn has_stop_in_glass(&self) -> bool {
        self.rows[self.stop].medium.index() != 1.0
    }

    pub(super) fn first_order(&self) -> Result<FirstOrder, String> {
        let matrix = RayMatrix::from_rows(&self.rows);
        if matrix.c >= 0.0 {
            return Err("the lens of the table does not form an image: its focal length is not above 0".to_owned());
        }
        let before_stop = RayMatrix::from_rows(&self.rows[..self.stop]);
        let gap = match self.stop {
            0 => 0.0,
            stop => self.rows[stop - 1].thickness_mm / self.rows[stop - 1].medium.index(),
        };
        // The point on the axis that is imaged into the middle of the stop: (a + gap·c) z + b + gap·d = 0 for a point z before the first vertex.
        let to_stop = before_stop.then_gap(gap);
        Ok(FirstOrder {
            focal_length: -1.0 / matrix.c,
            front_focus: -matrix.d / matrix.c,
            back_focus: -matrix.a / matrix.c,
            length: self.rows[..self.rows.len() - 1].iter().map(|row| row.thickness_mm).sum(),
            entrance_pupil: to_stop.b / to_stop.a,
        })
    }

    /// Our lens with the plane at this distance from its entrance pupil in focus. pbrt's surfaces lose no light.
    pub(super) fn prescription(&self, focus_m: f64) -> Prescription {
        let last = self.rows.len() - 1;
        let surface = |(i, row): (usize, &LensRow)| Surface {
            radius_mm: (row.radius_mm != 0.0).then(|| row.radius_mm.into()),
            thickness_mm: (i != last).then(|| row.thickness_mm.into()),
            glass: match &row.medium {
                LensMedium::Index(1.0) => None,
                LensMedium::Index(index) => {
                    Some(Glass::Numbers(GlassNumbers::new(GlassConstants::Index((*index).into()))))
                }
                LensMedium::Glass(name, _) => Some(Glass::Named(name.as_str().into())),
            },
            stop: (i == self.stop).then(|| true.into()),
            ..Surface::new(0.5 * row.diameter_mm)
        };
        let source = SurfaceListSource::Surfaces(self.rows.iter().enumerate().map(surface).collect());
        Prescription {
            focus_distance_m: Some(FocusDistance::Metres(focus_m.into())),
            coating: Some(Coating::Share(1.0.into())),
            ..Prescription::new(source)
        }
    }
}

impl LensRow {
    fn parse(words: &[(usize, &str); 4], before: &LensMedium) -> Result<Self, String> {
        let number = |i: usize| {
            let (line, word) = words[i];
            let number = word.parse::<f64>().ok().filter(|n| n.is_finite());
            number.ok_or_else(|| format!(":{line}: expected a finite number, found `{word}`"))
        };
        let (line, word) = words[2];
        let medium = match number(2) {
            Ok(0.0) if number(0)? == 0.0 => before.clone(),
            Ok(0.0) => LensMedium::Index(1.0),
            Ok(index) if (1.0..=5.0).contains(&index) => LensMedium::Index(index),
            Ok(index) => return Err(format!(":{line}: the index is {index}; expected 0 or 1 for air, or 1 to 5")),
            Err(_) => {
                let glass = glass::by_name(word).map_err(|e| format!(":{line}: {e}"))?;
                LensMedium::Glass(glass.name.to_owned(), glass.dispersion.index(LINE_D_NM))
            }
        };
        let row = Self { radius_mm: number(0)?, thickness_mm: number(1)?, medium, diameter_mm: number(3)? };
        if row.diameter_mm <= 0.0 || row.thickness_mm < 0.0 {
            return Err(format!(":{line}: expected a diameter above 0 and a thickness of 0 or more"));
        }
        Ok(row)
    }
}

impl FirstOrder {
    /// Focuses on the plane at a distance from the film, m; `None` if no place of the lens does so.
    ///
    /// Newton: x·x′ = f² for the distances x and x′ of object and image from the focal points, whose sum with the distance between those is given.
    pub(super) fn focused(&self, from_film_m: f64) -> Option<FocusedLens> {
        let sum = 1e3 * from_film_m - self.length - self.front_focus - self.back_focus;
        let root = sum * sum - 4.0 * self.focal_length * self.focal_length;
        if root < 0.0 || sum <= 0.0 {
            return None;
        }
        // The smaller root, without cancellation.
        let behind_focus = 2.0 * self.focal_length * self.focal_length / (sum + root.sqrt());
        let film_to_pupil_m = 1e-3 * (self.back_focus + behind_focus + self.length - self.entrance_pupil);
        Some(FocusedLens { film_to_pupil_m, focus_m: from_film_m - film_to_pupil_m })
    }
}

/// Paraxial matrix of height and index times angle.
#[derive(Clone, Copy)]
struct RayMatrix {
    a: f64,
    b: f64,
    c: f64,
    d: f64,
}

impl RayMatrix {
    /// Matrix from the first to the last vertex.
    fn from_rows(rows: &[LensRow]) -> Self {
        let mut matrix = Self { a: 1.0, b: 0.0, c: 0.0, d: 1.0 };
        let mut index = 1.0;
        for (i, row) in rows.iter().enumerate() {
            let next = row.medium.index();
            let power = if row.radius_mm == 0.0 { 0.0 } else { (next - index) / row.radius_mm };
            matrix = Self { c: matrix.c - power * matrix.a, d: matrix.d - power * matrix.b, ..matrix };
            if i + 1 < rows.len() {
                matrix = matrix.then_gap(row.thickness_mm / next);
            }
            index = next;
        }
        matrix
    }

    fn then_gap(self, reduced: f64) -> Self {
        Self { a: self.a + reduced * self.c, b: self.b + reduced * self.d, ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SINGLET: &str = "# thick singlet\n50 4 1.5168 12\n0 3 0 10\n-50 47 1 12\n";

    /// Lensmaker's formula of a thick lens in air, and Gauss's equation from its principal planes.
    #[test]
    fn a_thick_lens_has_the_focal_length_of_its_formula() {
        let table = LensTable::parse(SINGLET, 8.0).expect("a table");
        let lens = table.first_order().expect("a lens");
        let (n, r, t) = (1.5168, 50.0, 7.0);
        let power = (n - 1.0) * (2.0 / r - (n - 1.0) * t / (n * r * r));
        assert!((lens.focal_length - 1.0 / power).abs() < 1e-9, "{}", lens.focal_length);
        let principal = (n - 1.0) * t / (n * r * power);
        assert!((lens.back_focus - (1.0 / power - principal)).abs() < 1e-9);
        assert!((lens.front_focus - lens.back_focus).abs() < 1e-9, "it is symmetric");
        // The stop 4 mm behind the front in glass appears at 4/(n − 4 (n − 1)/r).
        assert!((lens.entrance_pupil - 4.0 / (n - 4.0 * (n - 1.0) / r)).abs() < 1e-9, "{}", lens.entrance_pupil);
        let focused = lens.focused(5.0).expect("in focus");
        let film = 1e3 * focused.film_to_pupil_m + lens.entrance_pupil - lens.length;
        let object = 5e3 - film - lens.length;
        let (s, s_image) = (object + principal, film + principal);
        assert!((1.0 / s + 1.0 / s_image - power).abs() < 1e-12);
        assert_eq!((table.stop_diameter_mm(), table.has_stop_in_glass()), (8.0, true));
        assert!(lens.focused(0.1).is_none(), "closer than four focal lengths");
    }

    #[test]
    fn named_glasses_are_those_of_the_catalogues() {
        let table = LensTable::parse("50 4 N-BK7 12\n0 3 0 10\n-50 47 1 12", 100.0).expect("a table");
        assert!((table.rows[0].medium.index() - 1.5168).abs() < 1e-5 && table.stop_diameter_mm() == 10.0);
    }

    #[test]
    fn damaged_tables_are_refused_with_their_line() {
        for (text, expected) in [
            ("50 4 1.5 12\n0 3 0", ": 7 numbers; expected rows of"),
            ("50 4 1.5 12\n0 3 x 10\n-50 47 1 12", ":2: no glass is called `x`"),
            ("50 4 1.5 12\n-50 47 1 12", ": 0 rows of radius 0"),
            ("50 4 0.5 12\n0 3 0 10", ":1: the index is 0.5"),
            ("0 3 0 10\n50 4 1.5 12", ": the last row has the index 1.5"),
        ] {
            let message = LensTable::parse(text, 1.0).expect_err("damaged");
            assert!(message.starts_with(expected), "{message}");
        }
    }
}
