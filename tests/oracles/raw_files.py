"""Raw files in programs that are not this one: figures/raw_files.json, and what the layers of EXR files hold.

A chart of 24 patches under D65 (figures/raw_files/chart.toml) is photographed with each Bayer phase, with optical black beside the picture,
and by a mono sensor behind odd rows and columns of optical black. rawpy (LibRaw) reads the DNG: levels, area, filter pattern as it sees
them, every raw number against the 16-bit TIFF, and its own development against this program's: mean colours of the patches, CIE ΔE 2000
after one common factor of brightness. tifffile, Pillow and OpenCV read TIFF of 16 and 32 bits, OpenEXR the electrons and the causes, whose
sum is the digital number. Versions: requirements.txt. Run from anywhere, the binary in ETENDUE or built anew; a folder as argument keeps
the pictures:
    python tests/oracles/raw_files.py
"""

import json
import os
import pathlib
import subprocess
import sys
import tempfile
from importlib.metadata import version

sys.path.pop(0)  # a script beside this one has the name of a library
import colour  # noqa: E402
import cv2  # noqa: E402
import numpy as np  # noqa: E402
import OpenEXR  # noqa: E402
import rawpy  # noqa: E402
import tifffile  # noqa: E402
from PIL import Image  # noqa: E402

HERE = pathlib.Path(__file__).parent / "figures"
ROOT = HERE.parents[2]
SIDE, COLUMNS, ROWS = 24, 6, 4
PHASES = ["rggb", "bggr", "grbg", "gbrg"]
GREYS = range(18, 24)


def binary():
    if "ETENDUE" in os.environ:
        return os.environ["ETENDUE"]
    subprocess.run(["cargo", "build", "--release", "-p", "etendue-cli"], check=True, cwd=ROOT)
    return str(ROOT / "target" / "release" / "etendue")


def render(program, folder, *settings, camera="camera"):
    command = [program, "render", str(HERE / "raw_files" / "chart.toml"), "--camera", camera, "-o", str(folder)]
    command += [part for setting in settings for part in ("--set", setting)]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    return folder / camera


def patches(picture):
    """Mean colours of the inner parts of the patches."""
    inner = lambda i, j: picture[j * SIDE + 6 : (j + 1) * SIDE - 6, i * SIDE + 6 : (i + 1) * SIDE - 6]
    return np.array([inner(i, j).reshape(-1, 3).mean(axis=0) for j in range(ROWS) for i in range(COLUMNS)])


def linear(encoded):
    return colour.models.eotf_sRGB(encoded)


def lab(rgb):
    return colour.XYZ_to_Lab(colour.RGB_to_XYZ(rgb, "sRGB"), colour.CCS_ILLUMINANTS["CIE 1931 2 Degree Standard Observer"]["D65"])


def bayer(program, phase, folder, keep):
    at = render(program, folder / phase, 'output.raw_format="dng"', f'cameras.camera.sensor.cfa="{phase}"')
    tiff = render(program, folder / f"{phase}-tiff", 'output.raw_format="tiff"', f'cameras.camera.sensor.cfa="{phase}"')
    numbers = tifffile.imread(tiff / "raw.0000.tif")
    ours = np.asarray(Image.open(at / "picture.0000.png"), dtype=float) / 255.0
    with rawpy.imread(str(at / "raw.0000.dng")) as raw:
        names = raw.color_desc.decode()
        visible = "".join(names[c] for row in raw.raw_colors_visible[:2, :2] for c in row).lower()
        sizes = raw.sizes
        found = {
            "pattern": visible,
            "black": [int(b) for b in raw.black_level_per_channel],
            "white": int(raw.white_level),
            "raw_size": [sizes.raw_width, sizes.raw_height],
            "visible": [sizes.left_margin, sizes.top_margin, sizes.width, sizes.height],
            "raw_is_tiff": bool((raw.raw_image == numbers).all()),
            "sum_and_sum_of_squares": [int(numbers.astype(np.int64).sum()), int((numbers.astype(np.int64) ** 2).sum())],
        }
        theirs = raw.postprocess(
            use_camera_wb=True, no_auto_bright=True, gamma=(2.4, 12.92), output_bps=16, user_flip=0, output_color=rawpy.ColorSpace.sRGB
        )
    theirs = theirs.astype(float) / 65535.0
    a, b = linear(patches(theirs)), linear(patches(ours))
    scale = (a[GREYS] * b[GREYS]).sum() / (a[GREYS] ** 2).sum()
    difference = colour.delta_E(lab(scale * a), lab(b), method="CIE 2000")
    neutral = a[GREYS] / a[GREYS].mean(axis=1, keepdims=True) - 1.0
    found |= {
        "scale": float(scale),
        "delta_e_mean": float(difference.mean()),
        "delta_e_worst": float(difference.max()),
        "neutral_off": float(np.abs(neutral[:5]).max()),
    }
    if keep:
        both = np.concatenate([np.clip(theirs, 0, 1), ours], axis=1)
        picture = Image.fromarray((255 * both).round().astype(np.uint8))
        picture.resize((3 * picture.width, 3 * picture.height), Image.NEAREST).save(keep / f"{phase}.png")
    return found


