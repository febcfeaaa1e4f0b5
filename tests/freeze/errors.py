"""Exit status and places of erroneous inputs, which stand in errors.json. The wording of messages is no part of the record."""

import json
import re
import shutil
from argparse import Namespace
from pathlib import Path

import record
from program import ROOT, Program

HEADING = """
The erroneous inputs of errors.json: exit status, then each error as place (file:line:column, or the argument), key, further
places, and [code] where the program states one.
"""

TABLE = Path(__file__).resolve().parent / "errors.json"

# An error and the indented lines below it.
ERROR = re.compile(r"^error(?:\[(?P<code>[\w-]+)\])?: (?P<text>.*(?:\n  .*)*)", re.MULTILINE)
# What precedes the wording: a file, its line and column, a key.
PLACE = re.compile(r"^(?P<place>[^\s:]+(?::\d+(?::\d+)?)?): (?:(?P<key>[a-z_][\w./\[\]-]*): )?")
# The place in a description that names a broken file.
FURTHER = re.compile(r"[^\s:()\"]+\.\w+:\d+:\d+(?:: [a-z_][\w./\[\]-]*\w)?")
ARGUMENT = re.compile(r"--set \S+?(?==|:|\s|$)|--[a-z][a-z0-9-]*")


def measure(program: Program, wanted: Namespace) -> record.Entries:
    table = json.loads(TABLE.read_text(encoding="utf-8"))
    entries: record.Entries = {}
    for number, case in enumerate(table["cases"]):
        folder = program.scratch / "errors" / str(number)
        cwd = prepare(table["bases"], case, folder)
        run = program.run(case.get("run", ["plan", "small.toml"]), cwd=cwd)
        if case["name"] in entries:
            raise SystemExit(f"two cases are named {case['name']}")
        entries[case["name"]] = entry(run.status, run.err)
        if wanted.details:
            file = wanted.details / "errors" / (re.sub(r"\W+", "-", case["name"]) + ".txt")
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(run.err, encoding="utf-8")
        shutil.rmtree(folder, ignore_errors=True)
    return entries


def prepare(bases: dict[str, list[str]], case: dict, folder: Path) -> Path:
    """The folder in which the command is run: a copy of the base with the case's edits, or the repository for "base": "repository"."""
    base = case.get("base", "small")
    if base == "repository":
        return ROOT
    folder.mkdir(parents=True)
    for pattern in bases[base]:
        for source in ROOT.glob(pattern):
            shutil.copy(source, folder / source.name)
    for name, before, after in case.get("edit", []):
        replace(folder / name, before, after)
    for name, text in case.get("write", {}).items():
        (folder / name).write_text(text, encoding="utf-8")
    for name, fraction in case.get("cut", {}).items():
        data = (folder / name).read_bytes()
        (folder / name).write_bytes(data[: int(len(data) * fraction)])
    for name in case.get("remove", []):
        (folder / name).unlink()
    return folder


def replace(path: Path, before: str, after: str) -> None:
    text = path.read_text(encoding="utf-8")
    if before not in text:
        raise SystemExit(f"{path.name} lacks {before!r}")
    path.write_text(text.replace(before, after, 1), encoding="utf-8")


def entry(status: int, err: str) -> str:
    found = [place(match["text"], match["code"]) for match in ERROR.finditer(err)]
    return " | ".join([f"exit {status}", *found])


def place(text: str, code: str | None) -> str:
    """What an error states besides its wording."""
    parts = []
    if head := PLACE.match(text):
        parts += [head["place"], head["key"]]
        text = text[head.end() :]
        parts += [further.replace(": ", " ") for further in FURTHER.findall(text)]
    elif argument := ARGUMENT.search(text):
        parts.append(argument[0])
    else:
        parts.append("no place")
    parts.append(f"[{code}]" if code else None)
    return " ".join(part for part in parts if part)


def describe(stored: str, found: str) -> str:
    """A code that was not stated when the record was stored is no difference."""
    bare = [re.sub(r" \[[\w-]+\]", "", value) for value in (stored, found)]
    if bare[0] == bare[1] and "[" not in stored:
        return ""
    return record.describe_values(stored, found)
