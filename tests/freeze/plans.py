"""Hash and JSON of the plan of every job that ships."""

import json
import sys
from argparse import Namespace
from pathlib import Path

import digest
import record
from program import ROOT, Program

HEADING = """
Every job below scenes and crates/cli/tests/jobs: the plan's hash (its first 24 digits), the SHA-256 of `plan --json`
with sorted keys, and the same without prose (texts that hold a blank are left out).
"""

FOLDERS = ("scenes", "crates/cli/tests/jobs")
# A job of models that are not in the repository: it is skipped where they are missing.
ASSETS = {"crates/cli/tests/jobs/kenney.toml": ROOT.parent / "shared" / "assets"}


def jobs() -> list[str]:
    """TOML files with cameras or settings of rendering, by their paths from the root."""
    files = sorted(path for folder in FOLDERS for path in (ROOT / folder).rglob("*.toml"))
    return [path.relative_to(ROOT).as_posix() for path in files if is_job(path.read_text(encoding="utf-8"))]


def is_job(text: str) -> bool:
    return "[[cameras]]" in text or "\n[render]" in text


def measure(program: Program, wanted: Namespace) -> record.Entries:
    entries: record.Entries = {}
    for job in jobs():
        if job in ASSETS and not ASSETS[job].is_dir():
            entries[job] = "skipped"
            continue
        run = program.run(["plan", "--json", job])
        if run.status != 0:
            print(f"etendue plan --json {job}\n{run.err}", file=sys.stderr)
            entries[job] = f"exit status {run.status}"
            continue
        entries[job] = entry(json.loads(run.out))
        if wanted.details:
            write_details(wanted.details / "plans" / job, json.loads(run.out))
    return entries


def entry(plan: dict) -> str:
    digests = (digest.digest(digest.canonical(value)) for value in (plan, without_prose(plan)))
    return " ".join([plan["hash"][: digest.DIGITS], *digests])


def without_prose(value):
    if isinstance(value, dict):
        return {key: without_prose(inner) for key, inner in value.items()}
    if isinstance(value, list):
        return [without_prose(inner) for inner in value]
    return "" if isinstance(value, str) and " " in value else value


def write_details(path: Path, plan: dict) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.with_suffix(".json").write_text(json.dumps(plan, indent=1, sort_keys=True, ensure_ascii=False) + "\n", encoding="utf-8")


def describe(stored: str, found: str) -> str:
    if "skipped" in (stored, found):
        return ""
    if "exit status" in stored + found:
        return f"was {stored}, is {found}"
    parts = ("hash", "JSON", "JSON without prose")
    changed = [name for name, was, is_now in zip(parts, stored.split(), found.split()) if was != is_now]
    return "other " + ", ".join(changed)
