#!/bin/sh
# Étendue's accelerator beside Intel Embree 4.4, which the wheel `embreex` brings along (PyPI; Python 3 is needed).
# Everything lands in target/peers. Arguments are the names of tables: rays, agreement, sizes; none for all. Before them
# --max-isa avx2 holds Embree to AVX2, --largest 1000000 leaves out larger hills.
set -e
root=$(cd "$(dirname "$0")/../.." && pwd)
venv=$root/target/peers/embree-venv
if [ ! -e "$venv/bin/python" ]; then
    python3 -m venv "$venv"
fi
"$venv/bin/python" -m pip install --quiet --disable-pip-version-check --no-deps "embreex==4.4.0.post1"
library=$(find "$venv" -name "libembree4*.so*" | head -n 1)
tbb=$(dirname "$library")
street=$root/target/peers/street.bin
cargo run --release --locked --quiet --manifest-path "$root/Cargo.toml" -p etendue-benches -- --contest "$street"
cd "$root/benches/peers/embree"
cargo build --release --locked --quiet --target-dir "$root/target/peers/embree"
LD_LIBRARY_PATH=$tbb exec "$root/target/peers/embree/release/etendue-beside-embree" "$library" "$street" "$@"
