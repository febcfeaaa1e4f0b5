"""Closed forms to 60 digits by mpmath for tests/tests/physics/ranges/numerics: figures/closed_forms.json.

Python 3.11, mpmath 1.4.1 (requirements.txt). Run at the root of the repository (seconds):
    python tests/oracles/closed_forms.py

Arguments are exact floats over the whole range that a function is declared for; each value is the nearest double and what is left of it.
"""

import json
import math
import random

import mpmath
import numpy as np

mpmath.mp.dps = 60
COUNT = 36
random.seed(20)


def logarithmic(low, high, signs=(1,)):
    return [random.choice(signs) * math.exp(random.uniform(math.log(low), math.log(high))) for _ in range(COUNT)]


def even(low, high):
    return [random.uniform(low, high) for _ in range(COUNT)]


def near(points, scale):
    """Either side of points, 10⁻¹ … `scale` away."""
    return [p + s * 10 ** random.uniform(math.log10(scale), -1) for p in points for s in (-1, 1) for _ in range(6)]


WHOLE = logarithmic(1e-300, 1e300)
SIGNED = logarithmic(1e-300, 1e300, (-1, 1))
ANGLES = logarithmic(1e-300, 1e5, (-1, 1)) + near([math.pi * k / 2 for k in (1, 2, 3, 7, 100)], 1e-12) + even(-20, 20)
UNIT = logarithmic(1e-300, 1, (-1, 1)) + even(-1, 1) + [s * (1 - 10 ** random.uniform(-15.5, -1)) for s in (-1, 1) for _ in range(12)]
EXPONENTS = logarithmic(1e-300, 700, (-1, 1)) + even(-700, 700)
ABOUT_ONE = WHOLE + [1 + s * 10 ** random.uniform(-15, -1) for s in (-1, 1) for _ in range(16)]

ONE = {
    "sin": (mpmath.sin, ANGLES),
    "cos": (mpmath.cos, ANGLES),
    "tan": (mpmath.tan, ANGLES),
    "asin": (mpmath.asin, UNIT),
    "acos": (mpmath.acos, UNIT),
    "atan": (mpmath.atan, SIGNED + even(-5, 5)),
    "exp": (mpmath.exp, EXPONENTS),
    "exp2": (lambda x: mpmath.mpf(2) ** x, [1.4 * x for x in EXPONENTS]),
    "exp_m1": (mpmath.expm1, EXPONENTS),
    "ln": (mpmath.log, ABOUT_ONE),
    "ln_1p": (mpmath.log1p, WHOLE + logarithmic(1e-300, 0.999, (-1,))),
    "log2": (lambda x: mpmath.log(x, 2), ABOUT_ONE),
    "log10": (lambda x: mpmath.log(x, 10), ABOUT_ONE),
    "cbrt": (lambda x: mpmath.sign(x) * mpmath.cbrt(abs(x)), SIGNED),
}
# The same within what a float of 32 bits holds.
SINGLE_RANGE = (1e-37, 1e37)
S_WHOLE = logarithmic(*SINGLE_RANGE)
S_SIGNED = logarithmic(*SINGLE_RANGE, (-1, 1))
S_EXPONENTS = logarithmic(1e-37, 87, (-1, 1)) + even(-87, 87)
S_ABOUT_ONE = S_WHOLE + [1 + s * 10 ** random.uniform(-6.5, -1) for s in (-1, 1) for _ in range(16)]
S_ANGLES = logarithmic(1e-37, 1e4, (-1, 1)) + near([math.pi * k / 2 for k in (1, 2, 3, 7, 100)], 1e-5) + even(-20, 20)
S_UNIT = logarithmic(1e-37, 1, (-1, 1)) + even(-1, 1) + [s * (1 - 10 ** random.uniform(-7, -1)) for s in (-1, 1) for _ in range(12)]
SINGLE = {
    "sin": S_ANGLES,
    "cos": S_ANGLES,
    "tan": S_ANGLES,
    "asin": S_UNIT,
    "acos": S_UNIT,
    "atan": S_SIGNED + even(-5, 5),
    "exp": S_EXPONENTS,
    "exp2": [1.4 * x for x in S_EXPONENTS],
    "exp_m1": S_EXPONENTS,
    "ln": S_ABOUT_ONE,
    "ln_1p": S_WHOLE + logarithmic(1e-37, 0.999, (-1,)),
    "log2": S_ABOUT_ONE,
    "log10": S_ABOUT_ONE,
    "cbrt": S_SIGNED,
}


