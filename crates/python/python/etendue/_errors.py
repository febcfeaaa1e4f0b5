"""Exceptions for unusable input and for failed runs."""

from __future__ import annotations

from dataclasses import dataclass


#: Maximum number of errors in a message; ``faults`` has all.
_MAX_SHOWN = 50


@dataclass(frozen=True)
class Fault:
    """One error of an input. Lines and columns count from 1; None: unknown, or an argument's."""

    message: str
    file: str | None = None
    line: int | None = None
    column: int | None = None
    key: str | None = None
    #: Error code, which ``etendue.explain(code)`` explains.
    code: str = "invalid-argument"
    #: Problem, without the place.
    problem: str = ""
    #: Remedy; None if the message states it.
    remedy: str | None = None


class Error(Exception):
    """Failure of a call. No file under a final name is incomplete."""


class InputError(Error, ValueError):
    """Unusable input (exit status 2 of the program): ``faults`` has all, ``code``, ``file``, ``line``, ``column`` and ``key`` are those of the first."""

    def __init__(self, faults):
        self.faults = [
            Fault(message, file, line, column, _python_name(key), *rest) for message, file, line, column, key, *rest in faults
        ]
        more = len(self.faults) - _MAX_SHOWN
        shown = [fault.message for fault in self.faults[:_MAX_SHOWN]] + [f"and {more} more"] * (more > 0)
        super().__init__("\n".join(shown))

    def __reduce__(self):
        return (type(self), ([(f.message, f.file, f.line, f.column, f.key, f.code, f.problem, f.remedy) for f in self.faults],))

    @property
    def code(self):
        """Error code, which ``etendue.explain(code)`` explains."""
        return self.faults[0].code

    @property
    def file(self):
        """File of the error; None if it is an argument's, or unknown."""
        return self.faults[0].file

    @property
    def line(self):
        """Line, from 1; None for the whole file or a change."""
        return self.faults[0].line

    @property
    def column(self):
        """Column of the line, in characters from 1; None if unknown."""
        return self.faults[0].column

    @property
    def key(self):
        """Dotted key of a description, or an argument; None if there is none."""
        return self.faults[0].key


class RunError(Error, RuntimeError):
    """Run that failed although its input is valid (exit status 1 of the program)."""


def _python_name(key):
    """The argument that the command line calls ``--edge-degree`` is ``edge_degree`` here."""
    return key[2:].replace("-", "_") if key and key.startswith("--") else key
