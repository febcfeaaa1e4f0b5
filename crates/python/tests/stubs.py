"""Stubs of the functions that are made of the command line's list of verbs."""

from etendue import _verbs

NUMBERS = {"integer": "int", "number": "float", "path": "_Path"}
ANSWERS = {"report": "Report", "dict": "dict[str, Any]", "paths": "list[Path]", "text": "str"}

HEAD = '''"""{title}

Written by `ETENDUE_BLESS=1` of `tests/test_stubs.py`.
"""

from collections.abc import Callable, Mapping, Sequence
from os import PathLike
from pathlib import Path
from typing import Any, Literal

{imports}__all__ = {names}

_Path = str | PathLike[str]
_Progress = Callable[[str, int, int], object]
'''


def value_type(argument):
    """What a value of an argument may be in Python."""
    if argument["kind"] == "switch":
        return "bool"
    if argument["words"]:
        words = f"Literal[{', '.join(repr(word) for word in argument['words'])}]".replace("'", '"')
        return f"{words} | Sequence[{words}]" if argument["listed"] else words
    if argument["name"] == "set":
        return "Mapping[str, Any] | Sequence[str]"
    if argument["value"] == "KEY=VALUE":
        return "Mapping[str, Any] | str | Sequence[Mapping[str, Any] | str]"
    one = NUMBERS.get(argument["kind"])
    if argument["listed"]:
        return f"Sequence[{one or 'float'}]"
    if one is None:
        mark = argument["value"]
        one = "range | tuple[int, int]" if mark == "A..B" else "tuple[float, float]" if mark == "BLACK..WHITE" else "str"
        one = "Sequence[float]" if "," in mark and mark == mark.upper() and "=" not in mark else one
        one = "tuple[float, _Path]" if mark.startswith("CELSIUS:") else one
    return f"{one} | Sequence[{one}]" if argument["many"] else one


def function(verb):
    arguments = sorted(_verbs.taken(verb), key=lambda argument: not argument["positional"])
    lines, is_named = [], False
    for argument in arguments:
        if not argument["positional"] and not is_named:
            lines.append("*")
            is_named = True
        kind = value_type(argument)
        if not argument["required"]:
            kind += " = False" if argument["kind"] == "switch" else " | None = None"
        lines.append(f"{_verbs.python_name(argument['name'])}: {kind}")
    lines += ([] if is_named else ["*"]) + ["progress: _Progress | None = None"]
    text = [f"def {_verbs.python_name(verb['name'])}(", *(f"    {line}," for line in lines), f") -> {ANSWERS[_verbs.answer_of(verb)]}:"]
    document = _verbs.document(verb).replace("\\", "\\\\").splitlines()
    text += [f'    """{document[0]}', *(f"    {line}".rstrip() for line in document[1:]), '    """']
    return "\n".join(text)


def names(verbs):
    """The names of the functions, as a list of Python."""
    return "[" + ", ".join(f'"{_verbs.python_name(verb["name"])}"' for verb in verbs) + "]"


def module(title, verbs):
    body = [function(verb) for verb in verbs]
    imports = "from . import Report\n\n" if any("-> Report" in text for text in body) else ""
    return HEAD.format(title=title, imports=imports, names=names(verbs)) + "".join(f"\n{text}\n" for text in body)
