"""Every picture is drawn, the same way twice, and shows what it should."""

import numpy as np
import pandas as pd
import pytest

from learn.paper import figures as learning_figures
from swgsim.common import style
from swgsim.flexspline.lattice import INNER
from swgsim.flexspline.silk_hat import sector
from swgsim.gear.acquisition import Window
from swgsim.gear.gear import Gear, OperatingPoint
from swgsim.storage.labelled_signals import CLASSES
from swgsim.studies import figures, flexspline_figures
from swgsim.studies.examples import EXAMPLES, Subject

SUBJECT = Subject((Gear(),), (OperatingPoint(2000, 7), OperatingPoint(4000, 70)), Window(), sectors=40)


def runs():
    rows = [
        {"classifier": "rf", "protocol": p, "study": s, "features": f, **{f"recall/{c}": 60.0 + i for i, c in
         enumerate(CLASSES)}}
        for s, p in (("table7", "random_folds"), ("table7", "grouped_folds"), ("table10", "leave_one_gear_out"))
        for f in ("selection_3", "selection_1")
    ]  # fmt: skip
    return pd.DataFrame(rows)


@pytest.fixture(scope="module")
def drawn():
    return {name: getattr(figures, name)(SUBJECT) for name in ("run_in", "influence_maps", "efficiency", "signals")}


def test_same_picture_gives_the_same_bytes(drawn):
    assert style.png(drawn["influence_maps"]) == style.png(figures.influence_maps(SUBJECT))


@pytest.mark.parametrize("name", ["run_in", "influence_maps", "efficiency"])
def test_every_axis_is_named(drawn, name):
    below = [axes for axes in drawn[name].axes if axes.get_subplotspec() and axes.get_subplotspec().is_last_row()]
    assert all(axes.get_ylabel() for axes in drawn[name].axes)
    assert all(axes.get_xlabel() for axes in below)


def test_signals_show_every_fault_and_the_healthy_gear(drawn):
    assert len(drawn["signals"].axes) == 2 * len(EXAMPLES)
    assert all(len(axes.lines) == 10 for axes in drawn["signals"].axes[::2])


def test_flex_spline_follows_the_wave_generator_and_is_held_at_the_edge():
    gear, hat = Gear(), sector(Gear().flex_spline, 40)
    moved = flexspline_figures.displacement(gear, 40)
    on_cam = hat.band & hat.layer(INNER)
    assert moved[0, on_cam, 0] == pytest.approx(gear.wave_generator.w0, rel=0.02)
    assert moved[10, on_cam, 0] == pytest.approx(-gear.wave_generator.w0, rel=0.02)
    assert moved[:, hat.clamped] == pytest.approx(0, abs=1e-12)


def test_gauges_lie_on_the_collar():
    axes = flexspline_figures.gauge_layout(Gear()).axes[0]
    grids = np.concatenate([line.get_xydata() for line in axes.lines])
    radius = np.linalg.norm(grids, axis=1)
    assert len(axes.lines) == 8 * 2 * 3
    assert radius.min() > 22.7
    assert radius.max() < 31


def test_catalogue_damping_meets_the_catalogue():
    ours, theirs = figures.catalogue_comparison(SUBJECT).values()
    assert theirs[0] == pytest.approx(figures.CATALOGUE_EFFICIENCY, abs=0.01)
    assert theirs[1] == pytest.approx(0.051, abs=0.001)
    assert ours[0] < theirs[0]


def test_spectrum_of_a_sine_is_one_line():
    turn = 2 * np.pi * 2000 / 60 * np.arange(650) / 1e4
    order, magnitude = learning_figures.spectrum(3 + 0.2 * np.sin(2 * turn), 2000, 1e4)
    assert order[magnitude.argmax()] == pytest.approx(2)
    assert np.sort(magnitude)[-2:] == pytest.approx([0, 0.2], abs=1e-12)


def test_recall_counts_the_forest_of_the_papers_protocols_only():
    axes = learning_figures.recall(runs()).axes[0]
    assert [label.get_text() for label in axes.get_yticklabels()] == [
        "VII, same gears, clean, selection 1",
        "VII, same gears, clean, selection 3",
        "X, new gear, disturbed, selection 1",
        "X, new gear, disturbed, selection 3",
    ]


def test_colours_tell_all_classes_and_sensors_apart():
    assert set(style.CLASS_COLOURS) == set(CLASSES)
    assert len(set(style.CLASS_COLOURS.values())) == len(CLASSES)
    assert len(set(style.SENSOR_COLOURS.values())) == 5
