"""The twin on gears of other authors: swg diagnose beside what was hidden."""

import json
from collections.abc import Sequence
from pathlib import Path
from time import process_time
from typing import Any

import swgsim as swg
from swgsim.blind.intervals import rate
from swgsim.common.version import code_version
from swgsim.dataset.faults import FAULTS

# A part of the report, which also has every recording.
FIELDS = ("verdict", "sentence", "probabilities", "fault", "chance", "lack_of_fit", "lack_of_fit_healthy")
HEALTHY, FAULTY, UNEXPLAINED, REFUSED = "healthy", "faulty", "something_else", "refused"


def code() -> str:
    """Version of the code on which a diagnosis depends."""
    return code_version("identification", "oracle", "twin")


def diagnosed(folder: Path) -> dict[str, Any]:
    """The truth of a gear, and its diagnosis; ``report`` is None if its effect is not one of the five faults."""
    truth = json.loads((folder / "truth.json").read_text())
    if truth["effect"] not in (None, *FAULTS):
        return {"truth": truth, "report": None}
    began = process_time()
    try:
        recordings, healthy = (swg.read_recordings(folder / name) for name in ("again", "healthy"))
        report = swg.diagnose(recordings, healthy, swg.Gear()).report
    except (ValueError, RuntimeError, ArithmeticError) as error:
        return {"truth": truth, "report": {"verdict": REFUSED, "sentence": f"{type(error).__name__}: {error}"}}
    return {"truth": truth, "report": {name: report[name] for name in FIELDS}, "seconds": process_time() - began}


def errors(answers: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """Share of gears whose diagnosis is not the truth [%], with Wilson's interval, and every gear.

    A diagnosis is right if it says healthy of a healthy gear, or faulty with the right class of another one. That no
    class explains a gear, or that something else is found, is not right; ``something_else`` counts such answers.
    """
    gears = [_gear(each) for each in answers if each["report"]]
    wrong = rate([not each["right"] for each in gears])
    percent = [100 * wrong[name] if gears else None for name in ("value", "low", "high")]
    healthy = [each["verdict"] for each in gears if each["label"] == HEALTHY]
    return {
        "value": percent[0],
        "ci95": percent[1:],
        "count": len(gears),
        "healthy": len(healthy),
        "healthy_called_faulty": healthy.count(FAULTY),
        "something_else": sum(each["verdict"] == UNEXPLAINED for each in gears),
        "right_class": sum(each["most_probable"] == each["label"] for each in gears),
        "code": code(),
        "gears": gears,
    }


def _gear(answer: dict[str, Any]) -> dict[str, Any]:
    report, label = answer["report"], answer["truth"]["effect"] or HEALTHY
    said = report["fault"]["name"] if report["verdict"] == FAULTY else report["verdict"]
    p = report.get("probabilities")
    return {
        "bench": answer["bench"],
        "case": answer["case"],
        "label": label,
        "right": said == label,
        "most_probable": None if p is None else max(p, key=p.__getitem__),
        "verdict": report["verdict"],
        "sentence": report["sentence"],
        "seconds": answer.get("seconds"),
    }
