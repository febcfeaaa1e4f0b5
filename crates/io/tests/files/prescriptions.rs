//! Lens files of Zemax and CODE V.

use std::path::Path;

use etendue_io::prescription::{read_glass_catalogue, read_prescription, read_prescription_with};
use etendue_scene::asset::{GlassAsset, LensFields, LensOpening, NamedGlass, PrescriptionAsset};
use etendue_spectra::glass;

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

/// A glass of a built-in catalogue.
fn built_in(name: &str) -> GlassAsset {
    let glass = glass::by_name(name).unwrap_or_else(|error| panic!("{error}"));
    GlassAsset::Named(Box::new(NamedGlass::built_in(glass)))
}

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
    assert_eq!(front.glass, built_in("N-BK7"));
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
    assert!(zmx("GLAS N-BK7", "GLAS UNOBTAINIUM").starts_with(&format!("{line}: unknown glass `UNOBTAINIUM`")));
    assert!(zmx("TYPE EVENASPH", "TYPE COORDBRK").contains("type COORDBRK"));
    assert!(zmx("MODE SEQ", "MODE NSC").starts_with("2: a non-sequential lens"));
    assert!(zmx("  STOP\n", "").contains("0 surfaces are aperture stops"));
    assert!(zmx("CURV 0.04", "CURV x").contains("CURV: found `x`; expected a number"));
    assert!(zmx("UNIT MM", "UNIT FURLONG").contains("UNIT is `FURLONG`"));
    let seq = |from: &str, to: &str| read("lens.seq", &SEQ.replacen(from, to, 1)).expect_err("refused");
    assert!(seq("NBK7_SCHOTT", "'mine'").contains("unknown glass `mine`"));
    assert!(
        seq("SO 0.0", "PRV\nPWL 600 500\n'mine' 1.5\nEND\nSO 0.0")
            .contains("1 of 2 indices; expected one for each wavelength")
    );
    let working = read("lens.zmx", &ZMX.replace("ENPD 10.0", "FNUM 4 1")).expect("a working f-number");
    assert_eq!(working.opening, Some(LensOpening::ImageCone { sine: 0.125 }));
    assert!(zmx("ENPD 10.0", "ENPD 0").contains("ENPD is 0; expected a number above 0"));
    assert!(zmx("CLAP 0 6.5 0", "OBSC 2 6.5 0").contains("in the form of a ring is not supported"));
    assert!(seq("  ASP", "  XDE 0.1").contains("XDE is not supported"));
    assert!(seq("RDM;LEN", "LEN").contains("surfaces precede RDM"));
    assert!(seq("  ASP", "  RMD TIR").contains("RMD TIR is not supported"));
    assert!(read("lens.txt", SEQ).expect_err("what kind").contains(".zmx"));
    assert!(read_prescription(Path::new("nowhere.zmx")).is_err());
}

fn glass_of(zmx_line: &str) -> (GlassAsset, Vec<String>) {
    let text = ZMX.replace("GLAS N-BK7 0 0 1.5 4.0E+1", zmx_line);
    let lens = read("lens.zmx", &text).expect("a lens");
    (lens.surfaces[0].glass.clone(), lens.notes)
}

