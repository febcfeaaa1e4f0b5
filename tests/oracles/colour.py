"""Figures of colour-science for crates/spectra: figures/colour.json.

Python 3.11, colour-science 0.4.7, numpy 2.4.6, scipy 1.17.1 (requirements.txt). Run at the root of the repository:
    python tests/oracles/colour.py
"""

import json
import sys
import warnings

sys.path.pop(0)  # this file has the library's name
warnings.filterwarnings("ignore")
import colour  # noqa: E402
import numpy as np  # noqa: E402

CMFS = colour.MSDS_CMFS["CIE 1931 2 Degree Standard Observer"].copy().align(colour.SpectralShape(360, 830, 1))
CIE = {"A": "A", "D50": "D50", "D65": "D65", "FL2": "FL2", "FL11": "FL11", "HP1": "HP1", "LED-B3": "LED-B3",
       "LED-RGB1": "LED-RGB1"}


def linear(sd, extrapolation):
    """The distribution on the grid of 360-830 nm, linear between points; zero or the end value outside."""
    shape = CMFS.shape
    x = np.asarray(sd.wavelengths)
    y = np.asarray(sd.values)
    ends = {} if extrapolation == "hold" else {"left": 0.0, "right": 0.0}
    return colour.SpectralDistribution(np.interp(shape.wavelengths, x, y, **ends), shape.wavelengths)


def xyz(sd, illuminant):
    return (colour.sd_to_XYZ(sd, CMFS, illuminant, method="Integration") / 100).tolist()


def illuminants():
    one = linear(colour.SDS_ILLUMINANTS["E"], "hold") / 100
    return {n: xyz(one, linear(colour.SDS_ILLUMINANTS[k], "zero")) for n, k in CIE.items()}


def colorchecker():
    d65 = linear(colour.SDS_ILLUMINANTS["D65"], "zero")
    patches = colour.SDS_COLOURCHECKERS["BabelColor Average"]
    white = np.array(xyz(linear(colour.SDS_ILLUMINANTS["E"], "hold") / 100, d65))
    found = []
    for name, sd in patches.items():
        value = np.array(xyz(linear(sd, "hold"), d65))
        found.append({"name": name, "xyz": value.tolist(),
                      "lab": colour.XYZ_to_Lab(value, colour.XYZ_to_xy(white)).tolist()})
    return {"white": white.tolist(), "patches": found}


# Sharma, Wu & Dalal 2005, table 1: the colours; the differences are colour-science's, which reproduce the table.
SHARMA = [
    ([50, 2.6772, -79.7751], [50, 0, -82.7485]), ([50, 3.1571, -77.2803], [50, 0, -82.7485]),
    ([50, 2.8361, -74.0200], [50, 0, -82.7485]), ([50, -1.3802, -84.2814], [50, 0, -82.7485]),
    ([50, -1.1848, -84.8006], [50, 0, -82.7485]), ([50, -0.9009, -85.5211], [50, 0, -82.7485]),
    ([50, 0, 0], [50, -1, 2]), ([50, -1, 2], [50, 0, 0]), ([50, 2.49, -0.001], [50, -2.49, 0.0009]),
    ([50, 2.49, -0.001], [50, -2.49, 0.0010]), ([50, 2.49, -0.001], [50, -2.49, 0.0011]),
    ([50, 2.49, -0.001], [50, -2.49, 0.0012]), ([50, -0.001, 2.49], [50, 0.0009, -2.49]),
    ([50, -0.001, 2.49], [50, 0.0011, -2.49]), ([50, 2.5, 0], [50, 0, -2.5]), ([50, 2.5, 0], [73, 25, -18]),
    ([50, 2.5, 0], [61, -5, 29]), ([50, 2.5, 0], [56, -27, -3]), ([50, 2.5, 0], [58, 24, 15]),
    ([50, 2.5, 0], [50, 3.1736, 0.5854]), ([50, 2.5, 0], [50, 3.2972, 0]), ([50, 2.5, 0], [50, 1.8634, 0.5757]),
    ([50, 2.5, 0], [50, 3.2592, 0.3350]), ([60.2574, -34.0099, 36.2677], [60.4626, -34.1751, 39.4387]),
    ([63.0109, -31.0961, -5.8663], [62.8187, -29.7946, -4.0864]), ([61.2901, 3.7196, -5.3901], [61.4292, 2.2480, -4.9620]),
    ([35.0831, -44.1164, 3.7933], [35.0232, -40.0716, 1.5901]), ([22.7233, 20.0904, -46.6940], [23.0331, 14.9730, -42.5619]),
    ([36.4612, 47.8580, 18.3852], [36.2715, 50.5065, 21.2231]), ([90.8027, -2.0831, 1.4410], [91.1528, -1.6435, 0.0447]),
    ([90.9257, -0.5406, -0.9208], [88.6381, -0.8985, -0.7239]), ([6.7747, -0.2908, -2.4247], [5.8714, -0.0985, -2.2286]),
    ([2.0776, 0.0795, -1.1350], [0.9033, -0.0636, -0.5514]),
]


def differences():
    return [{"first": a, "second": b, "difference": float(colour.delta_E(a, b, method="CIE 2000"))} for a, b in SHARMA]


def blackbody():
    """Planck radiances in W.m^-2.sr^-1.nm^-1 (the library's are per metre of wavelength)."""
    values = []
    for kelvin in (1000.0, 2856.0, 6504.0):
        for nm in (400.0, 555.0, 700.0, 1000.0):
            radiance = colour.colorimetry.planck_law(nm * 1e-9, kelvin, c1=3.741771852192757e-16, c2=1.438776877503933e-2)
            values.append({"kelvin": kelvin, "nm": nm, "radiance": float(radiance) * 1e-9})
    return values


def main():
    figures = {
        "script": "tests/oracles/colour.py",
        "library": f"colour-science {colour.__version__}",
        "illuminants": illuminants(),
        "colorchecker": colorchecker(),
        "ciede2000": differences(),
        "blackbody": blackbody(),
    }
    with open("tests/oracles/figures/colour.json", "w") as file:
        json.dump(figures, file, indent=1)
        file.write("\n")


if __name__ == "__main__":
    main()
