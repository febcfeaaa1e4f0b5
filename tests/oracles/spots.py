"""Spots, their centroids and chief rays by optiland and rayoptics (figures/spots.json), of lenses of which the rims clip the light.

optiland traces a square grid of parallel rays, square to the field's direction, over the whole front surface; rays that meet a surface
outside its opening are dropped, what passes is parted into connected bundles, and each is looked at again on a grid of its own. Every ray
counts the same: a far source lights that plane evenly. The chief ray goes through the middle of the stop. rayoptics traces the singlet behind its
stop, whose bundle is known beforehand, over rings and spokes with Gauss's weights; of every lens it traces the chief ray, too. Versions:
requirements.txt. Run anywhere, for all lenses or for those that are named (the others' figures are kept):
    python tests/oracles/spots.py [NAME ...]
"""

import json
import pathlib
import sys

import numpy as np
from rayoptics.raytr import raytrace
from scipy.ndimage import label
from scipy.optimize import brentq

from lenses import index, optiland_lens, optiland_trace, optiland_paraxial, rayoptics_lens, read, write

LINES = {"d": 587.56, "F": 486.1327, "C": 656.2725}
SIDE = 1600


def surface(radius, thickness, glass, semi, stop=False):
    return {"radius": radius, "thickness": thickness, "glass": glass, "open": semi, "stop": stop}


GLASS = (1.5168, 64.17)
BEHIND_ITS_STOP = [surface(np.inf, 3.0, None, 0.8, True), surface(12.0, 4.0, GLASS, 4.0), surface(-9.5, 0.0, None, 4.0)]
BEFORE_ITS_STOP = [surface(12.0, 4.0, GLASS, 5.0), surface(-9.5, 3.0, None, 5.0), surface(np.inf, 0.0, None, 0.8, True)]

# M. Laikin, Lens Design, 4th ed. (CRC Press 2007), p. 108, as optiland's samples have it: 100° across, f/4, 0.656 in; a strong negative front group
# and a stop far behind it. Radius and thickness in inches; clear apertures (mm) chosen for this test, to clip the bundle of 30° to some six tenths.
SK4, SF1 = (1.61272, 58.63), (1.71736, 29.62)
LAIKIN = [
    (8.0107, 0.2500, SK4, 21.42), (1.1856, 0.9613, None, 17.38), (1.6747, 0.3578, SF1, 13.22), (-7.5157, 0.2136, SK4, 11.56),
    (0.9411, 0.4146, None, 9.44), (-1.7688, 0.3333, SF1, 8.00), (-1.5531, 0.3863, SK4, 7.78), (-2.2281, 0.9842, None, 7.36),
    (np.inf, 0.1000, None, 5.832), (13.6803, 0.1400, SK4, 5.96), (-3.4279, 0.0605, None, 6.18), (20.0257, 0.3332, SK4, 6.34),
    (-0.9258, 0.4374, SF1, 6.70), (-3.2233, 0.2679, None, 7.46), (10.3847, 0.1400, SF1, 7.86), (2.4272, 0.2609, SK4, 8.12),
    (-3.8828, 0.0150, None, 8.56), (3.3650, 0.3167, SK4, 8.64), (-14.7547, 0.0, None, 8.68),
]
INCH = 25.4
RETROFOCUS = [surface(r * INCH, round(t * INCH, 6), glass, semi, i == 8) for i, (r, t, glass, semi) in enumerate(LAIKIN)]
CASES = {
    "singlet behind its stop": (BEHIND_ITS_STOP, [0.0, 5.0, 10.0]),
    "singlet before its stop": (BEFORE_ITS_STOP, [0.0, 4.0, 8.0, 9.0]),
    "double-gauss": (read("double-gauss"), [0.0, 10.0, 18.0]),
    "wide-angle": (read("wide-angle"), [0.0, 20.0, 30.0]),
    "retrofocus of 100 degrees": (RETROFOCUS, [0.0, 15.0, 30.0]),
}


def frame(angle):
    a = np.radians(angle)
    return np.array([0.0, np.sin(a), np.cos(a)]), np.array([0.0, np.cos(a), -np.sin(a)])


def trace(surfaces, nm, back, angle, x, y):
    """Where rays at x across and y up in the plane square to them land; and which pass."""
    lens = optiland_lens(surfaces, nm, back)
    direction, up = frame(angle)
    points = np.outer(x, [1.0, 0.0, 0.0]) + np.outer(y, up) - 60.0 * direction
    with np.errstate(all="ignore"):
        rays, at = optiland_trace(lens, points, np.tile(direction, (len(x), 1)), nm)
    passed = np.ones(len(x), dtype=bool)
    for i, s in enumerate(surfaces):
        hit = at(i + 1)
        passed &= np.isfinite(hit).all(axis=1) & (hit[:, 0] ** 2 + hit[:, 1] ** 2 <= s["open"] ** 2)
    return at(len(surfaces) + 1)[:, :2], passed, at


def grid(box, side):
    u = box[0] + (np.arange(side) + 0.5) * (box[1] - box[0]) / side
    v = box[2] + (np.arange(side) + 0.5) * (box[3] - box[2]) / side
    return np.meshgrid(u, v, indexing="ij")


