"""Solves the three basis reflectances of linear sRGB (crates/spectra/data/srgb_basis.csv).

Mallett & Yuksel 2019, "Spectral primary decomposition for rendering with sRGB reflectance": minimise the sum of squared
first differences over 380-780 nm in steps of 5 nm, with the three reflectances summing to 1, none negative, and each
having exactly its sRGB primary's tristimulus values in the light of D65.

Evaluated as the Rust code does: tables linear between points on a grid of 1 nm, the basis held beyond its ends, D65 and
the observer zero beyond theirs, sums over the nodes of 300-1100 nm. White is D65 so integrated, so that a perfect
diffuser is exactly (1, 1, 1); the sRGB matrices printed at the end are made from it and the primaries' chromaticities.

Python 3.11, numpy 2.4.6, scipy 1.17.1 (requirements.txt). Run at the root of the repository:
    python tests/oracles/upsample_basis.py
"""

import numpy as np
from scipy.optimize import minimize

DATA = "crates/spectra/data/"
GRID = np.arange(300.0, 1101.0)
KNOTS = np.arange(380.0, 781.0, 5.0)
COUNT = len(KNOTS)


def table(name):
    return np.loadtxt(DATA + name, delimiter=",", skiprows=1)


def emission(name):
    t = table(name)
    return np.interp(GRID, t[:, 0], t[:, 1], left=0.0, right=0.0)


def observer():
    t = table("cie_1931_2deg_1nm.csv")
    return np.stack([np.interp(GRID, t[:, 0], t[:, c], left=0.0, right=0.0) for c in (1, 2, 3)])


def knots_to_xyz():
    """3 x COUNT: what each knot adds to XYZ under D65, Y of the perfect diffuser 1."""
    hats = np.stack([np.interp(GRID, KNOTS, row) for row in np.eye(COUNT)])
    d65, bars = emission("illuminant_d65.csv"), observer()
    return (bars * d65) @ hats.T / (bars[1] @ d65)


def srgb_matrix(white):
    primaries = np.array([[0.64, 0.33], [0.30, 0.60], [0.15, 0.06]])
    columns = np.stack([primaries[:, 0] / primaries[:, 1], np.ones(3), (1 - primaries.sum(1)) / primaries[:, 1]])
    return columns * np.linalg.solve(columns, white)


def constraints(to_xyz, matrix):
    """Linear equations A x = b on x = (red, green, blue) knots; the last of each set follows from the sum."""
    sums = np.hstack([np.eye(COUNT)] * 3)
    rows, values = [sums], [np.ones(COUNT)]
    for i in range(2):
        block = np.zeros((3, 3 * COUNT))
        block[:, i * COUNT:(i + 1) * COUNT] = to_xyz
        rows.append(block)
        values.append(matrix[:, i])
    return np.vstack(rows), np.concatenate(values)


def hessian():
    d = np.diff(np.eye(COUNT), axis=0)
    return np.kron(np.eye(3), d.T @ d)


def kkt(h, a, b, fixed):
    """The minimum with the entries of `fixed` at zero; also the multipliers of those."""
    free = ~fixed
    system = np.block([[h[np.ix_(free, free)], a[:, free].T], [a[:, free], np.zeros((len(b), len(b)))]])
    solution = np.linalg.lstsq(system, np.concatenate([np.zeros(free.sum()), b]), rcond=None)[0]
    x = np.zeros(len(fixed))
    x[free] = solution[:free.sum()]
    gradient = h @ x + a.T @ solution[free.sum():]
    return x, gradient


def solve(h, a, b):
    """A start from SLSQP, then an active set iterated until every sign is right."""
    start = minimize(lambda x: 50 * x @ h @ x, np.full(len(h), 1 / 3), jac=lambda x: 100 * h @ x, method="SLSQP",
                     bounds=[(0, None)] * len(h), options={"maxiter": 300, "ftol": 1e-12},
                     constraints={"type": "eq", "fun": lambda x: a @ x - b, "jac": lambda _: a}).x
    fixed = start < 1e-5
    for _ in range(500):
        x, gradient = kkt(h, a, b, fixed)
        worst = np.argmin(x)
        if x[worst] < -1e-12:
            fixed[x < -1e-12] = True
            continue
        held = np.where(fixed, gradient, np.inf)
        release = np.argmin(held)
        if held[release] > -1e-10:
            return x
        fixed[release] = False
    raise SystemExit("the active set does not settle")


def main():
    to_xyz = knots_to_xyz()
    white = to_xyz.sum(1)
    matrix = srgb_matrix(white)
    a, b = constraints(to_xyz, matrix)
    h = hessian()
    basis = solve(h, a, b).reshape(3, COUNT)
    print("roughness", np.sum(np.diff(basis, axis=1) ** 2), "lowest", basis.min())
    print("residual", np.abs(basis @ to_xyz.T - matrix.T).max(), np.abs(basis.sum(0) - 1).max())
    basis = np.clip(basis, 0, 1)
    with open(DATA + "srgb_basis.csv", "w") as file:
        file.write("wavelength_nm,r,g,b\n")
        for nm, row in zip(KNOTS, basis.T):
            file.write(f"{nm:.0f}," + ",".join(f"{v:.10g}" for v in row) + "\n")
    print("white", white.tolist())
    print("XYZ from sRGB", matrix.tolist())
    print("sRGB from XYZ", np.linalg.inv(matrix).tolist())


if __name__ == "__main__":
    main()
