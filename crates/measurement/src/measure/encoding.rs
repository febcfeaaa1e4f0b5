//! Conversion of an image's numbers to light: by --encoding, the side-car, or the file.

use std::path::{Path, PathBuf};

use clap::Args;
use etendue_io::failure::{Error, ErrorCode};
use etendue_io::photograph::{Encoding, Photograph, PhotographChannel, SourcedEncoding, read_photograph};
use etendue_io::table::read_numbers;
use etendue_isp::ToneCurve;
use etendue_plan_report::tone_curve::tone_curve;
use etendue_sensor::hdr::companding::Companding;

/// Encoding of an image's numbers.
#[derive(Args, Clone, Debug, Default)]
pub struct EncodingChoice {
    /// Encoding of the numbers: linear, srgb, or a table of two columns: light from 0 to 1 and number over full scale, or exposure
    /// above 0 and number (a measured OECF) [default: by the side-car or the PNG, else by the bits]
    #[arg(id = "encoding", long, value_name = "linear|srgb|FILE.csv", value_parser = chosen)]
    pub chosen: Option<ChosenEncoding>,
}

fn chosen(text: &str) -> Result<ChosenEncoding, String> {
    match text {
        "linear" => Ok(ChosenEncoding::Linear),
        "srgb" => Ok(ChosenEncoding::Srgb),
        file if file.to_ascii_lowercase().ends_with(".csv") => Ok(ChosenEncoding::Table(file.into())),
        _ => Err(format!("expected linear, srgb or a table FILE.csv, not '{text}'")),
    }
}

/// Encoding that the user chose.
#[derive(Clone, Debug, PartialEq)]
pub enum ChosenEncoding {
    /// Proportional to light.
    Linear,
    /// The curve of IEC 61966-2-1.
    Srgb,
    /// The curve of a table.
    Table(PathBuf),
}

/// Two columns: a tone curve if the light begins at 0, otherwise a measured conversion function.
fn table(file: &Path) -> Result<Encoding, Error> {
    let table = read_numbers(file).map_err(Error::input)?;
    if table.columns != 2 {
        let file = file.display();
        let message = format!(
            "{file}: the number of columns is {}; expected two: light or exposure, and digital number",
            table.columns
        );
        return Err(Error::coded(ErrorCode::UnsuitableFile, message));
    }
    let points: Vec<(f64, f64)> = table.rows().map(|row| (row[0], row[1])).collect();
    let is_inverse = points.first().is_some_and(|first| first.0 == 0.0);
    Ok(if is_inverse { Encoding::Table(points) } else { Encoding::Oecf { points, largest_output: None } })
}

impl EncodingChoice {
    /// Encoding that the user states; `None` if none.
    fn stated(&self) -> Result<Option<SourcedEncoding>, Error> {
        let encoding = match &self.chosen {
            None => return Ok(None),
            Some(ChosenEncoding::Linear) => Encoding::Linear,
            Some(ChosenEncoding::Srgb) => Encoding::Srgb,
            Some(ChosenEncoding::Table(file)) => {
                return Ok(Some(SourcedEncoding::new(table(file)?, format!("`encoding` {}", file.display()))));
            }
        };
        Ok(Some(SourcedEncoding::new(encoding, "`encoding`")))
    }

    /// Opens an image whose numbers are to be converted to light.
    pub(crate) fn photograph(&self, file: &Path) -> Result<Photograph, Error> {
        let mut photograph = read_photograph(file).map_err(Error::input)?;
        if companding(&photograph).is_some() {
            photograph.stated.reason += ", companding undone";
        }
        let Some(stated) = self.stated()? else { return Ok(photograph) };
        if photograph.raw.is_some() && stated.encoding != Encoding::Linear {
            let (file, reason) = (file.display(), &photograph.stated.reason);
            let message = format!("{file}: raw numbers are proportional to light ({reason}); leave `encoding` out");
            return Err(Error::coded(ErrorCode::NoEffect, message));
        }
        photograph.stated = stated;
        Ok(photograph)
    }

    /// Opens an image whose numbers are measured as stored, unless the user requests the inversion of another curve.
    pub(crate) fn stored(&self, file: &Path) -> Result<Photograph, Error> {
        let mut photograph = self.photograph(file)?;
        if self.chosen.is_none() && photograph.raw.is_none() {
            photograph.stated = SourcedEncoding::new(Encoding::Linear, "numbers are measured as stored");
        }
        Ok(photograph)
    }

    /// Checks a raw image, whose numbers must be proportional to charge. Refuses one that states otherwise; a guessed encoding does
    /// not count.
    pub(crate) fn raw(&self, file: &Path, mut photograph: Photograph) -> Result<Photograph, Error> {
        let file = file.display();
        if companding(&photograph).is_some() {
            return Err(Error::coded(
                ErrorCode::UnsuitableFile,
                format!(
                    "{file}: its numbers are companded, so their noise is not that of the charge; give raw images of full bit depth"
                ),
            ));
        }
        let SourcedEncoding { encoding, reason, guessed } = &photograph.stated;
        if *encoding != Encoding::Linear && !guessed {
            let description = format!("{file}: {} numbers ({reason})", encoding.name());
            let remedy =
                if self.chosen.is_some() { "leave it out" } else { "if they are linear, set `encoding` to linear" };
            return Err(Error::coded(
                ErrorCode::UnsuitableFile,
                format!("{description}; expected numbers proportional to charge: {remedy}"),
            ));
        }
        if photograph.raw.is_none() && self.chosen.is_none() {
            photograph.stated = SourcedEncoding::new(Encoding::Linear, "raw numbers are measured as stored");
        }
        Ok(photograph)
    }
}

