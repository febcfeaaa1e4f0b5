//! Lamp files written by their standards, for tests.

use std::fmt::Write as _;
use std::path::Path;

use etendue_io::photometry::read_photometry;
use etendue_scene::asset::PhotometryAsset;

/// Reads a lamp file of the given name and contents; errors without the folder.
pub(crate) fn read_bytes(name: &str, bytes: &[u8]) -> Result<PhotometryAsset, String> {
    let folder = tempfile::tempdir().expect("temporary folder");
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).expect("write");
    read_asset(folder.path(), &path)
}

pub(crate) fn read_asset(folder: &Path, path: &Path) -> Result<PhotometryAsset, String> {
    read_photometry(path).map_err(|e| e.to_string().replace(&format!("{}/", folder.display()), ""))
}

/// Lamp to be written as IES.
#[derive(Clone, Debug)]
pub(crate) struct Ies {
    pub(crate) first: &'static str,
    /// From the line of TILT to before the count of lamps.
    pub(crate) tilt: String,
    pub(crate) lamps: u32,
    pub(crate) lumens: f64,
    pub(crate) multiplier: f64,
    pub(crate) kind: u8,
    pub(crate) units: u8,
    pub(crate) size: [f64; 3],
    pub(crate) ballast: [f64; 2],
    pub(crate) vertical: Vec<f64>,
    pub(crate) horizontal: Vec<f64>,
    pub(crate) candela: Vec<f64>,
}

impl Ies {
    /// A lamp of type 1 C, 2 B or 3 A whose intensities are a function of the horizontal and vertical angle.
    pub(crate) fn new(kind: u8, horizontal: &[f64], vertical: &[f64], candela: impl Fn(f64, f64) -> f64) -> Self {
        let candela = horizontal.iter().flat_map(|h| vertical.iter().map(|v| candela(*h, *v)).collect::<Vec<_>>());
        Self {
            first: "IESNA:LM-63-2002",
            tilt: "TILT=NONE".to_owned(),
            lamps: 1,
            lumens: -1.0,
            multiplier: 1.0,
            kind,
            units: 2,
            size: [0.0; 3],
            ballast: [1.0, 1.0],
            vertical: vertical.to_vec(),
            horizontal: horizontal.to_vec(),
            candela: candela.collect(),
        }
    }

    pub(crate) fn text(&self) -> String {
        let mut text = format!("{}\n[TEST] 7\n[MANUFAC] Lamps & Co\n[MORE] of Town\n{}\n", self.first, self.tilt);
        let [width, length, height] = self.size;
        let (verticals, horizontals) = (self.vertical.len(), self.horizontal.len());
        let (lamps, lumens, multiplier, kind, units) =
            (self.lamps, self.lumens, self.multiplier, self.kind, self.units);
        let [ballast, further] = self.ballast;
        let _ = writeln!(
            text,
            "{lamps} {lumens} {multiplier} {verticals} {horizontals} {kind} {units} {width} {length} {height}\n{ballast} {further} 42.5"
        );
        for numbers in
            [&self.vertical, &self.horizontal].into_iter().map(Vec::as_slice).chain(self.candela.chunks(verticals))
        {
            for ten in numbers.chunks(10) {
                let _ = writeln!(text, "{}", ten.iter().map(f64::to_string).collect::<Vec<_>>().join(" "));
            }
        }
        text
    }

    pub(crate) fn read(&self) -> PhotometryAsset {
        read_bytes("lamp.ies", self.text().as_bytes()).unwrap_or_else(|error| panic!("{error}"))
    }
}

/// Lamp to be written as EULUMDAT.
#[derive(Clone, Debug)]
pub(crate) struct Ldt {
    pub(crate) symmetry: u8,
    pub(crate) planes: Vec<f64>,
    pub(crate) vertical: Vec<f64>,
    /// Values of the stored planes, cd per 1 000 lm.
    pub(crate) values: Vec<f64>,
    /// Light output ratio, per cent; conversion factor; tilt.
    pub(crate) factors: [f64; 3],
    /// Count, lumens and watts of each set.
    pub(crate) sets: Vec<(i32, f64, f64)>,
}

impl Ldt {
    /// A lamp of that symmetry; `stored` are the planes whose values are written, of all `planes`.
    pub(crate) fn new(
        symmetry: u8,
        planes: &[f64],
        stored: &[f64],
        vertical: &[f64],
        value: impl Fn(f64, f64) -> f64,
    ) -> Self {
        let values = stored.iter().flat_map(|c| vertical.iter().map(|v| value(*c, *v)).collect::<Vec<_>>());
        let (planes, vertical, values) = (planes.to_vec(), vertical.to_vec(), values.collect());
        Self { symmetry, planes, vertical, values, factors: [100.0, 1.0, 0.0], sets: vec![(1, 1000.0, 10.0)] }
    }

    pub(crate) fn text(&self) -> String {
        let mut lines: Vec<String> = ["Lamps & Co", "3"].map(str::to_owned).to_vec();
        lines.push(self.symmetry.to_string());
        lines.extend([self.planes.len().to_string(), "0".to_owned(), self.vertical.len().to_string(), "0".to_owned()]);
        lines.extend(["R 7", "Street light", "42-A", "street.ldt", "2024-05-06"].map(str::to_owned));
        lines.extend(["600", "200", "100", "500", "150", "0", "0", "10", "0", "100"].map(str::to_owned));
        lines.extend(self.factors.map(|v| v.to_string()));
        lines.push(self.sets.len().to_string());
        for (count, lumens, watts) in &self.sets {
            lines.extend([count.to_string(), "LED".to_owned(), lumens.to_string()]);
            lines.extend(["4000".to_owned(), "80".to_owned(), watts.to_string()]);
        }
        lines.extend(std::iter::repeat_n("0.5".to_owned(), 10));
        lines.extend([&self.planes, &self.vertical, &self.values].into_iter().flatten().map(f64::to_string));
        lines.join("\r\n") + "\r\n"
    }

    pub(crate) fn read(&self) -> PhotometryAsset {
        read_bytes("lamp.ldt", self.text().as_bytes()).unwrap_or_else(|error| panic!("{error}"))
    }
}

/// Angles from `low` to `high` in equal steps.
pub(crate) fn steps(low: f64, high: f64, step: f64) -> Vec<f64> {
    let count = ((high - low) / step).round() as usize;
    (0..=count).map(|i| low + step * i as f64).collect()
}

/// Checks for the same grid and the same intensities, ignoring files, texts and hashes. Sums and differences of angles are exact.
pub(crate) fn assert_same_light(a: &PhotometryAsset, b: &PhotometryAsset) {
    assert_eq!((a.axes, &a.horizontal_deg, &a.vertical_deg), (b.axes, &b.horizontal_deg, &b.vertical_deg));
    assert_eq!(a.candela, b.candela);
}
