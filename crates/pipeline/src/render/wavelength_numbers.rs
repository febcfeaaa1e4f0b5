//! Random numbers for the wavelengths of a replicate's samples.

use crate::sizes::spectrum_spread::SpectrumSpread;
use etendue_core::random::{Draw, GoldenSequence, PathStream, PixelAddress, ShiftedLattice};

/// Random numbers for a replicate's wavelengths.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WavelengthNumbers {
    order: NumberSequence,
}

/// Random numbers of a replicate of a block.
pub(super) struct ReplicateNumbers {
    /// For each pixel, those of its first sample.
    pub(super) streams: Vec<PathStream>,
    /// Those of the wavelengths.
    pub(super) wavelength_numbers: WavelengthNumbers,
}

/// Sequence of a replicate's numbers.
#[derive(Clone, Copy, Debug)]
enum NumberSequence {
    Drawn,
    /// From a position on in the lattice of the samples that are spread together.
    Lattice(ShiftedLattice, u32),
    Golden(GoldenSequence),
}

impl WavelengthNumbers {
    /// Numbers of the replicate of `address`, which has `samples` samples, in a pass that starts at replicate `first` and has `replicates`.
    pub(crate) fn new(
        spread: SpectrumSpread,
        address: &PixelAddress,
        samples: u32,
        first: u32,
        replicates: u32,
    ) -> Self {
        let order = match spread {
            SpectrumSpread::Drawn => NumberSequence::Drawn,
            SpectrumSpread::EachReplicate => NumberSequence::Lattice(ShiftedLattice::new(address, samples), 0),
            SpectrumSpread::AllReplicates => {
                let all = PixelAddress { replicate: first, ..*address };
                NumberSequence::Lattice(
                    ShiftedLattice::new(&all, samples * replicates),
                    (address.replicate - first) * samples,
                )
            }
            SpectrumSpread::Open => NumberSequence::Golden(GoldenSequence::new(address)),
        };
        Self { order }
    }

    /// Number for the sampling of a sample's `wavelengths` wavelengths, in [0, 1).
    pub(crate) fn number(&self, stream: &PathStream, wavelengths: usize) -> f32 {
        let number = stream.one(Draw::Wavelength, 0);
        let uniform = match &self.order {
            NumberSequence::Drawn => return number,
            NumberSequence::Lattice(lattice, first) => lattice.at(first + stream.sample()),
            NumberSequence::Golden(sequence) => sequence.at(stream.sample()),
        };
        let n = wavelengths as f64;
        let rotation = (f64::from(number) * n).floor();
        (((rotation + uniform) / n) as f32).min(1.0_f32.next_down())
    }
}
