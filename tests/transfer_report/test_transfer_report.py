"""The transfer report from end to end on made-up runs, and its collection of runs."""

import json
import re
from pathlib import Path
from unittest.mock import ANY

import pandas as pd
import pytest
import yaml
from fabricated import recordings
from fabricated_transfer import POOLS, ROOT, Keeper, configured, keep_required, predictions, write_data
from prepared_store import prepared

from learn.inputs.residuals import ERRORS
from learn.jobs import settings
from learn.jobs.identity import code_version, flat
from learn.protocols.levels import NewGears
from learn.transfer_report import importance, seeds, tables, transfer_study
from learn.transfer_report import runs as transfer_runs
from learn.transfer_report.posteriors import OF_ORACLE, OF_TWIN, TWIN, mismatch, posteriors
from swgsim.common.version import code_version as version_of
from swgsim.storage import storage


@pytest.fixture(scope="module")
def data(tmp_path_factory):
    """Folder of the data sets and the digests."""
    folder = tmp_path_factory.mktemp("data")
    return folder, write_data(folder)


@pytest.fixture(scope="module")
def store(tmp_path_factory):
    """Folder of runs."""
    return prepared(tmp_path_factory.mktemp("runs"))


@pytest.mark.slow
@pytest.mark.end_to_end
def test_whole_report_from_made_up_runs(data, store, tmp_path):
    folder, digests = data
    out = tmp_path / "report"
    others = {"value": 12.5, "ci95": [2.2, 47.1], "count": 8, "healthy": 3, "healthy_called_faulty": 1,
              "something_else": 2}  # fmt: skip
    made = {"code": version_of("identification", "oracle", "twin"), "gears": []}
    (tmp_path / "others.json").write_text(json.dumps(others | made))
    config = configured(
        "transfer_report", f"data={folder}", f"tracking.folder={store}", f"out={out}",
        f"other_authors={tmp_path / 'others.json'}",
    )  # fmt: skip
    Keeper(store, {"gears-bench": "old"})("zero_shot", classifier="rf", features="selection_1")
    with pytest.raises(ValueError, match=r"study zero_shot on .* 'swg train experiment=zero_shot grid=gears"):
        transfer_study.run(config)
    keep_required(Keeper(store, digests), folder)

    transfer_study.run(config)

    content = json.loads((out / "transfer.json").read_text())
    z1 = content["z1"]
    assert z1["chosen_on_development_gears"] == "logistic regression on harmonics"
    assert z1["best_method"] == "twin on references"
    assert z1["ratio"] == pytest.approx(z1["best_error"] / z1["forest_error"], abs=1e-4)
    assert z1["ci95"][0] < z1["ratio"] < z1["ci95"][1]
    assert list(content["z3"]) == ["1", "2", "5"]
    assert {row["best_method"] for row in content["z3"].values()} == {"MLP: replay"}  # rezero has no labelled fault
    assert list(content["rezero"]) == ["0", "1", "2", "5"]
    low, high = content["rezero"]["2"]["ci95"]
    assert low < content["rezero"]["2"]["value"] < high
    assert (z1["seeds"], z1["spread_over_seeds"]) == (1, None)
    assert content["gears"] == 6
    twin = content["twin"]
    assert twin["matched"]["value"] == z1["best_error"]
    low, high = twin["ratio_to_floor"]["ci95"]
    assert low < twin["matched"]["value"] / twin["floor"]["value"] < high
    of_unit, mistaken = content["unit"]["twin on references"], twin["undeclared"]["after"]
    assert of_unit["value"] < twin["matched"]["value"] < mistaken["value"]
    assert twin["mesh"] is twin["undeclared"]["before"] is None  # they were not run
    assert twin["other_authors"] == others
    assert twin["session"]["unit"]["value"] < twin["session"]["value"] < twin["matched"]["value"] + 2
    joint = content["unit"]["logistic regression on harmonics, joint rows"]
    rezeroed = content["unit"]["logistic regression on harmonics, joint rows: rezero, healthy recordings only (K = 2)"]
    assert 5 < joint["value"] < 15
    assert rezeroed["value"] == pytest.approx(100 * 0.04 / 2 + 2.5, abs=1)
    assert 0 < twin["calibration_error"] < 0.5
    assert twin["calibration_error_mismatched"] is None  # neither mesh nor population
    fast = content["fast_twin"]
    assert twin["matched"]["value"] < fast["error"]["value"] < content["z1"]["forest_error"]
    assert fast["milliseconds"] == 0.25
    assert "The fast twin, one network" in (out / "transfer.html").read_text()
    assert content["detection"] == {}  # 72 healthy recordings do not show a rate of 1 %
    assert content["inputs"]["residual"] == {
        "mlp": {"value": pytest.approx(100 / 6, abs=3), "ci95": [ANY, ANY], "gears": 100},
        "cnn": None, "resnet": None, "minirocket": None,
    }  # fmt: skip
    assert content["disturbed"]["z1"] == [99.7, 99.8, 99.9]
    assert content["disturbed"]["forest_in_the_paper"] == [90.09, 86.2, 92.31]
    assert 0 < content["oracle_error"] < z1["best_error"]

    page = (out / "transfer.html").read_text()
    assert re.findall(r'(?:src|href)="(?!data:image/png;base64,|#|index\.html)', page) == []
    first = re.search(r"<p><b>(.*?)</b></p>", page).group(1)
    assert first.startswith("20 healthy recordings at each operating point identify a gear")
    assert f"in {z1['best_error']:.1f} %" in first
    assert "6 gears never seen, with their healthy references known, logistic regression on harmonics errs in" in page
    assert page.count("<table>") == page.count('<div class="wide" tabindex="0"><table>')  # nothing wider than a phone
    titles = re.findall(r"<h3>(.*?)</h3>", page)
    assert len(set(titles)) == len(titles) > 12
    assert set(re.findall(r'href="#(\w+)"', page)) == set(re.findall(r'<h2 id="(\w+)"', page))
    assert "the same, after the loop has found the effect" in page
    assert "Of 8 gears that other authors simulated" in page
    assert "Given 2 healthy specimens of the session at each operating point as well, the twin errs in" in page
    assert "12.5 % (2.2 to 47.1): 1 of 3 healthy ones are called faulty, and 2 gears something else" in page
    assert f"with 2, logistic regression errs in {content['rezero']['2']['value']:.1f} %" in page
    assert "MLP: CORAL (trained on 5 variants)" in page
    assert "replay (trained on" not in page
    assert re.search(r"studies with runs of older code</td>\s*<td[^>]*>zero_shot, inputs_gears, no_reference", page)
    assert re.search(r"protocol.folds</td>\s*<td[^>]*>2<", page)


