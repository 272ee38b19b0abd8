"""Command line, from tests/: python -m other_bench OUT --seed N [--effect NAME --size X]."""

import argparse
from dataclasses import replace
from pathlib import Path

import numpy as np

from other_bench.bench import record
from other_bench.effects import EFFECTS, Drawn, Effect

DESCRIPTION = "Record a healthy session of a unit, and another one with something hidden in it."


def main() -> None:
    """Record what the arguments ask for."""
    sizes = "; ".join(f"{name}: {kind.what}, {kind.size:g} {kind.unit}" for name, kind in EFFECTS.items())
    parser = argparse.ArgumentParser(prog="other_bench", description=DESCRIPTION)
    parser.add_argument("out", type=Path)
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument("--effect", choices=EFFECTS, default="none")
    parser.add_argument("--size", type=float, help=f"default of each: {sizes}".replace("%", "%%"))
    parser.add_argument("--unit", help="name of the specimen; default: one of the seed's own")
    parser.add_argument("--theta", type=float, help="direction or place of the effect [rad]; default: drawn")
    parser.add_argument("--channel", type=int, choices=(1, 2, 3, 4), help="which of s1 to s4; default: drawn")
    asked = parser.parse_args()
    given = {name: value for name in ("theta", "channel") if (value := getattr(asked, name)) is not None}
    drawn = replace(Drawn.of(np.random.default_rng([asked.seed, 9])), **given)
    size = EFFECTS[asked.effect].size if asked.size is None else asked.size
    unit = f"seed{asked.seed}" if asked.unit is None else asked.unit
    try:
        record(asked.out, asked.seed, Effect(asked.effect, size, drawn), unit)
    except ValueError as error:
        parser.error(str(error))


if __name__ == "__main__":
    main()
