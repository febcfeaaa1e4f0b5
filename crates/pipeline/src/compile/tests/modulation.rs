//! Time-dependent strengths in the tracer.

use super::plan;
use crate::Plan;
use etendue_core::{TimeInterval, Waveform};
use std::collections::BTreeSet;

const PWM: &str = "modulation = { type = \"pwm\", frequency_hz = 100, duty_cycle = 0.25, delay_s = 0.001";

fn lamps(keys: &str) -> Vec<Waveform> {
    let lamp = "[[scene.lights]]\nname = \"l\"\ntype = \"point\"\nintensity_cd = 100\nilluminant = \"A\"\n";
    let plan = plan(&format!("{lamp}{keys}\n")).expect("no fault");
    assert!(plan.sources.is_modulated() && !plan.material_table.is_modulated());
    plan.sources.lamps.iter().map(|lamp| lamp.modulation().expect("modulated").clone()).collect()
}

#[test]
fn the_strength_of_pulses_is_their_mean_and_that_of_a_programme_its_level_1() {
    let pulses = &lamps(&format!("position_m = [0, 0, 5]\n{PWM} }}"))[0];
    assert!((pulses.mean_level().expect("recurs") - 1.0).abs() < 1e-15 && pulses.max_level() == 4.0);
    assert_eq!([0.0, 0.0011, 0.0034, 0.0036].map(|t| pulses.at(t)), [0.0, 4.0, 4.0, 0.0]);
    let steps = "steps = [{ level = 1, duration_s = 2 }, { level = 0, duration_s = 1 }]";
    let programme = &lamps(&format!("position_m = [0, 0, 5]\nmodulation = {{ type = \"programme\", {steps} }}"))[0];
    assert_eq!([0.0, 1.9, 2.1, 3.1].map(|t| programme.at(t)), [1.0, 1.0, 0.0, 1.0]);
    let blink = &lamps("position_m = [0, 0, 5]\nmodulation = { type = \"blink\", frequency_hz = 2 }")[0];
    assert_eq!([0.1, 0.3, 0.6].map(|t| blink.at(t)), [1.0, 0.0, 1.0]);
}

#[test]
fn places_of_a_lamp_are_later_by_their_own_delay_or_by_chance() {
    let own = "instances = [{ position_m = [0, 0, 5] }, { position_m = [9, 0, 5], modulation_delay_s = 0.004 }]";
    let [first, second] = &lamps(&format!("{own}\n{PWM} }}"))[..] else { panic!("two places") };
    assert_eq!([0.002, 0.006].map(|t| [first.at(t), second.at(t)]), [[4.0, 0.0], [0.0, 4.0]]);
    let many: String = (0..40).map(|i| format!("{{ position_m = [{i}, 0, 5] }}, ")).collect();
    let street = format!("instances = [{many}]\n{PWM}, phases = \"random\" }}");
    let street_lamps = lamps(&street);
    let lit_lamps = street_lamps.iter().filter(|lamp| lamp.at(1.0) > 0.0).count();
    // A quarter of 40, standard deviation 2.7.
    assert!((2..=22).contains(&lit_lamps), "{lit_lamps}");
    assert_eq!(street_lamps, lamps(&street), "no seed tells the phases");
}

fn panel(emission: &str, place: &str) -> Result<Plan, String> {
    plan(&format!(
        "[[scene.materials]]\nname = \"led\"\ntype = \"emitter\"\n\
         emission = {{ luminance_cd_m2 = 100, illuminant = \"A\", {emission} }}\n\
         [[scene.objects]]\nname = \"panel\"\nmaterial = \"led\"\nshape = {{ type = \"quad\", size_m = [1, 1] }}\n{place}\n"
    ))
}

fn waveforms(plan: &Plan) -> Vec<&Waveform> {
    let of = |materials: &[etendue_tracer::MaterialId]| {
        let emission = plan.material_table.emission(materials[0]).expect("glows");
        emission.modulation.as_ref().map(etendue_tracer::materials::Modulation::waveform)
    };
    plan.world.instances().iter().filter_map(|instance| of(&instance.materials)).collect()
}

#[test]
fn objects_of_an_emissive_material_may_have_their_own_phases() {
    let places = "instances = [{ position_m = [0, 0, 5] }, { position_m = [9, 0, 5], modulation_delay_s = 0.004 }, { position_m = [8, 0, 5] }]";
    let plan = panel(&format!("{PWM} }}"), places).expect("no fault");
    assert!(plan.material_table.is_modulated() && !plan.sources.is_modulated());
    let [first, second, third] = waveforms(&plan)[..] else { panic!("three places") };
    assert_eq!([0.002, 0.006].map(|t| [first.at(t), second.at(t), third.at(t)]), [[4.0, 0.0, 4.0], [0.0, 4.0, 0.0]]);
    let plan = panel(&format!("{PWM}, phases = \"random\", multiplexed_rows = 8 }}"), places).expect("no fault");
    let interval = TimeInterval::new(0.2, 0.203).expect("in order");
    let means: BTreeSet<u64> = waveforms(&plan).iter().map(|waveform| waveform.mean(interval).to_bits()).collect();
    assert_eq!(means.len(), 3);
    let still = panel("sides = \"both\"", "position_m = [0, 0, 5]").expect("no fault");
    assert!(!still.material_table.is_modulated() && waveforms(&still).is_empty());
}

#[test]
fn a_delay_of_light_that_does_not_change_is_refused() {
    let message = panel("sides = \"both\"", "instances = [{ position_m = [0, 0, 5], modulation_delay_s = 1 }]").err();
    assert!(
        message
            .is_some_and(|text| text.contains("modulation_delay_s: \"modulation_delay_s\" has no effect on an object"))
    );
}

#[test]
fn a_table_of_the_wrong_width_is_refused() {
    let text = "[[scene.lights]]\nname = \"l\"\ntype = \"point\"\nintensity_cd = 100\nilluminant = \"A\"\n\
                position_m = [0, 0, 5]\nmodulation = { type = \"table\", file = \"flash.csv\" }\n";
    for (columns, values, expected_problem) in [
        (3, vec![0.0, 1.0, 2.0], Some("give two columns: time in s, level")),
        (2, vec![0.0, 1.0, -1.0, 2.0], Some("the time -1 s follows 0 s")),
        (2, vec![0.0, 1.0, 0.5, 3.0], None),
    ] {
        let result = super::plan_with(text, |assets| {
            let table = etendue_scene::asset::NumbersAsset { columns, values, hash: [1; 32] };
            assets.numbers.insert("flash.csv".into(), table);
        });
        match expected_problem {
            Some(problem) => assert!(result.err().is_some_and(|error| error.contains(problem)), "{problem}"),
            None => assert_eq!(result.expect("no fault").sources.lamps[0].modulation().map(|w| w.at(0.25)), Some(2.0)),
        }
    }
}
