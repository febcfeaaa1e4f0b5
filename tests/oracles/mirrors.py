"""Figures of rayoptics and optiland for lens files with mirrors (figures/mirrors.json).

Every file is read by the programs' own readers: CODE V files by rayoptics, Zemax files by both. The designs are those of rayoptics' and
optiland's samples (rc_f16, paraboloid, schmidt, mangin, achroMangin_ok and questar35; HubbleTelescope), written anew; the Gregorian is a
parabola and an ellipse with common foci. Rays begin `start_mm` before the first vertex and end in the image plane of the file. Versions:
requirements.txt. Run anywhere:
    python tests/oracles/mirrors.py
"""

import json
import pathlib
import tempfile
import warnings
from importlib.metadata import version

import numpy as np
from optiland.fileio import load_zemax_file
from optiland.rays import RealRays
from rayoptics.gui.appcmds import open_model
from rayoptics.raytr import raytrace

warnings.filterwarnings("ignore")
START = 100.0


def seq(title, lines):
    return f"RDM;LEN\nTITLE '{title}'\nDIM M\n" + "\n".join(lines) + "\nGO\n"


def zmx(title, diameter, wavelength_um, degrees, surfaces):
    """Surfaces: radius, thickness, conic, glass, semi-diameter, further lines."""
    text = f"VERS 140124 258 36214\nMODE SEQ\nNAME {title}\nUNIT MM X W X CM MR CPMM\nENPD {diameter}\nGCAT SCHOTT\n"
    text += f"FTYP 0 0 2 1 0 0 0\nYFLN 0 {degrees}\nXFLN 0 0\nWAVM 1 {wavelength_um} 1\nPWAV 1\n"
    text += 'SURF 0\n  TYPE STANDARD\n  CURV 0.0 0 0 0 0 ""\n  DISZ INFINITY\n  DIAM 0 0 0 0 1 ""\n'
    for i, (radius, thickness, conic, glass, semi, further) in enumerate(surfaces):
        curvature = 0.0 if radius == 0.0 else 1.0 / radius
        text += f"SURF {i + 1}\n" + "".join(f"  {line}\n" for line in further if line == "STOP")
        text += f'  TYPE STANDARD\n  CURV {curvature!r} 0 0 0 0 ""\n  CONI {conic!r}\n  DISZ {thickness!r}\n'
        text += f"  GLAS {glass} 0 0 1.5 40 0 0 0 0 0 0\n" if glass else ""
        text += f'  DIAM {semi} 1 0 0 1 ""\n' + "".join(f"  {line}\n" for line in further if line != "STOP")
    return text


FILES = {
    "ritchey-chretien.seq": seq("f/16 Ritchey-Chretien", [
        "EPD 7924.80", "WL 550", "YAN 0 .333", "SO 0. 1e13", "S -21335.137 -7490.46 REFL", " CON", " K -1.0961",
        "S -9576.712 9441.833 REFL", " CON", " K -5.1628", "SI 0 0",
    ]),
    "paraboloid.seq": seq("f/8 paraboloid", [
        "FNO 8.0", "WL 550", "YIM 0 10. 20. 30.", "SO 0. 1e13", "S -400 -200 REFL", " STO", " CON", " K -1", "SI 0 0",
    ]),
    "schmidt.seq": seq("Flat-field Schmidt", [
        "EPD 75.0", "WL 587.5618", "YAN 0.0 5.5", "SO 0.0 1e13", "S 1777.4675417 6.30393959108 569.631", " STO", " ASP",
        " A -0.40492987e-7; B -0.12165914e-11", "S 0.0 170.946831705", "S -211.818112 -96.2601569305 REFL",
        "S -40.9572315 -5.94371447159 569.631", "S 0.0 -1.731355379851178", "SI 0.0 0.0",
    ]),
    "mangin.seq": seq("Mangin mirror", [
        "EPD 200", "WL 555", "YAN 0 .333", "SO 0. 1e13", "S -1200 10. NBK7_SCHOTT", "S -1000 -10 REFL", "S -1200 -450.554",
        "SI 0 0",
    ]),
    "achromatic-mangin.seq": seq("Achromatic Mangin", [
        "WL 488. 587. 656.", "REF 2", "EPD 5.0", "YAN 0 0.5", "SO 0 1e13", "S -9.435 0.346 NSSK2_SCHOTT", " STO", "S 37.5 1.092 NKZFS4_SCHOTT",
        "S -14.357 -1.092 REFL", "S 37.5 -0.346 NSSK2_SCHOTT", "S -9.435 -7.935", "SI 0 0",
    ]),
    "maksutov.seq": seq("Maksutov of 3.5 inches", [
        "EPD 88.9", "WL 650.0 555.0 450.0", "REF 2", "YAN 0.0 0.25", "SO 0.0 1e13", "S -91.376347 7.218046 NBK7_SCHOTT", " CIR 44.5",
        "S -95.611378 168.097174", " CIR OBS L'A' 9.716599", "S -408.375037 -168.097174 REFL", " STO", " CIR HOL 9.543089",
        "S -95.611378 259.468230 REFL", "SI 0.0 0.0",
    ]),
    "hubble.zmx": zmx("Hubble telescope", 2400.0, 0.55, 0.15, [
        (-11040.02286, -4910.01016, -1.001152, "MIRROR", 1210.0, ["STOP", "CLAP 177.80035 1210 0"]),
        (-1349.31166, 6365.20955, -1.483014, "MIRROR", 180.0, []),
        (0.0, 0.0, 0.0, "", 30.0, []),
    ]),
    "gregorian.zmx": zmx("Gregorian", 200.0, 0.55, 0.1, [
        (-800.0, -500.0, -1.0, "MIRROR", 101.0, ["STOP", "CLAP 30 101 0"]),
        # Foci 100 mm and 600 mm from the vertex: R = 2 · 100 · 600/700, k = −(500/700)².
        (2.0 * 100.0 * 600.0 / 700.0, 600.0, -((500.0 / 700.0) ** 2), "MIRROR", 32.0, []),
        (0.0, 0.0, 0.0, "", 20.0, []),
    ]),
}


