"""What the program states of jobs and of itself: hash and JSON of the plan of every job that ships, and the help of every verb."""

import json
import re
from argparse import Namespace

import record
from record import ROOT, Program

PLANS_HEADING = """
Every job below scenes and crates/cli/tests/jobs: the plan's hash (its first 16 digits), the SHA-256 of `plan --json` with sorted
keys, and that of the same without prose, where texts that hold a blank are left out.
"""

HELP_HEADING = "`--help` of every verb and sub-verb: SHA-256 (its first 16 digits)."

FOLDERS = ("scenes", "crates/cli/tests/jobs")

ASSETS = {"crates/cli/tests/jobs/kenney.toml": ROOT.parent / "shared" / "assets"}
"""Jobs of models that are not in the repository, with the folder of these: they are skipped where it is missing."""


def jobs() -> list[str]:
    """TOML files with cameras or settings of rendering, by their paths from the root."""
    files = sorted(path for folder in FOLDERS for path in (ROOT / folder).rglob("*.toml"))
    return [path.relative_to(ROOT).as_posix() for path in files if is_job(path.read_text(encoding="utf-8"))]


def is_job(text: str) -> bool:
    return "[[cameras]]" in text or "\n[render]" in text


def measure_plans(program: Program, wanted: Namespace) -> record.Entries:
    return {job: measure_plan(program, wanted, job) for job in jobs()}


def measure_plan(program: Program, wanted: Namespace, job: str) -> str:
    if job in ASSETS and not ASSETS[job].is_dir():
        return record.SKIPPED
    run = program.run(["plan", "--json", job])
    if run.status != 0:
        return run.failure(f"etendue plan --json {job}")
    plan = json.loads(run.out)
    readable = json.dumps(plan, indent=1, sort_keys=True, ensure_ascii=False) + "\n"
    record.write_detail(wanted, f"plans/{job.removesuffix('.toml')}.json", readable.encode())
    digests = (record.digest(record.canonical(value)) for value in (plan, without_prose(plan)))
    return " ".join([plan["hash"][: record.DIGITS], *digests])


def without_prose(value):
    """A JSON value whose texts of several words are empty."""
    if isinstance(value, dict):
        return {key: without_prose(inner) for key, inner in value.items()}
    if isinstance(value, list):
        return [without_prose(inner) for inner in value]
    return "" if isinstance(value, str) and " " in value else value


def describe_plan(stored: str, found: str) -> str:
    parts = ("hash", "JSON", "JSON without prose")
    return "other " + ", ".join(part for part, was, now in zip(parts, stored.split(), found.split()) if was != now)


def measure_help(program: Program, wanted: Namespace) -> record.Entries:
    """Help pages, found by the list of commands of each page, from that of the program on."""
    entries: record.Entries = {}
    waiting: list[list[str]] = [[]]
    while waiting:
        verb = waiting.pop(0)
        name = " ".join(["etendue", *verb])
        run = program.run([*verb, "--help"])
        if run.status != 0:
            entries[name] = run.failure(f"{name} --help")
            continue
        entries[name] = record.digest(run.out)
        record.write_detail(wanted, f"help/{name.replace(' ', '-')}.txt", run.out)
        waiting += [[*verb, command] for command in commands(run.out.decode())]
    return entries


def commands(page: str) -> list[str]:
    """The commands that a help page lists, without `help` itself."""
    listed = re.search(r"^Commands:\n((?:  .*\n)+)", page, re.MULTILINE)
    names = re.findall(r"^  ([a-z][a-z0-9-]*)", listed[1], re.MULTILINE) if listed else []
    return [name for name in names if name != "help"]


def describe_help(_stored: str, _found: str) -> str:
    return "other text"


PLANS = record.Section(PLANS_HEADING, measure_plans, describe_plan)
HELP = record.Section(HELP_HEADING, measure_help, describe_help)