def pow_pairs(low, high, most):
    """Bases with exponents that keep the power within e^±most."""
    bases = logarithmic(low, high) + [1 + s * 10 ** random.uniform(-6, -1) for s in (-1, 1) for _ in range(16)]
    return [(b, random.uniform(-most, most) / max(abs(math.log(b)), 1e-9)) for b in bases]


def fresnel(c, n):
    """Both planes of a dielectric."""
    t = mpmath.sqrt(n * n - 1 + c * c)
    return ((c - t) / (c + t)) ** 2, ((n * n * c - t) / (n * n * c + t)) ** 2


def conductor(c, n, k):
    index = mpmath.mpc(n, k)
    t = mpmath.sqrt(index * index - 1 + c * c)
    s, p = abs((c - t) / (c + t)) ** 2, abs((index * index * c - t) / (index * index * c + t)) ** 2
    return (s + p) / 2


def planck(nm, kelvin):
    h, c, k = mpmath.mpf("6.62607015e-34"), mpmath.mpf(299792458), mpmath.mpf("1.380649e-23")
    metres = mpmath.mpf(nm) / 10**9
    return 2 * h * c * c / metres**5 / mpmath.expm1(h * c / (metres * k * kelvin)) / 10**9


def ciede2000(one, other):
    """Sharma, Wu and Dalal (2005), equations 1 to 22."""
    (l1, a1, b1), (l2, a2, b2) = [[mpmath.mpf(v) for v in lab] for lab in (one, other)]
    mean_c = (mpmath.hypot(a1, b1) + mpmath.hypot(a2, b2)) / 2
    g = (1 - mpmath.sqrt(mean_c**7 / (mean_c**7 + mpmath.mpf(25) ** 7))) / 2
    a1, a2 = (1 + g) * a1, (1 + g) * a2
    c1, c2 = mpmath.hypot(a1, b1), mpmath.hypot(a2, b2)
    degrees = lambda a, b: mpmath.degrees(mpmath.atan2(b, a)) % 360 if (a or b) else mpmath.mpf(0)
    h1, h2 = degrees(a1, b1), degrees(a2, b2)
    turn = h2 - h1
    if c1 * c2 == 0:
        turn = mpmath.mpf(0)
    elif turn > 180:
        turn -= 360
    elif turn < -180:
        turn += 360
    d_l, d_c, d_h = l2 - l1, c2 - c1, 2 * mpmath.sqrt(c1 * c2) * mpmath.sin(mpmath.radians(turn / 2))
    l, c = (l1 + l2) / 2, (c1 + c2) / 2
    if c1 * c2 == 0:
        h = h1 + h2
    elif abs(h1 - h2) <= 180:
        h = (h1 + h2) / 2
    else:
        h = (h1 + h2 + 360) / 2 if h1 + h2 < 360 else (h1 + h2 - 360) / 2
    cos = lambda x: mpmath.cos(mpmath.radians(x))
    t = 1 - mpmath.mpf("0.17") * cos(h - 30) + mpmath.mpf("0.24") * cos(2 * h) + mpmath.mpf("0.32") * cos(3 * h + 6) - mpmath.mpf("0.2") * cos(4 * h - 63)
    s_l = 1 + mpmath.mpf("0.015") * (l - 50) ** 2 / mpmath.sqrt(20 + (l - 50) ** 2)
    s_c, s_h = 1 + mpmath.mpf("0.045") * c, 1 + mpmath.mpf("0.015") * c * t
    theta = 30 * mpmath.exp(-(((h - 275) / 25) ** 2))
    r_t = -mpmath.sin(mpmath.radians(2 * theta)) * 2 * mpmath.sqrt(c**7 / (c**7 + mpmath.mpf(25) ** 7))
    return mpmath.sqrt((d_l / s_l) ** 2 + (d_c / s_c) ** 2 + (d_h / s_h) ** 2 + r_t * d_c / s_c * d_h / s_h)


