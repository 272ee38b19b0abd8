"""HTML pages of joints: the answer for one joint, and all cases of ``swg joints``; each is one file."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from swgsim.common import style
from swgsim.common.html import environment
from swgsim.common.numbers import significant
from swgsim.joint.naming import sizes


def page(report: Mapping[str, Any], pictures: Mapping[str, style.Picture]) -> str:
    """The page of one answer: first the part to forward, then folded details.

    Parameters
    ----------
    report : mapping
        Content of ``report.json``.
    pictures : mapping
        Pictures by name. The first part shows the ladder, or without an effect the measured and predicted signals.
    """
    front = "ladder" if report["effects"] else "stretches"
    others = [picture for name, picture in pictures.items() if name != front]
    return _rendered("joint_page", report=report, sizes=sizes, front=pictures.get(front), pictures=others)


def page_of_cases(
    reports: Mapping[str, Mapping[str, Any]], missing: Mapping[str, str], folders: Mapping[str, Path]
) -> str:
    """The page of all cases.

    Parameters
    ----------
    reports : mapping
        Name of a case to its report.
    missing : mapping
        Name of a case to the reason why it has no answer.
    folders : mapping
        Name of a case to the folder of its answer, with the pictures.
    """
    ladders = {name: (folder / "ladder.png").read_bytes() for name, folder in folders.items()}
    return _rendered("cases", reports=reports, missing=missing, ladders=ladders)


def ladders_as_markdown(reports: Mapping[str, Mapping[str, Any]]) -> str:
    """The ladders of all cases, for the documentation."""
    parts = ["<!-- Written by swg joints; do not edit. -->", "\n# Ladders of the measured joints"]
    for name, each in reports.items():
        unit, floor = each["unit"], each["noise_floor"]
        noise = "not recorded" if floor is None else f"{significant(floor)} {unit}, {each['noise_floor_how']}"
        parts.append(
            f"\n## {capital(name)}\n\n{each['sentence']}\n\n"
            f"Fitted: {len(each['split']['fit'])} recordings; held out: {', '.join(each['split']['heldout'])}. "
            f"Noise at rest: {noise}.\n\n"
            f"| effect | fit [{unit}] | held out [{unit}] | held out below 5 Hz [{unit}] | |\n|---|---|---|---|---|"
        )
        for rung in each["rungs"]:
            sign = "+ " if rung["kept"] and rung["effect"] != "textbook" else ""
            remark = "; ".join(filter(None, ["kept" if rung["kept"] else "", rung["why"]]))
            errors = f"{rung['fit']:.4f} | {rung['heldout']:.4f} | {rung['heldout_slow']:.4f}"
            parts.append(f"| {sign}{rung['title']} | {errors} | {remark} |")
    return "\n".join(parts) + "\n"


def capital(text: str) -> str:
    """A text with a capital at its beginning, all other letters unchanged.

    >>> capital("ripple through the UR10e's filter")
    "Ripple through the UR10e's filter"
    """
    return text[:1].upper() + text[1:]


def _rendered(template: str, **content: Any) -> str:
    templates = environment("swgsim")
    templates.filters |= {"words": style.words, "figure": significant, "capital": capital}
    return templates.get_template(f"joint/{template}.html.jinja").render(content)