/// Leftover numbers of an earlier model glass do not describe a catalogue glass.
#[test]
fn a_glass_of_no_catalogue_here_is_its_successor_whatever_numbers_are_left_over() {
    for (line, today) in [
        ("GLAS SK16 0 0 1.5 4.0E+1", "N-SK16"),
        ("GLAS SK2 0 0 1.61765 5.514E+1", "N-SK2"),
        ("GLAS LAK8 0 0 1.7762 4.94E+1", "N-LAK8"),
    ] {
        let (glass, notes) = glass_of(line);
        assert_eq!(glass, built_in(today));
        let message = format!(
            "line 26: {} is discontinued: its successor {today} is used",
            &line[5..line.find(" 0").expect("a mode")]
        );
        assert!(notes[0].starts_with(&message), "{notes:?}");
        assert_eq!(
            notes[0].contains("of its line, which are not used for a catalogue glass"),
            !line.contains("1.5 "),
            "{notes:?}"
        );
    }
    assert_eq!(glass_of("GLAS N-BK7 0 0 1.5 4.0E+1").1, Vec::<String>::new());
    let (glass, notes) = glass_of("GLAS 517642 0 0 1.5 4.0E+1");
    assert!(
        matches!(glass, GlassAsset::Abbe { index, abbe } if (index - 1.517).abs() < 1e-12 && (abbe - 64.2).abs() < 1e-9)
    );
    assert!(notes.is_empty());
    // Ohara's discontinued glasses are built in.
    assert_eq!(glass_of("GLAS LAH66 0 0 1.7762 4.94E+1"), (built_in("LAH66"), Vec::new()));
    for (name, today) in [("SK16_SCHOTT", "N-SK16"), ("LAK8_SCHOTT", "N-LAK8"), ("LAK8", "N-LAK8")] {
        let old = read("lens.seq", &SEQ.replace("NBK7_SCHOTT", name)).expect("a lens");
        assert_eq!(old.surfaces[0].glass, built_in(today));
        assert!(old.notes[0].contains(&format!("line 11: {name} is discontinued")), "{:?}", old.notes);
    }
    let other = read("lens.seq", &SEQ.replace("NBK7_SCHOTT", "LAH66_SCHOTT")).expect_err("not Schott's");
    assert!(other.contains("unknown glass `LAH66_SCHOTT`"), "{other}");
}

#[test]
fn a_glass_without_successor_is_taken_by_its_line_and_one_name_has_one_index() {
    let (glass, notes) = glass_of("GLAS XGLASS7 0 0 1.59282 68.63");
    assert_eq!(glass, GlassAsset::Abbe { index: 1.59282, abbe: 68.63 });
    assert!(notes[0].contains("line 26: XGLASS7 is in no supported catalogue: n_d 1.59282 and V_d 68.63"), "{notes:?}");
    let twice = |second: &str| {
        let text = ZMX.replace("GLAS N-BK7 0 0 1.5 4.0E+1", "GLAS XGLASS7 0 0 1.59282 68.63");
        read("lens.zmx", &text.replace("GLAS ___BLANK 1 0 1.62004 36.4 0", second))
    };
    assert!(twice("GLAS XGLASS7 0 0 1.59282 68.63").is_ok());
    // A model glass is defined by its numbers.
    assert!(twice("GLAS XGLASS7 1 0 1.7 40").is_ok());
    let message = twice("GLAS XGLASS7 0 0 1.61765 55.14").expect_err("two indices of one glass");
    assert!(
        message.contains("XGLASS7 has n_d 1.61765 and V_d 55.14 here, n_d 1.59282 and V_d 68.63 in line 26"),
        "{message}"
    );
}

/// Makers' glasses of the case table (K2): their catalogue indices apply, whatever numbers stand on the line.
#[test]
fn glasses_of_other_makers_are_those_of_their_catalogues() {
    for name in ["H-K9L", "FCD1", "J-LASF015", "K-VC78", "F_SILICA", "CAF2", "PMMA", "POLYCARB", "E48R", "LZ_K8"] {
        let (glass, notes) = glass_of(&format!("GLAS {name} 0 0 1.5 4.0E+1"));
        assert_eq!((&glass, &notes), (&built_in(name), &Vec::new()), "{name}");
    }
    let text = ZMX.replace("GLAS N-BK7 0 0 1.5 4.0E+1", "GLAS BAF4 0 0 1.5 4.0E+1");
    let maker = |lens: &PrescriptionAsset| match &lens.surfaces[0].glass {
        GlassAsset::Named(glass) => glass.catalogue.clone(),
        other => panic!("{other:?}"),
    };
    let several = read("lens.zmx", &text).expect("a lens");
    assert_eq!(maker(&several), "schott");
    assert!(several.notes[0].contains("BAF4 is discontinued: its successor N-BAF4 is used"), "{:?}", several.notes);
    let elsewhere = read("lens.zmx", &text.replace("GLAS BAF4", "GLAS ZF10")).expect("a lens");
    assert!(
        maker(&elsewhere) == "cdgm" && elsewhere.notes.iter().all(|note| note.contains("ZF10")),
        "{:?}",
        elsewhere.notes
    );
    let stated = read("lens.zmx", &text.replace("UNIT MM", "GCAT SCHOTT CDGM\nUNIT MM")).expect("a lens");
    assert_eq!((maker(&stated), stated.notes.len()), ("cdgm".to_owned(), 0));
}

