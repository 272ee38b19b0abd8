"""A diagnosis of a gear of another author is right if it says what was hidden, and nothing else."""

import pytest
from benches.diagnoses import errors


def answer(effect: str | None, verdict: str, fault: str = "tip_tooth_crack", healthy: float = 0.9) -> dict[str, object]:
    report = {
        "verdict": verdict,
        "sentence": "",
        "probabilities": {"healthy": healthy, fault: 1 - healthy},
        "fault": {"name": fault},
    }
    return {"bench": "any", "case": 0, "truth": {"effect": effect}, "report": report, "seconds": 1.0}


def test_only_the_truth_is_right() -> None:
    found = errors([
        answer(None, "healthy"),
        answer(None, "faulty"),
        answer("tip_tooth_crack", "faulty", healthy=0.1),
        answer("root_tooth_crack", "faulty", healthy=0.1),
        answer("tip_tooth_crack", "something_else", healthy=0.1),
        {"bench": "any", "case": 1, "truth": {"effect": None}, "report": {"verdict": "refused", "sentence": "no"}},
        {"bench": "any", "case": 2, "truth": {"effect": "wear"}, "report": None},
    ])  # fmt: skip
    assert (found["count"], found["healthy"], found["healthy_called_faulty"], found["something_else"]) == (6, 3, 1, 1)
    assert found["value"] == pytest.approx(100 * 4 / 6)
    assert found["right_class"] == 4  # the most probable class, whatever the verdict
    assert [each["right"] for each in found["gears"]] == [True, False, True, False, False, False]


def test_no_gear_has_no_error() -> None:
    assert errors([])["value"] is None
