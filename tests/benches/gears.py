"""Gears of the benches of other authors, recorded healthy and again, with what was hidden in between."""

import json
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

from swgsim.common.files import write_json
from swgsim.effects.library import LIBRARY

HERE = Path(__file__).parent
# Effects that tests/other_bench hides, six healthy gears first; the last two are in no library.
OF_OTHER_BENCH = (
    *["none"] * 6, "eccentric_wave_generator", "tilting_moment", "root_tooth_crack", "tip_tooth_crack",
    "kinematic_error_order", "reduced_damping", "reduced_stiffness", "flank_friction", "gauge_gain", "gauge_position",
    "zero_offset", "mains_hum", "sticky_bearing", "breathing_case",
)  # fmt: skip


class Bench(NamedTuple):
    """A bench: the folder that its module is run from, and whether it was asked only once, after all changes."""

    folder: Path
    asked_once: bool


BENCHES = {
    "other_bench": Bench(HERE.parent, False),
    "shell_bench": Bench(HERE, False),
    "ring_bench": Bench(HERE, False),
    "frame_bench": Bench(HERE, False),
    "ritz_bench": Bench(HERE, False),
}
GEARS = 20


def recorded(folder: Path, name: str, case: int, seed: int) -> None:
    """Folders ``healthy`` and ``again``, and truth.json."""
    if name == "other_bench":
        hidden = ["--seed", str(800 * seed + case), "--effect", OF_OTHER_BENCH[case]]
    else:
        hidden = ["--seed", str(seed), "--case", str(case)]
    subprocess.run([sys.executable, "-m", name, str(folder), *hidden], cwd=BENCHES[name].folder, check=True)
    if name == "other_bench":
        (folder / "commissioning").rename(folder / "healthy")
        (folder / "recordings").rename(folder / "again")
        effect = json.loads((folder / "truth.json").read_text())["effect"]
        library = effect["name"] in LIBRARY
        hidden_name = None if effect["name"] == "none" else effect["name"]
        write_json(folder / "truth.json", {"effect": hidden_name, "library": library, "size": effect["size"]})
