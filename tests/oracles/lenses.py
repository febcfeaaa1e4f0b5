"""Figures of optiland and rayoptics for the published prescriptions of crates/optics (figures/lenses.json) and for an aspheric
lens (figures/aspheric.json).

Both programs get the surfaces of crates/optics/data/lenses with the index of every glass as a number for each wavelength (their own
models of glasses known by index and Abbe number differ); the Conrady curve of that model is solved here anew. Paraxial quantities and
real rays come from both, relative illumination from optiland: the lens turned round, traced from sensor points over a grid of
slopes, apertures applied. Catalogue indices come from both programs' catalogues. Versions: requirements.txt. Run anywhere:
    python tests/oracles/lenses.py
"""

import json
import pathlib
import warnings
from importlib.metadata import version

import numpy as np
from optiland.materials import IdealMaterial, Material
from optiland.optic import Optic
from optiland.rays import RealRays
from rayoptics.elem.profiles import EvenPolynomial
from rayoptics.environment import OpticalModel
from rayoptics.raytr import raytrace
from opticalglass import glassfactory
from scipy.optimize import fsolve

warnings.filterwarnings("ignore")
ROOT = pathlib.Path(__file__).parents[2]
WAVELENGTHS = [450.0, 587.56, 650.0]
# Field angles of the rays, degrees, and sensor heights of the illumination, mm.
LENSES = {
    "double-gauss": ([0.0, 10.0, 20.0], [0.0, 8.0, 15.0, 20.0]),
    "wide-angle": ([0.0, 20.0, 38.0], [0.0, 7.0, 13.0, 18.0]),
    "fisheye": ([0.0, 45.0, 80.0], [0.0, 5.0, 9.0, 12.0]),
    "telephoto": ([0.0, 2.0, 3.5], [0.0, 2.5, 5.0]),
}
PUPIL = [(0.0, 0.0), (0.0, 0.6), (0.0, -0.6), (0.55, 0.0), (0.4, 0.4)]


def conrady(nd, vd, nm):
    d, f, c, g = (np.array([1.0, 1e3 / l, (1e3 / l) ** 3.5]) for l in (587.5618, 486.1327, 656.2725, 435.8343))
    principal = (nd - 1.0) / vd
    a = np.linalg.solve(np.array([d, f - c, g - f]), [nd, principal, principal * (0.6438 - 0.001682 * vd)])
    return float(a @ np.array([1.0, 1e3 / nm, (1e3 / nm) ** 3.5]))


def read(name):
    path = ROOT / "crates/optics/data/lenses" / (name.replace("-", "_") + ".csv")
    rows = [line.split(",") for line in path.read_text().splitlines() if not line.startswith("#")][1:]
    surface = lambda r, t, g, a: {
        "radius": np.inf if r in ("", "stop") else float(r),
        "thickness": float(t or 0.0),
        "glass": None if g == "air" else tuple(map(float, g.split("/"))),
        "open": float(a),
        "stop": r == "stop",
    }
    return [surface(*row) for row in rows]


def index(glass, nm):
    return 1.0 if glass is None else conrady(*glass, nm)


def optiland_lens(surfaces, nm, back, object_distance=np.inf, indices=None):
    lens = Optic()
    lens.add_surface(index=0, radius=np.inf, thickness=object_distance)
    indices = indices or [index(s["glass"], nm) for s in surfaces]
    for i, (s, n) in enumerate(zip(surfaces, indices)):
        thickness = s["thickness"] if i + 1 < len(surfaces) else back
        lens.add_surface(index=i + 1, radius=s["radius"], thickness=thickness, material=IdealMaterial(n), is_stop=s["stop"])
    lens.add_surface(index=len(surfaces) + 1)
    stop = next(s["open"] for s in surfaces if s["stop"])
    lens.set_aperture("float_by_stop_size", 2.0 * stop)
    lens.set_field_type("angle")
    lens.add_field(y=0.0)
    lens.add_wavelength(value=nm * 1e-3, is_primary=True)
    return lens