#[test]
fn a_given_catalogue_comes_first_and_its_unusable_glasses_are_refused_by_name() {
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str, text: &str| {
        let file = folder.path().join(name);
        std::fs::write(&file, text).expect("written");
        file
    };
    let agf =
        write("own.agf", "CC mine\nNM N-BK7 2 0 1.6 60 0\nCD 1.56 0.0 0 0 0 0\nLD 0.3 1.2\nNM BAD 1 0 1 0\nCD 0.5\n");
    let own = [read_glass_catalogue(&agf).expect("a catalogue")];
    let lens = read_prescription_with(&write("lens.zmx", ZMX), &own).expect("a lens");
    let GlassAsset::Named(glass) = &lens.surfaces[0].glass else { panic!("{:?}", lens.surfaces[0].glass) };
    // n² = 1 + 1.56.
    assert!(glass.catalogue == "own.agf" && (glass.dispersion.index(587.56) - 1.6).abs() < 1e-12, "{glass:?}");
    let bad = write("bad.zmx", &ZMX.replace("GLAS N-BK7", "GLAS BAD"));
    let error = read_prescription_with(&bad, &own).expect_err("an index of 0.7").to_string();
    assert!(error.contains("the glass BAD") && error.contains("line 5 of"), "{error}");
    let none = write("none.agf", "hello\n");
    assert!(read_glass_catalogue(&none).is_err());
}

/// K4: a model glass with V_d = 0 has no dispersion.
#[test]
fn a_model_glass_without_abbe_number_has_one_index() {
    assert_eq!(glass_of("GLAS ___BLANK 1 0 1.5168 0").0, GlassAsset::Index(1.5168));
}

#[test]
fn private_glasses_of_a_file_are_its_indices() {
    // Cauchy's own curve: 1.5 + 0.004/λ² (µm).
    let index = |nm: f64| 1.5 + 4e3 / (nm * nm);
    let lines = [656.27, 587.56, 486.13].map(|nm| format!("{:.12}", index(nm))).join(" ");
    let catalogue = format!("PRV\n PWL 656.27 587.56 486.13\n 'MINE' {lines}\nEND\nSO 0.0");
    let text = SEQ.replace("SO 0.0", &catalogue).replace("NBK7_SCHOTT", "'mine'");
    let lens = read("lens.seq", &text).expect("a lens");
    let GlassAsset::Abbe { index: n, abbe } = lens.surfaces[0].glass else { panic!("{:?}", lens.surfaces[0].glass) };
    let expected = (index(587.5618) - 1.0) / (index(486.1327) - index(656.2725));
    assert!((n - index(587.5618)).abs() < 1e-9 && (abbe / expected - 1.0).abs() < 1e-6, "{n} {abbe} {expected}");
    let one = SEQ.replace("SO 0.0", "PRV\nPWL 587.56\n'W' 1.7\nEND\nSO 0.0").replace("NBK7_SCHOTT", "'W'");
    assert_eq!(read("lens.seq", &one).expect("a lens").surfaces[0].glass, GlassAsset::Index(1.7));
}

/// The files with a near object: 205 mm in front of the lens.
fn near_zmx() -> String {
    ZMX.replacen("DISZ INFINITY", "DISZ 200", 1)
}

fn near_seq() -> String {
    SEQ.replace("0.1e14", "200.0")
}

