"""Ghosts of the published double Gauss by optiland and rayoptics: figures/ghosts.json.

Neither program knows ghosts: the lens is written out as light meets it, with two mirrors, running back between them. Indices
are numbers, as in lenses.py; no clear apertures. Versions: requirements.txt. Run anywhere:
    python tests/oracles/ghosts.py
"""

import numpy as np
from optiland.materials import IdealMaterial
from optiland.optic import Optic
from rayoptics.environment import OpticalModel

from lenses import both, index, optiland_lens, optiland_paraxial, read, write

NM = 587.56
# Surfaces from 0, the stop is 5: first the mirror that light meets second.
PAIRS = [(0, 1), (0, 3), (1, 2), (2, 4), (3, 6), (4, 6), (0, 10), (7, 9), (8, 9), (9, 10)]
RAYS = [(0.0, 0.0, 0.0), (0.0, 3.0, 0.0), (2.0, -1.0, 4.0), (0.0, 0.5, 8.0), (-3.0, 1.0, 8.0)]


def written_out(surfaces, back, front, rear):
    """Radius, signed thickness behind, index behind (None for a mirror), as light meets them."""
    thickness = [s["thickness"] for s in surfaces[:-1]] + [back]
    behind = [index(s["glass"], NM) for s in surfaces]
    before = [1.0] + behind[:-1]
    rows = [(surfaces[i]["radius"], thickness[i], behind[i]) for i in range(rear)]
    rows.append((surfaces[rear]["radius"], -thickness[rear - 1], None))
    rows += [(surfaces[i]["radius"], -thickness[i - 1], before[i]) for i in range(rear - 1, front, -1)]
    rows.append((surfaces[external_optics]["radius"], thickness[external_optics], None))
    return rows + [(surfaces[i]["radius"], thickness[i], behind[i]) for i in range(front + 1, len(surfaces))]


def models(rows):
    first, second = Optic(), OpticalModel()
    first.add_surface(index=0, radius=np.inf, thickness=np.inf)
    second.radius_mode = True
    sequence = second.seq_model
    sequence.gaps[0].thi = 50.0
    for i, (radius, thickness, n) in enumerate(rows):
        material = "mirror" if n is None else IdealMaterial(n)
        first.add_surface(index=i + 1, radius=radius, thickness=thickness, material=material, is_stop=i == 0)
        last = ["REFL"] if n is None else ([] if n == 1.0 else [n])
        sequence.add_surface([0.0 if np.isinf(radius) else radius, thickness] + last)
        if i == 0:
            sequence.set_stop()
    first.add_surface(index=len(rows) + 1)
    first.set_aperture("EPD", 5.0)
    first.set_field_type("angle")
    first.add_field(y=0.0)
    first.add_wavelength(value=NM * 1e-3, is_primary=True)
    second.optical_spec["wvls"].set_from_list([[NM, 1.0]])
    second.update_model()
    return first, second


def main():
    surfaces = read("double-gauss")
    back = optiland_paraxial(optiland_lens(surfaces, NM, 10.0), 10.0)["back_focus_mm"]
    rays = []
    for front, rear in PAIRS:
        rows = written_out(surfaces, back, front, rear)
        first, second = models(rows)
        for x, y, angle in RAYS:
            a = np.radians(angle)
            direction = np.array([0.0, np.sin(a), np.cos(a)])
            point = np.array([x, y, 0.0]) - 10.0 * direction
            rays.append({"front": front, "rear": rear} | both(first, second, len(rows), point, direction, NM))
    write("ghosts", {"lens": "double-gauss", "back_mm": back, "rays": rays})


if __name__ == "__main__":
    main()
