//! What kind of object a class is to ASAM OSI.

/// Numbers of `MovingObject.Type`.
pub(super) const OTHER: u64 = 1;
const VEHICLE: u64 = 2;
const PEDESTRIAN: u64 = 3;
const ANIMAL: u64 = 4;

/// An object by its class.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// A vehicle, and its `VehicleClassification.Type`.
    Vehicle(u64),
    /// Of another `MovingObject.Type`.
    Mover(u64),
    /// Of a `StationaryObject.Classification.Type`.
    Stationary(u64),
}

/// Vehicles by the names of classes.
const VEHICLES: [(&str, u64); 19] = [
    ("car", 4),
    ("van", 6),
    ("truck", 7),
    ("lorry", 7),
    ("semitrailer", 8),
    ("trailer", 9),
    ("caravan", 9),
    ("motorbike", 10),
    ("motorcycle", 10),
    ("bicycle", 11),
    ("bike", 11),
    ("bus", 12),
    ("tram", 13),
    ("train", 14),
    ("wheelchair", 15),
    ("scooter", 17),
    ("boat", 20),
    ("aircraft", 21),
    ("vehicle", OTHER),
];

/// Other things that move by themselves.
const MOVERS: [(&str, u64); 7] = [
    ("person", PEDESTRIAN),
    ("pedestrian", PEDESTRIAN),
    ("rider", PEDESTRIAN),
    ("animal", ANIMAL),
    ("dog", ANIMAL),
    ("deer", ANIMAL),
    ("horse", ANIMAL),
];

/// Things that stand.
const STATIONARY: [(&str, u64); 15] = [
    ("bridge", 2),
    ("building", 3),
    ("house", 3),
    ("pole", 4),
    ("polegroup", 4),
    ("traffic cone", 5),
    ("pylon", 5),
    ("delineator", 6),
    ("tree", 7),
    ("fence", 8),
    ("guard rail", 8),
    ("barrier", 8),
    ("vegetation", 9),
    ("curb", 10),
    ("wall", 11),
];

/// Surfaces that things stand on, and the sky: OSI has lanes and markings for them, and no boxes.
const SURFACES: [&str; 12] = [
    "road",
    "sidewalk",
    "pavement",
    "parking",
    "rail track",
    "ground",
    "terrain",
    "grass",
    "sky",
    "marking",
    "road marking",
    "lane marking",
];

impl Kind {
    /// Of the name of a class ("-" and "_" are blanks); what no list has is another moving or another stationary object. `None` of surfaces.
    pub(super) fn of(class: &str, moves: bool) -> Option<Self> {
        let name = class.to_lowercase().replace(['-', '_'], " ");
        let number = |list: &[(&str, u64)]| list.iter().find(|(known, _)| *known == name).map(|(_, number)| *number);
        if let Some(vehicle) = number(&VEHICLES) {
            return Some(Self::Vehicle(vehicle));
        }
        if let Some(mover) = number(&MOVERS) {
            return Some(Self::Mover(mover));
        }
        if moves {
            return Some(Self::Mover(OTHER));
        }
        let is_surface = SURFACES.contains(&name.as_str());
        (!is_surface).then(|| Self::Stationary(number(&STATIONARY).unwrap_or(OTHER)))
    }

    /// Its `MovingObject.Type`; `None` of what stands.
    pub(super) fn moving_type(self) -> Option<u64> {
        match self {
            Self::Vehicle(_) => Some(VEHICLE),
            Self::Mover(kind) => Some(kind),
            Self::Stationary(_) => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn classes_have_the_kinds_of_the_standard() {
        assert_eq!(Kind::of("Car", false), Some(Kind::Vehicle(4)));
        assert_eq!(Kind::of("guard_rail", false), Some(Kind::Stationary(8)));
        assert_eq!(Kind::of("person", false), Some(Kind::Mover(PEDESTRIAN)));
        assert_eq!(
            [Kind::of("crate", false), Kind::of("crate", true)],
            [Some(Kind::Stationary(1)), Some(Kind::Mover(1))]
        );
        assert_eq!([Kind::of("road", false), Kind::of("sky", false)], [None, None]);
        assert_eq!(Kind::Vehicle(12).moving_type(), Some(VEHICLE));
    }
}