#[test]
fn apertures_of_every_kind_and_what_has_none() {
    let opening = |line: &str| read("lens.zmx", &near_zmx().replace("ENPD 10.0", line)).expect("a lens").opening;
    assert_eq!(opening("FLOA"), None);
    assert_eq!(opening("FNUM 4.0 0"), Some(LensOpening::FNumber { f_number: 4.0 }));
    assert_eq!(opening("OBNA 0.1 0"), Some(LensOpening::ObjectCone { sine: 0.1 }));
    let Some(LensOpening::ObjectCone { sine }) = opening("OBNA 30 1") else { panic!("a cone") };
    assert!((sine - 0.5).abs() < 1e-12);
    let seq = |line: &str| read("lens.seq", &near_seq().replace("EPD 10.0", line)).expect("a lens");
    assert_eq!(seq("NAO 0.1").opening, Some(LensOpening::ObjectCone { sine: 0.1 }));
    assert_eq!(seq("NA 0.1").opening, Some(LensOpening::ImageCone { sine: 0.1 }));
    assert_eq!(seq("FNO 5").opening, Some(LensOpening::ImageCone { sine: 0.1 }));
    assert_eq!(seq("NA 0.1").opening_line, 3);
    assert_eq!(seq("EPD 10\nVUY 0 0.2 0.4\nVLY 0 0.1 0.3").vignetting, [vec![0.0, 0.2, 0.4], vec![0.0, 0.1, 0.3]]);
}

#[test]
fn an_aperture_that_is_none_is_refused_at_its_line() {
    let zmx = |line: &str| read("lens.zmx", &near_zmx().replace("ENPD 10.0", line)).expect_err(line);
    for (line, start) in [
        ("OBNA 1.0 0", "5: OBNA is 1.0; expected a number above 0 and below 1"),
        ("OBNA 0 0", "5: OBNA is 0; expected"),
        ("OBNA 90 1", "5: OBNA is 90; expected a number of degrees above 0 and below 90"),
        ("FNUM 0.5 0", "5: FNUM is 0.5; expected a number above 0.5"),
    ] {
        assert!(zmx(line).starts_with(start), "{}", zmx(line));
    }
    let seq = |line: &str| read("lens.seq", &near_seq().replace("EPD 10.0", line)).expect_err(line);
    for line in ["NA 0", "NA 1", "NA -0.2", "NAO 0", "NAO 1.2", "FNO 0", "EPD 0", "EPD -1"] {
        let name = line.split(' ').next().expect("a name");
        assert!(seq(line).starts_with(&format!("3: {name} is ")), "{}", seq(line));
    }
    // A cone from an object at infinity.
    let far = read("lens.seq", &SEQ.replace("EPD 10.0", "NAO 0.1")).expect_err("no object");
    assert!(far.starts_with("3: the aperture is a cone of light from the object"), "{far}");
}

#[test]
fn object_and_image_stand_where_the_file_has_them() {
    // The dummy surface in front of the lens is 5 mm thick.
    let near = read("lens.zmx", &ZMX.replacen("DISZ INFINITY", "DISZ 200", 1)).expect("a lens");
    assert_eq!((near.object_distance_mm, near.back_focus_mm, near.defocus_mm), (205.0, 40.0, 0.0));
    // CODE V: the image's thickness is a defocus; PIM lets the program compute the image position.
    let shifted = read("lens.seq", &SEQ.replace("SI 0.0 0.0", "SI 0.0 -0.25")).expect("a lens");
    assert_eq!((shifted.back_focus_mm, shifted.defocus_mm), (39.75, 0.0));
    let lens_with_image = read("lens.seq", &SEQ.replace("SI 0.0 0.0", "  PIM\nSI 0.0 -0.25")).expect("a lens");
    assert_eq!((lens_with_image.back_focus_mm, lens_with_image.defocus_mm), (0.0, -0.25));
}

/// A singlet, with edits before GO.
fn edited(edits: &str) -> Result<PrescriptionAsset, String> {
    read(
        "lens.seq",
        &format!(
            "RDM;LEN\nEPD 5\nDIM M\nWL 587.6\nYAN 0\nSO 0 1e13\nS 50 4 NBK7_SCHOTT\n STO\n CIR 6\nS -50 47\n CIR 6\nSI 0 0\n{edits}\nGO\n"
        ),
    )
}

