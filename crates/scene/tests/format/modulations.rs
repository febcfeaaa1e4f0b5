//! Contradictions of lights with modulated strength.

use crate::files::{DescriptionFiles, load};

/// Errors of a job with `more` appended, one per line.
fn errors_of_job(more: &str) -> String {
    load(&DescriptionFiles::with_camera(more), &[]).err().map_or(String::new(), |f| f.to_string())
}

fn lamp(keys: &str) -> String {
    let lamp = "[[scene.lights]]\nname = \"l\"\ntype = \"point\"\nintensity_cd = 100\nilluminant = \"A\"\n";
    errors_of_job(&format!("{lamp}{keys}\n"))
}

fn modulated(keys: &str) -> String {
    lamp(&format!("position_m = [0, 0, 5]\nmodulation = {{ {keys} }}"))
}

#[test]
fn every_modulation_is_read() {
    for keys in [
        "type = \"pwm\", frequency_hz = 90, duty_cycle = 0.1",
        "type = \"pwm\", frequency_hz = 90, duty_cycle = 0.1, rise_s = 1e-4, fall_s = 2e-4, delay_s = -0.001, phases = \"random\"",
        "type = \"mains\", frequency_hz = 50, modulation_depth = 0.3",
        "type = \"blink\", frequency_hz = 1.5, on_fraction = 0.4, rise_s = 0.05, fall_s = 0.1",
        "type = \"table\", points = [[0, 1], [0.5, 0], [2, 1]], period_s = 2, phases = \"random\"",
        "type = \"table\", file = \"flash.csv\", interpolation = \"steps\"",
        "type = \"programme\", steps = [{ level = 1, duration_s = 20 }, { level = 0, duration_s = 30 }], delay_s = 3",
        "type = \"programme\", steps = [{ level = 0, duration_s = 2 }, { level = 1, duration_s = 1 }], repeats = false",
    ] {
        assert_eq!(modulated(keys), "", "{keys}");
    }
}

#[test]
fn invalid_modulations_are_reported_with_their_place() {
    for (keys, problem) in [
        ("type = \"pwm\", frequency_hz = 90, duty_cycle = 1", "modulation.duty_cycle: found 1"),
        ("type = \"pwm\", frequency_hz = 0, duty_cycle = 0.5", "modulation.frequency_hz: found 0"),
        (
            "type = \"pwm\", frequency_hz = 100, duty_cycle = 0.1, rise_s = 0.003",
            "modulation: half of the rise time plus half of the fall time",
        ),
        ("type = \"blink\", frequency_hz = 100, fall_s = 0.02", "more than the shorter of pulse and pause, 0.005 s"),
        ("type = \"mains\", frequency_hz = 50, modulation_depth = 1.2", "modulation_depth: found 1.2"),
        ("type = \"table\", points = [[0, 1], [0, 2]]", "the time 0 s follows 0 s; give the times in increasing order"),
        ("type = \"table\", points = [[0, 0], [1, 0]]", "dark at all times"),
        ("type = \"table\", points = [[0, 1], [1, -1]]", "found the level -1"),
        ("type = \"table\", points = [[0, 1], [2, 0]], period_s = 1", "the table lasts 2 s, but its period is 1 s"),
        ("type = \"table\", points = [[0, 1], [2, 0]], file = \"a.csv\"", "\"points\", \"file\" contradict each other"),
        (
            "type = \"table\", points = [[0, 1], [2, 0]], phases = \"random\"",
            "modulation.phases: \"phases\" has no effect",
        ),
        ("type = \"programme\"", "the programme has no steps"),
        ("type = \"programme\", steps = [{ level = 0, duration_s = 2 }]", "dark at all times"),
        (
            "type = \"programme\", steps = [{ level = 1, duration_s = 2 }], repeats = false, phases = \"random\"",
            "\"phases\" has no effect on a modulation that does not repeat; remove it, or let it repeat",
        ),
        (
            "type = \"pwm\", frequency_hz = 90, duty_cycle = 0.1, multiplexed_rows = 16",
            "multiplexed_rows: this light has no rows",
        ),
        ("type = \"pulses\", frequency_hz = 90", "modulation.type: found the text \"pulses\""),
    ] {
        let message = modulated(keys);
        assert!(message.contains(problem) && message.contains("scene.lights.l.modulation"), "{keys}: {message}");
    }
}

#[test]
fn places_have_delays_where_there_is_something_to_delay() {
    let places = "instances = [{ position_m = [0, 0, 5] }, { position_m = [9, 0, 5], modulation_delay_s = 0.002 }]";
    assert_eq!(
        lamp(&format!("{places}\nmodulation = {{ type = \"mains\", frequency_hz = 50, modulation_depth = 1 }}")),
        ""
    );
    let idle = lamp(places);
    assert!(
        idle.contains("instances[1].modulation_delay_s: \"modulation_delay_s\" has no effect on an unmodulated light"),
        "{idle}"
    );
}

#[test]
fn surroundings_do_not_go_up_and_down() {
    let sky = "[scene.environment]\ntype = \"uniform\"\nluminance_cd_m2 = 1\nilluminant = \"A\"\n";
    assert_eq!(errors_of_job(sky), "");
    let message =
        errors_of_job(&format!("{sky}modulation = {{ type = \"mains\", frequency_hz = 50, modulation_depth = 1 }}\n"));
    assert!(message.contains("modulation"), "{message}");
}
