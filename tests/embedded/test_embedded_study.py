"""What the study of exported methods concludes from its results, which are made up here."""

from dataclasses import replace

import numpy as np
import pytest

from learn.embedded.figure import drawn
from learn.embedded.report import run
from learn.embedded.table import errors_of, variants_of
from learn.embedded.text import markdown
from learn.embedded.trade import Part, recommend
from learn.inputs.inputs import SPECIMEN

PART = Part.of({"flash_kib": 128, "ram_kib": 32, "rate": 10, "sampling": 10_000, "mips": 24})
# Mean error on gears never seen [%], flash [kB] and labels as in Python, of 540; one that is best does not fit, and one
# that is smallest is another method.
METHODS = {
    "huge": (5.0, 900, 540),
    "large": (10.0, 100, 540),
    "small": (10.5, 20, 538),
    "unlike": (10.5, 10, 537),
    "tiny": (30.0, 5, 540),
}


def entry(method, error, flash, equal, rng, *, machines=True, gears=8):
    """A result as outcome.py gives it: errors of specimens scatter by five points around the method's."""
    units, labels, draws = (
        each.ravel() for each in np.meshgrid(range(gears), ["A", "B", "C"], range(4), indexing="ij")
    )
    columns = dict(zip(SPECIMEN, (units.tolist(), labels.tolist(), draws.tolist()), strict=True))
    agreement = {"recordings": 540, "decided": 540, "equal": 539, "difference": 2e-6}
    counts = {"window": 400e3, "push": 700.0, "decide": 30e3, "features": 20e3, "classify": 9e3}
    machine = {
        "agreement": agreement,
        "instructions": counts,
        "most_instructions": 431_000,
        "longest_push": 700,
        "stack": 1000,
    }
    return {
        "method": method,
        "numbers": "float",
        "specimens": columns | {"error": (error + centred(rng, len(units))).tolist()},
        "disturbed": 99.0,
        "sanitized": agreement,
        "host": {"unseen": agreement, "disturbed": {**agreement, "equal": equal}},
        "flash": {"window": 1024, "forest": 1024 * (flash - 3), "gear": 1024, "libm": 1024} if machines else {},
        "ram": 2000 if machines else None,
        "machines": {"cortex-m4": machine, "cortex-m7": machine} if machines else {},
    }


def centred(rng, count):
    """Scatter whose mean is 0, so that the order of the methods is the one that was made up."""
    scatter = 5 * rng.standard_normal(count)
    return scatter - scatter.mean()


def results(**options):
    rng = np.random.default_rng(3)
    return [entry(method, *each, rng, **options) for method, each in METHODS.items()]


def advice_for(part):
    found = results()
    return recommend(variants_of(found), errors_of(found), part, np.random.default_rng(0))


def test_the_smallest_that_is_not_clearly_worse_is_recommended():
    advice = advice_for(PART)
    assert (advice.variant, advice.most_accurate) == ("small, float", "large, float")
    assert advice.low <= 0 < advice.difference < advice.high


def test_what_does_not_fit_is_not_recommended():
    assert advice_for(replace(PART, flash=6 * 1024)).variant == "tiny, float"
    assert advice_for(replace(PART, ram=2 * 1024)) is None
    assert advice_for(replace(PART, rate=60)) is None  # decisions a second
    assert advice_for(replace(PART, sampling=40_000)) is None  # a sample takes longer than there is till the next


def test_of_few_gears_the_most_accurate_is_recommended_and_no_interval_is_given():
    found = results(gears=2)
    variants = variants_of(found)
    advice = recommend(variants, errors_of(found), PART, np.random.default_rng(0))
    assert advice == ("large, float", "large, float", 0, 0, 0)
    assert "nan" not in markdown(variants, PART, advice)


def test_the_table_adds_up_and_says_what_was_left_out():
    found = results()
    variants = variants_of(found)
    parts = variants[["flash_features", "flash_classifier", "flash_gear", "flash_library"]].sum(axis=1)
    assert parts.equals(variants["flash"])
    assert (variants["flash"] == 1024 * np.array([flash for _, flash, _ in METHODS.values()])).all()
    assert (variants["low"] < variants["unseen"]).all()
    assert (variants["unseen"] < variants["high"]).all()
    text = markdown(variants, PART, advice_for(PART))
    line, _ = (line for line in text.splitlines() if line.startswith("| small"))
    assert line.count("539 of 540") == 4  # gears never seen, both microcontrollers, sanitizers
    assert "538 of 540" in line
    assert "**small, float**, 20.0 kB of flash, 2.9 kB of RAM, 4.3 million instructions" in text
    assert "These do not fit: huge, float." in text
    assert "Less than 99.5 % of labels as in Python: unlike, float." in text
    assert len(drawn(variants, PART).axes) == 4


def test_without_the_tools_accuracies_are_left():
    variants = variants_of(results(machines=False))
    assert "scripts/install_arm.sh" in markdown(variants, PART, None)
    assert "flash" not in variants
    assert (variants["disturbed"] == 99.0).all()


def test_an_absent_data_set_is_named_with_the_command_that_makes_it(tmp_path):
    config = {"data": str(tmp_path), "unseen": "gears-bench", "disturbed": "paper-disturbed", "methods": {"m": {}}}
    config |= {"embedded": str(tmp_path), "report": str(tmp_path)}
    with pytest.raises(ValueError, match=f"grid=gears condition=bench data={tmp_path}"):
        run(config)
    with pytest.raises(ValueError, match="methods is empty, so nothing would be compared"):
        run({**config, "methods": {}})
    assert not list(tmp_path.iterdir())
