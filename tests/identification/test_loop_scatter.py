"""Errors of single recordings are found from repeats."""

import numpy as np
import pytest
from chain_fixtures import GEAR
from loop_fixtures import POINTS, silent

from swgsim.gear.conditions import Conditions
from swgsim.gear.gear import OperatingPoint
from swgsim.identification.covariance.low_rank_covariance import Covariance
from swgsim.identification.covariance.recording_covariance import RecordingCovariance
from swgsim.identification.covariance.repeats import from_all, from_repeats
from swgsim.identification.covariance.scatter import (
    AT_FULL_LOAD,
    CARRIED,
    COMMON,
    DOUBT,
    PER_HOUR,
    PER_KELVIN,
    STATED,
    Scatter,
    directions,
    kinds,
    of_recordings,
    trends,
)
from swgsim.identification.data.beat import BEATING
from swgsim.identification.data.features import ORDERS, Layout
from swgsim.identification.data.measured import Measured
from swgsim.identification.data.model import Model, Situation, predict

POINT = OperatingPoint(2000.0, 35.0)
LAYOUT = Layout(("T_in", "T_out", "s0", "s1"))
KINDS = kinds(LAYOUT)
STATEMENT = Scatter.stated(LAYOUT)


def fabricated(
    seed: int, repeats: list[int], factor: dict[str, float], *, noise: float = 0.3
) -> tuple[np.ndarray, RecordingCovariance, np.ndarray, np.ndarray, list[object]]:
    """Residuals whose errors of single recordings are `factor` times those stated, on an offset of each group."""
    rng = np.random.default_rng(seed)
    groups = [group for group, number in enumerate(repeats) for _ in range(number)]
    offset = rng.normal(size=(len(repeats), len(LAYOUT)))
    B = rng.normal(size=(len(repeats), len(LAYOUT), len(KINDS)))[groups] / np.array([STATED[kind] for kind in KINDS])
    s = np.array([STATED[kind] * factor.get(kind, 1.0) for kind in KINDS])
    errors = np.einsum("rfk,rk->rf", B, s * rng.normal(size=(len(groups), len(KINDS))))
    white = RecordingCovariance.white(np.full((len(groups), len(LAYOUT)), noise**2))
    return offset[groups] + errors + noise * rng.standard_normal(errors.shape), white, B, B[..., :0], groups


def ratios(seed: int, repeats: list[int], factor: dict[str, float], noise: float = 0.3) -> np.ndarray:
    """Estimated over stated standard deviations."""
    found = from_repeats(*fabricated(seed, repeats, factor, noise=noise), STATEMENT)
    return np.array([found.sd[kind] / STATED[kind] for kind in KINDS])


@pytest.mark.parametrize("repeats", [[3] * 6, [2, 5, 1, 4, 7, 5]])
def test_known_standard_deviations_are_recovered(repeats):
    factor = {"load": 3.0, "trigger": 0.3, "zero of s0": 0.5}
    true = np.array([factor.get(kind, 1.0) for kind in KINDS])
    found = np.log([ratios(seed, repeats, factor) / true for seed in range(30)])
    freedom = sum(repeats) - len(repeats)
    expected = 1 / np.sqrt(2 * freedom)
    np.testing.assert_allclose(found.std(axis=0), expected, rtol=0.45)
    # A logarithm of a root of chi-squared lies 1 / (2 freedom) below zero in the mean.
    np.testing.assert_allclose(found.mean(axis=0), 0, atol=4 * expected / np.sqrt(30) + 1 / freedom)


@pytest.mark.parametrize("noise", [0.3, 1e-3])
def test_many_repeats_leave_little_doubt(noise):
    """Also where noise is of no account."""
    found = ratios(1, [100] * 3, {"load": 10.0, "speed": 0.1}, noise)
    assert found[KINDS.index("load")] == pytest.approx(10, rel=0.15)
    assert found[KINDS.index("speed")] == pytest.approx(0.1, rel=0.15)


def test_repeats_that_are_not_there_tell_nothing():
    found = from_repeats(*fabricated(1, [1] * 6, {"load": 10.0}), STATEMENT)
    assert found.repeats == 0
    assert found.sd == {kind: STATED[kind] for kind in KINDS}


