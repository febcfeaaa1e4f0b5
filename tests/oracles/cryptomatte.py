"""Figures of mmh3 for crates/io: figures/cryptomatte.json.

Hashes names by MurmurHash3 (32 bits, seed 0) and makes identities of them as Psyop's specification 1.2.0 says: names of every length to eight bytes, of other
scripts, and such as scenes have. States the bits of the identities.
Versions: requirements.txt. Run anywhere:
    python tests/oracles/cryptomatte.py
"""

import importlib.metadata
import json
import pathlib

import mmh3

FIGURES = pathlib.Path(__file__).parent / "figures"


def identity(name):
    hashed = mmh3.hash(name.encode("utf-8"), seed=0, signed=False)
    # The specification: exponents of 0 and 255 would be denormal numbers, infinities or none.
    if (hashed >> 23) & 255 in (0, 255):
        hashed ^= 1 << 23
    return f"{hashed:08x}"


def main():
    names = ["abcdefgh"[:length] for length in range(9)]
    names += ["hello", "cube", "sphere", "plane", "CryptoObject", "CryptoMaterial", "Straße", "λ", "日本", "a \"b\" \\", "short-block"]
    names += [f"car.{number}" for number in range(1200)]
    figures = {"program": f"mmh3 {importlib.metadata.version('mmh3')}", "identities": {name: identity(name) for name in names}}
    (FIGURES / "cryptomatte.json").write_text(json.dumps(figures, indent=1) + "\n")


if __name__ == "__main__":
    main()
