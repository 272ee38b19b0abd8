"""The score as a table of plain text."""

from collections.abc import Mapping
from typing import Any

ROWS = {
    "false_effect_rate": "false effect on nulls",
    "right_first": "right effect first",
    "right_in_set": "right effect in the set",
    "none_of_the_above_recall": "none of the above",
    "after_over_oracle_median": "error after / oracle",
}
OF_LOOP = {
    "false_alarm_rate": "false alarm on nulls",
    "right_family_first": "right family first",
    "right_of_sure": "right of those above 0.9",
    "false_extra_effect": "false extra effect",
    "worse_than_before": "worse than before",
    "worse_than_before_of_detectable": "... of detectable ones",
    "worse_with_the_true_model_too": "... with the truth too",
    "worse_where_recorded": "... at recorded points",
    "coverage95": "95 % intervals cover",
    "coverage95_of_angles": "... those of angles",
    "look_alikes_named": "look-alikes named",
    "absorbed_named_as_such": "untestable: of no size",
    "untestable_told": "... or not of its size",
}
OF_PROBABILITIES = {
    "expected_calibration_error": "calibration error",
    "expected_calibration_error_as_in_prior": "... of sets as in prior",
}


def table(found: Mapping[str, Any]) -> str:
    """Table of the identification and the baselines, then results without a baseline."""
    methods = {"loop": found, **found["baselines"]}
    lines = [" " * 26 + "".join(f"{name.replace('_', ' '):>24}" for name in methods)]
    for key, title in ROWS.items():
        lines.append(f"{title:<26}" + "".join(f"{figure(method.get(key)):>24}" for method in methods.values()))
    lines += [f"{title:<26}{figure(found[key]):>24}" for key, title in OF_LOOP.items()]
    described = found["unknown_described"]
    lines += [f"{'unknown: ' + part:<26}{figure(described[part]):>24}" for part in described]
    for key, title in OF_PROBABILITIES.items():
        error = "-" if found[key] is None else f"{found[key]:.3f}"
        lines.append(f"{title:<26}{error:>24}")
    lines.append(f"mean set size {found['mean_set_size']:.2f}, {found['cases']} cases, {found['nulls']} nulls")
    lines += [f"{count:4d}  {cause}" for cause, count in found["causes"].items()]
    return "\n".join(lines)


def figure(value: Mapping[str, Any] | None) -> str:
    """A figure with its interval and count.

    >>> figure({"value": 0.5, "low": 0.25, "high": 0.75, "count": 12})
    '0.50 [0.25, 0.75] of 12'
    """
    if value is None or value["value"] is None:
        return "-"
    return f"{value['value']:.2f} [{value['low']:.2f}, {value['high']:.2f}] of {value['count']}"
