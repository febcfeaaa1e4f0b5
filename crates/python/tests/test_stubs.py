"""Stubs say what the package has. `ETENDUE_BLESS=1` writes those of the verbs anew."""

import ast
import os
import pathlib

import pytest
import stubs

import etendue
from etendue import _verbs, chart, measure, verbs

FOLDER = pathlib.Path(__file__).resolve().parents[1] / "python/etendue"


@pytest.mark.parametrize(
    ("made", "listed"),
    [(measure, _verbs.group("measure")), (chart, _verbs.group("chart")), (verbs, _verbs.alone())],
    ids=["measure", "chart", "verbs"],
)
def test_stubs_of_verbs_are_those_of_the_command_line(made, listed):
    file = FOLDER / f"{made.__name__.rsplit('.')[-1]}.pyi"
    text = stubs.module(made.__doc__.strip(), listed)
    ast.parse(text)
    if os.environ.get("ETENDUE_BLESS"):
        file.write_text(text)
    assert file.read_text() == text, f"{file.name} is old: ETENDUE_BLESS=1 writes it anew"


def defined(body):
    return {node.name for node in body if isinstance(node, (ast.ClassDef, ast.FunctionDef))}


def test_classes_have_what_their_stubs_say():
    tree = ast.parse((FOLDER / "__init__.pyi").read_text())
    classes = {node.name: node for node in tree.body if isinstance(node, ast.ClassDef)}
    assert set(classes) == {name for name in etendue.__all__ if isinstance(getattr(etendue, name), type)}
    for name, node in classes.items():
        made = getattr(etendue, name)
        is_own = {n for n in dir(made) if not n.startswith("_") and not any(hasattr(base, n) for base in (dict, tuple, Exception))}
        fields = {n.target.id for n in node.body if isinstance(n, ast.AnnAssign)}
        told = {n for n in defined(node.body) | fields if not n.startswith("_")}
        if name != "Fault":
            assert told - is_own <= {"faults"} and is_own <= told, (name, is_own ^ told)


def test_everything_public_is_documented():
    for name in ("Job", "Results", "Camera", "Frame", "Report", "Estimate", "Error", "InputError", "RunError", "Fault"):
        made = getattr(etendue, name)
        assert made.__doc__, name
        for member in vars(made):
            value = getattr(made, member)
            assert member.startswith("_") or value is None or value.__doc__, (name, member)