def test_runs_of_the_present_code_replace_older_ones_of_their_study(store):
    keep = Keeper(store, {"gears-bench": "a", "foreign": "a+b", "changed": "a+c", "other": "c"})
    for study, on, classifier, code in (
        ("zero_shot", "gears-bench", "retired", "1"), ("zero_shot", "gears-bench", "cnn", code_version()),
        ("no_reference", "gears-bench", "cnn", "1"), ("inputs_gears", "foreign", "rf", "1"),
        ("inputs_gears", "changed", "knn", "1"), ("transfer", "other", "rf", "1"),
    ):  # fmt: skip
        keep(study, on, code=code, classifier=classifier, features="harmonics")
    found = transfer_runs.present_runs(keep.store, ["a"], ["a", "b"])
    assert set(zip(found["study"], found["classifier"], strict=True)) == {
        ("zero_shot", "cnn"), ("no_reference", "cnn"), ("inputs_gears", "rf")
    }  # fmt: skip
    runs = transfer_runs.Runs({}, {}, {}, {}, Path(), keep.store, found)
    assert runs.older_code() == ["inputs_gears", "no_reference"]
    assert runs.of_study("transfer").empty


def test_a_sweep_over_seeds_is_one_method_with_means_and_their_spread(tmp_path):
    keep = Keeper(prepared(tmp_path), {"gears-bench": "a"})
    facts = {"gear": 1, "label": "healthy", "variant": [0, 1]}
    for seed, error in ((0, 10.0), (1, 13.0), (2, 16.0)):
        table = pd.DataFrame({**facts, "shots": 5, "error": [error, error + 2], "unadapted": 20.0})
        keep("transfer", metrics={"test_score": 100 - error}, tables={"specimens": table}, classifier="perceptron",
             features="harmonics", adaptation="replay", seed=seed, **{"classifier.seed": seed})  # fmt: skip
    keep("transfer", classifier="perceptron", features="harmonics", adaptation="coral")
    runs = transfer_runs.Runs({}, {}, {}, {}, Path(), keep.store, transfer_runs.present_runs(keep.store, ["a"]))
    methods = transfer_runs.by_method(runs.of_study("transfer"))
    assert list(methods.index) == ["MLP: CORAL", "MLP: replay"]
    assert methods.loc["MLP: replay", ["seeds", "test_score", "spread"]].tolist() == [3, 87.0, 3.0]
    assert methods["seeds"].tolist() == [1, 3]
    assert seeds.spread_text(methods) == ["1: -", "3: 3.0"]
    found = runs.tables(methods.loc[["MLP: replay"]], "specimens")["MLP: replay"]
    assert found["error"].tolist() == [13.0, 15.0]
    assert found["unadapted"].tolist() == [20.0, 20.0]