def optiland_paraxial(lens, back):
    # F2 and XPL count from the image surface, which stands `back` behind the last vertex.
    p = lens.paraxial
    number = lambda v: float(np.ravel(np.asarray(v))[0])
    return {
        "focal_length_mm": number(p.f2()),
        "back_focus_mm": number(p.F2()) + back,
        "entrance_pupil_mm": number(p.EPL()),
        "entrance_diameter_mm": number(p.EPD()),
        "exit_diameter_mm": number(p.XPD()),
        "exit_pupil_from_image_mm": number(p.XPL()),
    }


def optiland_trace(lens, points, directions, nm):
    x, y, z = np.array(points, dtype=float).T
    l, m, n = np.array(directions, dtype=float).T
    ones = np.ones_like(x)
    rays = RealRays(x, y, z, l, m, n, ones, ones * nm * 1e-3)
    group = lens.surface_group
    for surface in group.surfaces[1:]:
        surface.trace(rays)
    at = lambda i: np.column_stack([group.surfaces[i].x, group.surfaces[i].y, group.surfaces[i].z])
    return rays, at


def rayoptics_lens(surfaces, nm, back):
    model = OpticalModel()
    sequence = model.seq_model
    model.radius_mode = True
    sequence.gaps[0].thi = 50.0
    for i, s in enumerate(surfaces):
        radius = 0.0 if np.isinf(s["radius"]) else s["radius"]
        thickness = s["thickness"] if i + 1 < len(surfaces) else back
        n = index(s["glass"], nm)
        sequence.add_surface([radius, thickness] + ([] if n == 1.0 else [n]))
        if s["stop"]:
            sequence.set_stop()
    model.optical_spec["wvls"].set_from_list([[nm, 1.0]])
    model.update_model()
    return model


def rayoptics_paraxial(surfaces, nm, back):
    model = rayoptics_lens(surfaces, nm, back)
    model.seq_model.gaps[0].thi = 1e10
    model.update_model()
    first = model["analysis_results"]["parax_data"].fod
    return {"focal_length_mm": first.efl, "back_focus_mm": first.bfl, "front_focus_mm": first.ffl, "entrance_pupil_mm": first.enp_dist}


def rays_of(name, surfaces, back, angles):
    """Rays through chosen points of the stop, found with optiland, and what both programs make of them."""
    stop = next(i for i, s in enumerate(surfaces) if s["stop"])
    radius = surfaces[stop]["open"]
    result = []
    for nm in WAVELENGTHS:
        lens = optiland_lens(surfaces, nm, back)
        other = rayoptics_lens(surfaces, nm, back)
        start = np.zeros(2)
        for angle in np.linspace(0.0, max(angles), 41):
            a = np.radians(angle)
            direction = np.array([0.0, np.sin(a), np.cos(a)])

            def launch(q):
                # From the plane through the first vertex across the ray, moved back along it.
                base = np.array([q[0], q[1] * np.cos(a), -q[1] * np.sin(a)])
                return base - 30.0 * direction

            def miss(q, target):
                _, at = optiland_trace(lens, [launch(q)], [direction], nm)
                return at(stop + 1)[0][:2] - target

            start = fsolve(miss, start, args=(np.zeros(2),), xtol=1e-12)
            if min(abs(angle - wanted) for wanted in angles) > 1e-9:
                continue
            for px, py in PUPIL:
                q = fsolve(miss, start, args=(radius * np.array([px, py]),), xtol=1e-12)
                point = launch(q)
                rays, at = optiland_trace(lens, [point], [direction], nm)
                end = at(len(surfaces) + 1)[0]
                out = [float(np.ravel(v)[0]) for v in (rays.L, rays.M, rays.N)]
                # The object plane of the other program, 50 mm before the first vertex.
                moved = point + direction * ((-50.0 - point[2]) / direction[2])
                traced, _, _ = raytrace.trace(other.seq_model, np.array([moved[0], moved[1], 0.0]), direction, nm)
                result.append({
                    "nm": nm, "angle_deg": float(angle), "pupil": [px, py],
                    "point_mm": point.tolist(), "direction": direction.tolist(),
                    "optiland": {"image_mm": end[:2].tolist(), "direction": out},
                    "rayoptics": {"image_mm": list(map(float, traced[-1][0][:2])), "direction": list(map(float, traced[-2][1]))},
                })
    return result


