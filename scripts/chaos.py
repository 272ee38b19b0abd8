"""Kills data sets and sweeps at random moments: ``python scripts/chaos.py --kills 200`` (docs/reliability.md)."""

import argparse
import os
import sys
import tempfile
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))  # the works that are killed belong to the tests

from chaos.campaign import campaign
from chaos.subjects import subjects, training_data

TABLE = Path("outputs/chaos.md")
# Of the kills: a command takes seconds to start, so that most of them are of forks of this process.
SHARES = {"data set, in a fork": 0.45, "data set, scripts/generate.py": 0.05, "sweep, in a fork": 0.45,
          "sweep, scripts/train.py": 0.05}  # fmt: skip


def main() -> int:
    """Print and write a table; the exit status is 1 if anything was lost or is not the same, or too much."""
    asked = argparse.ArgumentParser(description=__doc__)
    asked.add_argument("--kills", type=int, default=200)
    asked.add_argument("--seconds", type=float, default=float("inf"), help="after which no more are begun")
    asked.add_argument("--seed", type=int, default=0)
    asked.add_argument("--only", default="", help="works whose name has this in it")
    chosen = asked.parse_args()
    harm = []
    head = "| work | begun | killed and started again | lost | differing | phases of the kills |"
    rows = [head, "|---|--:|--:|--:|--:|---|"]
    with tempfile.TemporaryDirectory(prefix="chaos") as scratch:
        place = Path(scratch)
        os.environ["TMPDIR"] = tempfile.tempdir = scratch  # a killed process leaves its temporary files
        training_data(place)
        works = subjects(place)
        print("\n".join(rows), flush=True)
        for number, (name, share) in enumerate(SHARES.items()):
            if chosen.only not in name:
                continue
            folder = place / str(number)
            folder.mkdir()
            kills, rng = max(1, round(share * chosen.kills)), np.random.default_rng([chosen.seed, number])
            tally = campaign(works[name], kills, share * chosen.seconds, rng, folder)
            phases = ", ".join(f"{phase}: {count}" for phase, count in sorted(tally.phases.items()))
            cells = [name, tally.works, tally.kills, tally.lost.total(), tally.differing.total(), phases]
            rows.append(f"| {' | '.join(map(str, cells))} |")
            print(rows[-1], flush=True)
            harm += [f"{name}: {count} times {reason}" for reason, count in (tally.lost + tally.differing).items()]
    TABLE.parent.mkdir(exist_ok=True)
    TABLE.write_text("\n".join(rows) + "\n")
    print("\n".join(["", *(harm or ["nothing lost, nothing differs"])]))
    return 1 if harm else 0


if __name__ == "__main__":
    sys.exit(main())
