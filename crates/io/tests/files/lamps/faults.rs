//! Refused files: place, error, expected form.

use super::support::{Ies, Ldt, read_bytes, steps};

fn ies() -> String {
    Ies::new(1, &[0.0, 90.0], &[0.0, 45.0, 90.0], |_, _| 5.0).text()
}

fn headlamp() -> String {
    Ies::new(3, &[-10.0, 10.0], &[-5.0, 0.0, 5.0], |_, _| 5.0).text()
}

fn refusal(name: &str, text: &str, change: (&str, &str)) -> String {
    assert!(text.contains(change.0), "{name} has no {}:\n{text}", change.0);
    read_bytes(name, text.replacen(change.0, change.1, 1).as_bytes()).expect_err(change.1)
}

#[test]
fn errors_of_ies_files_are_reported_with_their_lines() {
    for (change, expected) in [
        (
            ("TILT=NONE\n", ""),
            "a.ies: no line begins with TILT=; expected TILT=NONE, TILT=INCLUDE or TILT=file before the numbers",
        ),
        (("TILT=NONE", "TILT="), "a.ies:5: nothing follows TILT=; expected NONE, INCLUDE or the name of a file"),
        (
            ("0 45 90\n", "0 45\n"),
            "a.ies:9: vertical angle 3 of 3 is 0° and follows 45°: sort the angles in increasing order, each once, or correct their number",
        ),
        (
            ("0 45 90\n", "0 45 60 90\n"),
            "a.ies:9: horizontal angle 2 of 2 is 0° and follows 90°: sort the angles in increasing order",
        ),
        (
            ("0 45 90\n", "0 90 45\n"),
            "a.ies:8: vertical angle 3 of 3 is 45° and follows 90°: sort the angles in increasing order",
        ),
        (
            ("0 45 90\n", "0 45 45\n"),
            "a.ies:8: vertical angle 3 of 3 is 45° and follows 45°: sort the angles in increasing order",
        ),
        (("0 45 90\n", "0 45 190\n"), "a.ies:8: the vertical angle is 190°; expected 0° to 180°"),
        (("0 45 90\n", "0 45 x\n"), "a.ies:8: found \"x\"; expected vertical angle 3 of 3: a number"),
        (
            ("\n0 90\n", "\n0 80\n"),
            "a.ies:9: found horizontal angles from 0° to 80°; expected 0° alone, or from 0° to 90°, 180° or 360°, or from 90° to 270°",
        ),
        (("5 5 5\n", "5 -5 5\n"), "a.ies:10: the intensity is -5; expected 0 or more"),
        (("5 5 5\n", "5 NaN 5\n"), "a.ies:10: found \"NaN\"; expected intensity 2 of 6: a number"),
        (("5 5 5\n", "5 1e999 5\n"), "a.ies:10: found \"1e999\"; expected intensity 2 of 6: a number"),
        (
            ("5 5 5\n", "5 5\n"),
            "a.ies:11: the file ends here; expected intensity 6 of 6: it is truncated, or its numbers",
        ),
        (
            ("5 5 5\n", "5 5 5 5 5\n"),
            "a.ies:11: found \"5\" and 1 more values after the last intensity; expected the end of the file",
        ),
        (
            ("1 -1 1 3 2 1 2", "1 -1 1 3 2 4 2"),
            "a.ies:6: found 4; expected the photometric type (1 is C, 2 is B, 3 is A): a whole number from 1 to 3",
        ),
        (("1 -1 1 3 2 1 2", "1 -1 1 3 2 1 3"), "a.ies:6: found 3; expected the unit (1 feet, 2 metres)"),
        (
            ("1 -1 1 3 2 1 2", "1 -2 1 3 2 1 2"),
            "a.ies:6: found -2 lumens; expected the lumens per lamp, or -1 for absolute photometry",
        ),
        (("1 -1 1 3 2 1 2", "0 -1 1 3 2 1 2"), "a.ies:6: found 0; expected the number of lamps: a whole number from 1"),
        (("1 -1 1 3 2 1 2", "1 -1 0 3 2 1 2"), "a.ies:6: found 0; expected the multiplier of the intensities: above 0"),
        (
            ("1 -1 1 3 2 1 2", "1 -1 1 3.5 2 1 2"),
            "a.ies:6: found 3.5; expected the number of vertical angles: a whole number from 2",
        ),
        (
            ("1 -1 1 3 2 1 2", "1 -1 1 4000000000 2 1 2"),
            "a.ies:6: found 4000000000; expected the number of vertical angles: a whole number from 2 to 36001",
        ),
        (("5 5 5\n5 5 5", "0 0 0\n0 0 0"), "a.ies: all intensities are 0"),
        (
            ("TILT=NONE", "TILT=INCLUDE\n4\n1 0 1"),
            "a.ies:6: found 4; expected the lamp-to-luminaire geometry: a whole number from 1 to 3",
        ),
        (
            ("TILT=NONE", "TILT=INCLUDE\n1\n2 90 0 1 1"),
            "a.ies:7: tilt angle 2 of 2 is 0° and follows 90°: sort the angles in increasing order",
        ),
    ] {
        let message = refusal("a.ies", &ies(), change);
        assert!(message.starts_with(expected), "{change:?}: {message}");
    }
}