def illumination(surfaces, back, heights, nm=587.56, side=700):
    """∫ cos⁴θ dt over what passes, from sensor points, over that of the axis."""
    turned = [dict(s, radius=-s["radius"]) for s in reversed(surfaces)]
    gaps = [s["thickness"] for s in surfaces[:-1]][::-1] + [10.0]
    behind = [1.0] + [index(s["glass"], nm) for s in surfaces[:-1]]
    for s, gap in zip(turned, gaps):
        s["thickness"] = gap
    lens = optiland_lens(turned, nm, 10.0, object_distance=back, indices=behind[::-1])
    totals = []
    for height in heights:
        box = [-1.5, 1.5, -1.0, 1.0]
        for _ in range(3):
            u, v = np.linspace(box[0], box[1], side), np.linspace(box[2], box[3], side)
            ty, tx = (g.ravel() for g in np.meshgrid(u, v))
            norm = np.sqrt(1.0 + tx**2 + ty**2)
            points = np.column_stack([np.zeros_like(tx), np.full_like(tx, height), np.full_like(tx, -back)])
            rays, at = optiland_trace(lens, points, np.column_stack([tx, ty, np.ones_like(tx)]) / norm[:, None], nm)
            passed = np.ones(tx.shape, dtype=bool)
            for i, s in enumerate(turned):
                hit = at(i + 1)
                passed &= np.isfinite(hit).all(axis=1) & (hit[:, 0] ** 2 + hit[:, 1] ** 2 <= s["open"] ** 2)
            cell = (u[1] - u[0]) * (v[1] - v[0])
            total = float(np.sum(norm[passed] ** -4.0) * cell)
            step = [2.0 * (u[1] - u[0]), 2.0 * (v[1] - v[0])]
            box = [ty[passed].min() - step[0], ty[passed].max() + step[0], tx[passed].min() - step[1], tx[passed].max() + step[1]]
        totals.append(total)
    return {"heights_mm": heights, "projected_sr": totals, "relative": [t / totals[0] for t in totals]}


def catalogue():
    names = [("N-BK7", "Schott"), ("N-SF6", "Schott"), ("F2", "Schott"), ("N-LAK8", "Schott"), ("S-LAH58", "Ohara"), ("S-FPL53", "Ohara")]
    rows = []
    for name, maker in names:
        own, other = Material(name, maker.lower()), glassfactory.create_glass(name, maker)
        for nm in (404.66, 486.13, 587.56, 656.27, 1013.98):
            rows.append({"glass": name, "nm": nm, "optiland": float(np.ravel(own.n(nm * 1e-3))[0]), "opticalglass": float(other.rindex(nm))})
    return rows


# A lens of aspheres as telephones have, its numbers made up: radius, thickness, glass, semi-aperture, conic constant, terms of r⁴, r⁶ …
ASPHERIC = [
    (np.inf, 0.05, None, 0.75, 0.0, []),
    (1.6, 0.8, (1.5445, 55.9), 0.9, -0.6, [1.2e-2, -3e-3, 1e-3]),
    (-9.0, 0.35, None, 0.95, 0.0, [5e-2, -1.5e-2]),
    (-2.5, 0.4, (1.64, 23.5), 1.05, 1.2, [-8e-2, 3e-2, -5e-3]),
    (8.0, 0.6, None, 1.2, 0.0, [-4e-2, 1e-2]),
    (2.2, 0.8, (1.5445, 55.9), 1.9, -3.0, [-5e-2, 8e-3, -5e-4]),
    (3.0, 0.0, None, 2.1, -1.0, [-3e-2, 2e-3]),
]
ASPHERIC_BACK = 1.4


