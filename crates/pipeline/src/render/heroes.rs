//! Random numbers for the wavelengths of a replicate's samples.

use crate::sizes::spectrum_spread::SpectrumSpread;
use etendue_core::random::{Draw, GoldenSequence, PathStream, PixelAddress, ShiftedLattice};

/// Random numbers for a replicate's wavelengths.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Heroes {
    order: Order,
}

/// Random numbers of a replicate of a block.
pub(super) struct ReplicateNumbers {
    /// For each pixel, those of its first sample.
    pub(super) streams: Vec<PathStream>,
    /// Those of the wavelengths.
    pub(super) heroes: Heroes,
}

/// Sequence of a replicate's numbers.
#[derive(Clone, Copy, Debug)]
enum Order {
    Drawn,
    /// From a position on in the lattice of the samples that are spread together.
    Lattice(ShiftedLattice, u32),
    Golden(GoldenSequence),
}

impl Heroes {
    /// Numbers of the replicate of `address`, which has `samples` samples, in a pass that starts at replicate `first` and has `replicates`.
    pub(crate) fn new(
        spread: SpectrumSpread,
        address: &PixelAddress,
        samples: u32,
        first: u32,
        replicates: u32,
    ) -> Self {
        let order = match spread {
            SpectrumSpread::Drawn => Order::Drawn,
            SpectrumSpread::EachReplicate => Order::Lattice(ShiftedLattice::new(address, samples), 0),
            SpectrumSpread::AllReplicates => {
                let all = PixelAddress { replicate: first, ..*address };
                Order::Lattice(ShiftedLattice::new(&all, samples * replicates), (address.replicate - first) * samples)
            }
            SpectrumSpread::Open => Order::Golden(GoldenSequence::new(address)),
        };
        Self { order }
    }

    /// Number for the sampling of a sample's `wavelengths` wavelengths, in [0, 1).
    pub(crate) fn number(&self, stream: &PathStream, wavelengths: usize) -> f32 {
        let drawn = stream.one(Draw::Wavelength, 0);
        let even = match &self.order {
            Order::Drawn => return drawn,
            Order::Lattice(lattice, first) => lattice.at(first + stream.sample()),
            Order::Golden(sequence) => sequence.at(stream.sample()),
        };
        let n = wavelengths as f64;
        let rotation = (f64::from(drawn) * n).floor();
        (((rotation + even) / n) as f32).min(1.0_f32.next_down())
    }
}