def density(alpha, m):
    """GGX: facets by solid angle over the projected area (Walter et al. 2007, equation 33)."""
    x, y, z = m
    return 1 / (mpmath.pi * alpha**2 * ((x * x + y * y) / alpha**2 + z * z) ** 2)


def slant(alpha, w):
    """cos θ (2 Λ + 1)."""
    x, y, z = w
    return mpmath.sqrt(z * z + alpha**2 * (x * x + y * y))


def masking(alpha, w):
    """G₁ of Smith's form (Heitz 2014, equation 43)."""
    return 2 * w[2] / (w[2] + slant(alpha, w))


def reflection(alpha, wo, wi, m):
    """D G₂/(4 cos θₒ), height-correlated (Heitz 2014, equation 99)."""
    g2 = 2 * wo[2] * wi[2] / (wi[2] * slant(alpha, wo) + wo[2] * slant(alpha, wi))
    return density(alpha, m) * g2 / (4 * wo[2])


def drawn(alpha, wo, u):
    """A visible facet by the spherical cap (Dupuy and Benyoub 2023, listing 3)."""
    unit = lambda v: [c / mpmath.sqrt(sum(d * d for d in v)) for c in v]
    sx, sy, sz = unit([alpha * wo[0], alpha * wo[1], wo[2]])
    z = (1 - u[1]) * (1 + sz) - sz
    r = mpmath.sqrt(1 - z * z)
    turn = 2 * mpmath.pi * u[0]
    h = [r * mpmath.cos(turn) + sx, r * mpmath.sin(turn) + sy, z + sz]
    return tuple(unit([alpha * h[0], alpha * h[1], h[2]]))


def direction(cosine):
    """A direction of about this cosine, in floats of 32 bits."""
    turn, sine = random.uniform(0, 2 * math.pi), math.sqrt(1 - cosine * cosine)
    return single([sine * math.cos(turn), sine * math.sin(turn), cosine])


def vectors(f):
    """The same of flat arguments: roughness, then directions of three numbers each."""
    return lambda alpha, *flat: f(alpha, *[flat[i : i + 3] for i in range(0, len(flat), 3)])


def observer():
    """The CIE 1931 functions at each nanometre, 360 to 830."""
    rows = [line.split(",") for line in open("crates/spectra/data/cie_1931_2deg_1nm.csv") if line[0].isdigit()]
    return [(mpmath.mpf(nm), [mpmath.mpf(v) for v in values]) for nm, *values in rows]


OBSERVER = observer()


def tristimulus(spectrum):
    """X, Y, Z, x and y by the sum over nanometres (CIE 15:2018, 7.1)."""
    sums = [683 * sum(spectrum(nm) * bars[i] for nm, bars in OBSERVER) for i in range(3)]
    return (*sums, sums[0] / sum(sums), sums[1] / sum(sums))


def single(values):
    return [float(np.float32(v)) for v in values]


def split(value):
    nearest = float(value)
    return [nearest, float(value - mpmath.mpf(nearest))]


def table(rows, answers):
    """Arguments and their answers, each number the nearest double and the rest."""
    out = []
    for arguments in rows:
        values = answers(*[mpmath.mpf(a) if not isinstance(a, (list, tuple)) else a for a in arguments])
        values = values if isinstance(values, tuple) else (values,)
        out.append({"at": list(arguments), "is": [split(v) for v in values]})
    return out


def within(rows, largest, smallest):
    return [r for r in rows if all(v[0] == 0 or smallest < abs(v[0]) < largest for v in r["is"])]


