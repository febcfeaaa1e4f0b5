"""Figures of pvlib for crates/tracer: figures/sun_position.json.

Python 3.11, pvlib 0.16.1 (requirements.txt). Run at the root of the repository:
    python tests/oracles/sun_position.py

pvlib's spa_python is NREL's Solar Position Algorithm (Reda & Andreas 2004), good to 0.0003 degrees; its elevation without
refraction is taken, for an observer at sea level.
"""

import json

import pandas
import pvlib

PLACES = [(51.4779, 0.0), (48.1351, 11.5820), (0.0, -78.5), (-33.8688, 151.2093), (69.6492, 18.9553), (-77.85, 166.67),
          (35.6762, 139.6503), (89.9, 45.0)]
TIMES = ["1950-01-01T00:00:00", "1992-10-13T00:00:00", "2000-01-01T12:00:00", "2003-10-17T19:30:30",
         "2012-02-29T23:59:59.5", "2024-03-20T03:06:00", "2024-06-21T11:30:00", "2025-12-21T15:03:12.25",
         "2026-09-23T05:45:00", "2049-07-04T18:20:00"]


def main():
    rows = []
    for time in TIMES:
        for latitude, longitude in PLACES:
            found = pvlib.solarposition.spa_python(pandas.DatetimeIndex([time], tz="UTC"), latitude, longitude,
                                                   altitude=0, delta_t=None)
            rows.append([time, latitude, longitude, round(float(found["azimuth"].iloc[0]), 5),
                         round(float(found["elevation"].iloc[0]), 5)])
    text = json.dumps({"program": f"pvlib {pvlib.__version__}, spa_python", "rows": rows}).replace("], ", "],\n")
    with open("tests/oracles/figures/sun_position.json", "w", encoding="utf-8") as file:
        file.write(text + "\n")


main()
