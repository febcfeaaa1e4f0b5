"""Etendue's pictures of the comparison: electrons of a pixel that responds like the eye, as luminance."""

import json

import numpy as np

import spectra

PLANCK_J_S, LIGHT_M_S = 6.62607015e-34, 299792458.0
# As in the job that scenes.py writes: the pinhole's f-number, and eta = PEAK x ybar / lambda in nm.
F_NUMBER, PEAK = 8.0, 400.0


def cos4(c):
    """The pinhole's fall-off."""
    pitch, focal = c["pixel_pitch_um"] * 1e-3, c["focal_length_mm"]
    x = (np.arange(c["width_px"]) + 0.5 - c["width_px"] / 2) * pitch
    y = (np.arange(c["height_px"]) + 0.5 - c["height_px"] / 2) * pitch
    return (focal**2 / (focal**2 + x[None] ** 2 + y[:, None] ** 2)) ** 2


def luminance(folder, electrons):
    """cd/m2 of the electrons of a second, a file of little-endian f32."""
    c = json.loads((folder / "scene.json").read_text())["camera"]
    counted = np.fromfile(electrons, "<f4").reshape(c["height_px"], c["width_px"]).astype(float)
    area = (c["pixel_pitch_um"] * 1e-6) ** 2
    per_radiance = np.pi / (4 * F_NUMBER**2) * area * PEAK * 1e-9 / (PLANCK_J_S * LIGHT_M_S)
    return spectra.LUMENS_PER_WATT * counted / (per_radiance * cos4(c))
