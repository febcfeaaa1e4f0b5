"""``python -m etendue.cluster JOB.toml -o DIR --shards N``."""

from __future__ import annotations

import argparse
import importlib.util
import re
import sys
import warnings

from .._errors import InputError, RunError
from .driver import render


def frames(text):
    found = re.fullmatch(r"(\d+)\.\.(\d+)", text)
    if not found or not int(found[1]) < int(found[2]) < 2**32:
        raise argparse.ArgumentTypeError(f"expected FIRST..END with FIRST < END, e.g. 0..10, not {text!r}")
    return range(int(found[1]), int(found[2]))


def parser():
    made = argparse.ArgumentParser(
        prog="python -m etendue.cluster",
        description="Render a job on the machines of a Ray cluster: the files of `etendue render`, byte for byte (docs/cluster.md).",
        allow_abbrev=False,
    )
    made.add_argument("job", metavar="JOB.toml", help="the job file; the files that it reads are sent to the machines")
    made.add_argument("-o", "--output", required=True, metavar="DIR", help="folder for the results; made where missing")
    made.add_argument("--shards", required=True, type=int, metavar="N", help="parts of each film: tasks are films times shards")
    made.add_argument("--frames", type=frames, default=range(0, 1), metavar="A..B", help="frames to take, the last excluded [default: 0..1]")
    made.add_argument("--address", metavar="HOST:PORT", help="the cluster, or auto [default: RAY_ADDRESS, or this machine alone]")
    made.add_argument("--threads", type=int, metavar="N", help="processors of a task [default: those of the smallest machine]; no bit depends on it")
    made.add_argument("--retries", type=int, default=3, metavar="N", help="how often a task is done again whose worker was lost [default: 3]")
    made.add_argument("--resume", action="store_true", help="go on where the same run was interrupted")
    made.add_argument("--overwrite", action="store_true", help="replace existing results")
    same = made.add_argument_group("as of `etendue render`")
    same.add_argument("--set", action="append", metavar="KEY=VALUE")
    same.add_argument("--spp", type=int, metavar="N")
    same.add_argument("--noise", type=float, metavar="F")
    same.add_argument("--seed", type=int, metavar="N")
    same.add_argument("--integrator", metavar="WORD")
    same.add_argument("--quality", metavar="WORD")
    same.add_argument("--camera", metavar="NAME")
    return made


def show(what, done, total):
    """Progress: one changing line on a terminal, elsewhere one line per step."""
    whole = float(done).is_integer()
    text = f"{what} {int(done)}/{total}" if whole else f"{what} {done:.1f}/{total}"
    if sys.stderr.isatty():
        print(f"\r\x1b[K{text}", end="" if done < total else "\n", file=sys.stderr, flush=True)
    elif whole and text != show.last:
        print(text, file=sys.stderr, flush=True)
        show.last = text


show.last = None


def spelled(text):
    """Message whose arguments, in backticks by their Python names, are replaced by those of the command line."""
    options = {action.dest: action.option_strings[-1] for action in parser()._actions if action.option_strings}
    return re.sub(r"`(\w+)`", lambda name: options.get(name[1], name[0]), str(text))


def main(arguments=None):
    """Exit status: 0, 1 if the run failed, 2 if the input is unusable, 130 after Ctrl-C."""
    given = vars(parser().parse_args(arguments))
    warnings.showwarning = lambda message, *_: print(f"warning: {spelled(message)}", file=sys.stderr)
    if importlib.util.find_spec("ray") is None:
        print('error: Ray is not installed; pip install "./crates/python[cluster]"', file=sys.stderr)
        return 2
    job, output = given.pop("job"), given.pop("output")
    try:
        paths = render(job, output, progress=show, **{name: value for name, value in given.items() if value is not None})
    except InputError as error:
        print("\n".join(f"error[{fault.code}]: {spelled(fault.message)}" for fault in error.faults), file=sys.stderr)
        return 2
    except ValueError as error:
        print("\n".join(f"error: {line}" for line in spelled(error).splitlines()), file=sys.stderr)
        return 2
    except RunError as error:
        print(f"error: {spelled(error)}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print("cancelled; what is finished is kept: go on with --resume", file=sys.stderr)
        return 130
    print("\n".join(map(str, paths)))
    return 0


if __name__ == "__main__":
    sys.exit(main())
