"""The blind test: its strata, what it hides, its baselines and its score; `make blind SMALL=1` runs the whole of it."""

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from chain_fixtures import GEAR
from hydra import compose, initialize_config_dir
from loop_fixtures import POINTS, drawn, fitted_to, holding
from omegaconf import OmegaConf

from swgsim.bench.scatter import Bench
from swgsim.blind import attempt, baselines, drawing
from swgsim.blind import blind_study as job
from swgsim.blind.altered import Alteration, Altered, StrayOrder, resized
from swgsim.blind.baselines import Task
from swgsim.blind.bench import Setting, in_question, unit_of, unseen
from swgsim.blind.calibration import as_in_prior, calibration_error
from swgsim.blind.drawing import drawn_inner
from swgsim.blind.families import FAMILIES
from swgsim.blind.intervals import median
from swgsim.blind.outside import OUTSIDE
from swgsim.blind.prediction import expected, unseen_error
from swgsim.blind.score import score, worst
from swgsim.blind.scored_case import RIGHT, ScoredCase
from swgsim.blind.sealed import Sealed, as_json, from_json
from swgsim.blind.strata import CYCLE, FULL, NULLS, SINGLE, UNTESTABLE, WRITTEN, Plan, plans, searched
from swgsim.blind.strength import sized, strengths
from swgsim.chain.chain import Run, simulate_turns
from swgsim.common.seeds import generator
from swgsim.effects.library import LIBRARY, SEARCHED
from swgsim.effects.quantity import quantities
from swgsim.gear.acquisition import Window
from swgsim.gear.conditions import Conditions
from swgsim.gear.gear import OperatingPoint
from swgsim.identification.data.features import COMPARED, Layout, features
from swgsim.identification.data.measured import Measured
from swgsim.identification.data.model import Model, predict
from swgsim.identification.decide.decision import Decision
from swgsim.identification.decide.option import option
from swgsim.identification.fit import map_fit as calibration
from swgsim.identification.fit.fitted import Fitted
from swgsim.identification.fit.fitting import fit
from swgsim.identification.fit.priors import of_unit
from swgsim.identification.fit.unit import Unit
from swgsim.identification.report.answer import Answer
from swgsim.identification.search.hypotheses import Hypothesis
from swgsim.identification.search.regularities import atoms
from swgsim.storage.labelled_signals import SENSORS

pytestmark = [pytest.mark.end_to_end, pytest.mark.slow]
CONF = Path(__file__).parents[2] / "conf"
FEW = (
    "eccentric_wave_generator", "cam_form", "tilting_moment", "gauge_gain", "channel_skew", "reduced_damping",
    "thermal_growth", "mains_hum",
)  # fmt: skip
SETTING = Setting(GEAR, Bench(), Window(), tuple(LIBRARY[name] for name in FEW), 4, (60,), 3)
CASE = Sealed(0, SINGLE, FULL.name, FULL.points, 3, 17, 60, True, False, (1.0, 1.0), "mesh")
SAID = {
    "verdict": "effect_found",
    "probability": 0.9,
    "accepted": ["cam_form"],
    "alternatives": [
        {"effects": ["cam_form"], "unknown": False, "probability": 0.9},
        {"effects": ["out_of_round"], "unknown": False, "probability": 0.08},
    ],
    "nearest": [],
    "lines": [],
    "unknown": [],
    "absorbed": [],
    "seen_from": {"cam_form": 1e-6},
    "scores": [["cam_form", 100.0, 1e-3]],
    "smallest_chance": 1e-3,
    "baselines": {name: ["cam_form"] for name in baselines.BASELINES},
    "error": {"before": 2.0, "after": 1.0, "oracle": 1.0},
    "log_likelihood": {"before": -2000.0, "after": -600.0, "oracle": -586.5},
    "heldout": {"before": 2.0, "after": 2.0},
    "intervals": [{"name": "cam_form", "true": 1.0, "found": 1.1, "deviation": 0.1}],
    "angles": [{"name": "cam_form", "true": 6.2, "found": 0.1, "deviation": 0.1}],
    "seconds": {"loop": 5.0, "loop_of_one_core": 4.0},
    "peak_memory_mib": 100.0,
}
INTERVALS = ("intervals", "angles")
NOTHING_NAMED = {"accepted": [], "alternatives": [{"effects": [], "unknown": False, "probability": 0.97}]}
MISSED = {**NOTHING_NAMED, "verdict": "nothing_missing"}
CALLED_UNKNOWN = {
    "accepted": [], "alternatives": [{"effects": [], "unknown": True, "probability": 0.97}],
    "verdict": "unknown_effect",
}  # fmt: skip
WRONG = {"accepted": ["out_of_round"], "alternatives": SAID["alternatives"][1:]}
ONE_MORE = {"accepted": ["cam_form", "coning"], "alternatives": []}
SHORT = replace(CASE, points=FULL.points[:2], repeats=1)
HIDDEN = replace(CASE, effects=(LIBRARY["cam_form"](3, 2e-6, 1.0),), strengths=(3000.0,))


