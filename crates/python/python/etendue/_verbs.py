"""Functions for the verbs of the command line, created from their list. A function takes the arguments of its verb, under the same names with ``_``.

Python values become words of the command line: True gives a switch, None omits an option, a sequence is written with the option's own
separator, a dict as ``key=value`` in TOML. A function returns what its verb prints.
"""

from __future__ import annotations

import inspect
import json
import keyword
import os
from collections.abc import Mapping
from pathlib import Path

from . import _etendue
from ._report import Report

CATALOGUE = json.loads(_etendue.catalogue())
#: Verbs that are methods of Job.
METHODS = ("render", "plan")


def python_name(word):
    """``chart-points`` is ``chart_points``; a Python keyword receives a ``_``."""
    name = word.lower().replace("-", "_")
    return name + "_" if keyword.iskeyword(name) else name


def functions(verbs, path=()):
    """A function for each verb, by its name."""
    return {python_name(verb["name"]): _function(verb, (*path, verb["name"])) for verb in verbs}


def group(name):
    """The verbs of a group such as ``measure``."""
    return next(verb["verbs"] for verb in CATALOGUE if verb["name"] == name)


def alone():
    """Verbs outside groups."""
    return [verb for verb in CATALOGUE if not verb["verbs"] and verb["name"] not in METHODS]


def taken(verb):
    """Arguments of a verb's function, without those that only affect the printed form."""
    return [argument for argument in verb["arguments"] if argument["name"] != "json"]


def answer_of(verb):
    """Kind of the result of a verb's function: "report", "dict", "paths" or "text"."""
    names = {argument["name"] for argument in verb["arguments"]}
    if "json" in names:
        return "report" if "plot" in names else "dict"
    if verb["name"] == "schema":
        return "dict"
    return "paths" if "output" in names else "text"


def parameters(verb):
    """The parameters of a verb's function."""
    kinds = {True: inspect.Parameter.POSITIONAL_OR_KEYWORD, False: inspect.Parameter.KEYWORD_ONLY}
    order = sorted(taken(verb), key=lambda argument: not argument["positional"])
    made = []
    for argument in order:
        empty = inspect.Parameter.empty if argument["required"] else (False if argument["kind"] == "switch" else None)
        made.append(inspect.Parameter(python_name(argument["name"]), kinds[argument["positional"]], default=empty))
    return [*made, inspect.Parameter("progress", kinds[False], default=None)]


def document(verb):
    """The documentation of a verb's function."""
    lines = [verb["help"] + ".", ""]
    for argument in sorted(taken(verb), key=lambda argument: not argument["positional"]):
        words = f" One of {', '.join(argument['words'])}." if argument["words"] else ""
        default = f" Default: {argument['default']}." if argument["default"] is not None else ""
        many = " One, or a sequence of them." if argument["many"] else ""
        many = " A dict of dotted keys to values, or texts key=value." if argument["name"] == "set" else many
        lines.append(f"{python_name(argument['name'])}: {argument['help'].rstrip('.')}.{words}{many}{default}")
    lines.append("progress: called with what is worked on, how much is done, and of how much; what it raises cancels, as Ctrl-C does.")
    answers = {
        "report": "Answers with a Report.",
        "dict": "Answers with a dict.",
        "paths": "Answers with the paths of what was written.",
        "text": "Answers with a text.",
    }
    return "\n".join([*lines, "", answers[answer_of(verb)]])


def _function(verb, path):
    signature = inspect.Signature(parameters(verb))
    arguments = {python_name(argument["name"]): argument for argument in taken(verb)}

    def function(*positional, **named):
        bound = signature.bind(*positional, **named)
        progress = bound.arguments.pop("progress", None)
        words = _words(arguments, bound.arguments)
        as_json = ["--json"] if answer_of(verb) in ("report", "dict") and verb["name"] != "schema" else []
        answer, differs = _etendue.call([*path, *as_json, *words], progress)
        return _answer(verb, answer, differs)

    function.__name__ = function.__qualname__ = python_name(verb["name"])
    function.__doc__ = document(verb)
    function.__signature__ = signature
    function.__module__ = "etendue" if len(path) == 1 else f"etendue.{path[0]}"
    return function


def _answer(verb, answer, differs):
    kind = answer_of(verb)
    if kind == "paths":
        return [Path(line) for line in answer.splitlines()]
    if kind == "text":
        return answer
    told = json.loads(answer)
    if kind == "dict":
        return told
    report = Report(told)
    report.differs = differs
    return report


def _words(arguments, given):
    options, values = [], []
    for name, value in given.items():
        argument = arguments[name]
        if value is None or (argument["kind"] == "switch" and not value):
            continue
        words = [word for one in _each(argument, value) for word in _written(argument, one)]
        if argument["positional"]:
            values += words
        elif argument["kind"] == "switch":
            _expect(name, value is True, "True or False", value)
            options.append(f"--{argument['name']}")
        else:
            options += [f"--{argument['name']}={word}" for word in words]
    return [*options, "--", *values] if values else options


def _expect(name, is_legal, expected, value):
    if not is_legal:
        raise TypeError(f"{name}: expected {expected}, not {value!r}")


def _is_sequence(value):
    return isinstance(value, (list, tuple)) or (hasattr(value, "tolist") and getattr(value, "ndim", 0) > 0)


def _each(argument, value):
    """The values of an argument that may be given more than once."""
    if isinstance(value, Mapping) and argument["value"] == "KEY=VALUE" and argument["name"] == "set":
        return [{key: item} for key, item in value.items()]
    if not argument["many"] or argument["listed"] or not _is_sequence(value):
        return [value]
    value = value.tolist() if hasattr(value, "tolist") else list(value)
    one = _separator(argument) is not None and value and not _is_sequence(value[0]) and not isinstance(value[0], (str, os.PathLike))
    return [value] if one else value


def _separator(argument):
    """Separator of the parts of a value, such as ``X,Y,W,H`` or ``A..B``."""
    if argument["listed"]:
        return ","
    return next((mark for mark in ("..", ",", ":", "/") if mark in argument["value"]), None)


def _written(argument, value):
    name, separator = python_name(argument["name"]), _separator(argument)
    if isinstance(value, range):
        _expect(name, separator == ".." and value.step == 1, "no range with a step" if separator == ".." else "no range", value)
        return [f"{value.start}..{value.stop}"]
    if isinstance(value, Mapping):
        _expect(name, argument["value"] == "KEY=VALUE", "no dict", value)
        return ["; ".join(f"{key}={'null' if item is None else _etendue.to_toml(item)}" for key, item in value.items())]
    if _is_sequence(value):
        _expect(name, separator is not None, "one value", value)
        return [separator.join(_text(name, argument, part) for part in (value.tolist() if hasattr(value, "tolist") else value))]
    return [_text(name, argument, value)]


def _text(name, argument, value):
    if hasattr(value, "item") and not isinstance(value, (str, bytes)):
        value = value.item()
    if argument["kind"] in ("integer", "number"):
        kinds = (int,) if argument["kind"] == "integer" else (int, float)
        expected = "a whole number" if argument["kind"] == "integer" else "a number"
        _expect(name, isinstance(value, kinds) and not isinstance(value, bool), expected, value)
    elif argument["kind"] == "path":
        _expect(name, isinstance(value, (str, os.PathLike)), "a path", value)
    _expect(name, isinstance(value, (str, int, float, os.PathLike, bool)), "a value", value)
    return os.fspath(value) if isinstance(value, os.PathLike) else str(value)