@pytest.mark.parametrize("seed", range(6))
def test_without_repeats_all_recordings_tell_it_beside_what_is_open(seed):
    factor = {"load": 4.0, "trigger": 0.25}
    residual, noise, B, _, _ = fabricated(seed, [1] * 18, factor)
    rng = np.random.default_rng(seed + 100)
    open_ = 5.0 * rng.normal(size=(residual.size, 12))
    # Less the offset of every group, which only repeats cancel.
    offset = np.random.default_rng(seed).normal(size=residual.shape)
    residual = (residual - offset).ravel() + open_ @ rng.standard_normal(12)
    # What all have in common, a zero that follows the time, and one that follows the load.
    elapsed = 600.0 * np.arange(len(B))
    loads = rng.uniform(7.0, 70.0, len(B))
    points = [OperatingPoint(2000.0, T) for T in loads]
    common = trends(B, [Situation(p, Conditions(elapsed=t)) for p, t in zip(points, elapsed, strict=True)], LAYOUT)
    unit = {name: B[..., KINDS.index(f"zero of {name}")] * STATED[f"zero of {name}"] for name in ("s0", "s1", "T_out")}
    residual += (COMMON * unit["T_out"] + PER_HOUR * (elapsed / 3600)[:, None] * unit["s0"]).ravel()
    residual += (AT_FULL_LOAD * (loads / 70)[:, None] * unit["s1"]).ravel()
    found = from_all(residual, Covariance(noise, open_), B, common, STATEMENT)
    share = np.array([found.sd[kind] / STATED[kind] / factor.get(kind, 1.0) for kind in KINDS])
    assert found.repeats == 0
    # Eighteen errors of each kind leave a sixth. Below it, the logarithm has a longer tail.
    np.testing.assert_allclose(np.log(share), 0, atol=5 / np.sqrt(2 * 18))
    assert np.sqrt(np.diag(found.doubt)) == pytest.approx(np.full(len(KINDS), 1 / np.sqrt(2 * 18)), rel=0.25)


@pytest.mark.parametrize("size", [0.0, 3.0])
def test_what_follows_the_temperature_is_no_error_of_single_recordings(size):
    """A zero that follows it at three times its bound leaves the estimate of its scatter as it is."""
    found = []
    for seed in range(30):
        residual, noise, B, _, groups = fabricated(seed, [3] * 6, {})
        rng = np.random.default_rng(seed + 100)
        conditions = [Conditions(25 + warmer, 60.0 * i) for i, warmer in enumerate(rng.uniform(0, 8, len(groups)))]
        warming = np.array([each.warmer for each in conditions])[:, None] * B[..., KINDS.index("zero of s0")]
        residual += size * PER_KELVIN * STATED["zero of s0"] * warming
        scatter = from_repeats(
            residual, noise, B, trends(B, [Situation(POINT, each) for each in conditions], LAYOUT), groups, STATEMENT
        )
        found.append(np.log(scatter.sd["zero of s0"] / STATED["zero of s0"]))
    # Twelve contrasts less one each for temperature and time.
    expected = 1 / np.sqrt(2 * 10)
    assert np.mean(found) == pytest.approx(0, abs=4 * expected / np.sqrt(30) + 1 / 10)
    assert np.std(found) == pytest.approx(expected, rel=0.45)


def test_what_recordings_have_in_common_is_no_error_of_single_ones():
    """Every error may be common to all; friction and zeros also follow temperature, time and load."""
    B = np.random.default_rng(1).normal(size=(2, len(LAYOUT), len(KINDS)))
    moves = B * np.array([STATED[kind] for kind in KINDS])
    following = moves[..., [i for i, kind in enumerate(KINDS) if "friction" in kind or "zero" in kind]]
    found = trends(B, [Situation(POINT, Conditions(26.0, 0.0)), Situation(POINT, Conditions(25.0, 3600.0))], LAYOUT)
    loaded = AT_FULL_LOAD * POINT.T_out / 70 * following
    none = 0 * following
    np.testing.assert_allclose(found[0], np.hstack([COMMON * moves[0], PER_KELVIN * following[0], none[0], loaded[0]]))
    np.testing.assert_allclose(found[1], np.hstack([COMMON * moves[1], none[1], PER_HOUR * following[1], loaded[1]]))


def test_an_error_that_cannot_be_seen_stays_as_stated():
    residual, noise, B, none, groups = fabricated(1, [3] * 6, {})
    unseen = KINDS.index("dry friction")
    B = B.copy()
    B[:, :, unseen] = 0
    assert from_repeats(residual, noise, B, none, groups, STATEMENT).sd["dry friction"] == pytest.approx(
        STATED["dry friction"]
    )


def test_two_repeats_weigh_the_statement_with_what_they_show():
    """The likeliest logarithm for one contrast that shows an error of 30 standard deviations in little noise."""
    size, rows = 30.0, 40
    B = np.zeros((2, len(LAYOUT), len(KINDS)))
    B[:, :rows, KINDS.index("load")] = 1 / STATED["load"]
    residual = np.zeros((2, len(LAYOUT)))
    residual[1, :rows] = size * np.sqrt(2)
    scatter = from_repeats(
        residual, RecordingCovariance.white(np.ones(residual.shape)), B, B[..., :0], [0, 0], STATEMENT
    )
    found = np.log(scatter.sd["load"] / STATED["load"])
    # Derivative of the logarithm of the posterior: size^2 / s^2 - 1 - log(s) / DOUBT^2 = 0.
    assert size**2 * np.exp(-2 * found) - 1 - found / DOUBT**2 == pytest.approx(0, abs=0.03)


