"""Figures of OpenEXR for crates/io: figures/exr.json, figures/other_writer.exr.

Reads the samples that crates/io wrote (figures/spectral.exr, figures/ground_truth.exr; a test holds them to the byte) and
states their channels, sample types, attributes and values; writes a spectral image of its own for our reader.
Versions: requirements.txt. Run anywhere:
    python tests/oracles/read_exr.py
"""

import json
import pathlib

import numpy as np
import OpenEXR

FIGURES = pathlib.Path(__file__).parent / "figures"


def as_json(value):
    if isinstance(value, np.floating | float):
        return float(value) if np.isfinite(value) else str(value)
    return int(value) if isinstance(value, np.integer | int) else str(value)


def told(name):
    file = OpenEXR.File(str(FIGURES / name), separate_channels=True)
    channels = {
        key: {"type": str(channel.pixels.dtype), "values": [as_json(v) for v in channel.pixels.flatten()]}
        for key, channel in sorted(file.channels().items())
    }
    header = {key: as_json(value) for key, value in sorted(file.header().items()) if isinstance(value, str | float | int)}
    header["compression"] = str(file.header()["compression"])
    return {"channels": channels, "header": header, "height_width": list(next(iter(file.channels().values())).pixels.shape)}


def write_other():
    """Values 1 … 6 + band, with a decimal comma, polarisation, half floats, and no mention of etendue."""
    pixels = np.arange(1.0, 7.0).reshape(2, 3)
    channels = {f"S0.{nm},0nm": (pixels + band).astype(np.float32) for band, nm in enumerate((450, 500, 550, 600))}
    channels["S1.450,0nm"] = (0.5 * pixels).astype(np.float16)
    header = {"compression": OpenEXR.PIZ_COMPRESSION, "type": OpenEXR.scanlineimage, "emissiveUnits": "W.m^-2.sr^-1",
              "spectralLayoutVersion": "1.0"}
    OpenEXR.File(header, channels).write(str(FIGURES / "other_writer.exr"))


def main():
    figures = {"program": f"OpenEXR {OpenEXR.__version__}"}
    figures |= {name: told(f"{name}.exr") for name in ("spectral", "ground_truth")}
    (FIGURES / "exr.json").write_text(json.dumps(figures, indent=1) + "\n")
    write_other()


if __name__ == "__main__":
    main()
