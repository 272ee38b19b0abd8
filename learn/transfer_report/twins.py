"""The claim of the study: the twin of a gear beside its floor, per recording and per unit, and where it is mistaken."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pandas as pd

from learn.evaluation.bootstrap import SPECIMEN, gear_bootstrap, ratio_to, specimens
from learn.evaluation.decisions import class_numbers, probabilities
from learn.evaluation.probability_calibration import expected_calibration_error, reliability
from learn.evaluation.units import units
from learn.transfer_report.posteriors import FAST_TWIN, FLOOR, TWIN, units_of
from learn.transfer_report.tables import (
    LIMITS,
    best_adapted,
    best_rezeroed,
    both_in_json,
    finite,
    in_json,
    least,
    named,
    number,
    row_of,
    text_of,
    with_intervals,
)
from swgsim.common.seeds import generator
from swgsim.common.version import code_version

# Twins, in the words of the page.
CASES: Mapping[str, str] = {
    "matched": "it believes what is true",
    "mesh": "it believes another mesh",
    "population": "gears of another population",
    "before": "an effect that it does not know",
    "after": "the same, after the loop has found the effect",
}
# Of the picture: levels, who learns, and numbers of healthy recordings of the day and of specimens of each fault.
REFERENCES, LEARNED, HEALTHY, SHOTS = "references", "best method that learns from other gears", 2, 5
Tables = Mapping[str, pd.DataFrame]


def of_units(predictions: Tables, joint: Tables) -> dict[str, pd.DataFrame]:
    """Predictions of units: the twin and those who know the gear take one as a whole, others multiply posteriors."""
    return {
        name: units_of(joint[name]) if name in joint else units(table)
        for name, table in predictions.items()
    }  # fmt: skip


def errors(predictions: Tables) -> pd.DataFrame:
    """Error of every method per row: ``value``, ``low``, ``high`` [%]."""
    return with_intervals({name: specimens(table) for name, table in predictions.items()}, "errors")


def calibration_error(predictions: pd.DataFrame) -> float:
    """Expected calibration error [-]."""
    return expected_calibration_error(reliability(probabilities(predictions), class_numbers(predictions))) / 100


def ratio_to_floor(errors: pd.DataFrame) -> pd.Series | None:
    """Error of the twin over that of the floor: ``value``, ``low``, ``high`` [-]; None without a floor."""
    if FLOOR not in errors:
        return None
    both = errors[[*SPECIMEN, TWIN, FLOOR]]
    return row_of(gear_bootstrap(both, ratio_to(FLOOR), generator("report", "twin and floor")), TWIN)


def mismatches(found: Mapping[str, tuple[pd.DataFrame, pd.DataFrame]]) -> pd.DataFrame:
    """Twins with true and with mistaken beliefs, by case.

    Parameters
    ----------
    found : mapping
        Case to the predictions of recordings and of units (:func:`.posteriors.mismatch`).

    Returns
    -------
    DataFrame
        ``value``, ``low``, ``high`` of recordings and ``unit``, ``unit_low``, ``unit_high`` of units [%];
        ``calibration_error`` [-], median ``misfit`` of the references [-], ``gears``.
    """
    rows = {}
    for case, (recordings, of_units) in found.items():
        error, of_unit = (
            row_of(with_intervals({case: specimens(each)}, f"mismatch {case}"), case) for each in (recordings, of_units)
        )
        facts = {
            "calibration_error": calibration_error(recordings),
            "misfit": recordings["misfit"].median(),
            "gears": recordings["gear"].nunique(),
        }
        rows[case] = {**error, **named("unit", of_unit.to_frame().T).iloc[0], **facts}
    return pd.DataFrame.from_dict(rows, orient="index")


def mismatches_text(table: pd.DataFrame) -> pd.DataFrame:
    """Result of :func:`mismatches` in the words of the page."""
    return pd.DataFrame(
        {
            "error [%]": text_of(table),
            "error of units [%]": text_of(table, "unit"),
            "calibration error [points]": [number(100 * each) for each in table["calibration_error"]],
            "median misfit of the references": [f"{each:.2g}" for each in table["misfit"]],
            "gears": table["gears"].map("{:.0f}".format),
        }
    ).set_axis(pd.Index([CASES[case] for case in table.index], name="twin"))


def other_authors(path: Path) -> dict[str, Any] | None:
    """Error of the twin on gears that other authors simulated [%], from the file of tests/benches; None without one of
    the present code.
    """
    if not path.is_file():
        return None
    found = json.loads(path.read_text(encoding="utf-8"))
    if found["code"] != code_version("identification", "oracle", "twin"):
        return None
    return {name: value for name, value in found.items() if name not in ("code", "gears")}


def other_authors_text(found: Mapping[str, Any]) -> str:
    """Result of :func:`other_authors` as a sentence of the page."""
    low, high = found["ci95"]
    error = number(found["value"], low, high, unit=" %")
    return (
        f"Of {found['count']} gears that other authors simulated, with programs that share no code with the model, the "
        f"answer of swg diagnose is not the truth in {error}: {found['healthy_called_faulty']} of {found['healthy']} "
        f"healthy ones are called faulty, and {found['something_else']} gears something else than one of the classes. "
        "The gears of one author are alike, and some of them were known when the method was built."
    )


def twin_json(
    zero: pd.DataFrame, ratio: pd.Series | None, cases: pd.DataFrame, others: dict[str, Any] | None,
    session: pd.Series | None,
) -> dict[str, Any]:  # fmt: skip
    """The part ``twin`` of ``transfer.json``: errors [%], calibration errors [-]; None for what was not run.

    Parameters
    ----------
    zero : DataFrame
        Result of :func:`.tables.zero_shot`.
    ratio : Series or None
        Result of :func:`ratio_to_floor`.
    cases : DataFrame
        Result of :func:`mismatches`.
    others : dict or None
        Result of :func:`other_authors`.
    session : Series or None
        Result of :func:`in_session`.
    """
    error = {name: in_json(row_of(cases, name)) if name in cases.index else None for name in CASES}
    mistaken = [cases["calibration_error"][name] for name in ("mesh", "population") if name in cases.index]
    return {
        "matched": in_json(row_of(zero, TWIN)),
        "mesh": error["mesh"],
        "population": error["population"],
        "other_authors": others,
        "session": None if session is None else both_in_json(session),
        "undeclared": {"before": error["before"], "after": error["after"]},
        "floor": None if ratio is None else in_json(row_of(zero, FLOOR)),
        "ratio_to_floor": None if ratio is None else in_json(ratio),
        "calibration_error": finite(cases["calibration_error"]["matched"]),
        "calibration_error_mismatched": finite(max(mistaken)) if mistaken else None,
    }


def fast_twin_json(zero: pd.DataFrame, methods: pd.DataFrame) -> dict[str, Any] | None:
    """The part ``fast_twin`` of ``transfer.json``: error [%], and time to judge a recording; None if it was not run.

    Parameters
    ----------
    zero : DataFrame
        Result of :func:`.tables.zero_shot`.
    methods : DataFrame
        Run of every method, with its metrics.
    """
    if FAST_TWIN not in methods.index:
        return None
    milliseconds = float(row_of(methods, FAST_TWIN)["milliseconds"])
    return {"error": in_json(row_of(zero, FAST_TWIN)), "milliseconds": finite(milliseconds)}


def in_session(recordings: Tables, of_unit: Tables) -> pd.Series | None:
    """Errors of the twin that knows healthy specimens of the session: ``value``, ``low``, ``high`` of recordings and
    ``unit``, ``unit_low``, ``unit_high`` of units [%]; None if it was not asked.
    """
    if not recordings:
        return None
    units = errors({name: units_of(table) for name, table in of_unit.items()})
    return row_of(errors(recordings).join(named("unit", units)), TWIN)


def known(
    zero: pd.DataFrame, of_units: pd.DataFrame, few: pd.DataFrame, nothing: pd.DataFrame, session: pd.Series | None
) -> pd.DataFrame:
    """Errors over what is known of the gear: ``known``, ``who``, and ``value``, ``low``, ``high`` of recordings and
    ``unit``, ``unit_low``, ``unit_high`` of units [%].

    Whoever learns is the best method of each level on the judged gears, which favours it.

    Parameters
    ----------
    zero, of_units, few : DataFrame
        Results of :func:`.tables.zero_shot`, :func:`errors` per unit and :func:`.tables.few_shot`.
    nothing : DataFrame
        Methods without references, with columns as above; it may be empty.
    session : Series or None
        Result of :func:`in_session`.
    """
    both = zero[["value", "low", "high"]].join(named("unit", of_units))
    of_day = f"references, {HEALTHY} healthy of the day"
    learned = {
        "nothing": None if nothing.empty else least(nothing),
        REFERENCES: least(both.drop(index=[TWIN, FAST_TWIN, *LIMITS], errors="ignore")),
        of_day: best_rezeroed(few).get(HEALTHY),
        f"references, {SHOTS} of each fault": best_adapted(few, SHOTS),
    }
    rows = [{**row, "known": name, "who": LEARNED} for name, row in learned.items() if row is not None]
    others = [who for who in (FAST_TWIN, TWIN, FLOOR) if who in both.index]
    rows += [{**row_of(both, who), "known": REFERENCES, "who": who} for who in others]
    if session is not None:
        rows.append({**session, "known": of_day, "who": TWIN})
    return pd.DataFrame(rows)[["known", "who", *both]]
