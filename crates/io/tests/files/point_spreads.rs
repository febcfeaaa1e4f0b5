//! Zemax's listings of point spreads: every known header, and invalid ones.

use etendue_io::lens_table::read_point_spread;
use etendue_scene::asset::{FieldPoint, PointSpreadAsset};

fn read_bytes(bytes: &[u8]) -> Result<PointSpreadAsset, String> {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("psf.txt");
    std::fs::write(&file, bytes).expect("written");
    read_point_spread(&file).map_err(|error| error.to_string())
}

fn read(text: &str) -> Result<PointSpreadAsset, String> {
    read_bytes(text.as_bytes())
}

/// Listing of 2005: fields of y alone, in Latin-1 with three digits of exponents.
const OLD: &str = "Listing of Huygens PSF Data\r\n\r\nFile : C:\\A.ZMX\r\nTitle: A at 2 mm\r\nDate : TUE AUG 30 2005\r\n\r\n\r\nHUYGENS PSF\r\n\
    0.5500 µm at -27.38 deg.\r\nData spacing is 0.25 µm.\r\nData area is 1.00 by 1.00 µm.\r\nStrehl ratio: 0.486\r\nPupil grid size: 32 by 32\r\n\
    Image grid size: 4 by 4\r\nCenter point is: 3, 3\r\nCenter coordinates: 0.00000000E+000, -9.59263593E-001\r\nValues are relative intensity.\r\n\r\n\
    0.0E+000\t0.000E+000\t1.000E-003\t0.000E+000\r\n0.0E+000\t1.000E-001\t5.000E-001\t1.000E-001\r\n\
    0.0E+000\t0.000E+000\t2.000E-001\t0.000E+000\r\n0.0E+000\t0.000E+000\t1.000E-004\t0.000E+000\r\n";

/// Listing of 2019: two fields, units of coordinates, the centroid, blanks before the rows.
const NEW: &str = "Listing of Huygens PSF Data\n\nFile : C:\\LSST.zmx\nTitle: LSST\nDate : 8/12/2019\n\n\n\n0.5000 µm at 0.0000, 1.2250 (deg).\n\
    Data spacing is 0.289 µm.\nData area is 1.156 by 1.156 µm.\nStrehl ratio: 0.214\nPupil grid size: 1024 by 1024\nImage grid size: 4 by 4\n\
    Center point is: 3, 3\nCenter coordinates     :   0.00000000E+00,   2.20488001E+02 Millimeters\n\
    Centroid offset         :   0.00000000E+00,   1.44500000E-04 Millimeters\nCentroid coordinates:   0.0E+00,   2.2E+02 Millimeters\n\n\
    Values are relative intensity.\n\n\n  0.0E+00\t  0.0E+00\t  5.0E-01\t  0.0E+00\n  0.0E+00\t  0.0E+00\t  5.0E-01\t  0.0E+00\n\
    0.0E+00\t  0.0E+00\t  0.0E+00\t  0.0E+00\n  0.0E+00\t  0.0E+00\t  0.0E+00\t  0.0E+00\n";

const FFT: &str = "Listing of FFT PSF Data\n\nFile : C:\\LSST.zmx\n\nFFT PSF\n0.5000 µm at 1.1760, 1.1760 (deg).\nData spacing is 0.289 µm.\n\
    Data area is 18.466 µm wide.\nSurface: Image (Detector)\nReference Coordinates: 2.11742E+02, 2.11742E+02\nPupil grid size: 32 by 32\n\
    Image grid size: 4 by 4\nCenter point is: row 3, column 2\nValues are not normalized.\n\n\
    0 0 0 0\n0 0 0 0\n0 1 0 0\n0 0 0 0\n";

#[test]
fn heads_of_all_kinds_are_read() {
    let old = read(OLD).expect("legal");
    assert_eq!((old.field, old.place_mm), (FieldPoint::Degrees([0.0, -27.38]), Some([0.0, -0.959_263_593])));
    assert_eq!((old.wavelengths_nm, old.spacing_um, old.width), ([550.0; 2], 0.25, 4));
    // The third row from the last, which is the second.
    assert_eq!((old.point, old.light.len(), old.light[6]), ([2, 1], 16, 0.5));
    assert_eq!(old.notes.len(), 2, "{:?}", old.notes);
    assert!(
        old.notes[0].contains("assumed to be in mm") && old.notes[1].contains("border is 20.0 %"),
        "{:?}",
        old.notes
    );

    let new = read(NEW).expect("legal");
    assert_eq!((new.field, new.place_mm), (FieldPoint::Degrees([0.0, 1.225]), Some([0.0, 220.488_001])));
    assert_eq!((new.point, new.spacing_um), ([2, 1], 0.289));
    // The centroid lies half a row above the centre, as in the header; the border is not dark.
    assert!(new.notes.len() == 1 && new.notes[0].contains("border"), "{:?}", new.notes);

    let fft = read(FFT).expect("legal");
    assert_eq!((fft.place_mm, fft.point, fft.light[9]), (Some([211.742; 2]), [1, 2], 1.0));
    assert_eq!(fft.field, FieldPoint::Degrees([1.176; 2]));
}

