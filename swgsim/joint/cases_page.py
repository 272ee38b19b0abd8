"""All cases on one page, for a robot engineer to pass on: what the textbook lacked and what each effect bought."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from swgsim.common.html import environment
from swgsim.common.numbers import significant
from swgsim.joint.joint_page import capital


def page(said: Mapping[str, Mapping[str, Any]], missing: Mapping[str, str], folders: Mapping[str, Path]) -> str:
    """The page of all cases.

    Parameters
    ----------
    said : mapping
        Name of a case to its report.
    missing : mapping
        Name of a case to why it has no answer.
    folders : mapping
        Name of a case to the folder of its answer, where the pictures are.
    """
    templates = environment("swgsim")
    templates.filters["figure"] = significant
    templates.filters["capital"] = capital
    ladders = {name: (folder / "ladder.png").read_bytes() for name, folder in folders.items()}
    return templates.get_template("joint/cases.html.jinja").render(said=said, missing=missing, ladders=ladders)


def tables(said: Mapping[str, Mapping[str, Any]]) -> str:
    """The ladders as Markdown, for the documentation."""
    parts = ["<!-- Written by scripts/joints.py; do not edit. -->"]
    for name, each in said.items():
        unit, floor = each["unit"], each["noise_floor"]
        noise = "not recorded" if floor is None else f"{significant(floor)} {unit}, {each['noise_floor_how']}"
        parts.append(
            f"\n## {capital(name)}\n\n{each['sentence']}\n\n"
            f"Fitted: {len(each['split']['fit'])} recordings; held out: {', '.join(each['split']['heldout'])}. "
            f"Noise at rest: {noise}.\n\n"
            f"| effect | fit [{unit}] | held out [{unit}] | held out below 5 Hz [{unit}] | |\n|---|---|---|---|---|"
        )
        parts += [
            f"| {'+ ' if rung['kept'] and rung['effect'] != 'textbook' else ''}{rung['title']} | {rung['fit']:.4f} | "
            f"{rung['heldout']:.4f} | {rung['heldout_slow']:.4f} | {'kept' if rung['kept'] else rung['why']} |"
            for rung in each["rungs"]
        ]
    return "\n".join(parts) + "\n"
