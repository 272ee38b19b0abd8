"""The diagnosis as ``diagnosis.json`` and as a page: verdict, probabilities, size, position, what no class explains."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from swgsim.common.numbers import NORMAL, significant
from swgsim.dataset.faults import FAULTS
from swgsim.effects.base import Effect
from swgsim.effects.library import named
from swgsim.effects.quantity import quantities, size_of
from swgsim.identification.fit.fitted import Fitted
from swgsim.identification.report.answer_page import next_steps, rendered
from swgsim.identification.report.effect_words import effect_in_words, effect_text
from swgsim.identification.report.found_effects import probability_text
from swgsim.identification.report.identification import Identification
from swgsim.oracle.cells import Partition
from swgsim.oracle.diagnosis import ENDS
from swgsim.oracle.severity import Severities, positions
from swgsim.storage.labelled_signals import CLASSES
from swgsim.twin.costs import Costs, expected
from swgsim.twin.fault_posterior import FaultPosterior, Suspected, lack_of_fit

HEALTHY, FAULTY, SOMETHING_ELSE = "healthy", "faulty", "something_else"
# Probability above which a sentence names another class.
RIVAL = 0.05


def report_of(
    suspected: Suspected,
    something_else: str | None,
    healthy: Fitted,
    of_healthy: Sequence[Effect] | None,
    loop: Identification,
    false_alarms: float,
    costs: Costs,
    rng: np.random.Generator,
) -> dict[str, Any]:
    """The diagnosis as plain numbers and text.

    Parameters
    ----------
    suspected : Suspected
    something_else : str or None
        What the loop found that is no fault.
    healthy : Fitted
        The healthy recordings beside the model of the series.
    of_healthy : sequence of Effect or None
        What the loop found in the healthy gear, if it was asked.
    loop : Identification
        What it found in the recordings to examine.
    false_alarms : float
        Share of healthy gears that may be called faulty.
    costs : mapping
        Decision to class to cost.
    rng : Generator
        Of simulated healthy gears.
    """
    measured = suspected.fitted.measured
    whole = suspected.posterior_of(np.ones(len(measured), bool))
    probabilities = _by_class(whole)
    fault = max(FAULTS, key=probabilities.__getitem__)
    found: dict[str, Any] = {
        "gear": measured.recordings[0].gear,
        "probabilities": probabilities,
        "fault": {"name": fault, "parameters": _parameters(suspected.partitions[fault], whole)},
        "chance": float(whole.chance(rng)[0]),
        "false_alarms": false_alarms,
        "expected_costs": expected(costs, probabilities),
        "lack_of_fit": {"value": float(whole.lack_of_fit[0]), "chance": float(whole.chance_of_lack[0])},
        "lack_of_fit_healthy": dict(zip(("value", "chance"), lack_of_fit(healthy), strict=True)),
        "structure": loop.report["structure"],
        "of_healthy": None if of_healthy is None else [effect_in_words(each) for each in of_healthy],
        "something_else": something_else,
        "recordings": [
            {
                "name": each.name,
                "n_in_rpm": float(each.point.n_in_rpm),
                "T_out_nm": float(each.point.T_out),
                "probabilities": _by_class(suspected.posterior_of(np.arange(len(measured)) == number)),
            }
            for number, each in enumerate(measured.recordings)
        ],
        "prior": dict(suspected.prior),
        "made": loop.report["made"],
    }
    verdict, sentence = _verdict(found)
    return {"verdict": verdict, "sentence": sentence, **found}


def _by_class(posterior: FaultPosterior) -> dict[str, float]:
    return dict(zip(CLASSES, posterior.posterior[0].tolist(), strict=True))


def _parameters(partition: Partition, whole: FaultPosterior) -> dict[str, Any]:
    """Size and position of a fault, as in ``report.json``."""
    kind, places = named(partition.label), whole.model.places(whole.x, partition.label)
    severities = Severities.of(partition, places)
    size = size_of(kind)
    low, middle, high = (float(severities.quantile(each)[0]) for each in (ENDS[0], 0.5, ENDS[1]))
    found = {size: {"value": middle, "ci95": [low, high], "unit": quantities(kind)[size].unit}}
    if partition.positions > 1:
        angle, deviation = (float(each[0]) for each in positions(partition, places))
        off = NORMAL * deviation
        found["theta"] = {"value": angle, "ci95": [angle - off, angle + off] if off < np.pi else None, "unit": "rad"}
    return found


def _verdict(found: Mapping[str, Any]) -> tuple[str, str]:
    """The verdict, and the same in a sentence."""
    probabilities, fault, limit = found["probabilities"], found["fault"], found["false_alarms"]
    if found["lack_of_fit"]["chance"] < limit:
        lack = significant(found["lack_of_fit"]["value"])
        verdict, said = SOMETHING_ELSE, f"No class explains the recordings (lack of fit {lack}; 1 is expected)"
    elif found["chance"] <= limit:
        p = probability_text(probabilities[fault["name"]]) + _rivals(probabilities, fault["name"])
        verdict, said = FAULTY, f"Faulty: {effect_text(fault['name'], fault['parameters'])}; probability {p}"
    else:
        p = probability_text(probabilities["healthy"]) + _rivals(probabilities, "healthy")
        verdict = SOMETHING_ELSE if found["something_else"] else HEALTHY
        said = f"No fault is seen: healthy with a probability of {p}"
    if found["something_else"]:
        said += f". Other finding: {found['something_else'].rstrip('.')}"
    if found["lack_of_fit_healthy"]["chance"] < limit:
        lack = significant(found["lack_of_fit_healthy"]["value"])
        said += f". The model does not fit this gear (lack of fit of its healthy recordings {lack}; 1 is expected)"
    return verdict, f"{said}."


def _rivals(probabilities: Mapping[str, float], named_first: str) -> str:
    rivals = [label for label in CLASSES if label != named_first and probabilities[label] > RIVAL]
    listed = [f"{label.replace('_', ' ')} ({probability_text(probabilities[label])})" for label in rivals]
    return f"; else {', '.join(listed)}" if listed else ""


def page(report: Mapping[str, Any], of_loop: Mapping[str, Any]) -> str:
    """The page of a diagnosis, with the report of the loop on the same recordings."""
    return rendered("twin/diagnosis_page.html.jinja", report=report, of_loop=of_loop, next_steps=next_steps(of_loop))
