"""Looks for texts that give anything but diagnostics.

    python tests/fuzz/fuzz_language.py --mutations 1000000 --seed 1 [--seconds 600]
    python tests/fuzz/fuzz_language.py --atheris --seconds 600      (guided by coverage; pip install atheris)

Changes the programs and queries of tests/corpus and of knowledge/, and reads, builds, lints and formats what comes
out. Anything raised that is not a QSRError is shown with a minimal text, and the exit code is 1.
"""

from __future__ import annotations

import argparse
import os
import random
import sys
import tempfile
import time
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Any

sys.path.insert(0, str(Path(__file__).parents[1]))

CHECK_CLOCK_EVERY = 256
TELL_EVERY = 100_000
LONGEST_SECONDS = 20
A_DAY = 86_400


def fuzz(harness: ModuleType, mutations: int, seed: int, seconds: float) -> tuple[int, int]:
    """Try changed texts; return how many, and how many different failures were shown."""
    end = time.monotonic() + seconds
    known: set[str] = set()
    tried = 0
    for target, text in harness.cases(seed):
        if tried >= mutations or (tried % CHECK_CLOCK_EVERY == 0 and time.monotonic() > end):
            break
        error = harness.failure(target, text)
        tried += 1
        if tried % TELL_EVERY == 0:
            print(f"{tried} texts", file=sys.stderr, flush=True)
        if error is not None and (place := harness.place(error)) not in known:
            known.add(place)
            print(harness.report(target, text), flush=True)
    return tried, len(known)


def fuzz_by_coverage(atheris: Any, harness: ModuleType, seconds: float) -> None:
    """Let atheris look for texts that reach new code; the first byte says what a text is taken for."""
    targets = dict(zip((b"b", b"l", b"f", b"q"), harness.TARGETS, strict=True))
    seeds = harness.seeds()

    def one(content: bytes) -> None:
        target = targets.get(content[:1], harness.build)
        text = content[1:].decode("utf-8", "surrogateescape")
        error = harness.failure(target, text)
        if error is not None:
            sys.stderr.write(harness.report(target, text))
            raise error

    def change(content: bytes, longest: int, seed: int) -> bytes:
        chance = random.Random(seed)
        if chance.random() < 0.3:
            return bytes(atheris.Mutate(content, longest))
        kind = content[:1] if content[:1] in targets else b"b"
        text = harness.mutate(content[1:].decode("utf-8", "surrogateescape"), chance, seeds[targets[kind]])
        return (kind + text.encode("utf-8", "surrogatepass"))[:longest]

    folder = Path(tempfile.mkdtemp(prefix="fuzz-"))
    for kind, target in targets.items():
        for number, text in enumerate(seeds[target]):
            (folder / f"{kind.decode()}{number}").write_bytes(kind + text.encode())
    os.chdir(folder)
    limits = [
        f"-max_total_time={seconds:.0f}",
        f"-max_len={harness.LONGEST_TEXT}",
        f"-timeout={LONGEST_SECONDS}",
    ]
    atheris.Setup([sys.argv[0], str(folder), *limits, "-print_final_stats=1"], one, custom_mutator=change)
    atheris.Fuzz()


def main() -> int:
    """Run from the command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--mutations", type=int, default=1_000_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--seconds", type=float, default=A_DAY)
    parser.add_argument("--atheris", action="store_true")
    given = parser.parse_args()
    if given.atheris:
        atheris = import_module("atheris")
        with atheris.instrument_imports(include=["qsrlang", "lark"]):
            harness = import_module("fuzz.harness")
        harness.parse_files_once()
        fuzz_by_coverage(atheris, harness, given.seconds)
    harness = import_module("fuzz.harness")
    harness.parse_files_once()
    begin = time.monotonic()
    tried, failures = fuzz(harness, given.mutations, given.seed, given.seconds)
    spent = time.monotonic() - begin
    print(f"{tried} texts in {spent:.0f} s ({1e3 * spent / max(tried, 1):.2f} ms each), {failures} failures")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
