//! Lens files of Zemax and CODE V.

use std::path::Path;

use etendue_io::prescription::read_prescription;
use etendue_scene::asset::{GlassAsset, LensFields, LensOpening, PrescriptionAsset};

const ZMX: &str = "VERS 140730 73 26155\nMODE SEQ\nNAME A triplet\nUNIT MM X W X CM MR CPMM\nENPD 10.0\n\
FTYP 0 0 3 2 0 0 0\nYFLN 0 7.0 10.0 0 0 0\nWAVM 1 4.861327E-1 1\nWAVM 2 5.875618E-1 1\nWAVM 3 5.5E-1 1\nPWAV 2\n\
SURF 0\n  TYPE STANDARD\n  CURV 0.0 0 0 0 0 \"\"\n  DISZ INFINITY\n  DIAM 0 0 0 0 1 \"\"\n\
SURF 1\n  TYPE STANDARD\n  CURV 0.0\n  DISZ 5.0\n  DIAM 9 1\n\
SURF 2\n  TYPE STANDARD\n  CURV 0.04 0 0 0 0 \"\"\n  DISZ 3.5\n  GLAS N-BK7 0 0 1.5 4.0E+1 0 0 0 0 0 0\n  DIAM 7.6 1 0 0 1 \"\"\n\
SURF 3\n  TYPE EVENASPH\n  CURV -0.02\n  PARM 1 0\n  PARM 2 1.1E-5\n  PARM 3 -2.0E-8\n  CONI -0.5\n  DISZ 2.0\n  DIAM 7.0\n  CLAP 0 6.5 0\n\
SURF 4\n  STOP\n  TYPE STANDARD\n  CURV 0.0\n  DISZ 1.0\n  DIAM 4.5\n\
SURF 5\n  TYPE STANDARD\n  CURV -0.05\n  DISZ 1.2\n  GLAS ___BLANK 1 0 1.62004 36.4 0\n  DIAM 5\n\
SURF 6\n  TYPE STANDARD\n  CURV 0.05\n  DISZ 40.0\n  DIAM 0\n\
SURF 7\n  TYPE STANDARD\n  CURV 0.0\n  DISZ 0\nTOL TOFF 0 0\n";

const SEQ: &str = "RDM;LEN       \"VERSION: 11.5\"\nTITLE 'A triplet'\nEPD 10.0  ! entrance pupil\nDIM M\nWL 486.1327 587.5618\nREF 2\n\
YAN 0.0 7.0 &\n 10.0\nSO 0.0 0.1e14\nS 0.0 5.0\nS 25.0 3.5 NBK7_SCHOTT\n  CIR 7.6\nS -50.0 2.0\n  ASP\n  K -0.5\n  A 1.1E-5; B -2.0E-8\n\
  CIR 6.5; CIR EDG 8\nS 0.0 1.0\n  STO\n  CIR 4.5\nS -20.0 1.2 620040.364000\n  CIR 5\nS 20.0 40.0\nSI 0.0 0.0\nGO\n";

fn read_bytes(name: &str, bytes: &[u8]) -> Result<PrescriptionAsset, String> {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join(name);
    std::fs::write(&file, bytes).expect("written");
    read_prescription(&file).map_err(|error| format!("{}: {}", error.line().unwrap_or(0), error.what()))
}

fn read(name: &str, text: &str) -> Result<PrescriptionAsset, String> {
    read_bytes(name, text.as_bytes())
}