fn companding(photograph: &Photograph) -> Option<Companding> {
    let frame = photograph.raw.as_ref()?.frame.as_ref()?;
    Some(Companding { knees: frame.companding_knees_dn.clone()?, bits: frame.bits })
}

/// Conversion from numbers to light.
pub(crate) enum LightConversion {
    /// None: numbers are proportional to light.
    Stored,
    /// A tone curve, of numbers relative to the full scale; light is 0 … 1.
    Curve(ToneCurve, f64),
    /// The segments of a companded raw; light is in its linear numbers.
    Companded(Companding),
}

impl LightConversion {
    pub(crate) fn from_photograph(file: &Path, photograph: &Photograph) -> Result<Self, Error> {
        if let Some(companding) = companding(photograph) {
            return Ok(Self::Companded(companding));
        }
        let SourcedEncoding { encoding, reason, .. } = &photograph.stated;
        if *encoding == Encoding::Linear {
            return Ok(Self::Stored);
        }
        let full_scale = photograph.full_scale.unwrap_or(1.0);
        let named = |error| {
            Error::coded(ErrorCode::UnsuitableFile, format!("{}: encoding by {reason}: {error}", file.display()))
        };
        Ok(Self::Curve(tone_curve(encoding, full_scale).map_err(named)?, full_scale))
    }

    /// Light of a channel. Numbers of 8 and 16 bits repeat: each is decoded once.
    pub(crate) fn channel_light(&self, channel: &PhotographChannel) -> Vec<f32> {
        let Self::Curve(curve, full_scale) = self else {
            return channel.samples.iter().map(|v| self.number(f64::from(*v)) as f32).collect();
        };
        let light = |v: f32| curve.decode((f64::from(v) / full_scale) as f32);
        let is_integer_scale = (2.0..=65_535.0).contains(full_scale);
        let table: Vec<f32> =
            if is_integer_scale { (0..=*full_scale as u32).map(|v| light(v as f32)).collect() } else { Vec::new() };
        let decode = |v: &f32| match table.get(*v as usize) {
            Some(light) if v.fract() == 0.0 && *v >= 0.0 => *light,
            _ => light(*v),
        };
        channel.samples.iter().map(decode).collect()
    }

    /// A level of a raw image in the unit of the light.
    pub(crate) fn number(&self, stored: f64) -> f64 {
        match self {
            Self::Companded(companding) => companding.linear(stored),
            Self::Stored | Self::Curve(..) => stored,
        }
    }

    /// The largest light, if the file has a largest number.
    pub(crate) fn full_scale(&self, photograph: &Photograph) -> Option<f64> {
        match self {
            Self::Curve(..) => Some(1.0),
            Self::Stored | Self::Companded(_) => photograph.full_scale.map(|full| self.number(full)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_and_tables_are_distinguished() {
        assert_eq!(chosen("srgb"), Ok(ChosenEncoding::Srgb));
        assert_eq!(chosen("curve.CSV"), Ok(ChosenEncoding::Table("curve.CSV".into())));
        assert!(chosen("gamma").is_err_and(|message| message.contains("FILE.csv")));
    }

    fn light(stated: Encoding, full_scale: Option<f64>, numbers: &[f32]) -> Vec<f32> {
        let channel = PhotographChannel { name: "Y".into(), samples: numbers.to_vec() };
        let stated = SourcedEncoding::new(stated, "told");
        let photograph = Photograph {
            width: numbers.len(),
            height: 1,
            channels: vec![channel],
            full_scale,
            stated,
            raw: None,
            correlated_block_px: 1,
        };
        let to_light = LightConversion::from_photograph(Path::new("a.png"), &photograph).expect("a curve");
        to_light.channel_light(&photograph.channels[0])
    }

    #[test]
    fn numbers_become_light_by_their_curve() {
        // IEC 61966-2-1: ((188/255 + 0.055)/1.055)^2.4.
        let srgb = light(Encoding::Srgb, Some(255.0), &[0.0, 188.0, 255.0]);
        assert!(srgb[0] == 0.0 && (srgb[1] - 0.502_886).abs() < 1e-5 && srgb[2] == 1.0, "{srgb:?}");
        assert_eq!(light(Encoding::Linear, Some(255.0), &[0.0, 188.0]), [0.0, 188.0]);
        let gamma = light(Encoding::Gamma(2.0), Some(65_535.0), &[32_767.5, 65_535.0]);
        assert!((gamma[0] - 0.25).abs() < 1e-6 && gamma[1] == 1.0, "{gamma:?}");
        let table = Encoding::Table(vec![(0.0, 0.0), (0.5, 0.8), (1.0, 1.0)]);
        assert!((light(table, Some(255.0), &[204.0])[0] - 0.5).abs() < 1e-6);
        // Of a measured function in the image's own numbers, half way in the logarithm.
        let oecf = Encoding::Oecf { points: vec![(2.0, 10.0), (8.0, 50.0), (32.0, 100.0)], largest_output: None };
        let linear = light(oecf, Some(255.0), &[10.0, 30.0, 100.0]);
        assert!(
            (linear[0] - 0.0625).abs() < 1e-6 && (linear[1] - 0.125).abs() < 1e-6 && linear[2] == 1.0,
            "{linear:?}"
        );
        assert!((light(Encoding::Srgb, None, &[0.5])[0] - 0.214_041).abs() < 1e-5);
    }
}
