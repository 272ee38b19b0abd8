"""Tables, sentences and figures of the transfer report follow from the numbers, whatever these are."""

import json

import numpy as np
import pandas as pd
import pytest
from fabricated_transfer import predictions

from learn.transfer_report import confidence, detections, figures, sentences, studies, tables, transfer_json, twins
from swgsim.storage.labelled_signals import CLASSES

CASES = pd.DataFrame([[90.0] * 3, [80.0] * 3, [100.0, 99.6, 99.4], [100.0, 100.0, 60.0]],
                     index=[studies.PUBLISHED, studies.DISTURBED_FOREST, "x on lines", "y on lines"])  # fmt: skip


BEST = "logistic regression on harmonics"


def errors_of(gears=6, **methods):
    """Nearly constant errors of methods on two specimens of every gear."""
    rows = [(gear, "healthy", variant) for gear in range(gears) for variant in range(2)]
    table = pd.DataFrame(rows, columns=["gear", "label", "variant"])
    return table.assign(**{name: value + 0.1 * np.arange(len(rows)) % 0.3 for name, value in methods.items()})


def zero_of(best, forest=30.0, oracle=5.0, gears=6):
    """Errors of specimens and the main table."""
    errors = errors_of(gears, best=best, forest=forest, oracle=oracle, second=oracle).rename(
        columns={"best": BEST, "forest": tables.FOREST, "second": tables.ORACLE_OF_SESSION}
    )
    names = [BEST, tables.FOREST]
    zero = tables.zero_shot(errors, pd.Series([90.0, np.nan], names), pd.Series(1.0, names))
    return errors, zero.assign(seeds=1.0, spread=np.nan)


def few_of(errors, after, before=10.0):
    """Replay errs in `after`, training from scratch in 5 more with five shots and in 0.5 less with ten."""

    def table(shots, error):
        return errors[["gear", "label", "variant"]].assign(shots=shots, error=error, unit=error / 2, unadapted=before)

    scratch = pd.concat([table(5, after + 5), table(10, after - 0.5)])
    both = pd.concat([table(5, after), table(10, after)])
    return tables.few_shot(errors, {"MLP: replay": both, "MLP: from scratch": scratch})


def test_main_table_compares_with_forest_and_oracle():
    errors, zero = zero_of(9.0)
    assert tables.best_of(zero) == tables.highest(zero["development"]) == BEST
    assert zero.loc[BEST, "ratio"] == pytest.approx(9.1 / 30.1, abs=1e-3)
    assert zero.loc[BEST, "oracle"] == pytest.approx(9.1 / 5.1, abs=1e-3)
    text = tables.methods_text(zero, errors, zero)
    assert text.loc[BEST, "better in gears"] == "6 of 6"
    assert text.loc[BEST, "error on development gears [%]"] == "10.0"
    assert text.loc[tables.FOREST, "p (Holm)"] == text.loc[tables.ORACLE, "p (Holm)"] == "-"
    with pytest.raises(ValueError, match="classifier=rf features=selection_1"):
        tables.zero_shot(errors.drop(columns=tables.FOREST), pd.Series(dtype=float), pd.Series(dtype=float))


def test_few_gears_have_no_interval_in_table_figure_and_json():
    errors, zero = zero_of(9.0, gears=3)
    few = few_of(errors, 5.0)
    assert tables.methods_text(zero, errors, zero).loc[BEST, "error [%]"] == "9.1"
    content = transfer_json.content(zero, zero, few, CASES, 3, 1.0)
    assert content["z1"]["ci95"] == [None, None]
    json.dumps(content, allow_nan=False)
    assert is_png(figures.errors(zero))
    assert is_png(figures.shots(few, dict.fromkeys(("forest", "best", "oracle"), 30.0)))


