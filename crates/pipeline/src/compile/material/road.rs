//! Retro-reflective sheeting and road markings.

use super::compiler::MaterialCompiler;
use super::reflectance::reflectance_spectrum;
use etendue_scene::asset::RetroTableAsset;
use etendue_scene::record::Colour;
use etendue_scene::record::material::{
    self as record, MarkingClass, MarkingDay, MarkingNight, SheetingClass, SheetingColour, SheetingTable,
};
use etendue_scene::{ErrorCode, Placed};
use etendue_spectra::Spectrum;
use etendue_tracer::materials::{
    DaytimeBrightness, RetroTable, RoadMarking, Sheeting, SheetingPreset, Surface, marking_class,
};
use std::path::PathBuf;

impl MaterialCompiler<'_, '_> {
    pub(super) fn sheeting(&mut self, r: &record::Sheeting) -> Option<Surface> {
        let print = match &r.print {
            Some(print) => Some(self.reflectance(print)?),
            None => None,
        };
        let result = match &r.table {
            SheetingTable::Class(class) => {
                let colour = r.colour.as_ref().map_or(SheetingColour::White, |c| c.value);
                // Every class has every colour; a test of the model checks it.
                let preset = SheetingPreset::named(class_name(class.value), colour_name(colour))?;
                match print {
                    Some(print) => Sheeting::printed(preset.luminance_factor, print, preset.table),
                    None => preset.sheeting(),
                }
            }
            SheetingTable::File(file) => {
                let table = self.retro_table(file)?;
                let base = r.reflectance.as_ref()?;
                match (print, base) {
                    (Some(print), Colour::Grey(white)) => Sheeting::printed(white.value, print, table),
                    _ => {
                        let base = reflectance_spectrum(base, self.context)?;
                        let colour = self.colour_or_white(r.retro_colour.as_ref())?;
                        Sheeting::new(base, &colour, table)
                    }
                }
            }
        };
        let sheeting = self.context.accept(&r.place, result)?;
        self.context.note_on(r.place.key(), sheeting.limits().to_string());
        Some(sheeting.into())
    }

    fn retro_table(&mut self, file: &Placed<PathBuf>) -> Option<RetroTable> {
        let Some(asset) = self.context.assets.retro_tables.get(&file.value) else {
            self.context.error(
                ErrorCode::UnreadableFile,
                &file.place,
                "the table was not loaded",
                "give a readable file",
            );
            return None;
        };
        let RetroTableAsset { observation_deg, entrance_deg, coefficients, .. } = asset;
        let table = RetroTable::new(observation_deg, entrance_deg, coefficients);
        self.context.accept(&file.place, table)
    }

    fn colour_or_white(&mut self, colour: Option<&Colour>) -> Option<Spectrum> {
        colour.map_or(Some(Spectrum::constant(1.0)), |colour| reflectance_spectrum(colour, self.context))
    }

    pub(super) fn road_marking(&mut self, r: &record::RoadMarking) -> Option<Surface> {
        let r_l = match &r.night {
            MarkingNight::Coefficient(r_l) => r_l.value,
            // Every class has its coefficient; a test checks it.
            MarkingNight::Class(class) => marking_class(marking_name(class.value))?,
        };
        let day = match &r.day {
            MarkingDay::Qd(q_d) => DaytimeBrightness::Qd(q_d.value),
            MarkingDay::LuminanceFactor(factor) => DaytimeBrightness::LuminanceFactor(factor.value),
        };
        let colour = self.colour_or_white(r.colour.as_ref())?;
        let marking = match &r.spread_deg {
            Some(spread) => RoadMarking::with_spread(r_l, day, &colour, spread.value),
            None => RoadMarking::new(r_l, day, &colour),
        };
        self.context.accept(&r.place, marking).map(Surface::from)
    }
}

fn class_name(class: SheetingClass) -> &'static str {
    match class {
        SheetingClass::Ra1 => "ra1",
        SheetingClass::Ra2 => "ra2",
        SheetingClass::D4956Ix => "d4956-ix",
    }
}

fn colour_name(colour: SheetingColour) -> &'static str {
    match colour {
        SheetingColour::White => "white",
        SheetingColour::Yellow => "yellow",
        SheetingColour::Red => "red",
        SheetingColour::Blue => "blue",
        SheetingColour::Green => "green",
    }
}

fn marking_name(class: MarkingClass) -> &'static str {
    match class {
        MarkingClass::R2 => "r2",
        MarkingClass::R3 => "r3",
        MarkingClass::R4 => "r4",
        MarkingClass::R5 => "r5",
        MarkingClass::YellowR1 => "yellow-r1",
        MarkingClass::YellowR3 => "yellow-r3",
        MarkingClass::YellowR5 => "yellow-r5",
        MarkingClass::Rw1 => "rw1",
        MarkingClass::Rw2 => "rw2",
        MarkingClass::Rw3 => "rw3",
        MarkingClass::Rw4 => "rw4",
        MarkingClass::Rw5 => "rw5",
        MarkingClass::Rw6 => "rw6",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use SheetingColour::{Blue, Green, Red, White, Yellow};

    #[test]
    fn the_model_knows_every_class_and_colour() {
        for class in [SheetingClass::Ra1, SheetingClass::Ra2, SheetingClass::D4956Ix] {
            for colour in [White, Yellow, Red, Blue, Green] {
                let preset = SheetingPreset::named(class_name(class), colour_name(colour)).expect("a preset");
                assert!(preset.sheeting().is_ok(), "{class:?} {colour:?}");
            }
        }
        use MarkingClass::{R2, R3, R4, R5, Rw1, Rw2, Rw3, Rw4, Rw5, Rw6, YellowR1, YellowR3, YellowR5};
        for class in [R2, R3, R4, R5, YellowR1, YellowR3, YellowR5, Rw1, Rw2, Rw3, Rw4, Rw5, Rw6] {
            assert!(marking_class(marking_name(class)).is_some_and(|r_l| r_l > 0.0), "{class:?}");
        }
    }
}
