"""The twin on gears of other authors: swg diagnose beside what was hidden."""

import json
from collections.abc import Sequence
from pathlib import Path
from time import process_time
from typing import Any

import numpy as np
from scipy.stats import binomtest

import swgsim as swg
from swgsim.dataset.faults import FAULTS

# A shorter share of the report, which also has every recording.
FIELDS = ("verdict", "sentence", "probabilities", "fault", "chance", "lack_of_fit", "lack_of_fit_healthy")


def diagnosed(folder: Path) -> dict[str, Any]:
    """The truth of a gear, and the diagnosis of it; no diagnosis of what is none of the faults."""
    truth = json.loads((folder / "truth.json").read_text())
    if truth["effect"] not in (None, *FAULTS):
        return {"truth": truth, "report": None}
    began = process_time()
    recordings, healthy = (swg.read_recordings(folder / name) for name in ("again", "healthy"))
    report = swg.diagnose(recordings, healthy, swg.Gear()).report
    return {"truth": truth, "report": {name: report[name] for name in FIELDS}, "seconds": process_time() - began}


def errors(answers: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """How many gears are called by another class than theirs [%], with the interval of Wilson, and every gear."""
    asked = [each for each in answers if each["report"]]
    gears = [
        {
            "bench": each["bench"],
            "case": each["case"],
            "label": each["truth"]["effect"] or "healthy",
            "most_probable": max(each["report"]["probabilities"], key=each["report"]["probabilities"].__getitem__),
            **{name: each["report"][name] for name in ("verdict", "sentence")},
            "lack_of_fit_healthy": each["report"]["lack_of_fit_healthy"]["value"],
            "seconds": each["seconds"],
        }
        for each in asked
    ]
    wrong = [each["most_probable"] != each["label"] for each in gears]
    interval = binomtest(sum(wrong), len(wrong)).proportion_ci(method="wilson")
    return {
        "value": 100 * float(np.mean(wrong)),
        "ci95": [100 * interval.low, 100 * interval.high],
        "count": len(gears),
        "healthy_called_faulty": sum(each["verdict"] == "faulty" for each in gears if each["label"] == "healthy"),
        "healthy": sum(each["label"] == "healthy" for each in gears),
        "gears": gears,
    }
