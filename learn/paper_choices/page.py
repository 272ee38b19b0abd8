"""The report of the study as one HTML page, as JSON, and as the preset ``grid=paper_fitted``."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import yaml

from learn.paper.paper_page import ROMAN, unbroken
from learn.paper_choices import figures
from learn.paper_choices.outcome import Outcome, cells, errors
from learn.paper_choices.preset import changes
from learn.paper_choices.reading import WORDS, conclusions, reading
from learn.paper_choices.remains import rests, sentences
from swgsim.common.files import write_json, write_text
from swgsim.common.html import environment
from swgsim.common.style import Picture, png, words

COMMAND = "make paper-choices"


def write(outcome: Outcome, config: Mapping[str, Any], folder: Path) -> None:
    """Write ``paper_choices.json`` and ``.html``, and in ``paper_choices/`` what a release keeps; print the answer."""
    write_json(folder / "paper_choices.json", outcome.fields())
    write_text(folder / "paper_choices.html", page(outcome, config))
    write_json(folder / "paper_choices" / "paper_choices.json", kept(outcome))
    write_text(folder / "paper_choices" / "paper_fitted.yaml", preset(outcome, config))
    print(f"{folder / 'paper_choices.html'}: {outcome.answer}")
    print(f"error before: {in_words(errors(outcome.before))}; after: {in_words(errors(outcome.after))}")


def in_words(errors: Mapping[str, float]) -> str:
    """Errors of the tables in a line.

    >>> in_words({"table7": 6.14, "table9": 17.4})
    'VII 6.1, IX 17.4 points'
    """
    return ", ".join(f"{ROMAN[name]} {error:.1f}" for name, error in errors.items()) + " points"


def kept(outcome: Outcome) -> dict[str, Any]:
    """The result that ``make paper`` shows next to its own."""
    return {
        "command": COMMAND,
        **outcome.fields(),
        "answer": outcome.answer,
        "judgement": outcome.judgement,
        "conclusions": conclusions(outcome.parts, outcome.draws),
        "remains": sentences(outcome, rests(outcome)),
        "samples": outcome.draws,
        "found": [each.name for each in outcome.found],
        "parts": {key: {name: round(share, 3) for name, share in of.items()} for key, of in outcome.parts.items()},
        "cells": cells(outcome.before, outcome.after, outcome.unreduced),
    }


def preset(outcome: Outcome, config: Mapping[str, Any]) -> str:
    """The file ``conf/grid/paper_fitted.yaml``."""
    found = changes(outcome.fit.values, config)
    found["grid"] = {"name": "paper_fitted", **found["grid"]}
    text = yaml.safe_dump({"defaults": ["paper@grid", "_self_"], **found}, sort_keys=False, width=120)
    return (
        "# @package _global_\n"
        f"# Made by '{COMMAND}': choices that the paper leaves open, FITTED to the scores of its Tables VII and IX.\n"
        "# grid=paper is not fitted to these. Intervals and sources: report/paper_choices.html.\n" + text
    )


def page(outcome: Outcome, config: Mapping[str, Any]) -> str:
    """The page."""
    templates = environment("learn")
    templates.filters["words"] = words
    pictures = [
        Picture(
            "Cells before and after",
            "Each point is a cell of a table. On the grey line our score equals the paper's. The fit saw the cells of "
            "Tables VII and IX.",
            png(figures.before_and_after(outcome.before, outcome.after)),
        ),
        Picture(
            "Which choice moves what",
            "Change of a score for one standard deviation of a choice's prior, with all others drawn from theirs. "
            "Tables IX and X: mean over the gears. S1 to S3 are the selections.",
            png(figures.effects(outcome.effects, outcome.choices)),
        ),
    ]
    found = rests(outcome)
    text = templates.get_template("paper_choices/paper_choices_page.html.jinja").render(
        outcome=outcome,
        before=errors(outcome.before),
        after=errors(outcome.after),
        unreduced=errors(outcome.unreduced),
        fields=outcome.fields(),
        conclusions=conclusions(outcome.parts, outcome.draws),
        reading=reading(outcome.held),
        remains=sentences(outcome, found),
        rests=found.head(12).to_dict("records"),
        claims=WORDS,
        roman=ROMAN,
        pictures=pictures,
        samples=outcome.draws,
        trials=len(outcome.trials),
        config=config,
        command=COMMAND,
    )
    return unbroken(text)
