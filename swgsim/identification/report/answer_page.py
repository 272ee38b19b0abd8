"""The answer as one HTML page with its pictures inside: a summary to forward, and folded details."""

import inspect
from collections.abc import Mapping
from typing import Any

import numpy as np

from swgsim.common import style
from swgsim.common.html import environment
from swgsim.common.numbers import significant
from swgsim.common.outcome import FOUND
from swgsim.effects.library import named
from swgsim.identification.report import engineering_units
from swgsim.identification.report.effect_words import effect_text, plain_title
from swgsim.identification.report.found_effects import probability_text
from swgsim.identification.report.next_experiment import HELPLESS, separation_text

TEMPLATE = "identification/report/answer_page.html.jinja"
# How to check a gear, by the place of an effect.
CHECKS = {
    "wave generator": "measure run-out and tilt on the shaft with a dial gauge, and inspect the bearing",
    "mesh": "inspect the teeth of flex spline and circular spline under magnification",
    "structure": "inspect the flex spline for cracks, such as with dye penetrant",
    "gear": "measure temperature, torque and zeros without load, and compare gauges and grease with their data",
    "drive": "inspect motor, brake, couplings and seals; measure the torque without load at low and high speed",
    "gauge": "check bonds, clamping bolts and external moments; record zeros without load, cold and warm",
    "acquisition": "feed a calibration signal into the amplifiers; check encoder and torque flanges at standstill",
}


def page(report: Mapping[str, Any], pictures: Mapping[str, style.Picture]) -> str:
    """The page of a report.

    Parameters
    ----------
    report : mapping
        As :func:`swgsim.identification.report.report_fields.report` makes it.
    pictures : mapping
        Pictures by name; ``residual`` and ``posterior`` are part of the summary.
    """
    return rendered(
        TEMPLATE,
        report=report,
        pictures=pictures,
        next_steps=next_steps(report),
        about=about,
        degrees=lambda angle: significant(None if angle is None else float(np.rad2deg(angle))),
        separation_text=separation_text,
        effect_text=effect_text,
    )


def rendered(template: str, **values: Any) -> str:
    """A template of this package with values, and with the texts of parameters and probabilities."""
    templates = environment("swgsim")
    templates.filters |= {"words": plain_title, "significant": significant}
    texts = {name: getattr(engineering_units, name) for name in ("parameter_words", "value_text", "interval_text")}
    return templates.get_template(template).render(probability_text=probability_text, **texts, **values)


def about(name: str) -> list[str]:
    """The paragraphs of an effect's docstring before its parameters: physics, signature and typical size."""
    text, _, _ = (inspect.getdoc(named(name)) or "").partition("\nAttributes\n")
    return [" ".join(paragraph.split()) for paragraph in text.split("\n\n") if paragraph.strip()]


def next_steps(report: Mapping[str, Any]) -> list[str]:
    """Recommendations for the reader, most useful first."""
    steps = []
    if report["verdict"] == FOUND:
        places = dict.fromkeys(effect["place"] for effect in report["effects"])
        steps += [
            f"Check the {place}: {CHECKS[place]}." if place in CHECKS else f"Check the {place}." for place in places
        ]
        steps.append("To simulate the gear with the effects that were found, declare them with effects=effects.yaml.")
    if experiment := report["next_experiment"]:
        steps += [_sentence(words) for words in experiment["words"].split("; ") if not words.startswith(HELPLESS)]
    if report["defects"]:
        steps.append(f"Correct the recordings: {len(report['defects'])} warnings, listed under Unit and recordings.")
    if report["error"]["noise_floor"] is None:
        steps.append("Record every operating point at least twice, so that the noise floor is known.")
    if not steps:
        steps.append(
            "No open question: nothing further needs to be recorded. Detection limits are in the answer of the loop."
        )
    return steps


def _sentence(words: str) -> str:
    return words[:1].upper() + words[1:] + "."
