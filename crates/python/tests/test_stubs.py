"""Stubs say what the package has. `ETENDUE_BLESS=1` writes those of the verbs anew."""

import ast
import inspect
import os
import pathlib
import re
import subprocess
import sys

import pytest
import stubs
from conftest import ROOT

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


def test_the_package_exports_the_verbs_that_are_in_no_group():
    file = FOLDER / "__init__.pyi"
    text = re.sub(r"^__all__ \+= .*$", f"__all__ += {stubs.names(_verbs.alone())}", file.read_text(), flags=re.M)
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
        is_own = {n for n in dir(made) if not n.startswith("_") and not any(hasattr(base, n) for base in (dict, tuple, Exception) if issubclass(made, base))}
        fields = {n.target.id for n in node.body if isinstance(n, ast.AnnAssign)}
        told = {n for n in defined(node.body) | fields if not n.startswith("_")}
        if name != "Fault":
            assert told - is_own <= {"faults"} and is_own <= told, (name, is_own ^ told)


def told_parameters(function):
    """Names of a stub's parameters, whether each is given by name alone, and its default."""
    arguments = function.args
    defaults = [None] * (len(arguments.args) - len(arguments.defaults)) + arguments.defaults
    told = [(a.arg, False, d) for a, d in zip(arguments.args, defaults)] + [(a.arg, True, d) for a, d in zip(arguments.kwonlyargs, arguments.kw_defaults)]
    return [(name, named, ast.literal_eval(default) if default else inspect.Parameter.empty) for name, named, default in told]


def test_methods_take_what_their_stubs_say():
    tree = ast.parse((FOLDER / "__init__.pyi").read_text())
    methods = [(c.name, f) for c in tree.body if isinstance(c, ast.ClassDef) for f in c.body if isinstance(f, ast.FunctionDef)]
    compared = 0
    for name, stub in methods:
        made = inspect.getattr_static(getattr(etendue, name), stub.name)
        if isinstance(made, property) or inspect.isgetsetdescriptor(made) or stub.name.startswith("__"):
            assert stub.name.startswith("__") or any(d.id == "property" for d in stub.decorator_list), (name, stub.name)
            continue
        parameters = inspect.signature(getattr(getattr(etendue, name), stub.name)).parameters.values()
        found = [(p.name, p.kind is p.KEYWORD_ONLY, p.default) for p in parameters]
        assert found == told_parameters(stub), (name, stub.name)
        compared += 1
    assert compared >= 10


def test_everything_public_is_documented():
    for name in ("Job", "Results", "Camera", "Frame", "Report", "Estimate", "Error", "InputError", "RunError", "Fault"):
        made = getattr(etendue, name)
        assert made.__doc__, name
        for member in vars(made):
            value = getattr(made, member)
            assert member.startswith("_") or value is None or value.__doc__, (name, member)


def test_the_package_has_the_version_of_the_change_log():
    assert etendue.__version__ == re.search(r"^## (\S+)", (ROOT / "CHANGELOG.md").read_text(), re.M)[1]


def mypy(module, *arguments, folder):
    """Runs mypy beside the package that is tested."""
    environment = {**os.environ, "MYPYPATH": str(pathlib.Path(etendue.__file__).parents[1])}
    done = subprocess.run([sys.executable, "-m", module, *map(str, arguments)], cwd=folder, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr


def test_mypy_finds_the_stubs_to_be_those_of_the_module(tmp_path):
    package = ROOT / "crates/python"
    configured = ["--mypy-config-file", package / "pyproject.toml", "--allowlist", package / "tests/stubtest.txt", "--ignore-unused-allowlist"]
    mypy("mypy.stubtest", "etendue", "--concise", *configured, folder=tmp_path)


def test_the_code_of_the_documentation_and_the_stubs_that_it_imports_are_strictly_typed(tmp_path):
    blocks = re.findall(r"```python\n(.*?)```", (ROOT / "docs/python.md").read_text(), re.S)
    assert len(blocks) == 3
    for number, block in enumerate(blocks):
        (tmp_path / f"block_{number}.py").write_text(f"import etendue\nimport numpy as np\n{block}")
    mypy("mypy", "--strict", "--no-incremental", "--python-version", "3.10", "--config-file", ROOT / "crates/python/pyproject.toml", ".", folder=tmp_path)