def bundles(surfaces, nm, back, angle):
    reach = 1.2 * surfaces[0]["open"] + 2.0
    box = [-reach, reach, -reach, reach]
    x, y = grid(box, SIDE)
    _, passed, _ = trace(surfaces, nm, back, angle, x.ravel(), y.ravel())
    labels, count = label(passed.reshape(SIDE, SIDE))
    step, found = 2.0 * reach / SIDE, []
    for k in range(1, count + 1):
        part = labels == k
        if part.sum() < 4:
            continue
        inside = [x[part].min() - step, x[part].max() + step, y[part].min() - step, y[part].max() + step]
        fx, fy = grid(inside, SIDE)
        image, through, _ = trace(surfaces, nm, back, angle, fx.ravel(), fy.ravel())
        near, _ = label(through.reshape(SIDE, SIDE))
        # Of the parts in its box the one of the first look.
        own = near[np.unravel_index(np.argmin((fx - x[part].mean()) ** 2 + (fy - y[part].mean()) ** 2), near.shape)]
        sizes = np.bincount(near.ravel())
        sizes[0] = 0
        own = own if own else int(np.argmax(sizes))
        landed = image[(near == own).ravel()]
        centroid = landed.mean(axis=0)
        square = ((landed - centroid) ** 2).sum(axis=1)
        cell = (inside[1] - inside[0]) * (inside[3] - inside[2]) / SIDE**2
        found.append({
            "area_mm2": len(landed) * cell, "centroid_mm": float(centroid[1]),
            "rms_mm": float(np.sqrt(square.mean())), "radius_mm": float(np.sqrt(square.max())),
        })
    return sorted(found, key=lambda b: -b["area_mm2"])


def chief(surfaces, nm, back, angle):
    stop = next(i for i, s in enumerate(surfaces) if s["stop"])
    def missed(y):
        _, _, at = trace(surfaces, nm, back, angle, np.zeros(1), np.array([y]))
        return float(at(stop + 1)[0][1])
    y = np.linspace(-0.9, 0.9, 181) * surfaces[0]["open"]
    _, _, at = trace(surfaces, nm, back, angle, np.zeros_like(y), y)
    heights = at(stop + 1)[:, 1]
    i = min((i for i in range(180) if heights[i] * heights[i + 1] <= 0.0), key=lambda i: abs(heights[i + 1] - heights[i]))
    root = brentq(missed, y[i], y[i + 1], xtol=1e-13)
    image, _, _ = trace(surfaces, nm, back, angle, np.zeros(1), np.array([root]))
    return float(image[0, 1]), chief_by_rayoptics(surfaces, nm, back, angle, root)


def chief_by_rayoptics(surfaces, nm, back, angle, root):
    """The same, its start found anew from a guess near by."""
    model = rayoptics_lens(surfaces, nm, back).seq_model
    stop = next(i for i, s in enumerate(surfaces) if s["stop"])
    direction, up = frame(angle)

    def traced(y):
        # The object plane of this program, 50 mm before the first vertex.
        start = y * up
        start = start + direction * ((-50.0 - start[2]) / direction[2])
        return raytrace.trace(model, np.array([0.0, start[1], 0.0]), direction, nm)[0]

    found = brentq(lambda y: float(traced(y)[stop + 1][0][1]), root - 0.1, root + 0.1, xtol=1e-13)
    return float(traced(found)[-1][0][1])


def by_rayoptics(surfaces, nm, back, angle):
    """Spot of the singlet behind its stop: the stop filled evenly."""
    model = rayoptics_lens(surfaces, nm, back).seq_model
    direction, _ = frame(angle)
    radii, weights = np.polynomial.legendre.leggauss(10)
    spokes, landed, weight = 40, [], []
    for r, w in zip(0.5 * (radii + 1.0), 0.5 * weights):
        for k in range(spokes):
            a = 2.0 * np.pi * (k + 0.5) / spokes
            point = np.array([0.8 * r * np.cos(a), 0.8 * r * np.sin(a), 0.0])
            start = point + direction * (-50.0 / direction[2])
            ray, _, _ = raytrace.trace(model, np.array([start[0], start[1], 0.0]), direction, nm)
            landed.append(ray[-1][0][:2])
            weight.append(w * r)
    landed, weight = np.array(landed, dtype=float), np.array(weight) / np.sum(weight)
    centroid = weight @ landed
    return {"centroid_mm": float(centroid[1]), "rms_mm": float(np.sqrt(weight @ ((landed - centroid) ** 2).sum(axis=1)))}


def field(surfaces, back, angle):
    chiefs = {line: chief(surfaces, nm, back, angle) for line, nm in LINES.items()}
    optiland = {line: {"chief_mm": chiefs[line][0], "bundles": bundles(surfaces, nm, back, angle)} for line, nm in LINES.items()}
    rayoptics = {line: {"chief_mm": chiefs[line][1]} for line in LINES}
    if surfaces is BEHIND_ITS_STOP:
        for line, nm in LINES.items():
            rayoptics[line] |= by_rayoptics(surfaces, nm, back, angle)
    return {"angle_deg": angle, "optiland": optiland, "rayoptics": rayoptics}


def stored():
    """The figures as they stand, by lens."""
    path = pathlib.Path(__file__).parent / "figures" / "spots.json"
    return {lens["name"]: lens for lens in json.loads(path.read_text())["lenses"]}


def main():
    asked, lenses = sys.argv[1:], []
    known = stored() if asked else {}
    for name, (surfaces, angles) in CASES.items():
        if name in known and name not in asked:
            lenses.append(known[name])
            continue
        back = optiland_paraxial(optiland_lens(surfaces, LINES["d"], 10.0), 10.0)["back_focus_mm"]
        fields = [field(surfaces, back, angle) for angle in angles]
        print(name, fields)
        keys = ("radius", "thickness", "glass", "open", "stop")
        plain = [{k: (None if k == "radius" and np.isinf(s[k]) else s[k]) for k in keys} for s in surfaces]
        lenses.append({"name": name, "back_mm": back, "surfaces": plain, "fields": fields})
    write("spots", {"lenses": lenses})


if __name__ == "__main__":
    main()
