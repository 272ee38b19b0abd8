"""The score of a sealed set: rates with Wilson's interval, medians with a bootstrap interval."""

from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from swgsim.blind.baselines import BASELINES
from swgsim.blind.calibration import as_in_prior, calibration_error, reliability
from swgsim.blind.intervals import median, rate
from swgsim.blind.scored_case import RIGHT, ScoredCase
from swgsim.blind.strata import PAIR, SINGLE, UNTESTABLE
from swgsim.common.numbers import NORMAL

WORST = 5
# Answers of this probability and more count as sure.
SURE = 0.9


def score(cases: Sequence[ScoredCase]) -> dict[str, Any]:
    """All figures of a set."""
    answered = [case for case in cases if not case.failed]
    nulls = [case for case in cases if case.null]
    known = [case for case in cases if case.known]
    outside = [case for case in cases if case.outside]
    told_apart = [case for case in outside if not case.look_alike]
    untestable = [case for case in cases if case.case.stratum == UNTESTABLE]
    hidden = [case for case in cases if not case.null]
    return {
        "cases": len(cases),
        "failures": len(cases) - len(answered),
        "nulls": len(nulls),
        "detectable": len(known),
        "outside": len(outside),
        "false_effect_rate": rate([bool(case.named) for case in nulls if not case.failed]),
        "false_alarm_rate": rate([case.first != "nothing" for case in nulls if not case.failed]),
        "chances_of_nulls": sorted(case.answer["smallest_chance"] for case in nulls if not case.failed),
        "right_first": rate([case.right_first for case in known]),
        "right_family_first": rate([case.right_family_first for case in known]),
        "right_in_set": rate([case.right_in_set for case in known]),
        "right_or_nearest": rate([case.right_first or case.nearest in case.case.names for case in known]),
        "both_of_a_pair": rate([case.right_in_set for case in known if case.case.stratum == PAIR]),
        "expected_calibration_error": calibration_error(answered),
        "expected_calibration_error_as_in_prior": calibration_error(answered, as_in_prior(answered)),
        "right_of_sure": rate([case.right for case in answered if case.answer["probability"] >= SURE]),
        "reliability": reliability(answered),
        "mean_set_size": float(np.mean([float(case.set_size) for case in known if case.named] or [0.0])),
        "false_extra_effect": rate([case.false for case in hidden if not case.failed]),
        "none_of_the_above_recall": rate([case.none_of_the_above for case in told_apart]),
        "look_alikes_named": rate([bool(case.named) for case in outside if case.look_alike]),
        "unknown_described": _described(told_apart),
        "absorbed_named_as_such": rate(
            [set(case.case.names) <= set(case.answer["absorbed"]) for case in untestable if not case.failed]
        ),
        "untestable_told": rate([case.reported_untestable for case in untestable if not case.failed]),
        "false_effect_on_untestable": rate([case.false for case in untestable if not case.failed]),
        "after_over_oracle_median": median([case.over("after", "oracle") for case in known if not case.failed]),
        "after_over_before_median": median([case.over("after", "before") for case in known if not case.failed]),
        "worse_than_before": rate([case.worse for case in answered]),
        "worse_than_before_of_detectable": rate([case.worse for case in known if not case.failed]),
        "worse_with_the_true_model_too": rate([case.worse_with_truth for case in answered if case.worse]),
        "worse_where_recorded": rate([worse for case in answered if (worse := case.worse_where_recorded) is not None]),
        "coverage95": rate(_covered(answered)),
        "coverage95_of_angles": rate(_covered(answered, "angles", 2 * np.pi)),
        "coverage95_of_library_form": rate(_covered([c for c in answered if c.case.form in ("mesh", "stray order")])),
        "seconds_median": median([case.answer["seconds"]["loop"] for case in answered])["value"],
        "seconds_max": max((case.answer["seconds"]["loop"] for case in answered), default=None),
        "seconds_of_one_core_median": median([case.answer["seconds"]["loop_of_one_core"] for case in answered])[
            "value"
        ],
        "peak_memory_mib": max((case.answer["peak_memory_mib"] for case in answered), default=None),
        "baselines": {name: _baseline(name, answered) for name in BASELINES},
        "by_strength": _by_strength(cases),
        "confusion": _confusion(cases),
        "causes": dict(Counter(case.cause for case in cases).most_common()),
        "worst": [account(case) for case in worst(cases)],
    }