#[test]
fn edits_of_named_surfaces_and_of_the_whole_lens_count() {
    let radius = edited("RDY S1 25\nCUY S2 -0.04").expect("a lens");
    assert_eq!((radius.surfaces[0].radius_mm, radius.surfaces[1].radius_mm), (25.0, -25.0));
    let glass = edited("THI S1 8\nGLA S1 SF6_SCHOTT\nTHI S2 40").expect("a lens");
    assert_eq!((glass.surfaces[0].thickness_mm, glass.back_focus_mm), (8.0, 40.0));
    assert_eq!(glass.surfaces[0].glass, built_in("SF6"));
    let both = edited("CIR S1..2 5\nK SA -1\nSTO S2\nA S2 1e-6; J S2 1e-20\nTHI SO 100\nTHI SI -0.1").expect("a lens");
    assert!(both.surfaces.iter().all(|s| s.semi_aperture_mm == Some(5.0) && s.conic == -1.0));
    assert_eq!(both.surfaces.iter().map(|s| s.stop).collect::<Vec<_>>(), [false, true]);
    let [_, a, .., h, j] = both.surfaces[1].asphere;
    assert_eq!((a, h, j, both.object_distance_mm), (1e-6, 0.0, 1e-20, 100.0));
    assert!((both.back_focus_mm - 46.9).abs() < 1e-12);
    let line = edited("S1 25 8\n CIR 7").expect("a lens");
    assert_eq!((line.surfaces[0].radius_mm, line.surfaces[0].thickness_mm), (25.0, 8.0));
    assert_eq!((line.surfaces[0].semi_aperture_mm, line.surfaces[0].glass.clone()), (Some(7.0), built_in("N-BK7")));
    let large = edited("A S1 1e-6\nSCA 2\nCIR S2 6").expect("a lens");
    let [front, back] = &large.surfaces[..] else { panic!("two surfaces") };
    assert_eq!((front.radius_mm, front.thickness_mm, front.semi_aperture_mm), (100.0, 8.0, Some(12.0)));
    assert_eq!((front.asphere[1], back.semi_aperture_mm, large.back_focus_mm), (1e-6 / 8.0, Some(6.0), 94.0));
    assert_eq!(large.opening, Some(LensOpening::EntrancePupil { diameter_mm: 10.0 }));
}

#[test]
fn commands_of_codev_that_are_not_read_are_refused_or_noted() {
    for (edit, start) in [
        ("RDY S7 25", "13: RDY S7: no such surface is defined before"),
        ("RDY S1 Z2 25", "13: RDY of a zoom position"),
        ("THI S2 PIM", "13: THI: found `PIM`; expected a number"),
        ("SCA EFL 100", "13: SCA: expected one factor above 0"),
        ("SCA 0", "13: SCA: expected one factor above 0"),
        ("INS S2", "13: INS is not supported"),
        ("DEL S2", "13: DEL is not supported"),
        ("RDX S1 30", "13: RDX is not supported"),
        ("S 0 1", "13: S: expected a surface defined before (S0 to S3)"),
        ("S9 0 1", "13: S9: expected a surface defined before"),
    ] {
        let message = edited(edit).map(|_| ()).expect_err(edit);
        assert!(message.starts_with(start), "{edit}: {message}");
    }
    let noted = edited("XYZ 3\nAUT\nCCY S1 100").expect("a lens");
    assert!(noted.notes[0].ends_with("XYZ (line 13), AUT (line 14)"), "{:?}", noted.notes);
    let solve = read("lens.seq", &SEQ.replace("S -50.0 2.0", "S -50.0 2.0\n CUY UMY -0.1")).expect("a lens");
    assert_eq!(solve.surfaces[1].radius_mm, -50.0);
    assert!(solve.notes[0].starts_with("line 14: the solve CUY UMY -0.1 is ignored"), "{:?}", solve.notes);
}

#[test]
fn planes_with_an_aperture_stay_and_a_mask_in_the_image_is_noted() {
    let baffle = read("lens.zmx", &ZMX.replacen("  DIAM 9 1", "  DIAM 9 1\n  CLAP 0 8 0", 1)).expect("a lens");
    assert_eq!(baffle.surfaces.len(), 6);
    let plane = &baffle.surfaces[0];
    assert_eq!((plane.semi_aperture_mm, plane.clips_light, plane.thickness_mm, plane.line), (Some(8.0), true, 5.0, 17));
    let field_stop = read("lens.seq", &SEQ.replace("S 20.0 40.0", "S 20.0 30.0\nS 0 10.0\n CIR 4")).expect("a lens");
    assert_eq!((field_stop.surfaces.len(), field_stop.surfaces[5].semi_aperture_mm), (6, Some(4.0)));
    assert_eq!(field_stop.back_focus_mm, 10.0);
    let mask = read("lens.seq", &SEQ.replace("SI 0.0", "S 0 0\n CIR 4\nSI 0.0")).expect("a lens");
    assert_eq!((mask.surfaces.len(), mask.back_focus_mm), (5, 40.0));
    assert!(mask.notes[0].contains("an aperture in the image plane is not modelled"), "{:?}", mask.notes);
}

