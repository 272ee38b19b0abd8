"""The report of the study as one HTML page and as JSON."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import pandas as pd

from learn.paper.paper_page import unbroken
from learn.sim_to_real.figure import picture
from learn.sim_to_real.judging import COMMISSIONING, DAYS, MODELS
from learn.sim_to_real.verdicts import Finished, named, row_of, why, worth
from swgsim.common.files import write_json, write_text
from swgsim.common.html import environment
from swgsim.common.style import words

SCORES = ("accuracy", "false_alarms", "gain")


def write(finished: Sequence[Finished], folder: Path) -> None:
    """Write ``sim_to_real.html`` and ``sim_to_real.json``, and print for how many effects the loop helps."""
    fields = content(finished)
    methods = fields["methods"]
    templates = environment("learn")
    templates.filters["words"] = words
    html = templates.get_template("sim_to_real/sim_to_real_page.html.jinja").render(
        study=fields, days=DAYS, models=MODELS, pictures=[picture(finished, method) for method in methods]
    )
    write_json(folder / "sim_to_real.json", fields)
    write_text(folder / "sim_to_real.html", unbroken(html))
    print(f"{folder / 'sim_to_real.html'}:")
    for sentence in fields["sentences"]:
        print(sentence)


def content(finished: Sequence[Finished]) -> dict[str, Any]:
    """``sim_to_real.json``."""
    methods = list(dict.fromkeys(str(method) for method in finished[0].scores["method"]))
    effects = [_effect(each, methods) for each in finished]
    return {"methods": methods, "effects": effects, "sentences": [_sentence(effects, method) for method in methods]}


def _effect(finished: Finished, methods: Sequence[str]) -> dict[str, Any]:
    results = []
    for method in methods:
        for day in DAYS:
            rows = {model: row_of(finished.scores, method, day, model) for model in MODELS}
            numbers = {model: {what: _score(row, what) for what in SCORES} for model, row in rows.items()}
            verdict, reason = why(finished, method, day)
            judgement = {"verdict": verdict, "why": reason, "gainful": worth(rows["oracle"])}
            results.append({"method": method, "references": day, **judgement, **numbers})
    return {
        "undeclared": finished.name, "hidden": finished.hidden, "loop": {**finished.loop, "named": named(finished)},
        "healthy_specimens": int(finished.scores["specimens"].iloc[0]), "results": results,
    }  # fmt: skip


def _score(row: pd.Series, what: str) -> dict[str, Any]:
    """A score with its interval, to hundredths."""
    value, low, high = (round(float(row[f"{what}{end}"]), 2) for end in ("", "_low", "_high"))
    return {"value": value, "ci95": [low, high]}


def _sentence(effects: Sequence[Mapping[str, Any]], method: str) -> str:
    """Result for a method, with references of the commissioning day, over the effects that cost accuracy."""
    acting = [
        result
        for effect in effects
        if effect["hidden"]
        for result in effect["results"]
        if result["method"] == method and result["references"] == COMMISSIONING
    ]
    hurt = [result for result in acting if result["gainful"]]
    helped = [result for result in hurt if result["verdict"] == "helps"]

    def mean(model: str, what: str) -> str:
        return f"{sum(result[model][what]['value'] for result in hurt) / len(hurt):.1f}"

    name = words(method).capitalize()
    if not hurt:
        return f"{name}: none of {len(acting)} undeclared effects costs accuracy that a model with it would keep."
    return (
        f"{name}: {len(hurt)} of {len(acting)} undeclared effects cost accuracy if the references were recorded before "
        f"the effect came. For {len(helped)} of them, closing the loop recovers at least 80 % of it. Mean of these "
        f"{len(hurt)}: accuracy "
        f"{mean('before', 'accuracy')} % before, {mean('after', 'accuracy')} % after, {mean('oracle', 'accuracy')} % "
        f"with the effect known; false alarms {mean('before', 'false_alarms')}, {mean('after', 'false_alarms')} and "
        f"{mean('oracle', 'false_alarms')} %."
    )
