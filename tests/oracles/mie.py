"""Phase functions of water fog by miepython for crates/spectra/src/mie.rs: figures/mie.json.

Python 3.11, miepython 3.3.0 (requirements.txt). Run at the root of the repository (some minutes):
    python tests/oracles/mie.py

Diameters are log-normal by number, of the factor 1.35; 20 001 sizes within four standard deviations of the mean by area, as single
spheres have narrow resonances.
"""

import json

import miepython
import numpy as np

NM = 550.0
INDEX = 1.333 - 2e-9j
DEGREES = [0, 5, 30, 90, 140, 170, 180]
SPREAD = np.log(1.35)


def phase(diameter_um):
    cosines = np.cos(np.radians(DEGREES))
    sum_, whole = 0.0, 0.0
    for deviation in np.linspace(-4, 4, 20001) + 2 * SPREAD:
        x = np.pi * diameter_um * np.exp(deviation * SPREAD) * 1e3 / NM
        share = np.exp(-0.5 * deviation**2) * x * x * miepython.efficiencies_mx(INDEX, x)[1]
        sum_ = sum_ + share * miepython.i_unpolarized(INDEX, x, cosines, norm="4pi") / (4 * np.pi)
        whole += share
    return list(sum_ / whole)


figures = {"version": miepython.__version__, "degrees": DEGREES, "per_sr": {d: phase(d) for d in (5.0, 12.0, 20.0)}}
with open("tests/oracles/figures/mie.json", "w") as file:
    json.dump(figures, file, indent=1)
    file.write("\n")
