"""Exit status and places of erroneous inputs, which stand in errors.json. The wording of messages is no part of the record."""

import json
import re
import shutil
from argparse import Namespace
from pathlib import Path

import record
from record import ROOT, Program

HEADING = """
The erroneous inputs of errors.json: exit status, then each error as place (file:line:column, or the argument), key, the place
that names a broken file, and [code] where the program states one.
"""

TABLE = Path(__file__).resolve().parent / "errors.json"

ERROR = re.compile(r"^error(?:\[(?P<code>[\w-]+)\])?: (?P<text>.*(?:\n  .*)*)", re.MULTILINE)
"""An error and the indented lines below it."""

PLACE = re.compile(r"^(?P<place>[^\s:]+(?::\d+(?::\d+)?)?): (?:(?P<key>[a-z_][\w./\[\]-]*): )?")
"""What precedes the wording: a file with line and column, and a key."""

FURTHER = re.compile(r"[^\s:()\"]+\.\w+:\d+:\d+(?:: [a-z_][\w./\[\]-]*\w)?")
"""A place within the wording."""

ARGUMENT = re.compile(r"--set \S+?(?==|:|\s|$)|--[a-z][a-z0-9-]*")

CODE = re.compile(r" \[[A-Z][\w-]*\]")


def measure(program: Program, wanted: Namespace) -> record.Entries:
    table = json.loads(TABLE.read_text(encoding="utf-8"))
    entries: record.Entries = {}
    for case in table["cases"]:
        name = case["name"]
        if name in entries:
            raise SystemExit(f"{TABLE.name}: two cases are named {name}")
        folder = program.scratch / "errors"
        prepare(table["bases"], case, folder)
        run = program.run(case.get("run", ["plan", "small.toml"]), cwd=folder)
        entries[name] = entry(run.status, run.err)
        record.write_detail(wanted, f"errors/{name.replace(' ', '-')}.txt", run.err.encode())
        shutil.rmtree(folder)
    return entries


def prepare(bases: dict[str, list[str]], case: dict, folder: Path) -> None:
    """Makes the folder in which a case is run.

    base    files that are copied there, by their name in "bases"; the small job unless stated
    edit    the first occurrence of a text in a file, and what replaces it
    write   contents of further files
    cut     the part of a file that is kept
    remove  files that are removed
    """
    folder.mkdir(parents=True)
    for pattern in bases[case.get("base", "small")]:
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


def replace(path: Path, before: str, after: str) -> None:
    text = path.read_text(encoding="utf-8")
    if before not in text:
        raise SystemExit(f"{path.name} lacks {before!r}")
    path.write_text(text.replace(before, after, 1), encoding="utf-8")


def entry(status: int, err: str) -> str:
    return " | ".join([f"status {status}", *(place(match["text"], match["code"]) for match in ERROR.finditer(err))])


def place(text: str, code: str | None) -> str:
    """What an error states besides its wording."""
    if head := PLACE.match(text):
        further = FURTHER.findall(text[head.end() :])
        parts = [head["place"], head["key"], *(found.replace(": ", " ") for found in further)]
    elif argument := ARGUMENT.search(text):
        parts = [argument[0]]
    else:
        parts = ["no place"]
    return " ".join(part for part in [*parts, code and f"[{code}]"] if part)


def describe(stored: str, found: str) -> str:
    """A code where none was stored is no difference."""
    if not CODE.search(stored) and CODE.sub("", found) == stored:
        return ""
    return record.was_and_is(stored, found)


SECTION = record.Section(HEADING, measure, describe)