def test_sentence_compares_shots_with_no_label():
    errors, zero = zero_of(9.0)
    development = pd.Series({"MLP: replay": 95.0})
    worse = sentences.with_shots(zero, few_of(errors, 10.0), development)
    assert "MLP: replay errs in 10.0 % (10.0 to 10.0), not below the 9.1 % of logistic regression" in worse
    assert "The development gears select MLP: replay" in worse
    assert ", below the 9.1 %" in sentences.with_shots(zero, few_of(errors, 4.0), development)
    assert sentences.with_shots(zero, few_of(errors, 4.0).query("shots == 10"), development) == ""


def test_sentence_counts_the_gears_for_which_faults_are_worth_more_than_healthy_specimens():
    errors, _ = zero_of(9.0)
    few = few_of(errors, 4.0)
    rezero = f"extra trees{tables.REZERO}"
    both = pd.concat([few, few.assign(method=rezero)])
    of_gears = pd.DataFrame({"gear": [1, 2, 3], "shots": 5, "error": [1.0, 4.0, 2.0]})
    gears = {"MLP: replay": of_gears, rezero: of_gears.assign(error=3.0)}
    assert sentences.beside_rezero(both, gears) == (
        "For 2 of 3 gears MLP: replay with 5 labelled variants of each class errs less than extra trees with 5 healthy "
        "ones alone."
    )
    assert sentences.beside_rezero(few, gears) == ""


def test_sentence_on_the_choice_gives_its_cost():
    _, zero = zero_of(9.0)
    assert "with 9.1 %, the same method" in sentences.choice(zero)
    other = zero.assign(development=pd.Series({tables.FOREST: 99.0}))
    assert f"select {tables.FOREST} with 30.1 %, 21.0 points more" in sentences.choice(other)
    assert sentences.choice(zero.assign(development=np.nan)) == ""


def test_forgetting_is_that_of_methods_with_source_gears_at_any_number_of_shots():
    table = pd.DataFrame({"shots": [5, 10, 5], "forgotten": [1.0, 2.5, 3.0]})
    text = tables.forgetting_text({"MLP: replay": table, "MLP: from scratch": table})
    assert text.to_dict("index") == {"MLP: replay": {"K = 5": "+2.0", "K = 10": "+2.5", "worst gear": "+3.0"}}
    assert tables.forgetting_text({"MLP: replay": table.assign(forgotten=np.nan)}) is None


def test_disturbed_data_are_solved_by_the_best_worst_case():
    assert studies.best_disturbed(CASES) == "x on lines"
    assert "x on lines recognises 100.0 / 99.6 / 99.4 %" in sentences.disturbed(CASES)
    assert "90.0 / 90.0 / 90.0 % in the paper and 80.0 / 80.0 / 80.0 % here" in sentences.disturbed(CASES)


def test_shots_are_columns_and_all_labels_are_z4():
    errors, _ = zero_of(9.0)
    wide = tables.shots_text(few_of(errors, 4.0), "gain", 10, {"MLP: replay": " (trained on 5 variants)"})
    assert list(wide.columns) == ["source model [%]", "K = 5", "K = 10 (Z4)"]
    assert wide.loc["MLP: replay (trained on 5 variants)", "K = 5"] == "-6.0 (-6.0 to -6.0)"


def test_prediction_sets_reach_their_target_in_every_class(monkeypatch):
    table = predictions(0.1, "sets")
    assert "6 gears are too few" in confidence.sets_text(table, "recordings")
    monkeypatch.setattr(confidence, "NOMINAL", 0.8)
    # Tip cracks get a low probability wherever they are, so that one threshold for all classes would leave them out.
    p = table[list(CLASSES)].to_numpy(copy=True)
    p[table["label"] == "tip_tooth_crack", -1] /= 5
    table[list(CLASSES)] = p / p.sum(axis=1, keepdims=True)
    sets = confidence.conformal(table)
    assert sets.groupby("label")["covered"].mean().min() >= 0.75
    assert sets["size"].mean() < len(CLASSES)
    assert "the true class is in the set of" in confidence.sets_text(table, "units")