def mono(program, folder):
    at = render(program, folder / "mono", 'output.raw_format="dng"', camera="mono")
    tiff = render(program, folder / "mono-tiff", 'output.raw_format="tiff"', camera="mono")
    numbers = tifffile.imread(tiff / "raw.0000.tif")
    with tifffile.TiffFile(at / "raw.0000.dng") as dng:
        page = dng.pages[0]
        pixels = page.asarray()
        area = [int(v) for v in page.tags["ActiveArea"].value]
    with rawpy.imread(str(at / "raw.0000.dng")) as raw:
        visible = [raw.sizes.left_margin, raw.sizes.top_margin, raw.sizes.width, raw.sizes.height]
        same = bool((raw.raw_image == numbers).all())
        grey = raw.postprocess(no_auto_bright=True, gamma=(1, 1), output_bps=16, user_flip=0).astype(float).mean()
    share = (numbers[3:, 5:].mean() - 256) / (15256 - 256)
    return {
        "dng_is_tiff": bool((pixels == numbers).all()), "active_area": area, "size": list(pixels.shape[::-1]),
        "visible": visible, "raw_is_tiff": same, "mean_over_ours": float(grey / 65535 / share),
    }


def deep(program, folder):
    """Numbers of 24 bits."""
    subprocess.run(
        [program, "flat", str(ROOT / "scenes/cameras/automotive-hdr.toml"), "--wavelength-nm", "550", "--irradiance-w-m2", "1", "-o",
         str(folder / "deep"), "--set", "sensor.width_px=64", "--set", "sensor.height_px=32", "--set", "sensor.companding.bits=24",
         "--set", "sensor.companding.knees=[[16777215,16777215]]"],
        check=True, stdout=subprocess.DEVNULL,
    )
    path = next((folder / "deep").rglob("raw.0000.tif"))
    by_tifffile = tifffile.imread(path)
    by_pillow = np.asarray(Image.open(path)).astype(np.int64)
    by_opencv = cv2.imread(str(path), cv2.IMREAD_UNCHANGED)
    agree = lambda other: other is not None and bool((np.asarray(other).astype(np.int64) == by_tifffile.astype(np.int64)).all())
    return {"bits": int(by_tifffile.dtype.itemsize * 8), "largest": int(by_tifffile.max()), "pillow": agree(by_pillow), "opencv": agree(by_opencv)}


def layers(program, folder):
    at = render(program, folder / "exr", 'output.raw_format="tiff"', "output.electrons=true", "output.signal_breakdown=true")
    plain = render(program, folder / "plain", 'output.raw_format="tiff"')
    facts = json.loads((at / "camera.json").read_text())["sensor"]["electronics"]
    numbers = tifffile.imread(at / "raw.0000.tif").astype(float)
    causes = OpenEXR.File(str(at / "signal_breakdown.0000.exr"), separate_channels=True).channels()
    planes = {name: channel.pixels.astype(float) for name, channel in causes.items()}
    total = sum(plane for name, plane in planes.items() if name != "saturated")
    off = total - (numbers - facts["black_level_dn"]) / facts["gain_dn_per_e"]
    electrons = OpenEXR.File(str(at / "electrons.exr"), separate_channels=True).channels()
    [(name, mean)] = electrons.items()
    signal = planes["signal"][6:, 4:]
    return {
        "signal_breakdown": sorted(planes),
        "largest_difference_of_the_sum_e": float(np.abs(off).max()),
        "electrons_channel": name,
        "signal_is_electrons": bool((mean.pixels == signal.astype(np.float32)).all()),
        "raw_without_breakdown_is_the_same": (at / "raw.0000.tif").read_bytes() == (plain / "raw.0000.tif").read_bytes(),
    }


def main():
    program = binary()
    keep = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else None
    with tempfile.TemporaryDirectory() as place:
        folder = pathlib.Path(place)
        figures = {
            "bayer": {phase: bayer(program, phase, folder, keep) for phase in PHASES},
            "mono": mono(program, folder),
            "tiff_32": deep(program, folder),
            "exr": layers(program, folder),
        }
    programs = ["rawpy", "tifffile", "pillow", "opencv-contrib-python-headless", "OpenEXR", "colour-science"]
    known = lambda name: next((version(n) for n in (name, "opencv-python-headless") if installed(n)), "?")
    with_programs = {"programs": [f"{p} {known(p)}" for p in programs], "libraw": ".".join(map(str, rawpy.libraw_version))}
    text = json.dumps(with_programs | {"script": "tests/oracles/raw_files.py"} | figures, indent=1)
    print(text)
    (HERE / "raw_files.json").write_text(text + "\n")


def installed(name):
    try:
        return bool(version(name))
    except Exception:
        return False


if __name__ == "__main__":
    main()
