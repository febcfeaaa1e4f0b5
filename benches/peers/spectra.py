"""Spectra and colours that the peers need in their own form, from the tables of crates/spectra/data."""

from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
DATA = ROOT / "crates/spectra/data"
LUMENS_PER_WATT = 683.002
# CIE 1931, 2 degrees, at 1 nm.
_OBSERVER = np.loadtxt(DATA / "cie_1931_2deg_1nm.csv", delimiter=",", skiprows=1)
NM, OBSERVER = _OBSERVER[:, 0], _OBSERVER[:, 1:4]
# IEC 61966-2-1: linear sRGB from XYZ of D65 white.
RGB_OF_XYZ = np.linalg.inv(np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]]))


def table(path):
    """Wavelengths and values of a two-column CSV file with comments and a header."""
    rows = [line for line in Path(path).read_text().splitlines() if line[:1].isdigit()]
    return np.array([[float(x) for x in row.split(",")[:2]] for row in rows])


def on_grid(points, outside="zero"):
    """A table on the observer's grid, linear between points."""
    ends = {"left": 0.0, "right": 0.0} if outside == "zero" else {}
    return np.interp(NM, points[:, 0], points[:, 1], **ends)


def black_body(kelvin):
    """Planck's law on the observer's grid, relative."""
    metres = NM * 1e-9
    return 1e-30 * metres**-5 / np.expm1(1.438776877e-2 / (metres * kelvin))


def with_luminance(relative, luminance):
    """The spectrum scaled to a luminance, cd/m2 (or an illuminance, lx): W m-2 sr-1 nm-1 (or W m-2 nm-1)."""
    return relative * (luminance / (LUMENS_PER_WATT * np.sum(relative * OBSERVER[:, 1])))


def rgb_of_light(radiance):
    """Linear sRGB of a spectrum, in cd/m2."""
    return RGB_OF_XYZ @ (LUMENS_PER_WATT * radiance @ OBSERVER)


def rgb_of_reflectance(reflectance, light):
    """The factors on linear sRGB that give the colour of the reflected light."""
    return np.clip(rgb_of_light(reflectance * light) / rgb_of_light(light), 0.0, 1.0)