def test_kinds_follow_the_channels():
    assert "zero of T_in" in kinds(LAYOUT)
    assert "zero of s4" not in kinds(LAYOUT)


def test_what_commissioning_found_holds_without_repeats_and_yields_to_many():
    before = Scatter({kind: 3 * STATED[kind] for kind in KINDS}, 30, 0.01 * np.eye(len(KINDS)))
    alone = from_repeats(*fabricated(1, [1] * 6, {}), before.carried)
    assert alone.sd == before.sd
    np.testing.assert_allclose(np.diag(alone.doubt), 0.01 + CARRIED**2)
    many = from_repeats(*fabricated(1, [60] * 5, {}), before.carried)
    np.testing.assert_allclose([many.sd[kind] / STATED[kind] for kind in KINDS], 1, rtol=0.25)
    few = from_repeats(*fabricated(1, [2] * 3, {}), before.carried)
    shares = np.array([few.sd[kind] / STATED[kind] for kind in KINDS])
    assert ((shares > 1) & (shares < 3.5)).all()


@pytest.mark.parametrize("order", BEATING)
def test_the_beat_is_an_order_of_the_kinematic_error_in_any_phase(order):
    """Two such waves, a quarter of a wave apart, have the lines of this order in the torque; all else is little."""
    layout = Layout(("T_in", "T_out"))
    moves = directions(Model(GEAR), [Situation(POINT, Conditions())], layout)[0]
    waves = [f"beat of order {order}, {wave}" for wave in ("cosine", "sine")]
    cosine, sine = (layout.lines(moves[:, kinds(layout).index(kind)])[1] for kind in waves)
    assert sine[order] / cosine[order] == pytest.approx(-1j, abs=0.02)
    assert np.abs(np.delete(cosine, order)).max() < 0.1 * np.abs(cosine[order])


def test_kinematic_errors_make_ripples_at_their_orders_and_at_sums_of_two():
    layout, loaded = Layout(("s0",)), Situation(OperatingPoint(2000.0, 70.0), Conditions())
    ripple = np.abs(layout.lines(predict([Model(GEAR)], [loaded], layout)[0]))[0, 0]
    orders = np.arange(1, len(ripple))
    beating = np.isin(orders, BEATING)
    assert ripple[orders[beating]].min() > 10 * ripple[orders[~beating]].max()


def test_above_the_resonance_the_output_stands_still_against_the_beat():
    """Its torque is stiffness times error."""
    layout = Layout(("T_in", "T_out"))
    moves = directions(Model(GEAR), [Situation(POINT, Conditions())], layout)[0]
    t = GEAR.transmission
    torque = np.abs(layout.lines(moves[:, kinds(layout).index("beat of order 2, cosine")])[1, 2])
    assert torque == pytest.approx(t.k1 / np.tan(t.alpha_tooth) ** 2, rel=0.5)


def test_errors_are_known_at_the_limits_of_load_and_speed():
    """Where no gear may be loaded or driven any further, they are told from below."""
    most, less = (Situation(OperatingPoint(*at), Conditions()) for at in ((7300.0, 143.0), (7290.0, 142.8)))
    at_most, at_less = directions(Model(GEAR), [most, less], LAYOUT)
    scale = np.abs(at_less).max(axis=0)
    np.testing.assert_allclose(at_most / scale, at_less / scale, atol=0.02)


def test_triggers_turn_what_was_recorded_and_all_else_what_the_model_says():
    """A line whose phase the model misses is turned by a trigger all the same, that of the gauges turns theirs only."""
    recordings = silent(POINTS[:2], repeats=2)
    values = np.random.default_rng(6).normal(size=(len(recordings), len(LAYOUT)))
    measured = Measured(recordings, LAYOUT, values, np.ones(values.shape))
    moves = of_recordings(Model(GEAR), measured)
    model = directions(Model(GEAR), measured.situations, LAYOUT)[measured.of_recording]
    turned = LAYOUT.vector(1j * np.arange(ORDERS + 1) * LAYOUT.lines(values))
    np.testing.assert_allclose(moves[..., KINDS.index("trigger")], turned, rtol=1e-12)
    gauges = moves[..., KINDS.index("trigger of gauges")]
    np.testing.assert_allclose(gauges, turned * np.isin(LAYOUT.channel, ["s0", "s1"]), rtol=1e-12)
    others = [number for number, kind in enumerate(KINDS) if "trigger" not in kind]
    # Without samples nothing drifts.
    np.testing.assert_allclose(moves[..., others], model[..., others], rtol=1e-12)
