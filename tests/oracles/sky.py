"""Figures of Mitsuba's sunsky emitter for crates/spectra: figures/sky.json.

Python 3.11, mitsuba 3.9.1 (requirements.txt). Run at the root of the repository:
    python tests/oracles/sky.py

The emitter keeps the Hosek-Wilkie tables in single precision. At 720 nm itself it reads one band too far and answers
NaN at times, so 719 nm is asked for. Its Sun has 0.5358 degrees; points of the disc are named by mu, the cosine at
which light leaves the Sun.
"""

import json
import math

import mitsuba as mi

mi.set_variant("scalar_spectral")
NM = [320.0, 360.0, 393.0, 440.0, 467.5, 520.0, 560.0, 587.0, 600.0, 640.0, 691.0, 719.0]
TURBIDITIES = [1.0, 1.7, 2.0, 3.25, 6.0, 9.5, 10.0]
ALBEDOS = [0.0, 0.2, 1.0]
ELEVATIONS_DEG = [0.1, 2.0, 7.0, 30.0, 60.0, 89.0]
ZENITH_AZIMUTH_DEG = [(0.0, 0.0), (35.0, 10.0), (60.0, 90.0), (84.0, 30.0), (88.0, 175.0)]
SUN_DIAMETER_DEG = 0.5358


def radiance(emitter, direction, nm):
    si = mi.SurfaceInteraction3f()
    si.wi = -mi.Vector3f(*direction)
    found = []
    for i in range(0, len(nm), 4):
        si.wavelengths = type(si.wavelengths)(nm[i:i + 4])
        found += [float(v) for v in emitter.eval(si)]
    assert all(math.isfinite(v) for v in found)
    return [float(f"{v:.7g}") for v in found]


def emitter(turbidity, albedo, elevation_deg, **scales):
    e = math.radians(elevation_deg)
    return mi.load_dict({"type": "sunsky", "turbidity": turbidity, "albedo": albedo, "complex_sun": True,
                         "sun_direction": [math.cos(e), 0.0, math.sin(e)], "sun_aperture": SUN_DIAMETER_DEG, **scales})


def towards(zenith_deg, azimuth_deg):
    z, a = math.radians(zenith_deg), math.radians(azimuth_deg)
    return (math.sin(z) * math.cos(a), math.sin(z) * math.sin(a), math.cos(z))


def sky():
    rows, n = [], 0
    for turbidity in TURBIDITIES:
        for albedo in ALBEDOS:
            for elevation in ELEVATIONS_DEG:
                lamp = emitter(turbidity, albedo, elevation, sun_scale=0.0)
                for view in (ZENITH_AZIMUTH_DEG[n % 5], ZENITH_AZIMUTH_DEG[(n + 2) % 5]):
                    rows.append([turbidity, albedo, elevation, *view, radiance(lamp, towards(*view), NM)])
                n += 1
    return rows


def sun():
    rows = []
    for turbidity in TURBIDITIES:
        for elevation in [0.5, 2.0, 4.7, 7.0, 15.0, 30.0, 60.0, 89.0]:
            lamp = emitter(turbidity, 0.2, elevation, sky_scale=0.0)
            for mu in (1.0, 0.5):
                sine = math.sin(math.radians(SUN_DIAMETER_DEG / 2)) * math.sqrt(1 - mu * mu)
                # Beside the centre: the emitter takes radiance at the point's own elevation.
                aside = 2 * math.asin(math.sin(math.asin(sine) / 2) / math.cos(math.radians(elevation)))
                direction = towards(90 - elevation, math.degrees(aside))
                rows.append([turbidity, elevation, mu, radiance(lamp, direction, NM)])
    return rows


def main():
    figures = {"program": f"mitsuba {mi.__version__}, sunsky", "nm": NM, "sky": sky(), "sun": sun()}
    lines = json.dumps(figures).replace("]], ", "]],\n")
    with open("tests/oracles/figures/sky.json", "w", encoding="utf-8") as file:
        file.write(lines + "\n")


main()