def aspheric_lenses(nm):
    """The aspheric lens in both programs."""
    first, second = Optic(), OpticalModel()
    first.add_surface(index=0, radius=np.inf, thickness=np.inf)
    sequence = second.seq_model
    second.radius_mode = True
    sequence.gaps[0].thi = 50.0
    for i, (radius, thickness, glass, _, conic, terms) in enumerate(ASPHERIC):
        t = thickness if i + 1 < len(ASPHERIC) else ASPHERIC_BACK
        n = index(glass, nm)
        shape = {"surface_type": "even_asphere", "conic": conic, "coefficients": [0.0] + terms, "tol": 1e-14} if terms else {}
        first.add_surface(index=i + 1, radius=radius, thickness=t, material=IdealMaterial(n), is_stop=i == 0, **shape)
        sequence.add_surface([0.0 if np.isinf(radius) else radius, t] + ([] if n == 1.0 else [n]))
        if terms:
            sequence.ifcs[sequence.cur_surface].profile = EvenPolynomial(r=radius, cc=conic, coefs=[0.0] + terms)
        if i == 0:
            sequence.set_stop()
    first.add_surface(index=len(ASPHERIC) + 1)
    first.set_aperture("float_by_stop_size", 2.0 * ASPHERIC[0][3])
    first.set_field_type("angle")
    first.add_field(y=0.0)
    first.add_wavelength(value=nm * 1e-3, is_primary=True)
    second.optical_spec["wvls"].set_from_list([[nm, 1.0]])
    second.update_model()
    return first, second


def both(first, second, surfaces, point, direction, nm):
    """What both programs make of a ray: where it lands, and its direction there."""
    rays, at = optiland_trace(first, [point], [direction], nm)
    moved = point + direction * ((-50.0 - point[2]) / direction[2])
    traced, _, _ = raytrace.trace(second.seq_model, np.array([moved[0], moved[1], 0.0]), direction, nm)
    return {
        "nm": nm, "point_mm": point.tolist(), "direction": direction.tolist(),
        "optiland": {
            "image_mm": at(surfaces + 1)[0][:2].tolist(),
            "direction": [float(np.ravel(v)[0]) for v in (rays.L, rays.M, rays.N)],
        },
        "rayoptics": {"image_mm": list(map(float, traced[-1][0][:2])), "direction": list(map(float, traced[-2][1]))},
    }


def aspheric():
    """Rays through the aspheric lens: figures/aspheric.json."""
    rays = []
    for nm in WAVELENGTHS:
        first, second = aspheric_lenses(nm)
        for angle in (0.0, 8.0, 16.0, 24.0):
            a = np.radians(angle)
            direction = np.array([0.0, np.sin(a), np.cos(a)])
            for px, py in [*PUPIL, (0.0, 0.95), (-0.6, -0.6)]:
                point = 0.75 * np.array([px, py, 0.0]) - 5.0 * direction
                rays.append({"angle_deg": angle} | both(first, second, len(ASPHERIC), point, direction, nm))
    keys = ("radius_mm", "thickness_mm", "glass", "semi_aperture_mm", "conic", "terms")
    surfaces = [dict(zip(keys, s)) | {"radius_mm": None if np.isinf(s[0]) else s[0]} for s in ASPHERIC]
    write("aspheric", {"back_mm": ASPHERIC_BACK, "surfaces": surfaces, "rays": rays})


def write(name, figures):
    programs = [f"{p} {version(p)}" for p in ("optiland", "rayoptics", "opticalglass")]
    path = pathlib.Path(__file__).parent / "figures" / f"{name}.json"
    path.write_text(json.dumps({"programs": programs} | figures, indent=1) + "\n")


def main():
    lenses = []
    for name, (angles, heights) in LENSES.items():
        surfaces = read(name)
        back = optiland_paraxial(optiland_lens(surfaces, 587.56, 10.0), 10.0)["back_focus_mm"]
        paraxial = [
            {"nm": nm, "optiland": optiland_paraxial(optiland_lens(surfaces, nm, back), back), "rayoptics": rayoptics_paraxial(surfaces, nm, back)}
            for nm in WAVELENGTHS
        ]
        lenses.append({
            "name": name, "back_mm": back, "paraxial": paraxial,
            "rays": rays_of(name, surfaces, back, angles), "illumination": illumination(surfaces, back, heights),
        })
        print(name, back, lenses[-1]["illumination"]["relative"])
    write("lenses", {"lenses": lenses, "catalogue": catalogue()})
    aspheric()


if __name__ == "__main__":
    main()