fn is_the_triplet(lens: &PrescriptionAsset) {
    assert_eq!(lens.title, "A triplet");
    assert_eq!(lens.opening, Some(LensOpening::EntrancePupil { diameter_mm: 10.0 }));
    assert_eq!(lens.fields, Some(LensFields::AnglesDeg(vec![0.0, 7.0, 10.0])));
    assert!((lens.wavelengths_nm[1] - 587.5618).abs() < 1e-9 && lens.wavelengths_nm.len() == 2);
    let [front, back, stop, second, last] = &lens.surfaces[..] else { panic!("five surfaces: the dummy is left out") };
    assert!((front.radius_mm - 25.0).abs() < 1e-12 && front.semi_aperture_mm == Some(7.6));
    assert_eq!(front.glass, GlassAsset::Named("N-BK7".into()));
    assert_eq!((back.conic, back.asphere[..3].to_vec()), (-0.5, vec![0.0, 1.1e-5, -2.0e-8]));
    assert_eq!((back.semi_aperture_mm, back.glass.clone()), (Some(6.5), GlassAsset::Air));
    assert!(stop.stop && stop.radius_mm == f64::INFINITY && !front.stop);
    let GlassAsset::Abbe { index, abbe } = second.glass else { panic!("a model glass") };
    assert!((index - 1.62004).abs() < 1e-12 && (abbe - 36.4).abs() < 1e-9);
    assert_eq!((last.semi_aperture_mm, last.thickness_mm, lens.back_focus_mm), (None, 40.0, 40.0));
    assert_eq!(lens.object_distance_mm, f64::INFINITY);
}

#[test]
fn both_programs_files_give_the_same_lens() {
    is_the_triplet(&read("lens.zmx", ZMX).expect("a lens"));
    is_the_triplet(&read("lens.SEQ", SEQ).expect("a lens"));
}

#[test]
fn zemax_in_utf_16_of_either_order() {
    for swap in [false, true] {
        let order = |unit: u16| if swap { unit.to_be_bytes() } else { unit.to_le_bytes() };
        let bytes: Vec<u8> = core::iter::once(0xfeff).chain(ZMX.encode_utf16()).flat_map(order).collect();
        is_the_triplet(&read_bytes("lens.zmx", &bytes).expect("a lens"));
    }
}

#[test]
fn inches_become_millimetres() {
    let inches = read("lens.zmx", &ZMX.replace("UNIT MM", "UNIT IN")).expect("a lens");
    assert!((inches.surfaces[0].radius_mm - 635.0).abs() < 1e-9);
    // r⁴ has the unit of 1/length³.
    assert!((inches.surfaces[1].asphere[1] / (1.1e-5 / 25.4 / 25.4 / 25.4) - 1.0).abs() < 1e-12);
    assert_eq!(inches.opening, Some(LensOpening::EntrancePupil { diameter_mm: 254.0 }));
}

#[test]
fn what_is_not_modelled_is_refused_with_its_line() {
    let zmx = |from: &str, to: &str| read("lens.zmx", &ZMX.replacen(from, to, 1)).expect_err("refused");
    let line = 1 + ZMX.lines().position(|l| l.contains("GLAS N-BK7")).expect("a line");
    assert!(zmx("GLAS N-BK7", "GLAS MIRROR").starts_with(&format!("{line}: a mirror")));
    assert!(zmx("GLAS N-BK7", "GLAS UNOBTAINIUM").contains("no glass is called `UNOBTAINIUM`"));
    assert!(zmx("TYPE EVENASPH", "TYPE COORDBRK").contains("type COORDBRK"));
    assert!(zmx("MODE SEQ", "MODE NSC").starts_with("2: a non-sequential lens"));
    assert!(zmx("  STOP\n", "").contains("0 surfaces are the stop"));
    assert!(zmx("CURV 0.04", "CURV x").contains("CURV: found `x`, expected a number"));
    assert!(zmx("UNIT MM", "UNIT FURLONG").contains("UNIT is `FURLONG`"));
    let seq = |from: &str, to: &str| read("lens.seq", &SEQ.replacen(from, to, 1)).expect_err("refused");
    assert!(seq("SO 0.0", "PRV\nSO 0.0").contains("private catalogue"));
    assert!(seq("NBK7_SCHOTT", "'mine'").contains("a glass of a private catalogue"));
    assert!(seq("  ASP", "  XDE 0.1").contains("XDE is not modelled"));
    assert!(seq("RDM;LEN", "LEN").contains("surfaces before RDM"));
    assert!(seq("3.5 NBK7_SCHOTT", "3.5 REFL").contains("a mirror"));
    assert!(read("lens.txt", SEQ).expect_err("what kind").contains(".zmx"));
    assert!(read_prescription(Path::new("nowhere.zmx")).is_err());
}