def test_every_experiment_of_a_study_is_among_its_commands():
    studies = {**transfer_runs.EXPERIMENTS, **transfer_runs.PAPER_EXPERIMENTS}
    found = {study: set() for study in studies}
    for path in (ROOT / "conf" / "experiment").glob("*.yaml"):
        study = yaml.safe_load(path.read_text()).get("study")
        if study in found:
            found[study].add(path.stem)
    assert found == {study: set(names) for study, names in studies.items()}


def test_parameters_of_a_run_name_its_method():
    config = configured("train", "classifier=perceptron", "features=residual", "adaptation=l2_sp")
    assert transfer_runs.method_of(flat(config)) == "MLP on residual signals: L2-SP"


def test_oracle_of_another_data_set_is_refused(data):
    folder, digests = data
    path, judged = folder / "gears-bench-oracle.parquet", predictions(0.1, "any")
    with pytest.raises(ValueError, match=r"another data set .* run 'swg oracle grid=gears condition=bench"):
        posteriors(path, "other", judged, OF_ORACLE)
    with pytest.raises(ValueError, match=r"lacks gear 1, which is judged"):
        posteriors(path, digests["gears-bench"], judged.assign(row=judged["row"] + 10_000), OF_ORACLE)
    with pytest.raises(ValueError, match=r"no oracle .*: run 'swg oracle"):
        posteriors(folder / "none-bench-oracle.parquet", digests["gears-bench"], judged, OF_ORACLE)
    found, known = posteriors(path, storage.digest(folder / "gears-bench.h5"), judged, OF_ORACLE).values()
    assert list(found["row"]) == list(known["row"]) == list(judged["row"])


def test_a_twin_without_comparison_has_no_floor(data, tmp_path):
    folder, digests = data
    table = pd.read_parquet(folder / "gears-bench-twin.parquet")
    path = tmp_path / "gears-bench-twin.parquet"
    table[[name for name in table if "floor" not in name]].to_parquet(path)
    assert list(posteriors(path, digests["gears-bench"], predictions(0.1, "any"), OF_TWIN)) == [TWIN]


def test_a_mistaken_twin_on_the_same_data_counts_on_the_judged_recordings_only(data):
    folder, digests = data
    path, judged = folder / "gears-bench-twin.parquet", predictions(0.1, "any")
    some = judged[judged["gear"] == 1]
    recordings, units = mismatch(path, some, digests["gears-bench"])
    assert len(recordings) == len(some)
    assert set(recordings["gear"]) == {1}
    assert len(units) == len(some) // 4  # operating points
    assert len(mismatch(path, some, "another data set")[0]) == len(judged)
    assert mismatch(folder / "none.parquet", judged, "") is None


def test_options_are_those_of_the_first_fold():
    config = {"classifier": {"trials": [{"columns": 0.1}, {"columns": 0.2}, {"columns": 0.3}]}}
    run = pd.Series({"trial/1": 80.0, "trial/2": 90.0, "trial/3": 85.0, "chosen/1": 3.0, "chosen/2": 2.0})
    assert importance.options_of(config, run, NewGears(**POOLS)) == {"columns": 0.3}


def test_every_feature_of_the_harmonics_has_its_group():
    names = settings.representation({"name": "harmonics"}).learning_set([recordings(gears=2, variants=1)]).names
    groups = {group: [names[i] for i in columns] for group, columns in importance.groups_of(names).items()}
    assert sum(map(len, groups.values())) == len(names)
    assert set(groups["operating point"]) == {"speed", "load", "temperature", *ERRORS}
    assert {"s0[0]", "|s1..s4[0]| wave 2"} <= set(groups["gauge offsets"])
    assert all("[0]" not in name for name in groups["torque ripple"])
    assert {f"|s1..s4[{order}]| wave 0" for order in (2, 4)} <= set(groups["torque ripple"])


def test_importance_marks_the_physics_and_hides_doubt():
    rows = [(group, label, drop, doubt) for label in importance.PHYSICS
            for group, drop, doubt in (("efficiency", 30.0, 1.0), ("gauge offsets", 2.0, 4.0))]  # fmt: skip
    text = importance.importance_text(pd.DataFrame(rows, columns=["group", "label", "drop", "doubt"]))
    assert list(text.loc["reduced damping"]) == ["30.0 *", "not clear"]
    assert list(text.loc["tip tooth crack"]) == ["30.0", "not clear *"]


def test_methods_judged_on_different_specimens_are_not_paired():
    table = pd.DataFrame({"gear": [1, 1], "label": "healthy", "variant": [0, 1], "error": [0.0, 1.0]})
    assert list(tables.paired({"a": table, "b": table})["b"]) == [0.0, 1.0]
    with pytest.raises(ValueError, match="b was judged on 1 specimens that are not the 2 of a"):
        tables.paired({"a": table, "b": table[:1]})