def test_a_single_gear_has_no_temperature():
    table = predictions(0.2, "one gear")
    one = table[table["gear"] == table["gear"].min()].reset_index(drop=True)
    text = confidence.calibration_text({"all": table, "one": one})
    assert list(text.loc["one"])[2:5] == ["-", "-", "-"]
    assert " to " in text.loc["all", "temperatures"]
    both = {"all": table, "one": one}
    assert is_png(figures.confidence(confidence.reliabilities(both), confidence.risk_curves(both)))


def test_detection_has_a_size_or_a_reason(monkeypatch):
    assert detections.detections("recordings", {"any": predictions(0.0, "few")}).empty
    monkeypatch.setattr(detections, "RATE", 0.05)  # fewer gears are made up than 1 % needs
    table = predictions(0.0, "missed")
    p = table[list(CLASSES)].to_numpy(copy=True)
    small = (table["label"] == "tip_tooth_crack") & (table["severity"] < 0.4) & (table["gear"] % 3 < 2)
    p[small] = np.eye(len(CLASSES))[0]
    found = detections.detections("recordings", {"any": table.assign(**dict(zip(CLASSES, p.T, strict=True)))})
    text = detections.detections_text(found)
    assert text.loc[("any", "recordings"), "reduced damping"] == "100 %; all sizes"
    json_of = detections.detections_json(found)["any"]["recordings"]
    assert json_of["reduced_damping"]["reason"].startswith("a90: below the smallest size tried")
    assert json_of["reduced_damping"]["a90_95"] is None
    assert 0.1 < json_of["tip_tooth_crack"]["a90"] < 0.9
    assert json_of["false_alarms"] < 10


def test_the_claim_has_figure_interval_and_conditions():
    errors, zero = zero_of(9.0)
    with_twin = zero.rename(index={BEST: twins.TWIN, tables.ORACLE: twins.FLOOR})
    ratio = twins.ratio_to_floor(errors.rename(columns={BEST: twins.TWIN, tables.ORACLE: twins.FLOOR}))
    text = sentences.claim(with_twin, with_twin, ratio, 6, 20)
    assert text.startswith("20 healthy recordings at each operating point identify a gear")
    assert "errs in 9.1 % (" in text
    assert "ratio 1.78 (" in text
    assert "Conditions: 6 simulated gears never seen" in text
    assert "ratio" not in sentences.claim(with_twin, with_twin, None, 6, 20)


def test_the_picture_has_a_place_for_everything_that_is_known():
    errors, zero = zero_of(9.0)
    few = few_of(errors, 4.0)
    rezero = few.assign(method=f"extra trees{tables.REZERO}", shots=2)
    nothing = pd.DataFrame({"value": 40.0, "low": 38.0, "high": 42.0, "unit": 30.0, "unit_low": 28, "unit_high": 32},
                           index=["CNN on raw signals"])  # fmt: skip
    with_twin = zero.rename(index={tables.ORACLE: twins.TWIN})
    session = nothing.iloc[0] / 20
    table = twins.known(with_twin, with_twin, pd.concat([few, rezero]), nothing, session)
    learned = table[table["who"] == twins.LEARNED]
    levels = ["nothing", "references", "references, 2 healthy of the day", "references, 5 of each fault"]
    assert learned["known"].tolist() == levels
    np.testing.assert_allclose(learned["value"], [40, 9.1, 3.5, 4], atol=0.1)
    of_twin = table[table["who"] == twins.TWIN].set_index("known")
    assert of_twin.index.tolist() == levels[1:3]
    assert of_twin.loc[levels[2], "value"] == 2.0
    assert is_png(figures.known(table))
    assert len(twins.known(zero, zero, few, nothing[:0], None)) == 2  # neither the twin, nor the day, nor nothing


def is_png(png):
    return png[:8] == b"\x89PNG\r\n\x1a\n" and len(png) > 10_000
