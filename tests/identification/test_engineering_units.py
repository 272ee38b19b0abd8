"""Every parameter of the library has a name in words and a unit that engineers use."""

import pytest

from swgsim.effects.library import LIBRARY, SEARCHED
from swgsim.effects.quantity import Role, quantities, size_of
from swgsim.identification.report import effect_words, engineering_units
from swgsim.identification.report.answer_page import about, next_steps
from swgsim.identification.report.effect_words import effect_text
from swgsim.identification.report.engineering_units import OF_EFFECT, in_unit, interval_text, value_text
from swgsim.identification.report.next_experiment import HELPLESS


def typical(kind: type) -> dict[str, dict]:
    """Estimates at the typical values, with an interval for the size."""
    found = {
        name: {"value": q.typical, "ci95": None, "unit": q.unit}
        for name, q in quantities(kind).items()
        if q.role is not Role.RANDOM
    }
    size = size_of(kind)
    low, high = sorted((0.9 * found[size]["value"], 1.1 * found[size]["value"]))
    return found | {size: found[size] | {"ci95": [low, high]}}


@pytest.mark.parametrize("kind", SEARCHED, ids=lambda kind: kind.name())
def test_an_effect_is_written_in_engineering_units(kind):
    estimates = typical(kind)
    text = effect_text(kind.name(), estimates)
    assert "_" not in text
    assert "95 %: " in text
    for name, each in estimates.items():
        named = f"{kind.name()}.{name}" in OF_EFFECT or name in engineering_units.PARAMETERS
        assert named, f"{kind.name()}.{name} has no name in words"
        assert in_unit(kind.name(), name, each)[2] not in ("rad", "m", "K", "1/K", "-")
    assert about(kind.name())


def test_every_name_belongs_to_a_parameter():
    for key in OF_EFFECT:
        effect, _, parameter = key.partition(".")
        assert parameter in quantities(LIBRARY[effect])
    assert set(effect_words.PHRASES) | set(effect_words.TITLES) <= set(LIBRARY)


@pytest.mark.parametrize(
    ("value", "ci95", "unit", "shown"),
    [
        (1.0125e-5, [9.75e-6, 1.05e-5], "m", ("10.1 µm", "9.8 to 10.5")),
        (2.0e-5, [1.9e-5, 2.11e-5], "m", ("20 µm", "19 to 21")),
        (1.0e-5, [0.999e-5, 1.001e-5], "m", ("10 µm", "9.99 to 10")),
        (1.0, None, "-", ("1", "")),
    ],
)
def test_an_interval_has_the_decimals_of_its_value(value, ci95, unit, shown):
    estimate = {"value": value, "ci95": ci95, "unit": unit}
    texts = value_text("outside:Effect", "gap", estimate), interval_text("outside:Effect", "gap", estimate)
    assert texts == shown


def test_next_steps_leave_out_what_no_recording_can_decide():
    report = {
        "verdict": "nothing_missing", "effects": [], "defects": [], "error": {"noise_floor": 1.0},
        "next_experiment": {"words": f"to detect a, make 2 recordings; {HELPLESS} can detect b"},
    }  # fmt: skip
    assert next_steps(report) == ["To detect a, make 2 recordings."]
    assert next_steps({**report, "next_experiment": None})[0].startswith("No open question")
