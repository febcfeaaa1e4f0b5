# Every task of the project. `just` lists them.

default:
    @just --list

# All tests (the README's command)
test:
    cargo test --workspace

# What CI runs
ci:
    .ci/run

# The studies of which CI makes a part, in full: coverage by 200 seeds, all jobs with all integrators, the bytes of a build for this machine's processor
whole:
    ETENDUE_WHOLE=1 cargo test -p etendue-metrology
    ETENDUE_WHOLE=1 cargo test -p etendue-cli --test binary plans::
    .ci/same_bits whole

# Tests of the Python package (needs Python 3.10 and PyPI)
python:
    ETENDUE_PYTHON="$(.ci/python)" cargo test --workspace --test package --test binary -- the_package help

# Runs on a Ray cluster of two nodes, one of which is killed (400 MB of PyPI)
cluster:
    ETENDUE_PYTHON_CLUSTER="$(.ci/python cluster)" cargo test -p etendue-python --test package -- a_cluster

# The notebooks of docs/notebooks, run from top to bottom
notebooks:
    ETENDUE_PYTHON_NOTEBOOKS="$(.ci/python notebooks)" cargo test -p etendue-python --test package -- notebooks

# Pages of results in headless Chromium, opened from the file system (Debian: apt-get install chromium)
view-test:
    ETENDUE_CHROMIUM="$(command -v chromium)" cargo test --workspace --test binary -- view::

# A wheel of the Python package as it is released, in target/packages (needs Python 3.11 and PyPI)
wheel:
    packaging/wheel

# The program as it is released, with manual pages and completions, in target/packages (needs Python 3.11)
dist:
    packaging/dist

# Both packages, taken by an environment without Rust (after just dist and just wheel)
packages-test:
    packaging/test

# Benchmarks: rays, paths, memory
bench:
    cargo run --release -p etendue-benches

# Instructions of the whole tracer over those of one without optional effects, on a diffuse scene (needs valgrind)
instructions:
    benches/instructions/count

# Regenerate the scenes that ship with the project
scenes:
    cargo run --release -p etendue-scenes -- scenes

# Recompute the figures of independent programs (needs Python and PyPI)
oracles:
    tests/oracles/run

# Compare the release binary's behaviour with the stored record: `just freeze compare`, `just freeze store` (needs Python 3.10 and valgrind)
freeze *arguments:
    tests/freeze/run {{arguments}}

# Additions of docs/how-to-add applied to a copy, which is checked, and their tests (`branch`, `store`: how the patches are regenerated, tests/additions/run)
additions *arguments:
    tests/additions/run {{arguments}}

# The reader of Universal Scene Description, its tests and its fuzz targets (in a folder of their own: it changes how PNGs are compressed)
usd:
    CARGO_TARGET_DIR=target/usd cargo test -p etendue-import -p etendue -p etendue-cli -p etendue-fuzz --features etendue-import/usd,etendue/usd,etendue-cli/usd,etendue-fuzz/usd -- usd what_was_found

# Recover the declared parameters of reference cameras from renders of charts: writes docs/evidence/validation.md
validate *cameras:
    cargo run --release -q -p etendue-validation --bin validate -- {{cameras}}

# How often the intervals of characterise hold the truth, over 50 seeds (an hour; --resume goes on): writes target/laboratory/coverage.md
laboratory *arguments:
    cargo run --release -q -p etendue-validation --bin laboratory -- {{arguments}}

# Cameras with a fault beside their files without it: every fault must be flagged; writes docs/evidence/faults.md
faults:
    ETENDUE_BLESS=1 cargo test -p etendue-cli --test binary faults::

# The ends of every range: writes docs/evidence/extremes.md
extremes:
    ETENDUE_BLESS=1 ETENDUE_INSTANCES=1 cargo test -p etendue-tests --test physics ranges:: -- --test-threads=1
    ETENDUE_BLESS=1 cargo test -p etendue-cli --test binary -- --test-threads=1 extremes:: pictures_that_are_mirrored killed:: concurrent::

# Variance by the density of wavelengths, by sensor and light: writes docs/evidence/wavelengths.md
wavelengths:
    ETENDUE_BLESS=1 cargo test -p etendue-tests --test physics wavelength_density

# The book of docs as HTML, in the folder book (needs mdBook: cargo install mdbook)
book:
    mdbook build
    # The pages of docs/evidence are outside the book: links lead to the files.
    find book -name '*.html' -exec sed -i -E 's#href="((\.\./)*)evidence/([a-z-]+)\.html#href="\1../docs/evidence/\3.md#g' {} +

# Render the pictures of docs/pictures.md anew (names: some of them)
gallery *names:
    docs/pictures/gallery {{names}}

# Render the pictures of docs/effects anew and measure their prices (names: some of the pages; needs Python)
effects *names:
    docs/pictures/effects {{names}}

# Time against error of five scenes: writes docs/evidence/tradeoff-scenes.md (names: some of them)
tradeoff *names:
    docs/pictures/tradeoff {{names}}

# Efficiency beside Mitsuba 3 and Cycles (needs Python 3.11, PyPI, libllvm19)
peers *arguments:
    benches/peers/run {{arguments}}

# Kill small runs at so many random moments, and resume or rerun them: writes target/kills.md
kills count="1000" seed="1":
    ETENDUE_KILLS={{count}} ETENDUE_KILLS_SEED={{seed}} cargo test --release -p etendue-cli --test binary killed::

# The accelerator's tests under the address sanitiser: all there is of unsafe code (Linux, x86-64)
sanitise:
    RUSTC_BOOTSTRAP=1 RUSTFLAGS="-Zsanitizer=address -Ctarget-cpu=x86-64-v2" cargo test --target x86_64-unknown-linux-gnu --target-dir target/sanitised -p etendue-tracer --lib -- accel:: render_space::

# Licences, sources and advisories of everything that is used (needs cargo-deny and a network)
policy:
    cargo deny --all-features check

# The bill of materials of the program, CycloneDX as JSON on stdout (needs Python 3.11)
sbom:
    @.ci/sbom

# The licences of all that is linked into the program, as text on stdout (needs Python 3.11)
licences:
    @packaging/licences
