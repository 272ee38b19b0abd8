"""Every reader on spoiled files for a given time: ``python scripts/fuzz.py --seconds 300`` (docs/reliability.md)."""

import argparse
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))  # the targets belong to the tests

from fuzzing.campaign import HARMLESS, KINDS, campaign
from fuzzing.targets import TARGETS

KEPT = Path("outputs/fuzz")


def main() -> int:
    """Print a table; the exit status is 1 if anything but a reading or a refusal came out."""
    asked = argparse.ArgumentParser(description=__doc__)
    asked.add_argument("--seconds", type=float, default=300, help="for all readers together")
    asked.add_argument("--seed", type=int, default=0)
    asked.add_argument("--only", default="", help="readers whose name has this in it")
    chosen = asked.parse_args()
    names = [name for name in TARGETS if chosen.only in name]
    print(f"| reader | tried | {' | '.join(KINDS)} | most memory [MiB] |\n|---|{'--:|' * (len(KINDS) + 2)}")
    harm = []
    for number, name in enumerate(names):
        rng = np.random.default_rng([chosen.seed, number])
        tally = campaign(name, chosen.seconds / len(names), rng, KEPT / name.replace("/", "-"))
        cells = [sum(tally.kinds.values()), *(tally.kinds[kind] for kind in KINDS), tally.memory // 2**20]
        print(f"| {name} | {' | '.join(map(str, cells))} |", flush=True)
        harm += [f"{name}: {count} times {reason}" for reason, count in tally.harm.most_common()]
    print("\n".join(["", *harm]) if harm else f"\nnothing but {' and '.join(HARMLESS)}")
    return 1 if harm else 0


if __name__ == "__main__":
    sys.exit(main())
