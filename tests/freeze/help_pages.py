"""The help of every verb and sub-verb, found by the lists of commands in the help itself."""

import re
from argparse import Namespace
from pathlib import Path

import digest
import record
from program import Program

HEADING = "`--help` of every verb and sub-verb: SHA-256 (its first 24 digits)."


def measure(program: Program, wanted: Namespace) -> record.Entries:
    entries: record.Entries = {}
    waiting: list[list[str]] = [[]]
    while waiting:
        verb = waiting.pop(0)
        run = program.run([*verb, "--help"])
        if run.status != 0:
            raise SystemExit(f"{' '.join(verb)} --help: exit status {run.status}\n{run.err}")
        name = " ".join(["etendue", *verb])
        entries[name] = digest.digest(run.out)
        waiting += [[*verb, command] for command in commands(run.out.decode())]
        if wanted.details:
            file = wanted.details / "help" / (name.replace(" ", "-") + ".txt")
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_bytes(run.out)
    return entries


def commands(text: str) -> list[str]:
    """The names in the list of commands; `help` is the argument parser's own."""
    listed = re.search(r"^Commands:\n((?:  .*\n)+)", text, re.MULTILINE)
    names = re.findall(r"^  ([a-z][a-z0-9-]*)", listed.group(1), re.MULTILINE) if listed else []
    return [name for name in names if name != "help"]


def describe(stored: str, found: str) -> str:
    return "other text"
