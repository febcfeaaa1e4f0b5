"""What the scripts of this folder share: version, target, folders, and the environment that cargo builds a release in."""

import os
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
TARGET = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")).absolute()
#: Where the artefacts of a release are left.
PACKAGES = TARGET / "packages"


def run(*command, **options):
    """What a command prints, run in the root of the repository."""
    return subprocess.run(list(map(str, command)), cwd=ROOT, check=True, stdout=subprocess.PIPE, text=True, **options).stdout


HOST = next(line.split(": ")[1] for line in run("rustc", "-vV").splitlines() if line.startswith("host: "))
VERSION = run("cargo", "pkgid", "--offline", "-p", "etendue-cli").strip().split("#")[1].split("@")[-1]


def environment():
    """The caller's environment, with which paths of this machine's registry do not get into what is built."""
    registry = Path(os.environ.get("CARGO_HOME", Path.home() / ".cargo")) / "registry/src"
    variable = f"CARGO_TARGET_{HOST.upper().replace('-', '_')}_RUSTFLAGS"
    return {**os.environ, variable: f"--remap-path-prefix={registry}=registry"}


def write_notices(package, folder):
    """The licences of what is linked into a package of the workspace, and its bill of materials."""
    (folder / "THIRD-PARTY-LICENCES.txt").write_text(run("packaging/licences", package))
    (folder / "sbom.cdx.json").write_text(run(".ci/sbom", package))
    sysroot = Path(run("rustc", "--print", "sysroot").strip())
    (folder / "RUST-STANDARD-LIBRARY-LICENCES.html").write_bytes((sysroot / "share/doc/rust/COPYRIGHT-library.html").read_bytes())
    for name in ("LICENSE-APACHE", "LICENSE-MIT"):
        (folder / name).write_bytes((ROOT / name).read_bytes())
