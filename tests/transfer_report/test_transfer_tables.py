"""Tables, sentences and figures of the transfer report follow from the numbers, whatever these are."""

import json
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from fabricated import recordings
from fabricated_transfer import adapted, predictions

from learn.evaluation.bootstrap import specimens
from learn.transfer_report import confidence, figures, sentences, studies, tables, transfer_study
from learn.transfer_report.runs import method_of
from swgsim.storage import storage
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
        return errors[["gear", "label", "variant"]].assign(shots=shots, error=error, unadapted=before)

    scratch = pd.concat([table(5, after + 5), table(10, after - 0.5)])
    both = pd.concat([table(5, after), table(10, after)])
    return tables.few_shot(errors, {"MLP: replay": both, "MLP: from scratch": scratch})


def test_main_table_compares_with_forest_and_oracle():
    errors, zero = zero_of(9.0)
    assert tables.best_of(zero) == tables.highest(zero["development"]) == BEST
    assert zero.loc[BEST, "ratio"] == pytest.approx(9.1 / 30.1, abs=1e-3)
    assert zero.loc[BEST, "oracle"] == pytest.approx(9.1 / 5.1, abs=1e-3)
    text = tables.methods_text(zero, errors)
    assert text.loc[BEST, "better in gears"] == "6 of 6"
    assert text.loc[BEST, "error on development gears [%]"] == "10.0"
    assert text.loc[tables.FOREST, "p (Holm)"] == text.loc[tables.ORACLE, "p (Holm)"] == "-"
    wide = tables.representations_text(zero)
    assert wide.loc["logistic regression", "harmonics"].startswith("9.1 (")
    assert wide.loc["random forest", "harmonics"] == "-"
    assert wide.loc["oracle", "all that is known"].startswith("5.1 (")
    with pytest.raises(ValueError, match="classifier=rf features=selection_1"):
        tables.zero_shot(errors.drop(columns=tables.FOREST), pd.Series(dtype=float), pd.Series(dtype=float))


def test_few_gears_have_no_interval_in_table_figure_and_json():
    errors, zero = zero_of(9.0, gears=3)
    few = few_of(errors, 5.0)
    assert tables.methods_text(zero, errors).loc[BEST, "error [%]"] == "9.1"
    inputs = pd.DataFrame({"input": ["raw"], "method": ["cnn"], "efficiency": [True], "value": [12.0]})
    content = transfer_study.content_of(zero, few, inputs, CASES, 3, 1.0)
    assert content["z1"]["ci95"] == [None, None]
    assert content["inputs"]["raw"] == {"mlp": None, "cnn": 12.0, "minirocket": None}
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


def map_runs(**columns):
    rows = pd.DataFrame({"classifier": "perceptron", "features": "harmonics", "adaptation": "replay",
                         "protocol.sources": "2", "features.acquisitions": "1", **columns})  # fmt: skip
    return rows.assign(method=[method_of(row) for row in rows.to_dict("records")])


def test_map_separates_gain_from_harm():
    gain, harm = adapted(0.05, 0.2, (5,))[0], adapted(1.5, 0.2, (5,))[0]
    table = studies.transfer_map(map_runs(target=["far-bench", "few-bench"]), {"0": gain, "1": harm}, {})
    where = ("gears far outside the sources", "other gears of the sources' population")
    assert list(table["scenario"]) == [f"{target}: 2 source gears, 1 reference acquisition" for target in where]
    assert list(studies.map_text(table)["pays"]) == studies.verdicts(table) == ["yes", "harms"]
    assert studies.verdicts(table.assign(method="MLP: from scratch")) == ["-", "-"]
    assert studies.verdicts(table.assign(low=-1.0, high=1.0)) == ["not clearly"] * 2
    assert studies.verdicts(table.assign(low=np.nan, high=np.nan)) == ["too few gears"] * 2
    assert "pays in 1 of 2 cases" in studies.map_sentence(table)
    assert "was not run in these scenarios" in studies.map_sentence(table)
    assert is_png(figures.benefit(table))