def rays(degrees, radius):
    """Points of the plane of the first vertex that rays pass without the lens, and their directions."""
    for angle in (0.0, np.radians(degrees)):
        direction = np.array([0.0, np.sin(angle), np.cos(angle)])
        for x, y in [(0.0, 0.0), (0.0, 1.0), (0.0, -0.7), (0.7, 0.7), (0.5, 0.0)]:
            yield np.array([x * radius, y * radius, 0.0]), direction


def with_rayoptics(path, nm, launched):
    model = open_model(str(path))
    first = model["analysis_results"]["parax_data"].fod
    result = {"efl_mm": first.efl, "bfl_mm": first.bfl, "rays": []}
    sequence = model.seq_model
    sequence.gaps[0].thi = START
    model.update_model()
    for point, direction in launched:
        start = point - direction * (START / direction[2])
        traced, _, _ = raytrace.trace(sequence, np.array([start[0], start[1], 0.0]), direction, nm)
        result["rays"].append({"image_mm": list(map(float, traced[-1][0][:2])), "direction": list(map(float, traced[-2][1]))})
    return result


def with_optiland(path, nm, launched):
    lens = load_zemax_file(str(path))
    result = {"efl_mm": float(np.ravel(lens.paraxial.f2())[0]), "rays": []}
    for point, direction in launched:
        start = point - direction * (START / direction[2])
        numbers = [[float(v)] for v in (*start, *direction)]
        bundle = RealRays(*numbers, [1.0], [nm * 1e-3])
        lens.surface_group.trace(bundle, 1)
        out = [float(np.ravel(v)[0]) for v in (bundle.L, bundle.M, bundle.N)]
        result["rays"].append({"image_mm": [float(bundle.x[0]), float(bundle.y[0])], "direction": out})
    return result


# Wavelength, nm, field angle, degrees, and radius of the pupil, mm, of the rays.
RAYS = {
    "ritchey-chretien.seq": (550.0, 0.1, 3962.4), "paraboloid.seq": (550.0, 3.0, 12.5), "schmidt.seq": (587.5618, 5.5, 37.0),
    "mangin.seq": (555.0, 0.333, 100.0), "achromatic-mangin.seq": (587.0, 0.5, 2.5), "maksutov.seq": (555.0, 0.25, 41.0),
    "hubble.zmx": (550.0, 0.15, 1200.0), "gregorian.zmx": (550.0, 0.1, 100.0),
}


def main():
    files = []
    with tempfile.TemporaryDirectory() as folder:
        for name, text in FILES.items():
            path = pathlib.Path(folder) / name
            path.write_text(text)
            nm, degrees, radius = RAYS[name]
            launched = list(rays(degrees, radius))
            programs = {"rayoptics": with_rayoptics(path, nm, launched)}
            if name.endswith(".zmx"):
                programs["optiland"] = with_optiland(path, nm, launched)
            starts = [{"point_mm": list(map(float, p)), "direction": list(map(float, d))} for p, d in launched]
            files.append({"name": name, "text": text, "nm": nm, "rays": starts} | programs)
            print(name, {k: v["efl_mm"] for k, v in programs.items()}, programs["rayoptics"]["rays"][1])
            if "optiland" in programs:
                print("   ", programs["optiland"]["rays"][1], programs["optiland"]["rays"][6], programs["rayoptics"]["rays"][6])
    programs = [f"{p} {version(p)}" for p in ("optiland", "rayoptics", "opticalglass")]
    path = pathlib.Path(__file__).parent / "figures" / "mirrors.json"
    path.write_text(json.dumps({"programs": programs, "start_mm": START, "files": files}, indent=1) + "\n")


if __name__ == "__main__":
    main()