#[test]
fn parameters_of_a_standard_surface_are_no_coefficients() {
    let text = ZMX.replace("TYPE EVENASPH", "TYPE STANDARD");
    let lens = read("lens.zmx", &text).expect("a lens");
    assert_eq!(lens.surfaces[1].asphere, [0.0; 10]);
}

/// Radii, thicknesses and conics as light meets them: the Cassegrain of both programs, in inches.
#[test]
fn mirrors_are_unfolded() {
    let zmx = "MODE SEQ\nUNIT IN X W\nENPD 10\nWAVM 1 0.55 1\nPWAV 1\nSURF 0\n  TYPE STANDARD\n  CURV 0\n  DISZ INFINITY\n\
               SURF 1\n  TYPE STANDARD\n  CURV 0\n  DISZ 30\n  OBSC 0 2 0\n  DIAM 2\n\
               SURF 2\n  STOP\n  TYPE EVENASPH\n  CURV -0.0125\n  CONI -1\n  PARM 2 1e-6\n  GLAS MIRROR 0 0 1.5 40\n  DISZ -30\n  CLAP 1.5 5 0\n\
               SURF 3\n  TYPE EVENASPH\n  CURV -0.025\n  CONI -9\n  PARM 2 -2e-6\n  GLAS MIRROR 0 0 1.5 40\n  DISZ 10\n  DIAM 1.8\n\
               SURF 4\n  TYPE STANDARD\n  CURV 0\n  DISZ 10\n  DIAM 3\nSURF 5\n  TYPE STANDARD\n  CURV 0\n  DISZ 0\n";
    let seq = "RDM\nDIM I\nEPD 10\nWL 550\nSO 0 1e13\nS 0 30\n CIR OBS 2\n CIR 10\nS -80 -30 REFL\n STO\n K -1\n A 1e-6\n CIR 5\n CIR HOL L'B' 1.5\n\
               S -40 10\n RMD REFL\n K -9\n A -2e-6\n CIR 1.8\nS 0 10\n XDE 0.0; ADE 0\nSI 0 0\nGO\n";
    for lens in [read("lens.zmx", zmx).expect("a lens"), read("lens.seq", seq).expect("a lens")] {
        let [disc, primary, secondary] = &lens.surfaces[..] else { panic!("{:?}", lens.surfaces) };
        assert!(primary.mirror && secondary.mirror && !disc.mirror && primary.stop);
        // The plane with the disc does not clip at the disc's own size.
        assert!(disc.obscured_radius_mm == 50.8 && disc.semi_aperture_mm.is_some_and(|mm| mm >= 250.0), "{disc:?}");
        assert!((primary.obscured_radius_mm - 38.1).abs() < 1e-12 && secondary.obscured_radius_mm == 0.0);
        assert!((primary.radius_mm + 2032.0).abs() < 1e-9 && (secondary.radius_mm - 1016.0).abs() < 1e-9);
        // The sag of r⁴ turns with z: 1 in⁻³ is 25.4⁻³ mm⁻³.
        let per_mm3 = 1.0 / (25.4 * 25.4 * 25.4);
        assert!((primary.asphere[1] / (1e-6 * per_mm3) - 1.0).abs() < 1e-12);
        assert!((secondary.asphere[1] / (2e-6 * per_mm3) - 1.0).abs() < 1e-12);
        let thickness: Vec<f64> = lens.surfaces.iter().map(|s| s.thickness_mm).collect();
        assert_eq!(thickness, [762.0, 762.0, 508.0]);
        assert!((lens.back_focus_mm - 508.0).abs() < 1e-9);
    }
}

