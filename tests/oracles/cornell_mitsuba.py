"""Mean radiance of every wall and block of scenes/cornell by Mitsuba 3: figures/cornell.json.

Python 3.11, mitsuba 3.9.1 (requirements.txt), variant scalar_spectral (it needs no LLVM). Run at the root of the
repository:
    python tests/oracles/cornell_mitsuba.py
The camera is the scene's own. A wall's mean is over the pixels whose centre and whose eight neighbours' centres see it;
a band's is over its wavelengths, W m-2 sr-1 nm-1. The standard error is that of independent pictures. A path scatters
MAX_BOUNCES times at most.
"""

import json
import sys
import tempfile
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path[0] = str(ROOT / "benches/peers")
import os  # noqa: E402

os.environ["PEER_VARIANT"] = "scalar_spectral"
import scenes  # noqa: E402

sys.path.append(str(ROOT / "benches/peers/mitsuba"))
import render  # noqa: E402

mi = render.mi
MAX_BOUNCES = 12
BANDS = [[400.0 + 50.0 * i, 450.0 + 50.0 * i] for i in range(6)]
SEEDS, SPP = 16, 32
SIDE_PX = 256


def camera(view):
    """That of cornell.toml: 25 mm over the picture."""
    return view | {"width_px": SIDE_PX, "height_px": SIDE_PX, "pixel_pitch_um": 25e3 / SIDE_PX}


def seen(scene, corners):
    """The object that every pixel's centre sees, from 1; 0 for none (Moeller and Trumbore 1997)."""
    c = camera(scene["camera"])
    at = (np.arange(SIDE_PX) + 0.5 - SIDE_PX / 2) * c["pixel_pitch_um"] * 1e-3 / c["focal_length_mm"]
    y, x = np.meshgrid(at, at, indexing="ij")
    # The camera looks along +x, its picture's columns run to -y and its rows to -z.
    way = np.stack([np.ones_like(x), -x, -y], axis=-1)
    nearest, found = np.full(x.shape, np.inf), np.zeros(x.shape, int)
    for triangle, thing in zip(corners, scene["objects"]):
        a, u, v = triangle[0], triangle[1] - triangle[0], triangle[2] - triangle[0]
        across = np.cross(way, v)
        with np.errstate(divide="ignore", invalid="ignore"):
            inverse = 1.0 / (across @ u)
            from_a = np.array(c["position_m"]) - a
            b1 = (across @ from_a) * inverse
            b2 = (way @ np.cross(from_a, u)) * inverse
            t = (v @ np.cross(from_a, u)) * inverse
        hit = (b1 >= 0) & (b2 >= 0) & (b1 + b2 <= 1) & (t > 0) & (t < nearest)
        nearest[hit], found[hit] = t[hit], thing + 1
    return found


def inside(things):
    """0 where a neighbour sees another."""
    padded = np.pad(things, 1)
    same = [np.roll(padded, (i, j), (0, 1))[1:-1, 1:-1] == things for i in (-1, 0, 1) for j in (-1, 0, 1)]
    return np.where(np.all(same, axis=0), things, 0)


def described(folder, scene):
    sensor = render.sensor(camera(scene["camera"]))
    sensor["film"] = {"type": "specfilm", "width": SIDE_PX, "height": SIDE_PX, "component_format": "float32",
                      "rfilter": {"type": "box"}}
    for i, (low, high) in enumerate(BANDS):
        sensor["film"][f"band{i}"] = {"type": "regular", "wavelength_min": low, "wavelength_max": high, "values": "1,1"}
    integrator = {"type": "path", "max_depth": MAX_BOUNCES + 1}
    return mi.load_dict({"type": "scene", "sensor": sensor, "integrator": integrator} | render.meshes(folder, scene))


def main():
    scene, mesh = scenes.cornell()
    names = ["floor", "ceiling", "back", "left", "right", "short-block", "tall-block"]
    # Corners as arrays() would share them, but in the order of the objects.
    corners = np.concatenate([part[0] for part in mesh.parts])
    things = inside(seen(scene, corners))
    arrays = mesh.arrays()
    with tempfile.TemporaryDirectory() as folder:
        np.savez(Path(folder) / "mesh.npz", **arrays)
        loaded = described(Path(folder), scene)
        pictures = [np.array(mi.render(loaded, spp=SPP, seed=seed)) for seed in range(SEEDS)]
    # Radiance is in UNIT, summed over a band.
    widths = np.array([high - low for low, high in BANDS]) * render.UNIT
    walls = []
    for i, name in enumerate(names):
        chosen = things == i + 1
        means = np.array([picture[chosen].mean(axis=0) / widths for picture in pictures])
        walls.append({"name": name, "pixels": int(chosen.sum()), "mean": means.mean(axis=0).tolist(),
                      "standard_error": (means.std(axis=0, ddof=1) / np.sqrt(SEEDS)).tolist()})
    figures = {"bands_nm": BANDS, "max_bounces": MAX_BOUNCES, "seeds": SEEDS, "walls": walls}
    (ROOT / "tests/oracles/figures/cornell.json").write_text(json.dumps(figures, indent=1) + "\n")


if __name__ == "__main__":
    main()
