"""Exceptions: what a call raises where its input cannot be used, or its run does not succeed."""

from __future__ import annotations

from dataclasses import dataclass


#: Faults that a message shows; ``faults`` has all.
_MAX_SHOWN = 50


@dataclass(frozen=True)
class Fault:
    """One fault of an input. Lines and columns count from 1; None: not known, or an argument's."""

    message: str
    file: str | None = None
    line: int | None = None
    column: int | None = None
    key: str | None = None
    #: The kind of the fault, which ``etendue.explain(code)`` explains.
    code: str = "invalid-argument"
    #: What is wrong, without the place.
    problem: str = ""
    #: What to do; None where the message says it in its own words.
    remedy: str | None = None


class Error(Exception):
    """Why a call did not succeed. Nothing that was written under a final name is half-written."""


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
        """The kind of the fault, which ``etendue.explain(code)`` explains."""
        return self.faults[0].code

    @property
    def file(self):
        """The file at fault; None where it is an argument's, or not known."""
        return self.faults[0].file

    @property
    def line(self):
        """The line, from 1; None where it is of the whole file or of a change."""
        return self.faults[0].line

    @property
    def column(self):
        """The column of the line, in characters from 1; None where it is not known."""
        return self.faults[0].column

    @property
    def key(self):
        """The dotted key of a description, or an argument; None where there is none."""
        return self.faults[0].key


class RunError(Error, RuntimeError):
    """A run that did not succeed although its input is good (exit status 1 of the program)."""


def _python_name(key):
    """The argument that the command line calls ``--edge-degree`` is ``edge_degree`` here."""
    return key[2:].replace("-", "_") if key and key.startswith("--") else key