def worst(cases: Sequence[ScoredCase]) -> list[ScoredCase]:
    """The worst errors: failures, then nulls, then the strongest effects."""

    def weight(case: ScoredCase) -> tuple[bool, bool, float]:
        return case.failed, case.null, max(case.case.strengths, default=0.0)

    wrong = [case for case in cases if case.cause not in (RIGHT, "too weak", "unknown effect too weak")]
    return sorted(wrong, key=weight, reverse=True)[:WORST]


def account(case: ScoredCase) -> dict[str, Any]:
    """What went wrong in a case, if anything."""
    return {"number": case.case.number, "cause": case.cause, "why": case.why}


def _described(cases: Sequence[ScoredCase]) -> dict[str, Any]:
    """Of effects that were written to be described: their order, pattern and law, and all three."""
    found = [case.described for case in cases if case.case.described]
    parts = {name: rate([each[i] for each in found]) for i, name in enumerate(("order", "pattern", "law"))}
    return {**parts, "all": rate([all(each) for each in found])}


def _covered(cases: Sequence[ScoredCase], kind: str = "intervals", turn: float = np.inf) -> list[bool]:
    """Whether true values lie within the reported intervals: of sizes, or of angles if a full turn is given.

    Intervals of a whole turn are left out.
    """
    found = [each for case in cases for each in case.answer[kind] if not NORMAL * each["deviation"] > turn / 2]
    off = [abs(each["found"] - each["true"]) for each in found]
    nearer = [min(by % turn, turn - by % turn) for by in off]
    return [by <= NORMAL * each["deviation"] for by, each in zip(nearer, found, strict=True)]


def _baseline(name: str, cases: Sequence[ScoredCase]) -> dict[str, Any]:
    """The same figures for a simpler method."""
    known = [(case, case.answer["baselines"][name]) for case in cases if case.known]
    apart = [case for case in cases if case.outside and not case.look_alike]
    return {
        "false_effect_rate": rate([bool(case.answer["baselines"][name]) for case in cases if case.null]),
        "right_first": rate([bool(named) and named[0] in case.case.names for case, named in known]),
        "right_in_set": rate([set(case.case.names) <= set(named) for case, named in known]),
        "mean_set_size": float(np.mean([len(named) for _, named in known if named] or [0])),
        "none_of_the_above_recall": rate([not case.answer["baselines"][name] for case in apart]),
    } | (
        {"after_over_oracle_median": median([c.over("before", "oracle") for c, _ in known])}
        if name == "calibration_only"
        else {}
    )


def _by_strength(cases: Sequence[ScoredCase]) -> Mapping[str, Any]:
    """Share of correct first names, by the strength of the weaker hidden effect."""
    found = {}
    for low, high in ((30, 200), (200, 1200), (1200, 10000), (10000, np.inf)):
        here = [
            case for case in cases if case.case.stratum in (SINGLE, PAIR) and low <= min(case.case.strengths) < high
        ]
        found[f"{low:g} to {high:g}"] = rate([case.right_first for case in here])
    return found


def _confusion(cases: Sequence[ScoredCase]) -> dict[str, dict[str, int]]:
    """The first named effect, by the hidden effect."""
    table: dict[str, Counter] = {}
    for case in cases:
        hidden = " + ".join(case.case.names) or "nothing"
        table.setdefault(hidden, Counter())[case.first] += 1
    return {hidden: dict(named) for hidden, named in sorted(table.items())}
