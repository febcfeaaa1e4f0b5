"""Results of measurements."""

from __future__ import annotations

from typing import NamedTuple


class Estimate(NamedTuple):
    """A number with its standard uncertainty (None: not stated, or not finite) and unit ("" for none)."""

    value: float | None
    standard_uncertainty: float | None
    unit: str


class Report(dict):
    """Result of a measurement: the dict that ``--json`` prints, with the numbers by their keys.

    ``report["figures"]["mtf50_cy_px"]["value"]`` and ``report.value("mtf50_cy_px")`` are the same. ``differs`` states, for ``measure.compare``, why two
    measurements, or a camera and its measurement, differ; None otherwise.
    """

    differs: str | None = None

    @property
    def figures(self):
        """All numbers: keys to Estimates."""
        return {key: self.estimate(key) for key in self["figures"]}

    @property
    def tables(self):
        """All tables: keys to lists of rows, each a dict of columns."""
        return self["tables"]

    @property
    def notes(self):
        """Notes on the result, in sentences."""
        return self["notes"]

    def estimate(self, key):
        """A number with its uncertainty and unit; KeyError names the available ones."""
        figures = self["figures"]
        if key not in figures:
            raise KeyError(f"no figure {key!r}; there are {', '.join(figures)}")
        figure = figures[key] or {}
        return Estimate(figure.get("value"), figure.get("standard_uncertainty"), figure.get("unit", ""))

    def value(self, key):
        """A number without its uncertainty; None where it is unknown."""
        return self.estimate(key).value

    def table(self, key):
        """A table as a pandas DataFrame (the extra "pandas")."""
        import pandas

        return pandas.json_normalize(self["tables"][key])

    def __str__(self):
        lines = [self.get("method", "")]
        for key, (value, uncertainty, unit) in self.figures.items():
            plus_minus = "" if uncertainty is None else f" ± {uncertainty:.2g}"
            lines.append(f"{key}: {'unknown' if value is None else f'{value:.6g}'}{plus_minus} {unit}".rstrip())
        return "\n".join(lines + [f"note: {note}" for note in self.get("notes", [])])