figures = {"version": mpmath.__version__, "double": {}, "single": {}}
for name, (f, arguments) in ONE.items():
    figures["double"][name] = within(table([(x,) for x in arguments], f), 1e307, 1e-307)
    figures["single"][name] = within(table([(x,) for x in single(SINGLE[name])], f), 3e38, 1.2e-38)
two = lambda pairs, f, top, bottom: within(table(pairs, f), top, bottom)
figures["double"]["pow"] = two(pow_pairs(1e-300, 1e300, 690), mpmath.power, 1e307, 1e-307)
figures["single"]["pow"] = two([tuple(single(p)) for p in pow_pairs(1e-37, 1e37, 85)], mpmath.power, 3e38, 1.2e-38)
figures["double"]["atan2"] = two(list(zip(SIGNED, logarithmic(1e-300, 1e300, (-1, 1)))), mpmath.atan2, 1e307, 1e-307)
figures["single"]["atan2"] = two([tuple(single(p)) for p in zip(S_SIGNED, logarithmic(*SINGLE_RANGE, (-1, 1)))], mpmath.atan2, 3e38, 1.2e-38)
figures["double"]["hypot"] = two(list(zip(WHOLE, [x * 10 ** random.uniform(-3, 3) for x in WHOLE])), mpmath.hypot, 1e307, 1e-307)
figures["single"]["hypot"] = two([tuple(single(p)) for p in zip(S_WHOLE, [x * 10 ** random.uniform(-1, 1) for x in S_WHOLE])], mpmath.hypot, 3e38, 1.2e-38)

cosines = logarithmic(1e-6, 1)
indices = [1 + 10 ** random.uniform(-4, 0.477) for _ in range(COUNT)]
figures["dielectric"] = table([tuple(single(p)) for p in zip(cosines, indices)], fresnel)
metals = [(c, 10 ** random.uniform(-1.5, 0.8), 10 ** random.uniform(-1, 1)) for c in cosines]
figures["conductor"] = table([tuple(single(p)) for p in metals], conductor)
figures["planck"] = within(table(list(zip(even(300, 1100), logarithmic(10, 1e8))), planck), 1e307, 1e-290)
labs = [[random.uniform(0, 100), random.uniform(-120, 120), random.uniform(-120, 120)] for _ in range(COUNT)]
others = [[v + random.choice((1e-6, 1e-2, 1, 30)) * random.uniform(-1, 1) for v in lab] for lab in labs]
figures["ciede2000"] = table(list(zip(labs, others)), ciede2000)

# What 32 bits hold of roughness, directions and random numbers.
roughness = single([10 ** random.uniform(-4, 0) for _ in range(COUNT)])
facets = [direction(1 / math.hypot(1, a * 10 ** random.uniform(-2, 1.5))) for a in roughness]
grazing = lambda: [direction(c) for c in logarithmic(1e-6, 1)]
flat = lambda *columns: [tuple(v for part in row for v in (part if isinstance(part, list) else [part])) for row in zip(*columns)]
figures["ggx"] = {
    "density": table(flat(roughness, facets), vectors(density)),
    "masking": table(flat(roughness, grazing()), vectors(masking)),
    "reflection": table(flat(roughness, grazing(), grazing(), facets), vectors(reflection)),
    "drawn": table(
        flat(roughness, grazing(), [single([random.random(), random.random()]) for _ in range(COUNT)]),
        lambda alpha, x, y, z, *u: drawn(alpha, (x, y, z), u),
    ),
}
figures["black_bodies"] = table([(10 ** random.uniform(3, 6),) for _ in range(COUNT)], lambda kelvin: tristimulus(lambda nm: planck(nm, kelvin)))
lines = [(random.uniform(380, 780), 10 ** random.uniform(0, 2)) for _ in range(COUNT)]
figures["lines"] = table(lines, lambda centre, width: tristimulus(lambda nm: mpmath.exp(-(((nm - centre) / width) ** 2))))

# A row a line: differences stay readable.
lines = json.dumps(figures).replace('{"at"', '\n{"at"')
with open("tests/oracles/figures/closed_forms.json", "w") as file:
    file.write(lines + "\n")
