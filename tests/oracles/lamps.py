"""Lamp files written by this script and by other programs, and what those programs read in them: figures/lamps.

Python 3.11, eulumdat 0.7.1 (written in Rust), eulumdat-py 1.0.0, eulumdat-ies 1.1.0, numpy, scipy (requirements.txt).
Run at the root of the repository:
    python tests/oracles/lamps.py
"""

import json
import math
import pathlib

import eulumdat
import eulumdat_ies
import numpy as np
import pyldt
from scipy.integrate import dblquad
from scipy.interpolate import RegularGridInterpolator

FOLDER = pathlib.Path("tests/oracles/figures/lamps")
GAMMA = [5.0 * i for i in range(19)]
LUMENS = 2500.0


def street(c, gamma):
    """A lobe to the sides of the road, cd per 1 000 lm. Even about C90; the side away from the road is darker."""
    lobe = 180 + 260 * math.exp(-((gamma - 62) / 14) ** 2) * math.cos(math.radians(c)) ** 2
    return round(lobe * (1 + 0.5 * math.sin(math.radians(c))) * math.cos(math.radians(gamma)) ** 0.7, 3)


def about_c0(c, gamma):
    return street(90 + min(c, 360 - c), gamma)


def both(c, gamma):
    c = min(c, 360 - c)
    return street(min(c, 180 - c), gamma)


def ies_text(horizontal, value, lumens=LUMENS, multiplier=2.5):
    rows = [[value(c, g) for g in GAMMA] for c in horizontal]
    lines = ["IESNA:LM-63-2002", "[TEST] 1", "[MANUFAC] none", "TILT=NONE",
             f"1 {lumens:g} {multiplier:g} {len(GAMMA)} {len(horizontal)} 1 2 0.2 0.5 0", "1 1 100",
             " ".join(f"{g:g}" for g in GAMMA), " ".join(f"{c:g}" for c in horizontal)]
    lines += [" ".join(f"{v:g}" for v in row) for row in rows]
    return "\r\n".join(lines) + "\r\n"


def steps(low, high, step):
    return [low + step * i for i in range(round((high - low) / step) + 1)]


def ldt_text(symmetry, value):
    planes = steps(0, 345, 15)
    stored = {0: planes, 1: [0.0], 2: steps(0, 180, 15), 3: [c % 360 for c in steps(270, 450, 15)], 4: steps(0, 90, 15)}
    lines = ["none", 3, symmetry, len(planes), 15, len(GAMMA), 5, "1", "lamp", "2", "lamp.ldt", "today"]
    lines += [500, 200, 80, 450, 150, 0, 0, 0, 0, 100, 100, 1, 0, 1, 1, "LED", f"{LUMENS:g}", "4000", "80", "100"]
    lines += [0.5] * 10 + planes + GAMMA + [value(c, g) for c in stored[symmetry] for g in GAMMA]
    return "\r\n".join(f"{x:g}".replace(".", ",") if isinstance(x, float) else str(x) for x in lines) + "\r\n"


def write_files():
    FOLDER.mkdir(parents=True, exist_ok=True)
    texts = {
        "round.ies": ies_text([0], both),
        "quadrants.ies": ies_text(steps(0, 90, 15), both),
        "about_c0.ies": ies_text(steps(0, 180, 15), about_c0),
        "about_c90.ies": ies_text(steps(90, 270, 15), street),
        "full.ies": ies_text(steps(0, 360, 15), street),
        "none.ldt": ldt_text(0, street),
        "round.ldt": ldt_text(1, both),
        "about_c0.ldt": ldt_text(2, about_c0),
        "about_c90.ldt": ldt_text(3, street),
        "quadrants.ldt": ldt_text(4, both),
    }
    for name, text in texts.items():
        (FOLDER / name).write_bytes(text.encode("latin-1"))
    read = pyldt.LdtReader.read(FOLDER / "about_c90.ldt")
    eulumdat_ies.ldt_to_ies(read, FOLDER / "by_eulumdat_ies.ies")
    pyldt.LdtWriter.write(read, FOLDER / "by_eulumdat_py.ldt", overwrite=True)
    other = eulumdat.Eulumdat.from_file(str(FOLDER / "none.ldt"))
    (FOLDER / "by_eulumdat.ies").write_text(other.to_ies())
    (FOLDER / "by_eulumdat.ldt").write_text(other.to_ldt())


def by_python(path):
    """Planes, angles and cd by eulumdat-py or eulumdat-ies."""
    ldt = eulumdat_ies.ies_to_ldt(path) if path.suffix == ".ies" else pyldt.LdtReader.read(path)
    cd = np.array(ldt.intensities) * ldt.header.lamp_flux[0] / 1000
    planes = ldt.header.c_angles[: len(cd)]
    return planes, ldt.header.g_angles, cd


def by_rust(path):
    """The same by eulumdat: the planes that the file stores, in its order."""
    read = eulumdat.Eulumdat.parse_ies(path.read_text()) if path.suffix == ".ies" else eulumdat.Eulumdat.from_file(str(path))
    cd = np.array(read.intensities) * read.lamp_sets[0].total_luminous_flux / 1000
    planes = list(read.c_angles)
    if path.suffix == ".ldt" and len(cd) < len(planes):
        first = planes.index(270.0) if "C90" in str(read.symmetry) else 0
        planes = [planes[(first + i) % len(planes)] for i in range(len(cd))]
    return planes[: len(cd)], list(read.g_angles), cd


def flux(planes, gamma, cd):
    """The integral of the bilinear interpolation, by adaptive quadrature cell by cell."""
    if len(planes) == 1:
        planes, cd = [0.0, 360.0], np.vstack([cd, cd])
    at = RegularGridInterpolator((planes, gamma), cd)
    total = 0.0
    for a, b in zip(planes, planes[1:]):
        for low, high in zip(gamma, gamma[1:]):
            total += dblquad(lambda g, c: float(at((c, g))) * math.sin(math.radians(g)), a, b, low, high, epsabs=1e-6)[0]
    return total * math.radians(1) ** 2


def every(count, planes, gamma, cd):
    """Some of the intensities: plane, angle and cd."""
    cells = [(float(c), float(g), float(cd[i][j])) for i, c in enumerate(planes) for j, g in enumerate(gamma)]
    return cells[::count]


def main():
    write_files()
    lamps = {}
    for path in sorted(FOLDER.iterdir()):
        if path.suffix not in (".ies", ".ldt"):
            continue
        lamps[path.name] = {"eulumdat-py, eulumdat-ies": every(5, *by_python(path)), "eulumdat": every(7, *by_rust(path))}
    planes, gamma, cd = by_python(FOLDER / "full.ies")
    closed = ([*planes, 360.0], gamma, np.vstack([cd, cd[:1]])) if planes[-1] < 360 else (planes, gamma, cd)
    figures = {
        "script": "tests/oracles/lamps.py",
        "libraries": "eulumdat 0.7.1, eulumdat-py 1.0.0, eulumdat-ies 1.1.0",
        "flux_lm": {"full.ies": flux(*closed), "round.ies": flux(*by_python(FOLDER / "round.ies"))},
        "lamps": lamps,
    }
    with open(FOLDER.parent / "lamps.json", "w") as file:
        json.dump(figures, file, indent=None, separators=(",", ":"))
        file.write("\n")


if __name__ == "__main__":
    main()
