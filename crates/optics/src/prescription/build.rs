//! From what a maker states to a prescription that is open, in focus and checked.

use super::elements;
use super::indices::IndexTable;
use super::paraxial::AxialOpening;
use super::{Prescription, PrescriptionParameters, check, focus, paraxial};
use crate::error::PrescriptionError;

impl Prescription {
    /// A checked and focused lens.
    ///
    /// # Errors
    /// Where the surfaces are no lens, or it cannot be focused as asked.
    pub fn new(parameters: PrescriptionParameters) -> Result<Self, PrescriptionError> {
        let PrescriptionParameters { mut surfaces, f_number, focus, defocus_mm, reference_nm, other_rims } = parameters;
        let stop = check::surfaces(&surfaces)?;
        let (list, places) = elements::media(&surfaces)?;
        let table = IndexTable::new(&list);
        let media = table.at(check::reference(reference_nm)?);
        focus::open(&mut surfaces, stop, f_number, &places, &media)?;
        let focused = focus::focused(&mut surfaces, stop, focus, &places, &media)?;
        check::overlaps(&surfaces)?;
        let elements = elements::elements(&surfaces, &places);
        let paraxial = paraxial::paraxial(&elements, stop, surfaces[stop].semi_aperture_mm, &media);
        let last_mm = elements.last().map_or(0.0, |e| e.z_mm);
        let sensor_position_mm =
            last_mm + focused.image_mm + check::finite_number(surfaces.len(), "defocus_mm", defocus_mm)?;
        let mut lens = Self {
            sensor_position_mm,
            focus_distance_m: focused.distance_m,
            magnification: focused.magnification,
            principal_distance_mm: focus::principal_distance_mm(
                &elements,
                &paraxial,
                sensor_position_mm - last_mm,
                &media,
            ),
            surfaces,
            elements,
            table,
            stop,
            reference_nm,
            paraxial,
            axial_opening: AxialOpening::STOP,
        };
        lens.axial_opening = check::axial_bundle(&lens, other_rims)?;
        lens.paraxial = paraxial.clipped(lens.axial_opening.share);
        Ok(lens)
    }
}
