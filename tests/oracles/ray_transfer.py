"""Fall-off and edge response of a published ray-transfer file (figures/ray_transfer.json), by numpy from the file alone.

The convention is that of the camera "rtf" in ISET's fork of pbrt-v4 (https://github.com/scienstanford/pbrt-v4, src/pbrt/cameras.cpp): rays are turned until
their point on the input plane lies on the y axis, pass where they meet an ellipse, and leave by the polynomials. A square grid of points of the pupil's plane takes
the place of samples. An edge at infinity is square to the meridian: light comes from directions that look farther out than the grid's mean ray of the
edge's field; its response is the share of that light in pixels about the field. Run anywhere: python tests/oracles/ray_transfer.py
"""

import json
import pathlib

import numpy as np

FOLDER = pathlib.Path(__file__).parent / "figures"
FILE = FOLDER.parents[2] / "scenes" / "lenses" / "dgauss28deg-zemax-poly6-raytransfer.json"
# Where ISET's scripts have the film of this lens, mm behind its last surface: the focus of infinity.
FILM = 57.315
SIDE = 401
# Pixels to either side of an edge, their size in mm, and places looked at in each.
PIXELS, PITCH, PARTS = 6, 0.005, 3


def polynomial(spec, rho, dx, dy):
    powers = [np.cumprod(np.stack([np.ones_like(x)] + [x] * 9), axis=0) for x in (rho, dx, dy)]
    terms = zip(*(np.atleast_1d(spec[k]) for k in ("coeff", "termr", "termdx", "termdy")))
    return sum(c * powers[0][a] * powers[1][b] * powers[2][d] for c, a, b, d in terms)


class Lens:
    def __init__(self, text):
        self.data = json.loads(text)
        self.one = self.data["polynomials"][0]
        self.by_name = {p["outputname"]: p for p in self.one["poly"]}
        self.ellipse = self.one["passnopass"]

    def rays(self, height):
        """Weights of the rays that pass, and their slopes along the meridian in front of the lens, of a film point (0, height)."""
        plane = self.ellipse["intersectPlaneDistance"]
        to_input = FILM - self.data["planeoffsetinput"]
        distance = to_input + plane
        reach = 20.0
        grid = (np.arange(SIDE) + 0.5) / SIDE * 2 * reach - reach
        qx, qy = np.meshgrid(grid, grid + 0.53 * height)
        along = np.stack([qx, qy - height, np.full_like(qx, distance)])
        along /= np.linalg.norm(along, axis=0)
        px, py = along[0] / along[2] * to_input, height + along[1] / along[2] * to_input
        rho = np.hypot(px, py)
        ey, ex = np.where(rho > 0, py / np.maximum(rho, 1e-300), 1.0), np.where(rho > 0, px / np.maximum(rho, 1e-300), 0.0)
        dx, dy = along[0] * ey - along[1] * ex, along[0] * ex + along[1] * ey
        at_x, at_y = dx / along[2] * plane, rho + dy / along[2] * plane
        where = self.ellipse["positions"]
        cx, cy, rx, ry = (np.interp(rho, where, self.ellipse[k]) for k in ("centersX", "centersY", "radiiX", "radiiY"))
        passes = (((at_x - cx) / rx) ** 2 + ((at_y - cy) / ry) ** 2 <= 1) & (rho <= where[-1])
        weight, rho, dx, dy, ex, ey = (np.asarray(x)[passes] for x in (along[2] ** 4, rho, dx, dy, ex, ey))
        u, v = (polynomial(self.by_name[k], rho, dx, dy) for k in ("outdx", "outdy"))
        w = np.sqrt(np.maximum(1 - u * u - v * v, 1e-12))
        return weight, (v * ey - u * ex) / w


def main():
    lens = Lens(FILE.read_text())
    heights = [0.0, 8.0, 16.0, 20.0, 24.0, 28.0]
    light = np.array([lens.rays(h)[0].sum() for h in heights])
    edges = []
    for field in (0.0, 12.0):
        weight, along = lens.rays(field)
        slope = float((weight * along).sum() / weight.sum())
        response = []
        for pixel in range(-PIXELS, PIXELS + 1):
            lit = whole = 0.0
            for part in (np.arange(PARTS) + 0.5) / PARTS - 0.5:
                # A film point sees the far side: outwards is against y.
                weight, along = lens.rays(field + (pixel + part) * PITCH)
                lit, whole = lit + (weight * (along < slope)).sum(), whole + weight.sum()
            response.append(round(float(lit / whole), 6))
        edges.append({"height_mm": field, "outward_slope": -slope, "response": response})
    figures = {
        "film_mm": FILM,
        "pixel_mm": PITCH,
        "heights_mm": heights,
        "relative_illumination": (light / light[0]).tolist(),
        "edges": edges,
    }
    (FOLDER / "ray_transfer.json").write_text(json.dumps(figures, indent=1) + "\n")


if __name__ == "__main__":
    main()