#[test]
fn further_words_and_encodings_are_understood() {
    let replaced = |from: &str, to: &str| read(&NEW.replace(from, to)).expect("legal");
    let poly = replaced(
        "0.5000 µm at 0.0000, 1.2250 (deg).",
        "Polychromatic Huygens PSF\n0.4861 to 0.6563 µm at 0.0000, 14.0000 (deg).",
    );
    assert_eq!((poly.wavelengths_nm, poly.field), ([486.1, 656.3], FieldPoint::Degrees([0.0, 14.0])));
    let millimetres = replaced("1.2250 (deg).", "4.0000 mm.");
    assert_eq!(millimetres.field, FieldPoint::Millimetres([0.0, 4.0]));
    assert_eq!(replaced("Center point is: 3, 3", "Center point is: row 2, column 3").point, [2, 1]);
    assert_eq!(replaced("2.20488001E+02 Millimeters", "2.0E+01 Centimeters").place_mm, Some([0.0, 200.0]));
    assert_eq!(replaced("2.20488001E+02 Millimeters", "2.0E+00 Inches").place_mm, Some([0.0, 50.8]));
    assert!((replaced("spacing is 0.289 µm", "spacing is 0.000289 mm").spacing_um - 0.289).abs() < 1e-12);
    let without = |from: &str| {
        let lines = NEW.lines().filter(|line| !line.starts_with(from));
        read(&lines.map(|line| format!("{line}\n")).collect::<String>()).expect("legal")
    };
    assert_eq!(without("Center coordinates").place_mm, None);
    let centreless = without("Center point");
    assert!(centreless.point == [2, 1] && centreless.notes[0].contains("no centre"), "{:?}", centreless.notes);
    let fft = FFT.replace("Center point is: row 3, column 2\n", "");
    assert_eq!(read(&fft).expect("legal").point, [1, 2]);
    let turned = replaced("1.44500000E-04", "-1.44500000E-03");
    assert!(
        turned.notes[1].contains("0.14 µm from the centre, but the header states 0.00, -1.45 µm"),
        "{:?}",
        turned.notes
    );

    let wide: Vec<u8> = std::iter::once(0xfeff).chain(NEW.encode_utf16()).flat_map(u16::to_le_bytes).collect();
    let latin: Vec<u8> = NEW.chars().map(|c| c as u8).collect();
    for bytes in [wide, latin] {
        let PointSpreadAsset { hash: _, ref light, spacing_um, .. } = read_bytes(&bytes).expect("legal");
        assert_eq!((light.len(), spacing_um), (16, 0.289));
    }
}

#[test]
fn listings_that_cannot_be_used_are_reported_with_their_line() {
    for (listing, phrases) in [
        (NEW.replace("PSF", "MTF"), &["psf.txt", "not a listing of a point-spread function"][..]),
        (NEW.replace("Data spacing is 0.289 µm.\n", ""), &["does not state the sample spacing"]),
        (NEW.replace("spacing is 0.289 µm", "spacing is 0.289 mr"), &["psf.txt:10", "not a length above 0"]),
        (NEW.replace("spacing is 0.289", "spacing is 0"), &["psf.txt:10", "not a length above 0"]),
        (NEW.replace(" at 0.0000, 1.2250 (deg).", ""), &["does not state wavelength and field"]),
        (NEW.replace("(deg)", "(furlong)"), &["psf.txt:9", "neither in degrees nor in mm"]),
        (NEW.replace("0.5000 µm", "50.000 µm"), &["psf.txt:9", "50000", "100 … 20 000"]),
        (NEW.replace("4 by 4", "5 by 4"), &["psf.txt:14", "5 by 4 samples, but the file has 4 rows of 4"]),
        (NEW.replace("Center point is: 3, 3", "Center point is: 3, 9"), &["psf.txt:15", "not one of the 4 by 4"]),
        (NEW.replace("relative intensity", "log base 10"), &["psf.txt:20", "\"Linear\""]),
        (NEW.replace("5.0E-01", "-5.0E-01"), &["psf.txt:23", "-0.5", "0 or more"]),
        (NEW.replace("5.0E-01", "0.0E-01"), &["psf.txt:23", "all values are 0"]),
        (
            NEW.replacen("5.0E-01\t  0.0E+00\n", "5.0E-01\n", 1),
            &["psf.txt:24", "the number of values is 4; expected 3"],
        ),
        (format!("{NEW}\nand\n1 2\n"), &["psf.txt:29", "second table"]),
        ("Listing of Huygens PSF Data\n".to_owned(), &["no row of numbers"]),
    ] {
        let message = read(&listing).expect_err("cannot be used");
        assert!(phrases.iter().all(|phrase| message.contains(phrase)), "{phrases:?}: {message}");
    }
}