@pytest.fixture(scope="module")
def fitted() -> Fitted:
    """A model fitted to a healthy unit at two points."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(calibration, "MOST_STEPS", 3)
        return fit(Measured.of(in_question(SHORT, SETTING, ())), Unit(Model(GEAR)))


def test_a_set_has_the_shares_that_were_declared() -> None:
    planned = plans(200, 5, SEARCHED)
    strata = [plan.stratum for plan in planned]
    shares = {name: strata.count(name) / 200 for name in dict.fromkeys(strata)}
    assert sum(shares[name] for name in NULLS) == 0.25
    assert shares["single"] == 0.3
    assert shares["pair"] == 0.15
    assert shares["taken out"] == shares["written"] == shares["untestable"] == 0.1
    assert 0.7 < np.mean([plan.commissioned for plan in planned if plan.stratum != "untestable"]) < 0.9
    assert {plan.design.name for plan in planned} == {"6 points", "4 points", "2 speeds", "1 repeat"}


def test_more_cases_do_not_change_the_first_ones() -> None:
    assert plans(40, 5, SEARCHED)[:23] == plans(23, 5, SEARCHED)
    assert plans(23, 6, SEARCHED) != plans(23, 5, SEARCHED)


def test_no_effect_is_dealt_twice_before_all_others_were() -> None:
    sought = [kind for kind in SEARCHED if searched(kind)]
    single = [plan.kinds[0] for plan in plans(20 * len(CYCLE), 5, SEARCHED) if plan.stratum == SINGLE]
    assert len(set(single[: len(sought)])) == len(sought)


def test_every_stratum_sees_every_strength() -> None:
    planned = plans(200, 5, SEARCHED)
    for stratum in ("single", "pair", "taken out", "written"):
        strengths = [plan.strength for plan in planned if plan.stratum == stratum]
        assert min(strengths.count(s) for s in set(strengths)) >= len(strengths) // 4 - 1
        assert len(set(strengths)) == 4


@pytest.mark.parametrize(("stratum", "planned"), [("written", OUTSIDE[:1]), ("pair", SETTING.library[:2])])
def test_what_cannot_be_seen_gives_way_to_another_of_its_stratum(
    monkeypatch: pytest.MonkeyPatch, stratum: str, planned: tuple[type, ...]
) -> None:
    """To none that the library has where something written is hidden, and to none that is planned anyway."""
    for name in ("unit_known", "in_question", "fit", "likeness"):
        monkeypatch.setattr(drawing, name, lambda *_: (0.0, ""))
    monkeypatch.setattr(drawing.Measured, "of", lambda *_: None)
    for number in range(10):
        seen = iter([1.0, *[3000.0] * len(planned)])
        monkeypatch.setattr(drawing, "sized", lambda effect, *_: (effect, next(seen)))  # noqa: B023
        plan = Plan(number, stratum, FULL, True, 3000.0, "mesh", planned)
        first, *others = map(type, drawing.draw(plan, SETTING).effects)
        assert first in (OUTSIDE if stratum == "written" else SETTING.library)
        assert first not in planned
        assert tuple(others) == tuple(planned[1:])


def test_the_law_of_the_load_scales_the_size() -> None:
    effect = LIBRARY["cam_form"](3, 2e-6, 1.0)
    altered = Altered(effect, Alteration(exponent=0.2))
    sizes = [altered.at(OperatingPoint(2000, T), Conditions()).amplitude for T in (7.0, 39.0, 70.0)]
    np.testing.assert_allclose(sizes, 2e-6 * (np.array([7.0, 39.0, 70.0]) / 39) ** 0.2)


def test_scattered_sizes_have_the_spread_that_was_asked_for() -> None:
    factors = [Alteration.scattered(0.1, generator("test", i)).factor(p) for i in range(400) for p in POINTS]
    assert np.mean(factors) == pytest.approx(1, abs=0.01)
    assert np.std(factors) == pytest.approx(0.1, rel=0.1)


def test_a_size_stays_within_its_bounds() -> None:
    assert resized(LIBRARY["reduced_damping"](0.4), 3.0).b1_ratio == 0.3
    assert resized(LIBRARY["reduced_damping"](0.8), 0.5).b1_ratio == pytest.approx(0.9)


def test_of_a_level_more_is_a_lower_one() -> None:
    assert resized(LIBRARY["clipping"](0.22), 1.1).level == pytest.approx(0.2)


@pytest.mark.parametrize("kind", SEARCHED, ids=lambda kind: kind.name())
def test_inner_parameters_are_drawn_within_their_bounds(kind: type) -> None:
    effects = [drawn_inner(kind, generator("inner", i)) for i in range(20)]
    nothing = {name: q.nothing for name, q in quantities(kind).items() if q.role.value == "size"}
    assert all(getattr(effect, name) != value for effect in effects for name, value in nothing.items())


def test_effects_from_outside_are_in_no_library_and_can_be_described() -> None:
    shown = atoms(Layout(COMPARED))
    for kind in OUTSIDE:
        assert kind.name() not in LIBRARY
        assert kind.described in shown


def test_a_stray_order_is_in_one_channel() -> None:
    runs = [Run(GEAR, POINTS[0], effects) for effects in ((), (StrayOrder(3, 5, 1e-3, 0.4),))]
    layout = Layout(SENSORS)
    seen = np.array([features(r, layout) for r in simulate_turns(runs, 1, 64, 60)])
    lines = layout.lines(seen[1] - seen[0])
    assert abs(lines[3, 5]) == pytest.approx(1e-3)
    assert np.abs(lines).sum() == pytest.approx(1e-3, rel=1e-6)


def test_the_truth_comes_back_from_json() -> None:
    case = replace(
        HIDDEN,
        effects=(*HIDDEN.effects, OUTSIDE[1](0.01, 1.0)),
        alteration=Alteration(exponent=0.2),
        stray=StrayOrder(2, 5, 1e-3, 0.1),
        strengths=(400.0, 3000.0),
        taken_out=("cam_form",),
    )
    assert from_json(json.loads(json.dumps(as_json(case)))) == case


def test_units_lie_within_what_the_loop_declares() -> None:
    nominal, deviations = of_unit(GEAR), []
    for seed in range(12):
        unit = Model(unit_of(seed, SETTING))
        deviations.append([(p.value(unit) - p.value(Model(GEAR))) / p.sd for p in nominal.values()])
    assert 0.3 < np.std(deviations) < 1.0
    assert (np.std(deviations, axis=0) < 1.5).all()


def test_a_size_is_found_that_has_the_strength(fitted: Fitted) -> None:
    for kind in (LIBRARY["eccentric_wave_generator"], LIBRARY["mains_hum"]):
        effect, strength = sized(drawn_inner(kind, generator("sized")), 100.0, fitted)
        assert strength == pytest.approx(100, rel=0.2)
        assert strengths([effect], [kind], fitted)[0] == pytest.approx(strength, rel=1e-6)


def test_a_parameter_within_its_spread_is_not_strong_as_its_law_is_curved(fitted: Fitted) -> None:
    """A drop of k1 by 15 % is 1.5 standard deviations of a unit never seen, whatever its second derivative is."""
    dropped = LIBRARY["reduced_stiffness"](0.85)
    assert 0.5 < strengths([dropped], [type(dropped)], fitted)[0] < 1.1 * 1.5**2
    assert sized(dropped, 1.0, fitted)[1] == pytest.approx(1.0, rel=0.1)


def test_beside_a_law_that_is_straight_fitting_is_projecting(fitted: Fitted) -> None:
    balanced = LIBRARY["zero_offset"](1, 0.01)
    seen = predict([fitted.model, fitted.model.plus(balanced)], fitted.measured.situations, fitted.measured.layout)
    white = fitted.whole.whiten(fitted.measured.rows(seen[1] - seen[0]))
    assert strengths([balanced], [type(balanced)], fitted)[0] == pytest.approx(white @ white, rel=1e-3)


def test_the_prediction_where_nothing_was_recorded(fitted: Fitted) -> None:
    truth = unseen(SHORT, SETTING, fitted.measured.layout)
    assert unseen_error(fitted, expected(fitted)) == pytest.approx(0, abs=1e-9)
    wrong = truth + 0.05 * np.abs(truth)
    assert unseen_error(fitted, truth) < 0.5 * unseen_error(fitted, wrong)


def test_the_zero_of_a_session_is_expected_where_nothing_was_recorded(fitted: Fitted) -> None:
    layout = fitted.measured.layout
    off = 0.3 * ((layout.channel == "T_out") & (layout.order == 0))
    moved = replace(fitted, measured=replace(fitted.measured, values=fitted.measured.values + off))
    change = expected(moved) - expected(fitted)
    assert change[:, off > 0] == pytest.approx(0.3, rel=0.2)
    assert np.abs(change[:, layout.channel == "s1"]).max() < 1e-3


def test_zeros_of_bridges_balanced_anew_are_expected_there_too(fitted: Fitted) -> None:
    layout = fitted.measured.layout
    off = 0.06 * ((layout.channel == "s1") & (layout.order == 0))
    anew = fitted.with_zeros(16.0)
    moved = replace(anew, measured=replace(anew.measured, values=anew.measured.values + off))
    change = expected(moved) - expected(anew)
    assert change[:, off > 0] == pytest.approx(0.06, rel=0.2)
    assert np.abs(change[:, layout.channel == "s2"]).max() < 2e-3


def test_what_is_unseen_has_the_flanges_of_the_session_in_question() -> None:
    sure = replace(SETTING, bench=replace(SETTING.bench, flange_in_bias=0.0, flange_out_bias=0.0))
    layout = Layout(("T_in", "T_out", "s1"))
    recorded = [Measured.of(in_question(SHORT, each, ())) for each in (SETTING, sure)]
    off = recorded[0].values - recorded[1].values
    seen = unseen(SHORT, SETTING, layout) - unseen(SHORT, sure, layout)
    for channel in layout.channels:
        mean, all_of_it = ((each.channel == channel) & (each.order == 0) for each in (recorded[0].layout, layout))
        np.testing.assert_allclose(seen[:, all_of_it], off[:, mean], atol=1e-9)
    assert np.abs(seen[:, layout.order > 0]).max() < 1e-12


def _task(residual_of: int | None, projected_away: bool = False) -> Task:
    """Twelve signatures, of which one is in the residual, or none."""
    rng = generator("baselines")
    fitted = fitted_to(Layout(("s1", "s2")), rng, open_=2)
    kinds = [kind for kind in SEARCHED if searched(kind)][:12]
    signatures = [10 * rng.standard_normal((len(fitted.from_start), 1)) for _ in kinds]
    residual = drawn(fitted.errors, rng)
    if residual_of is not None:
        residual = residual + signatures[residual_of][:, 0]
    found = [Hypothesis(kind, (), 1) for kind in kinds]
    return Task(found, signatures, holding(fitted, residual))


@pytest.mark.parametrize("name", ["correlation", "bic_forward", "sparse_regression"])
def test_baselines_name_what_stands_out(name: str) -> None:
    task = _task(7)
    assert baselines.BASELINES[name](task)[0] == task.found[7].kind.name()


def test_baselines_name_nothing_that_no_channel_shows() -> None:
    task = _task(7)
    nothing = np.zeros_like(task.signatures[0])
    assert baselines.correlation(task._replace(signatures=[nothing] * len(task.found))) == []


def test_baselines_name_nothing_of_a_library_without_a_signature(fitted: Fitted) -> None:
    """The phase of a hum is another one in every recording."""
    named = baselines.named_by_baselines(fitted, (LIBRARY["mains_hum"],))
    assert named == {key: [] for key in baselines.BASELINES}


@pytest.mark.parametrize("name", ["calibration_only", "correlation", "bic_forward"])
def test_baselines_name_nothing_in_noise(name: str) -> None:
    assert baselines.BASELINES[name](_task(None)) == []


def test_medians_have_the_interval_of_a_bootstrap() -> None:
    values = generator("median").normal(1, 0.1, 200).tolist()
    found = median(values)
    assert found["low"] < found["value"] < found["high"]
    assert found["high"] - found["low"] == pytest.approx(2 * 1.96 * 1.25 * 0.1 / np.sqrt(200), rel=0.5)


def test_a_family_holds_effects_of_the_library_and_no_effect_twice() -> None:
    members = [name for family in FAMILIES.values() for name in family]
    assert len(set(members)) == len(members)
    assert set(members) <= set(LIBRARY)


@pytest.mark.parametrize(
    ("case", "changes", "cause"),
    [
        (HIDDEN, {}, RIGHT),
        (HIDDEN, {"accepted": ["out_of_round"]}, "right one is a rival"),
        (HIDDEN, WRONG, "wrong effect named"),
        (HIDDEN, ONE_MORE, "right, with a false extra effect"),
        (HIDDEN, MISSED, "missed"),
        (HIDDEN, {"failure": "it broke"}, "no answer"),
        (HIDDEN, {**CALLED_UNKNOWN, "nearest": ["cam_form"]}, "called unknown, the right one nearest"),
        (HIDDEN, {**CALLED_UNKNOWN, "nearest": ["coning"]}, "called unknown, coning nearest"),
        (HIDDEN, CALLED_UNKNOWN, "called unknown, no effect nearest"),
        (replace(CASE, stratum="easy null"), {}, "false effect"),
        (replace(HIDDEN, stratum=UNTESTABLE), {}, RIGHT),
        (replace(HIDDEN, stratum=UNTESTABLE), MISSED, RIGHT),
        (replace(HIDDEN, stratum=UNTESTABLE), ONE_MORE, "false effect"),
        (replace(CASE, stratum="hard null"), MISSED, RIGHT),
        (replace(HIDDEN, stratum="taken out"), {}, "known effect named for an unknown one"),
        (replace(HIDDEN, stratum="taken out", likeness=0.95), {}, "look-alike named for an unknown effect"),
        (replace(HIDDEN, stratum="written"), CALLED_UNKNOWN, RIGHT),
    ],
)  # fmt: skip
def test_what_went_wrong_is_said(case: Sealed, changes: dict, cause: str) -> None:
    judged = ScoredCase(case, {**SAID, **changes})
    assert judged.cause == cause
    assert judged.right == (cause == RIGHT)
    assert judged.why.startswith(case.stratum)
    told = "log-likelihood +1,400.0, with the true model +1,413.5" in judged.why
    assert told == bool(case.effects and not judged.failed)


def test_how_likely_the_true_model_is_goes_unsaid_where_it_is_random() -> None:
    """Lines between the orders are in no fit."""
    case = replace(HIDDEN, effects=(*HIDDEN.effects, LIBRARY["mains_hum"](1e-3)), strengths=(3000.0, 400.0))
    assert "log-likelihood" not in ScoredCase(case, SAID).why


@pytest.mark.parametrize(("orders", "which"), [((10, 3), 1), ((3, 10), 0), ((10,), 0), ((), None)])
def test_another_order_of_a_kind_is_another_effect(orders: tuple[int, ...], which: int | None) -> None:
    """Unless nothing else was found for it."""
    pickup = LIBRARY["motor_pickup"]
    assert attempt._found_as(pickup(3, 0.01), [pickup(p, 0.002) for p in orders]) == which


@pytest.mark.parametrize("law", [None, Alteration(exponent=0.2)])
def test_the_true_size_is_the_one_that_there_was(monkeypatch: pytest.MonkeyPatch, law: Alteration | None) -> None:
    """An effect that is seen at one operating point only, which has another size at each."""
    after = fitted_to(Layout(("T_in", "s1")), np.random.default_rng(1))
    case, true = replace(HIDDEN, alteration=law), HIDDEN.effects[0]
    for seen, point in zip(after.measured.point_rows(), after.measured.situations, strict=True):
        monkeypatch.setattr(attempt, "signature", lambda _, number, seen=seen: {0: 2.0 * seen}[number])
        there = resized(true, law.factor(point.point)).amplitude if law else true.amplitude
        assert attempt._acted(true, case, after, 0) == pytest.approx(there, rel=1e-9)


def test_the_true_size_is_weighed_by_how_much_is_seen_of_it(monkeypatch: pytest.MonkeyPatch) -> None:
    """By its square over the variance of the noise."""
    after, case = fitted_to(Layout(("T_in",)), np.random.default_rng(1)), replace(HIDDEN, alteration=Alteration(0.2))
    (first, second), points = after.measured.point_rows()[:2], [s.point for s in after.measured.situations]
    deviation = np.sqrt(after.errors.variance)
    monkeypatch.setattr(attempt, "signature", lambda *_: (first + 2.0 * second) * deviation)
    sizes = [resized(HIDDEN.effects[0], case.alteration.factor(point)).amplitude for point in points[:2]]
    expected = np.average(sizes, weights=[1, 4])
    assert attempt._acted(HIDDEN.effects[0], case, after, 0) == pytest.approx(expected, rel=1e-9)


def test_a_mean_has_the_real_part_of_a_pattern_only() -> None:
    turning = OUTSIDE[2].described.pattern
    unknown = {**SAID, **CALLED_UNKNOWN}
    leaning = replace(HIDDEN, stratum="written", effects=(OUTSIDE[5](0.01, 1.0),))
    atom = OUTSIDE[5].described
    assert ScoredCase(leaning, {**unknown, "unknown": [[0, turning, atom.law]]}).described == (True, True, True)
    assert ScoredCase(leaning, {**unknown, "unknown": [[3, "in s1 alone", atom.law]]}).described == (False, False, True)
    wobbling = replace(HIDDEN, stratum="written", effects=(OUTSIDE[2](0.01, 1.0),))
    said = ScoredCase(wobbling, {**unknown, "unknown": [[3, atom.pattern, "constant"]]})
    assert said.described == (True, False, False)


def test_the_score_counts_what_it_says() -> None:
    null = replace(CASE, stratum="easy null")
    quiet = {**MISSED, **dict.fromkeys(INTERVALS, ())}
    written = replace(HIDDEN, stratum="written", effects=(OUTSIDE[0](0.01, 1.0),))
    unknown = {**quiet, **CALLED_UNKNOWN}
    cases = [
        ScoredCase(HIDDEN, {**SAID, "seconds": {"loop": 7.0, "loop_of_one_core": 4.0}}),
        ScoredCase(HIDDEN, {**SAID, **WRONG, **dict.fromkeys(INTERVALS, ())}),
        ScoredCase(replace(HIDDEN, strengths=(60.0,)), {**SAID, **quiet}),
        ScoredCase(null, {**SAID, **quiet}),
        ScoredCase(null, SAID),
        ScoredCase(null, {"failure": "it broke"}),
        ScoredCase(written, {**SAID, **unknown, "unknown": [[1, "in s4 alone", "constant"]]}),
        ScoredCase(written, {**SAID, **dict.fromkeys(INTERVALS, ({"true": 1.0, "found": 2.0, "deviation": 0.1},))}),
        ScoredCase(HIDDEN, {"failure": "it broke"}),
    ]
    found = score(cases)
    promised = {"mean_set_size", "after_over_oracle_median", "worse_than_before", "peak_memory_mib", "baselines"}
    assert promised <= set(found)
    assert found["cases"] == 9
    assert found["failures"] == 2
    # A null without an answer names nothing false, nor does it count for that.
    assert (found["false_effect_rate"]["value"], found["nulls"]) == (0.5, 3)
    # The weak one is none that has to be found; a failure is.
    assert (found["right_first"]["value"], found["right_first"]["count"]) == (pytest.approx(1 / 3), 3)
    assert found["mean_set_size"] == 1.5
    assert found["none_of_the_above_recall"]["value"] == 0.5
    assert [found["unknown_described"][part]["value"] for part in ("order", "pattern", "law", "all")] == [
        0.5,
        0.5,
        0,
        0,
    ]
    # An angle a little below a whole turn lies beside one a little above none.
    assert [found[kind]["value"] for kind in ("coverage95", "coverage95_of_angles")] == [2 / 3, 2 / 3]
    assert found["baselines"]["correlation"]["false_effect_rate"]["value"] == 1
    assert found["confusion"]["cam_form"] == {"cam_form": 1, "out_of_round": 1, "nothing": 1, "failure": 1}
    assert [case.failed for case in worst(cases)] == [True, True, False, False, False]
    assert (found["seconds_max"], found["seconds_median"]) == (7.0, 5.0)
    json.dumps(found, allow_nan=False)


def test_probabilities_are_compared_with_the_share_of_right_answers() -> None:
    """Eight of ten right where 0.9 was said, and one of two where 0.6 was said."""
    said = [(0.9, {})] * 8 + [(0.9, WRONG)] * 2 + [(0.6, {}), (0.6, WRONG)]
    found = score([ScoredCase(HIDDEN, {**SAID, **changes, "probability": p}) for p, changes in said])
    assert [(each["stated"], each["right"]["value"], each["right"]["count"]) for each in found["reliability"]] == [
        (pytest.approx(0.6), 0.5, 2),
        (pytest.approx(0.9), 0.8, 10),
    ]
    assert found["expected_calibration_error"] == pytest.approx(0.1)
    assert (found["right_of_sure"]["value"], found["right_of_sure"]["count"]) == (0.8, 10)
    assert score([ScoredCase(HIDDEN, {"failure": "it broke"})])["expected_calibration_error"] is None


def test_cases_count_as_often_as_the_prior_expects_them() -> None:
    """Two healthy gears have the probability of one together; so has what is outside the library."""
    healthy, outside = replace(HIDDEN, stratum=NULLS[0], effects=()), replace(HIDDEN, stratum=WRITTEN)
    pair = replace(HIDDEN, effects=HIDDEN.effects * 2)
    weights = as_in_prior([ScoredCase(each, SAID) for each in (healthy, healthy, HIDDEN, outside, pair)])
    rate = -np.log(0.8)
    expected = [0.4, 0.4, 0.8 * rate * 0.9, 0.8 * rate * 0.1, 0.8 * rate**2 / 2 * 0.9**2]
    assert weights == pytest.approx(expected)


def test_a_weighted_calibration_error_is_that_of_repeated_cases() -> None:
    """A case of weight 3 counts like three of them."""
    right, wrong = (ScoredCase(HIDDEN, {**SAID, **changes, "probability": 0.6}) for changes in ({}, WRONG))
    weighted = calibration_error([right, wrong], np.array([3.0, 1.0]))
    assert weighted == pytest.approx(calibration_error([right] * 3 + [wrong])) == pytest.approx(0.15)


@pytest.mark.parametrize("order", [3, 5])
def test_angles_are_judged_of_what_was_chosen_alike(fitted: Fitted, order: int) -> None:
    """The phase of another order is another thing."""
    found = LIBRARY["cam_form"](order, 2.1e-6, 0.9)
    after = replace(fitted, calibrated=replace(fitted.calibrated, model=fitted.model.plus(found)))
    decision = Decision(fitted, after, option(fitted, (), (), 1), (), (), ())
    decision.__dict__["deviation"] = {"cam form 1: amplitude": 1e-7, "cam form 1: phase": 0.2}
    sizes, angles = attempt._intervals(Answer(decision, (), (), (), (), ()), HIDDEN)
    assert sizes == [{"name": "cam_form", "true": 2e-6, "found": 2.1e-6, "deviation": 1e-7}]
    assert angles == ([{"name": "cam_form", "true": 1.0, "found": 0.9, "deviation": 0.2}] if order == 3 else [])


def test_the_true_model_is_likelier_than_an_answer_that_names_nothing() -> None:
    hidden = replace(SHORT, effects=(LIBRARY["cam_form"](3, 2e-5, 1.0),), strengths=(3e5,))
    unit = Unit(Model(GEAR))
    before = fit(Measured.of(in_question(hidden, SETTING, hidden.acting)), unit)
    answer = Answer(Decision(before, before, option(before, (), (), 1), (), (), ()), (), (), (), (), ())
    said = attempt._against_truth(answer, unit, hidden, SETTING)
    likely = said["log_likelihood"]
    assert likely["before"] == likely["after"] == before.log_likelihood
    assert likely["oracle"] > before.log_likelihood + 100


def test_an_angle_that_may_be_any_is_not_counted() -> None:
    angles = [{"true": 1.0, "found": 1.2, "deviation": deviation} for deviation in (0.2, 0.05, 2.0)]
    covered = score([ScoredCase(HIDDEN, {**SAID, "angles": angles})])["coverage95_of_angles"]
    assert (covered["value"], covered["count"]) == (0.5, 2)


def test_worse_predictions_are_told_from_those_of_the_true_model() -> None:
    """Worse by the loop alone, by both, and by neither, within a few per cent."""
    errors = [(1.0, 1.2, 1.0), (1.0, 1.2, 1.2), (1.0, 1.04, 1.04), (1.0, 0.5, 1.2)]
    weak = replace(HIDDEN, strengths=(60.0,))
    cases = [
        ScoredCase(case, {**SAID, "error": {"before": before, "after": after, "oracle": oracle}})
        for case, (before, after, oracle) in zip((HIDDEN, weak, HIDDEN, HIDDEN), errors, strict=True)
    ]
    found = score(cases)
    assert (found["worse_than_before"]["value"], found["worse_than_before"]["count"]) == (0.5, 4)
    of_detectable = found["worse_than_before_of_detectable"]
    assert (of_detectable["value"], of_detectable["count"]) == (pytest.approx(1 / 3), 3)
    with_truth = found["worse_with_the_true_model_too"]
    assert (with_truth["value"], with_truth["count"]) == (0.5, 2)


def test_of_one_operating_point_there_is_no_error_held_out() -> None:
    """Worse, within a few per cent, and not to be had."""
    heldout = [(1.0, 1.2), (1.0, 1.04), (None, None)]
    cases = [ScoredCase(HIDDEN, {**SAID, "heldout": {"before": before, "after": after}}) for before, after in heldout]
    found = score(cases)["worse_where_recorded"]
    assert (found["value"], found["count"]) == (0.5, 2)


@pytest.mark.parametrize(
    ("said", "told"),
    [
        ({"seen_from": {"cam_form": 3e-6}}, True),
        ({"seen_from": {"cam_form": 1e-6}}, False),
        ({"seen_from": {"cam_form": None}}, True),  # of no size
        ({"seen_from": {}}, False),
        ({"seen_from": {}, "absorbed": ["cam_form"]}, True),
    ],
)
def test_what_is_untestable_is_told_if_it_would_not_have_been_seen(said: dict[str, Any], told: bool) -> None:
    """A cam form of 2 um."""
    case = ScoredCase(replace(HIDDEN, stratum=UNTESTABLE), {**SAID, **said})
    assert case.reported_untestable == told
    assert score([case])["untestable_told"]["value"] == told


def _words(folder: Path) -> list[str]:
    """Choices of a small set."""
    words = [f"blind={folder}/set", f"report={folder}/report", "workers=1", "seed=3", "cases=3", "revolutions=4"]
    return [*words, "sectors=[60]", f"library=[{','.join(FEW)}]"]


def _config(folder: Path, **changes: object) -> dict:
    with initialize_config_dir(str(CONF.resolve()), version_base="1.3"):
        config = OmegaConf.to_container(compose("blind", _words(folder)), resolve=True)
    return {**config, **changes}


def test_a_set_is_sealed_once_and_a_killed_run_goes_on(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[int] = []
    monkeypatch.setattr(job, "draw", lambda plan, setting: replace(HIDDEN, number=plan.number))
    monkeypatch.setattr(job, "attempt", lambda case, setting: asked.append(case.number) or SAID)
    found = job.run(_config(tmp_path))
    assert asked == [0, 1, 2]
    assert json.loads((tmp_path / "report" / "blind.json").read_text()) == json.loads(json.dumps(found))
    (tmp_path / "set" / "answers" / "0001.json").unlink()
    assert job.run(_config(tmp_path)) == found
    assert asked == [0, 1, 2, 1]
    with pytest.raises(ValueError, match="other settings"):
        job.run(_config(tmp_path, cases=4))
    truth = tmp_path / "set" / "truth.json"
    truth.write_text(truth.read_text().replace("cam_form", "coning"))
    with pytest.raises(ValueError, match="changed after it was sealed"):
        job.run(_config(tmp_path))


def test_a_loop_that_breaks_down_is_counted(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(case: Sealed, setting: Setting) -> dict:
        raise ValueError("it broke")

    monkeypatch.setattr(job, "draw", lambda plan, setting: replace(HIDDEN, number=plan.number))
    monkeypatch.setattr(job, "attempt", broken)
    assert job.run(_config(tmp_path))["failures"] == 3
