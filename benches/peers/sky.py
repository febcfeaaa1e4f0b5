"""A clear sky as a picture in Radiance's format, for renderers that share no model of the sky.

CIE standard general sky, type 12 (ISO 15469:2004): L = f(chi) phi(Z) with phi(Z) = 1 + a exp(b / cos Z) and
f(chi) = 1 + c (exp(d chi) - exp(d pi / 2)) + e cos^2 chi, Z the angle from the zenith, chi from the sun; scaled to an
illuminance of the level ground. Colours: daylight of 8 000 K at the horizon to 20 000 K at the zenith. The sun's disc is
not in it; below the horizon stands ground of one luminance.
"""

import numpy as np

WIDTH, HEIGHT = 256, 128
A, B, C, D, E = -1.0, -0.32, 10.0, -3.0, 0.45
HORIZON, ZENITH = np.array([0.947, 0.992, 1.237]), np.array([0.747, 0.990, 1.844])
GROUND = np.array([1.0, 1.0, 0.9])


def directions():
    """Of the centres of pixels: row 0 at the zenith, the middle column along +x, columns to the right towards -y."""
    azimuth = (0.5 - (np.arange(WIDTH) + 0.5) / WIDTH) * 2 * np.pi
    zenith = (np.arange(HEIGHT)[:, None] + 0.5) / HEIGHT * np.pi
    return np.stack(np.broadcast_arrays(np.sin(zenith) * np.cos(azimuth), np.sin(zenith) * np.sin(azimuth),
                                        np.cos(zenith)), axis=-1)


def pixels(towards_sun, diffuse_lx, ground_cd_m2):
    """Linear sRGB, cd/m2."""
    way = directions()
    up = way[..., 2]
    cos_chi = np.clip(way @ towards_sun, -1.0, 1.0)
    relative = 1 + C * (np.exp(D * np.arccos(cos_chi)) - np.exp(D * np.pi / 2)) + E * cos_chi**2
    relative = relative * (1 + A * np.exp(B / np.maximum(up, 1e-3))) * (up > 0)
    edges = np.cos(np.arange(HEIGHT + 1) / HEIGHT * np.pi)
    solid_angle = 2 * np.pi / WIDTH * (edges[:-1] - edges[1:])[:, None]
    scale = diffuse_lx / np.sum(relative * np.maximum(up, 0.0) * solid_angle)
    blue = (1 - (1 - up) ** 2)[..., None]
    above = (HORIZON + (ZENITH - HORIZON) * blue) * (scale * relative)[..., None]
    return np.where(up[..., None] > 0, above, GROUND * ground_cd_m2)


def write(path, rgb):
    """Radiance's format (Ward 1991): a common exponent, each row in runs, here of literal bytes."""
    _, exponent = np.frexp(rgb.max(axis=-1))
    mantissa = np.floor(rgb * (256.0 / 2.0**exponent)[..., None])
    rows = np.concatenate([mantissa, (exponent + 128)[..., None]], axis=-1).astype(np.uint8)
    out = bytearray(f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {HEIGHT} +X {WIDTH}\n".encode())
    for row in rows:
        out += bytes([2, 2, WIDTH >> 8, WIDTH & 255])
        for channel in row.T:
            for start in range(0, WIDTH, 128):
                out += bytes([128]) + channel[start:start + 128].tobytes()
    path.write_bytes(out)