#[test]
fn a_fan_needs_a_width_and_angles_that_its_axes_have() {
    for (change, expected) in [
        (("\n-10 10\n", "\n-100 100\n"), None),
        (("\n-10 10\n", "\n-190 10\n"), Some("a.ies:9: the horizontal angle is -190°; expected -180° to 180°")),
        (("-5 0 5\n", "-95 0 5\n"), Some("a.ies:8: the vertical angle is -95°; expected -90° to 90°")),
    ] {
        let result = read_bytes("a.ies", headlamp().replacen(change.0, change.1, 1).as_bytes());
        assert_eq!(result.err().as_deref().map(|t| t.starts_with(expected.unwrap_or("?"))), expected.map(|_| true));
    }
    let narrow = Ies::new(3, &[0.0], &[-5.0, 5.0], |_, _| 1.0).text();
    let message = read_bytes("a.ies", narrow.as_bytes()).expect_err("no width");
    assert!(message.starts_with("a.ies:9: found one horizontal angle; expected at least two"), "{message}");
}

#[test]
fn counts_that_no_file_holds_cost_no_memory() {
    let all = ies().replacen("1 -1 1 3 2 1 2", "1 -1 1 36001 36001 1 2", 1);
    let text = all.split("\n0 90\n").next().expect("what stands before the planes");
    let message = read_bytes("a.ies", text.as_bytes()).expect_err("three angles of 36001");
    assert!(message.starts_with("a.ies:8: the file ends here; expected vertical angle 4 of 36001"), "{message}");
}

fn ldt() -> String {
    Ldt::new(4, &[0.0, 90.0, 180.0, 270.0], &[0.0, 90.0], &[0.0, 45.0, 90.0], |_, _| 160.0).text()
}

#[test]
fn errors_of_eulumdat_files_are_reported_with_their_lines() {
    let lines: Vec<String> = ldt().lines().map(str::to_owned).collect();
    let with = |line: usize, text: &str| {
        let mut lines = lines.clone();
        lines[line - 1] = text.to_owned();
        read_bytes("a.ldt", lines.join("\n").as_bytes()).expect_err(text)
    };
    for (line, text, expected) in [
        (2, "9", "a.ldt:2: found 9; expected the type of the luminaire (1, 2 or 3)"),
        (
            3,
            "5",
            "a.ldt:3: found 5; expected the symmetry (0 none, 1 rotational, 2 about C0, 3 about C90, 4 both): a whole number from 0 to 4",
        ),
        (4, "", "a.ldt:4: found \"\"; expected the number of C planes: a number"),
        (6, "1", "a.ldt:6: found 1; expected the number of angles in a plane: a whole number from 2"),
        (
            6,
            "4",
            "a.ldt:55: the file ends here; expected intensity 6 of 8: it is truncated, or its numbers of angles are wrong",
        ),
        (23, "0", "a.ldt:23: found 0; expected the light output ratio, per cent: above 0"),
        (24, "-1", "a.ldt:24: found -1; expected the conversion factor of the intensities: above 0"),
        (26, "0", "a.ldt:26: found 0; expected the number of sets of lamps: a whole number from 1"),
        (27, "0", "a.ldt:27: found 0 lamps; expected their number, negative for absolute photometry"),
        (29, "", "a.ldt:29: found \"\"; expected the total lumens of the lamps: a number"),
        (44, "0", "a.ldt:44: C angle 2 of 4 is 0° and follows 0°: sort the angles in increasing order"),
        (46, "400", "a.ldt:46: the C angle is 400°; expected 0° to 360°"),
        (
            44,
            "80",
            "a.ldt:46: a light of symmetry 4 contains the planes from C0 to C90; expected them at these positions among 4 planes",
        ),
        (48, "0", "a.ldt:48: vertical angle 2 of 3 is 0° and follows 0°: sort the angles in increasing order"),
        (50, "-1", "a.ldt:50: the intensity is -1; expected 0 or more"),
        (50, "1 1", "a.ldt:55: found \"160\" and 0 more values after the last intensity; expected the end of the file"),
        (55, "", "a.ldt:54: the file ends here; expected intensity 6 of 6: it is truncated"),
    ] {
        let message = with(line, text);
        assert!(message.starts_with(expected), "line {line} {text:?}: {message}");
    }
    let message = read_bytes("a.ldt", lines[..20].join("\n").as_bytes()).expect_err("truncated");
    assert!(
        message.starts_with("a.ldt:20: the file ends here; expected the light output ratio, per cent in line 23"),
        "{message}"
    );
}

#[test]
fn what_is_no_lamp_file_is_refused_by_its_name_or_bytes() {
    assert!(
        read_bytes("a.txt", b"x")
            .expect_err("a name")
            .contains("expected a photometric file with the extension .ies (LM-63) or .ldt")
    );
    assert!(read_bytes("a.ies", b"IESNA\n\0\x01").expect_err("bytes").starts_with("a.ies:2: not text; expected"));
    assert!(read_bytes("a.ies", b"").expect_err("empty").contains("is empty"));
}

#[test]
fn no_cut_of_a_file_is_a_lamp_and_none_panics() {
    let texts = [
        ("a.ies", Ies::new(1, &steps(0.0, 90.0, 30.0), &steps(0.0, 90.0, 30.0), |_, _| 77.0).text()),
        ("a.ldt", Ldt::new(0, &[0.0, 120.0, 240.0], &[0.0, 120.0, 240.0], &[0.0, 90.0], |_, _| 160.0).text()),
    ];
    for (name, text) in texts {
        read_bytes(name, text.as_bytes()).expect("whole");
        // The last number may lose digits and still be a number.
        for end in 0..text.trim_end().len() - 3 {
            assert!(read_bytes(name, &text.as_bytes()[..end]).is_err(), "{name}, {end} bytes");
        }
    }
}
