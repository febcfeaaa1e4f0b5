//! Retro-reflecting surfaces: sheeting and road markings.

use std::path::PathBuf;

use crate::asset::file_list::{FileList, NamesFiles};
use crate::asset::request::AssetKind;
use crate::fault::{DescriptionErrors, ErrorCode};
use crate::place::{Place, Placed};
use crate::reader::{choice, keyed, number, path, record, words};
use crate::record::reflectance::{Colour, Reflectance, any_colour, any_reflectance};

record! {
    /// Retro-reflective sheeting: signs, number plates.
    pub struct Sheeting check(check_sheeting) {
        /// Retro-reflection.
        inside table: SheetingTable;
        /// With "class": colour of the sheeting. Default: "white".
        optional colour: Placed<SheetingColour> = choice();
        /// With "r_a_table": diffuse reflectance by day.
        optional reflectance: Colour = any_colour();
        /// With "r_a_table": relative spectrum of the retro-reflected light. Default: white.
        optional retro_colour: Colour = any_colour();
        /// Transmittance of transparent ink on white sheeting.
        optional print: Reflectance = any_reflectance();
    }
}

impl NamesFiles for Sheeting {
    fn name_files(&self, files: &mut FileList) {
        let Self { place: _, table, colour: _, reflectance, retro_colour, print } = self;
        table.name_files(files);
        reflectance.name_files(files);
        retro_colour.name_files(files);
        print.name_files(files);
    }
}

keyed! {
    /// Coefficients of retro-reflection R_A.
    pub enum SheetingTable {
        /// Minimum values of a standard; new sheeting has about 1.5 times as much.
        class => Class(Placed<SheetingClass>) = choice();
        /// Measured R_A, cd·lx⁻¹·m⁻²: CSV, entrance angles after one field, then rows of observation angle and coefficients (degrees).
        r_a_table => File(Placed<PathBuf>) = path(&["csv"]);
    }
}

impl NamesFiles for SheetingTable {
    fn name_files(&self, files: &mut FileList) {
        match self {
            Self::Class(_) => {}
            Self::File(file) => files.add(AssetKind::RetroTable, file),
        }
    }
}

words! {
    /// A class of sheeting.
    pub enum SheetingClass {
        /// EN 12899-1, class RA1: glass beads.
        "ra1" => Ra1,
        /// EN 12899-1, class RA2: encapsulated beads or prisms.
        "ra2" => Ra2,
        /// ASTM D4956, type IX: micro-prisms.
        "d4956-ix" => D4956Ix,
    }
}

words! {
    /// A colour of sheeting.
    pub enum SheetingColour {
        /// White.
        "white" => White,
        /// Yellow.
        "yellow" => Yellow,
        /// Red.
        "red" => Red,
        /// Blue.
        "blue" => Blue,
        /// Green.
        "green" => Green,
    }
}

record! {
    /// A road marking with glass beads.
    pub struct RoadMarking {
        /// Retro-reflection at night.
        inside night: MarkingNight;
        /// Brightness by day.
        inside day: MarkingDay;
        /// Relative spectrum of the colour. Default: white.
        optional colour: Colour = any_colour();
        /// Angle at which retro-reflected light falls to a quarter. Default: 3, an assumption.
        optional spread_deg: Placed<f64> = number("°").at_least(0.5).at_most(30.0);
    }
}

impl NamesFiles for RoadMarking {
    fn name_files(&self, files: &mut FileList) {
        let Self { place: _, night: _, day: _, colour, spread_deg: _ } = self;
        colour.name_files(files);
    }
}

keyed! {
    /// The coefficient of retro-reflected luminance R_L at the 30 m geometry of EN 1436.
    pub enum MarkingNight {
        /// R_L.
        r_l_mcd_m2_lx => Coefficient(Placed<f64>) = number("mcd·m⁻²·lx⁻¹").at_least(0.0);
        /// Minimum R_L of a class of EN 1436.
        class => Class(Placed<MarkingClass>) = choice();
    }
}

keyed! {
    /// Brightness of a marking by day.
    pub enum MarkingDay {
        /// Luminance coefficient under diffuse light Q_d.
        q_d_mcd_m2_lx => Qd(Placed<f64>) = number("mcd·m⁻²·lx⁻¹").at_least(0.0).at_most(318.0);
        /// Luminance factor β.
        luminance_factor => LuminanceFactor(Placed<f64>) = number("").at_least(0.0).at_most(1.0);
    }
}

words! {
    /// A class of road markings, with its minimum R_L.
    pub enum MarkingClass {
        /// White, dry: 100.
        "r2" => R2,
        /// White, dry: 150.
        "r3" => R3,
        /// White, dry: 200.
        "r4" => R4,
        /// White, dry: 300.
        "r5" => R5,
        /// Yellow, dry: 80.
        "yellow-r1" => YellowR1,
        /// Yellow, dry: 150.
        "yellow-r3" => YellowR3,
        /// Yellow, dry: 200.
        "yellow-r5" => YellowR5,
        /// Wet: 25.
        "rw1" => Rw1,
        /// Wet: 35.
        "rw2" => Rw2,
        /// Wet: 50.
        "rw3" => Rw3,
        /// Wet: 75.
        "rw4" => Rw4,
        /// Wet: 100.
        "rw5" => Rw5,
        /// Wet: 150.
        "rw6" => Rw6,
    }
}

fn check_sheeting(sheeting: &Sheeting, errors: &mut DescriptionErrors) {
    match &sheeting.table {
        SheetingTable::Class(_) => {
            let of_table = [("reflectance", &sheeting.reflectance), ("retro_colour", &sheeting.retro_colour)];
            for (key, value) in of_table {
                value.iter().for_each(|item| refuse(key, "\"r_a_table\"", item.place(), errors));
            }
        }
        SheetingTable::File(file) => {
            sheeting.colour.iter().for_each(|colour| refuse("colour", "\"class\"", &colour.place, errors));
            if sheeting.reflectance.is_none() {
                errors.add(
                    ErrorCode::MissingKey,
                    &file.place,
                    "the table does not state the diffuse (daytime) reflectance of the sheeting",
                    "add \"reflectance\"",
                );
            }
        }
    }
    if sheeting.print.is_some() {
        check_print(sheeting, errors);
    }
}

/// Refuses a print on sheeting that is not white.
fn check_print(sheeting: &Sheeting, errors: &mut DescriptionErrors) {
    let coloured = sheeting.colour.iter().filter(|c| c.value != SheetingColour::White).map(|c| &c.place);
    let tinted = sheeting.retro_colour.iter().map(Colour::place);
    let grey = |colour: &&Colour| !matches!(colour, Colour::Grey(_));
    let base = sheeting.reflectance.iter().filter(grey).map(Colour::place);
    for place in coloured.chain(tinted).chain(base) {
        errors.add(
            ErrorCode::Contradiction,
            place,
            "\"print\" needs white sheeting; this key colours it",
            "remove one of the two, or give a grey",
        );
    }
}

fn refuse(key: &str, owner: &str, place: &Place, errors: &mut DescriptionErrors) {
    errors.add(ErrorCode::NoEffect, place, format!("\"{key}\" has no effect here, it belongs to {owner}"), "remove it");
}
