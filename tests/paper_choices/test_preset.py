"""Presets: the usual values are grid=paper, and grid=paper_fitted has the values that were kept."""

import json
from importlib.resources import files

import pytest
import yaml
from paper_choices.study_configuration import CONFIG, USUAL, composed

from learn.paper_choices.preset import changes, merged
from swgsim.common.configured import conf_folder
from swgsim.jobs import settings


def gears(values):
    return settings.gears(merged({**CONFIG, "grid": {**CONFIG["grid"]}}, changes(values, CONFIG)))


def test_the_usual_values_are_the_papers_grid():
    changed = changes(USUAL, CONFIG)
    assert merged(CONFIG["grid"], changed["grid"]) == CONFIG["grid"]
    assert merged(CONFIG["window"], changed["window"]) == CONFIG["window"]
    for name, gear in CONFIG["gears"].items():
        assert settings.gear(merged(gear, changed["gears"][name])) == settings.gear(gear)
    assert changed["features"] == {"orders": 6, "floor": 1e-6, "whole_revolutions": True}


def test_a_gears_errors_grow_by_its_own_factor():
    plain, worse = gears(USUAL), gears(USUAL | {"gauge_errors_2": 3.0})
    assert worse[0] == plain[0]
    assert worse[1].gauges.position == pytest.approx([3 * each for each in plain[1].gauges.position])
    assert worse[1].gauges.gain[0] - 1 == pytest.approx(3 * (plain[1].gauges.gain[0] - 1), abs=1e-3)


def test_kinematic_errors_differ_from_gear_1_as_far_as_asked():
    errors = [gear.transmission.kinematic_error for gear in gears(USUAL | {"kinematic_difference": 0.5})]
    assert errors[0] == gears(USUAL)[0].transmission.kinematic_error
    assert len({error[0].phase for error in errors}) == 3


def test_the_fitted_preset_has_the_values_that_were_kept():
    kept = json.loads((files("learn.paper") / "tables" / "paper_choices.json").read_text())
    values = {name: each["value"] for name, each in kept["choices"].items()}
    written = yaml.safe_load((conf_folder() / "grid" / "paper_fitted.yaml").read_text())
    grid = composed("paper_choices")
    found = changes(values, grid)
    assert {key: written[key] for key in ("window", "gears", "features")} == {
        key: found[key] for key in ("window", "gears", "features")
    }
    assert written["grid"]["severities"] == found["grid"]["severities"]


def test_the_fitted_preset_reaches_chain_and_features():
    made, trained = composed("generate", "grid=paper_fitted"), composed("train", "grid=paper_fitted")
    written = yaml.safe_load((conf_folder() / "grid" / "paper_fitted.yaml").read_text())
    assert made["grid"]["name"] == "paper_fitted"
    assert made["window"]["samples"] == written["window"]["samples"]
    assert made["gears"]["gear3"]["gauges"]["position"] == written["gears"]["gear3"]["gauges"]["position"]
    assert trained["features"]["orders"] == written["features"]["orders"]
