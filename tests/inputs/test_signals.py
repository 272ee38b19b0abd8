"""Signals as inputs: their columns, waveforms and auxiliary inputs."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from fabricated import of_lines, recordings

from learn.inputs.inputs import Layout
from learn.inputs.signals import Signals

AUXILIARY = ("log eta_rel", "root of log eta_rel", "viscous loss", "speed", "load", "temperature")
POINTS, ORDERS = 16, 6
ANGLE = 2 * np.pi * np.arange(POINTS) / POINTS


def signals(signal, **options):
    return Signals(signal, POINTS, ORDERS, **options)


def of(data, representation):
    """The signals of a data set (sample, channel, point) and its side inputs by name."""
    made = representation.learning_set([data])
    end = made.layout.columns
    shape = (len(made.features), made.layout.channels, made.layout.points)
    return made.features[:, :end].reshape(shape), dict(zip(made.names[end:], made.features[:, end:].T, strict=True))


def with_facts(data, samples=None, references=None):
    """The recordings with other facts of all samples and of all references."""
    table = data.table.copy()
    for rows, facts in ((~table["reference"], samples), (table["reference"], references)):
        for name, value in (facts or {}).items():
            table.loc[rows, name] = value
    return replace(data, table=table)


@pytest.mark.parametrize(
    ("signal", "channels", "more"),
    [
        ("raw", 5, ()),
        ("template", 5, ()),
        ("differenced", 2, ()),
        ("residual", 5, ("load error", "angle error", "speed error")),
        ("residual_with_reference", 10, ("load error", "angle error", "speed error")),
    ],
)
def test_signals_precede_auxiliary_inputs_channel_by_channel(signal, channels, more):
    data = recordings(gears=2, variants=2)
    made = signals(signal).learning_set([data])
    assert made.layout == Layout(channels, POINTS)
    assert made.features.shape == (len(data.samples), len(made.names))
    assert made.names[channels * POINTS :] == (*AUXILIARY, *more)
    pd.testing.assert_frame_equal(made.table, data.samples.table)


def test_signals_are_waveforms_over_the_angle():
    lines = np.zeros((2, 5, ORDERS + 1), dtype=complex)
    lines[1, 1, 0], lines[1, 1, 2], lines[1, 3, 1] = 0.5, 3.0 * np.exp(0.4j), 2.0
    data = of_lines(lines, reference=[True, False])
    s1, s3 = 0.5 + 3.0 * np.cos(2 * ANGLE + 0.4), 2.0 * np.cos(ANGLE)
    raw, _ = of(data, signals("raw"))
    np.testing.assert_allclose(raw[0, [1, 3]], [s1, s3], atol=1e-12)
    np.testing.assert_allclose(raw[0, [0, 2, 4]], 0, atol=1e-12)
    differenced, _ = of(data, signals("differenced"))
    np.testing.assert_allclose(differenced[0], [s1 - s3, 0 * ANGLE], atol=1e-12)
    for relative_to_zero in ("template", "residual"):
        np.testing.assert_allclose(of(data, signals(relative_to_zero))[0], raw, atol=1e-12)


@pytest.mark.parametrize(
    ("options", "names"),
    [
        ({"efficiency": False}, AUXILIARY[3:]),
        ({"operating_point": False}, AUXILIARY[:3]),
        ({"efficiency": False, "operating_point": False}, ()),
        ({"reference": False}, ("log eta", *AUXILIARY[3:])),
    ],
)
def test_auxiliary_inputs_can_be_left_out(options, names):
    data = recordings(gears=1, variants=1)
    made, plain = (signals("raw", **each).learning_set([data]) for each in (options, {}))
    assert made.names[made.layout.columns :] == names
    end = made.layout.columns
    np.testing.assert_array_equal(made.features[:, :end], plain.features[:, :end])


def test_without_a_reference_inputs_do_not_depend_on_the_healthy_gear():
    data = recordings(gears=1, variants=2)
    other = with_facts(data, references={"efficiency": 0.3, "temperature_c": 50.0})
    other = replace(other, signals=np.where(data.table["reference"].to_numpy()[:, None, None], 1.0, other.signals))
    for signal in ("raw", "differenced"):
        known, unknown = (
            [signals(signal, reference=r).learning_set([d]).features for d in (data, other)] for r in (True, False)
        )
        assert not np.allclose(*known)
        np.testing.assert_array_equal(*unknown)


def test_auxiliary_inputs_are_changes_of_efficiency_and_temperature():
    data = with_facts(
        recordings(gears=1, variants=1),
        samples={"efficiency": 0.6, "temperature_c": 45.0},
        references={"efficiency": 0.8, "temperature_c": 40.0},
    )
    _, side = of(data, signals("raw"))
    np.testing.assert_allclose(side["log eta_rel"], np.log(0.75))
    np.testing.assert_allclose(side["root of log eta_rel"], -(np.log(4 / 3) ** 0.25))
    np.testing.assert_allclose(side["temperature"], 5.0)
    speed = data.samples.table["n_in_rpm"] / 60 * 2 * np.pi
    np.testing.assert_allclose(side["viscous loss"] * speed / data.samples.table["T_out_nm"], 1 / 0.6 - 1 / 0.8)
    _, side = of(data, signals("raw", reference=False))
    np.testing.assert_allclose(side["log eta"], np.log(0.6))
    np.testing.assert_allclose(side["temperature"], 45.0)


def test_healthy_samples_that_equal_their_reference_give_no_residual():
    data = recordings(gears=2)
    healthy = (data.samples.table["label"] == "healthy").to_numpy()
    residual, side = of(data, signals("residual"))
    assert np.abs(residual[healthy]).max() < 1e-12
    assert all(np.abs(side[name][healthy]).max() < 1e-12 for name in (*AUXILIARY[:3], "angle error"))
    assert np.abs(residual[~healthy]).max() > 1e-3


def test_the_reference_stands_beside_an_unchanged_residual():
    data = recordings(gears=2, disturbance=0.01)
    residual, side = of(data, signals("residual"))
    both, same_side = of(data, signals("residual_with_reference"))
    np.testing.assert_array_equal(both[:, :5], residual)
    assert all(np.array_equal(side[name], same_side[name]) for name in side)
    # A raw signal minus the template is the reference; its mean is the load's and not the gear's.
    reference = of(data, signals("raw"))[0] - of(data, signals("template"))[0]
    np.testing.assert_allclose(both[:, 5:], reference - reference.mean(axis=2, keepdims=True), atol=1e-12)
    of_point = data.samples.table.groupby(["gear", "n_in_rpm", "T_out_nm"]).indices.values()
    assert all(np.ptp(both[rows, 5:], axis=0).max() == 0 for rows in of_point)