#[test]
fn a_mirror_keeps_the_medium_before_it_and_codev_s_first_surface_is_the_stop() {
    let mangin = "RDM\nEPD 20\nSO 0 1e13\nS -120 5 NBK7_SCHOTT\nS -100 -5 REFL\nS -120 -50\nSI 0 -0.5\nGO\n";
    let lens = read("lens.seq", mangin).expect("a lens");
    let glass = built_in("N-BK7");
    let [front, mirror, back] = &lens.surfaces[..] else { panic!("three surfaces") };
    assert_eq!((&front.glass, &mirror.glass, &back.glass), (&glass, &glass, &GlassAsset::Air));
    // Behind the mirror z is reversed: the same surface is convex towards the light, and the image 0.5 mm further along it.
    assert_eq!([front.radius_mm, mirror.radius_mm, back.radius_mm], [-120.0, -100.0, 120.0]);
    assert_eq!((mirror.thickness_mm, lens.back_focus_mm), (5.0, 50.5));
    assert!(front.stop && lens.notes.iter().any(|note| note.contains("no surface is the stop")), "{:?}", lens.notes);
}

#[test]
fn dummy_ideal_and_odd_surfaces_of_zemax() {
    let with = |from: &str, to: &str| read("lens.zmx", &ZMX.replacen(from, to, 1));
    let zeros = "TYPE COORDBRK\n  PARM 1 0\n  PARM 4 0.0\n  PARM 6 1\n";
    is_the_triplet(&with("TYPE STANDARD\n  CURV 0.0\n  DISZ 5.0", &format!("{zeros}  DISZ 5.0")).expect("a dummy"));
    // Inside a glass a coordinate break is in that glass.
    let split = format!(
        "DISZ 1.5\n  GLAS N-BK7 0 0 1.5 40\nSURF 3\n  {zeros}  DISZ 2.0\n  DIAM 0\nSURF 4\n  TYPE STANDARD\n  CURV 0\n  DISZ 0\n"
    );
    let inside = with("DISZ 3.5\n", &split).expect("a lens");
    assert_eq!((inside.surfaces[0].thickness_mm, inside.surfaces.len()), (3.5, 5));
    let tilted =
        with("TYPE STANDARD\n  CURV 0.0\n  DISZ 5.0", "TYPE COORDBRK\n  PARM 3 5\n  DISZ 5.0").expect_err("a tilt");
    assert!(tilted.contains("surface 1 of type COORDBRK shifts or tilts by 5 (PARM 3)"), "{tilted}");
    let ideal =
        with("TYPE STANDARD\n  CURV 0.0\n  DISZ 5.0", "TYPE PARAXIAL\n  CURV 0\n  PARM 1 80\n  PARM 2 1\n  DISZ 5.0");
    let ideal = ideal.expect("a lens");
    assert_eq!((ideal.surfaces[0].thin_lens_mm, ideal.surfaces.len()), (Some(80.0), 6));
    let in_glass =
        with("TYPE STANDARD\n  CURV 0.0\n  DISZ 1.0", "TYPE PARAXIAL\n  PARM 1 80\n  GLAS N-BK7\n  DISZ 1.0");
    assert!(in_glass.expect_err("in glass").contains("surface 4 of type PARAXIAL"));
    // PARM i of an ODDASPHE belongs to rⁱ.
    let odd = with(
        "TYPE EVENASPH\n  CURV -0.02\n  PARM 1 0\n  PARM 2 1.1E-5\n  PARM 3 -2.0E-8",
        "TYPE ODDASPHE\n  CURV -0.02\n  PARM 3 0\n  PARM 4 1.1E-5\n  PARM 6 -2.0E-8",
    );
    is_the_triplet(&odd.expect("even terms alone"));
    let cubic =
        with("TYPE EVENASPH\n  CURV -0.02\n  PARM 1 0", "TYPE ODDASPHE\n  CURV -0.02\n  PARM 3 1e-5").expect_err("r³");
    assert!(cubic.contains("surface 3 of type ODDASPHE has 0.00001 as its coefficient of r^3"), "{cubic}");
}
