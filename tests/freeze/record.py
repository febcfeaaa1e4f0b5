"""The stored record: one text file a section, one line an entry, `name  value`."""

from pathlib import Path

FOLDER = Path(__file__).resolve().parent / "record"

Entries = dict[str, str]


def path(section: str) -> Path:
    return FOLDER / f"{section}.txt"


def write(section: str, heading: str, entries: Entries) -> None:
    FOLDER.mkdir(exist_ok=True)
    comments = [f"# {line}" for line in heading.strip().splitlines()]
    lines = comments + [f"{name}  {value}" for name, value in entries.items()]
    path(section).write_text("\n".join(lines) + "\n", encoding="utf-8")


def read(section: str) -> Entries:
    if not path(section).is_file():
        return {}
    lines = path(section).read_text(encoding="utf-8").splitlines()
    pairs = (line.split("  ", 1) for line in lines if line and not line.startswith("#"))
    return {name: value for name, value in pairs}


def differences(stored: Entries, found: Entries, describe=None) -> list[str]:
    """One line for each entry that is new, missing or other; `describe(stored, found)` says how the values differ, or nothing."""
    describe = describe or describe_values
    lines = [f"{name}: missing, was {value}" for name, value in stored.items() if name not in found]
    for name, value in found.items():
        if name not in stored:
            lines.append(f"{name}: new, {value}")
        elif value != stored[name] and (text := describe(stored[name], value)):
            lines.append(f"{name}: {text}")
    return lines


def describe_values(stored: str, found: str) -> str:
    return f"was {stored}, is {found}"
