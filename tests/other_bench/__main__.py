"""Command line, from tests/: python -m other_bench OUT --seed N [--effect NAME]."""

import argparse
from pathlib import Path

import numpy as np

from other_bench.bench import record
from other_bench.effects import EFFECTS, Drawn, Effect

DESCRIPTION = "Record a healthy session of a unit, and another one with something hidden in it."


def main() -> None:
    """Record what the arguments ask for."""
    parser = argparse.ArgumentParser(prog="other_bench", description=DESCRIPTION)
    parser.add_argument("out", type=Path)
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument("--effect", choices=EFFECTS, default="none")
    asked = parser.parse_args()
    drawn = Drawn.of(np.random.default_rng([asked.seed, 9]))
    effect = Effect(asked.effect, EFFECTS[asked.effect].size, drawn)
    record(asked.out, asked.seed, effect, f"seed{asked.seed}")


if __name__ == "__main__":
    main()
