"""Zeros of the flanges are found from healthy recordings of the session, and from nothing that is judged."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from fabricated import recordings

from learn.adaptation.adapting import adapt_and_judge
from learn.adaptation.rezero import HealthyEfficiency, Rezero
from learn.inputs.auxiliary_inputs import LOG, changes_of_efficiency
from learn.inputs.harmonics import Harmonics
from learn.inputs.inputs import SPECIMEN
from learn.inputs.joint_rows import joint_rows
from learn.methods.strong import logistic_regression
from learn.protocols.levels import NewGears
from swgsim.common.seeds import generator

PROTOCOL = NewGears(folds=2, development=0, labelled=4, unlabelled=1, kept_out=1)
SPREAD = np.array([0.1, 0.2])  # of the biases of a session, N m at the output
NOISE = 1e-4  # of the logarithm of the efficiency


@pytest.fixture(scope="module")
def sound():
    return Harmonics("harmonics", 6).learning_set([recordings(gears=8, variants=8, disturbance=1e-3)])


def biased(data, noise=NOISE, slope=0.004, spread=SPREAD):
    """The data in sessions with biases of the flanges and temperatures; and the biases of every row."""
    rng, table = generator("sessions"), data.table
    bias = spread * rng.standard_normal((9, 2))[table["gear"]]
    warmer = 4 * rng.standard_normal(len(table))
    load, eta = table["T_out_nm"].to_numpy(), table["efficiency"].to_numpy()
    healthy = eta / np.exp(data.features[:, data.names.index(LOG)])
    error = bias[:, 0] / load + bias[:, 1] * healthy / load + slope * warmer + noise * rng.standard_normal(len(load))
    columns = changes_of_efficiency(eta * np.exp(error), healthy, table["n_in_rpm"].to_numpy(), load)
    features = data.features.copy()
    for name, values in columns.items():
        features[:, data.names.index(name)] = values
    table = table.assign(efficiency=eta * np.exp(error), temperature_c=25 + warmer)
    return replace(data, features=features, table=table), bias


def first(data):
    return next(iter(PROTOCOL.episodes(data.table)))


def change(data):
    return np.asarray(data.features)[:, data.names.index(LOG)]


def test_the_error_of_the_efficiency_falls_with_the_number_of_healthy_recordings(sound):
    data, bias = biased(sound, noise=3e-3)
    episode, load = first(data), data.table["T_out_nm"].to_numpy()
    healthy = data.table["efficiency"].to_numpy() / np.exp(change(data))
    of_bias = bias[:, 0] / load + bias[:, 1] * healthy / load
    targets = np.concatenate([target.judged for target in episode.targets])
    left = []
    for number in (0, 1, 4):
        given, _ = Rezero().rezeroed(data, episode, number, draw=0)
        left.append(np.std((change(given) - change(data) + of_bias)[targets]))
    assert left[0] > 5 * left[1] > 5 * left[2]


def test_temperature_and_scatter_come_from_healthy_source_recordings(sound):
    data, _ = biased(sound)
    rows = first(data).source
    model = HealthyEfficiency.of(data, rows[data.table["label"].iloc[rows] == "healthy"])
    warmer = data.table["temperature_c"].to_numpy()
    np.testing.assert_allclose(np.polyfit(warmer, model.warm, 1)[0], 0.004, rtol=0.05)
    assert np.sqrt(model.variance.mean()) == pytest.approx(NOISE, rel=0.5)


def test_faults_and_judged_recordings_have_no_say_and_what_corrects_a_source_gear_does_not_train(sound):
    data, _ = biased(sound)
    episode = first(data)
    label = data.table["label"].to_numpy()
    given, trained = Rezero().rezeroed(data, episode, 2, draw=1)
    shots = np.concatenate([target.shots(data.table, 2, 1) for target in episode.targets])
    allowed = np.append(episode.source, shots)
    touched = np.setdiff1d(np.arange(len(label)), allowed[label[allowed] == "healthy"])
    error = np.zeros(len(label))
    error[touched] = 0.1 * generator("touched").standard_normal(len(touched))
    features = data.features.copy()
    features[:, data.names.index(LOG)] += error
    table = data.table.assign(efficiency=data.table["efficiency"] * np.exp(error))
    other, same = Rezero().rezeroed(replace(data, features=features, table=table), episode, 2, draw=1)
    np.testing.assert_allclose(change(other) - error, change(given), atol=1e-12)
    assert np.array_equal(trained, same)
    left_out = np.setdiff1d(episode.source, trained)
    gears = data.table["gear"].iloc[episode.source].nunique()
    assert len(left_out) == 2 * gears * 4  # at every operating point
    assert (label[left_out] == "healthy").all()


def test_all_inputs_of_the_efficiency_follow(sound):
    data, _ = biased(sound)
    given, _ = Rezero().rezeroed(data, first(data), 1, draw=0)
    eta = data.table["efficiency"].to_numpy()
    healthy = eta / np.exp(change(data))
    facts = (data.table[name].to_numpy() for name in ("n_in_rpm", "T_out_nm"))
    for name, values in changes_of_efficiency(healthy * np.exp(change(given)), healthy, *facts).items():
        np.testing.assert_allclose(given.features[:, given.names.index(name)], values, atol=1e-12)
    others = [i for i, name in enumerate(data.names) if "eta" not in name and name != "viscous loss"]
    assert np.array_equal(given.features[:, others], data.features[:, others])


def test_healthy_recordings_of_the_session_lower_the_error_on_new_gears(sound):
    data, _ = biased(sound, noise=1e-3, spread=10 * SPREAD)

    def source_model(X, y, gears):
        return logistic_regression(strength=100).fit(X, y)

    judged = adapt_and_judge(data, PROTOCOL.episodes(data.table), source_model, Rezero(), [0, 2], draws=2)
    errors = judged.gears.groupby("shots")["error"].mean()
    assert errors[2] < errors[0] - 2
    assert set(judged.specimens["shots"]) == {0, 2}


def test_units_in_one_row_are_corrected_as_their_recordings_are(sound):
    data, _ = biased(sound)
    units = joint_rows(data)
    given, trained = Rezero().rezeroed(units, first(units), 2, draw=1)
    corrected, of_recordings = Rezero().rezeroed(data, first(data), 2, draw=1)
    expected = joint_rows(corrected)
    np.testing.assert_allclose(given.features, expected.features, atol=1e-11)
    specimens = data.table.loc[of_recordings, list(SPECIMEN)].drop_duplicates()
    pd.testing.assert_frame_equal(
        units.table.loc[trained, list(SPECIMEN)].sort_values(list(SPECIMEN), ignore_index=True),
        specimens.sort_values(list(SPECIMEN), ignore_index=True),
    )


def test_inputs_without_the_efficiency_and_a_single_source_gear_are_refused(sound):
    bare = Harmonics("harmonics", 6, efficiency=False).learning_set([recordings(gears=2, variants=8)])
    with pytest.raises(ValueError, match="'log eta_rel' is not among the inputs: take features=harmonics"):
        Rezero().rezeroed(bare, first(bare), 1, 0)
    data, _ = biased(sound)
    alone = next(iter(replace(PROTOCOL, sources=1).episodes(data.table)))
    with pytest.raises(ValueError, match="1 source gears have healthy recordings: take at least 2"):
        Rezero().rezeroed(data, alone, 1, 0)