def test_map_names_the_best_method_without_adaptation():
    plain = map_runs(target="few-bench", classifier=["rf", "extra_trees", "rf"], adaptation="none")
    wrong = {"0": (0.5, "worse"), "1": (0.0, "better"), "2": (0.0, "outdated")}
    errors = {key: specimens(predictions(*each)) for key, each in wrong.items()}
    best = studies.best_unadapted(plain, errors)
    table = studies.transfer_map(map_runs(target=["few-bench"]), {"0": adapted(0.05, 0.2, (5,))[0]}, best)
    assert list(table["reference"]) == ["extra trees on harmonics (of 2)"]
    assert table["best_low"].item() > 0 > table["high"].item()
    assert "better in 0 of 1 cases and clearly worse in 1." in studies.map_sentence(table)


def test_inputs_are_compared_with_and_without():
    runs = pd.DataFrame({"method": ["MLP on raw signals"] * 2})
    errors = {"0": specimens(predictions(0.1, "with")), "1": specimens(predictions(0.6, "without"))}
    (row,) = studies.without_text(runs[:1], runs[1:], errors).to_numpy()
    assert float(row[0]) < float(row[1])
    assert float(row[2].split()[0]) == pytest.approx(float(row[1]) - float(row[0]), abs=0.11)


def test_prediction_sets_reach_their_target(monkeypatch):
    assert "6 gears are too few" in confidence.sets_text(predictions(0.1, "sets"))
    monkeypatch.setattr(confidence, "NOMINAL", 0.8)
    sets = confidence.conformal(predictions(0.1, "sets"))
    assert sets["coverage"].mean() >= 0.75
    assert sets["mean_size"].max() < len(CLASSES)


def test_a_single_gear_has_no_temperature():
    table = predictions(0.2, "one gear")
    one = table[table["gear"] == table["gear"].min()].reset_index(drop=True)
    text = confidence.calibration_text({"all": table, "one": one})
    assert list(text.loc["one"])[2:5] == ["-", "-", "-"]
    assert " to " in text.loc["all", "temperatures"]
    both = {"all": table, "one": one}
    assert is_png(figures.confidence(confidence.reliabilities(both), confidence.risk_curves(both)))


def test_detection_has_a_size_or_a_reason():
    table = predictions(0.0, "missed")
    p = table[list(CLASSES)].to_numpy(copy=True)
    small = (table["label"] == "tip_tooth_crack") & (table["severity"] < 0.4) & (table["gear"] % 3 < 2)
    p[small] = np.eye(len(CLASSES))[0]
    text = confidence.detection_text(table.assign(**dict(zip(CLASSES, p.T, strict=True))))
    assert text.loc["reduced damping", "detected [%]"] == "100.0"
    assert "a90: below the smallest size tried" in text.loc["reduced damping", "reason without a size"]
    assert 0.1 < float(text.loc["tip tooth crack", "a90"]) < 0.9


def gears_with(folder, name, gain, gears=8):
    """A data set whose signals are scaled."""
    made = recordings(gears=gears, variants=1, disturbance=1e-3)
    storage.write(folder / f"{name}.h5", [replace(made, signals=made.signals * np.float32(gain))], len(made))
    return folder / f"{name}.h5"


def test_novelty_separates_gears_of_another_population(tmp_path):
    bench, far = gears_with(tmp_path, "a", 1.0), gears_with(tmp_path, "b", 1.5, gears=3)
    errors = pd.Series([5.0, 9.0, 7.0], [1, 2, 3])
    usual, foreign = confidence.novelty(bench, far, errors)
    assert list(usual.index) == [1, 2, 3]
    assert (foreign > 3 * usual["novelty"].max()).all()
    text = confidence.novelty_text((usual, foreign), "any method")
    assert "the 3 gears of grid=far" in text
    assert "3 of them exceed" in text
    assert "(AUROC) of 1.00" in text
    assert "no comparison" in confidence.novelty_text(confidence.novelty(bench, tmp_path / "none", errors), "any")
    assert confidence.novelty(far, bench, errors) is None
    for order, verdict in ((usual["novelty"], " correlates"), (-usual["novelty"], " does not clearly correlate")):
        assert verdict in confidence.novelty_text((usual.assign(error=order), None), "any method")


def is_png(png):
    return png[:8] == b"\x89PNG\r\n\x1a\n" and len(png) > 10_000
