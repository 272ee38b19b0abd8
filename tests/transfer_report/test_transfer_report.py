"""The report of the transfer study from end to end on fabricated runs, and what its sentences follow from."""

import json
import re
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import yaml
from fabricated import recordings
from hydra import compose, initialize_config_dir
from learn.transfer_report.content import cnn_fit, content
from learn.transfer_report.transfer_page import Table
from omegaconf import OmegaConf

from learn import tracking
from learn.inputs.residuals import ERRORS
from learn.jobs import settings
from learn.jobs.identity import code_version, flat
from learn.protocols.levels import NewGears
from learn.transfer_report import adapted as transfer_adapted
from learn.transfer_report import carried, map_study, practice, results, sentences
from learn.transfer_report import judging as transfer_judging
from learn.transfer_report import runs as transfer_runs
from learn.transfer_report import studies as transfer_studies
from learn.transfer_report import transfer_study as job
from swgsim.common.seeds import generator
from swgsim.oracle.columns import KNOWN
from swgsim.storage import storage
from swgsim.storage.gauge_set import CLASSES

ROOT = Path(__file__).parents[2]
POOLS = {"folds": 2, "development": 2, "labelled": 2, "unlabelled": 1, "kept_out": 1, "variants": None}
METHODS = (("rf", "selection_1", 0.4), ("logistic_regression", "harmonics", 0.15), ("perceptron", "harmonics", 0.2))
CASES = ("1_2_to_3", "2_3_to_1", "1_3_to_2")


@cache
def samples():
    """Facts of the samples of eight gears."""
    table = recordings(gears=8, variants=6, length=600).table
    return table[~table["reference"]].reset_index(drop=True)


def predictions(wrong, purpose):
    """Probabilities for the judged rows of which a share is wrong."""
    table, rng = samples(), generator("fabricated predictions", purpose)
    rows = np.concatenate([split.test for split in NewGears(**POOLS).split(None, table)])
    facts = table.loc[rows, ["gear", "label", "variant", "severity", "n_in_rpm", "T_out_nm"]].reset_index(names="row")
    true = pd.Index(CLASSES).get_indexer(facts["label"])
    said = np.where(rng.random(len(true)) < wrong, rng.integers(len(CLASSES), size=len(true)), true)
    p = rng.dirichlet(np.ones(len(CLASSES)), len(true)) + 2 * np.eye(len(CLASSES))[said]
    table = facts.assign(label=facts["label"].astype(str)).join(
        pd.DataFrame(p / p.sum(axis=1, keepdims=True), columns=list(CLASSES))
    )
    healthy = table["label"] == "healthy"
    return table.assign(severity=table["severity"].where(~healthy).clip(upper=0.9))


def adapted(after, before, shots):
    """Tables of an adaptation: error of specimens, and what is forgotten."""
    every = predictions(0, "facts")[["gear", "label", "variant"]].drop_duplicates()
    parts = [every.assign(shots=k, error=100 * after / max(k, 1), unadapted=100.0 * before) for k in shots]
    specimens = pd.concat(parts, ignore_index=True)
    noise = generator("fabricated adaptation", after).uniform(0, 5, len(specimens))
    specimens["error"] += noise
    gears = specimens.groupby(["gear", "shots"])[["error", "unadapted"]].mean().reset_index()
    return specimens, gears.assign(forgotten=0.5 * gears["shots"])


def configured(name, *overrides):
    with initialize_config_dir(str(ROOT / "conf"), version_base="1.3"):
        return OmegaConf.to_container(compose(name, list(overrides)), resolve=True)


class Keeper:
    """Keeps fabricated runs in a store."""

    def __init__(self, folder, digests):
        self.store, self.digests = tracking.local_store(str(folder)), digests

    def __call__(self, study, condition="bench", metrics=None, tables=None, config=None, code="1", **parameters):
        everything = {"study": study, "adaptation": "none", "draws": 2, "seed": 0, "shots": "[1, 2]"}
        everything |= {f"protocol.{name}": value for name, value in POOLS.items()} | parameters
        tags = {"data_digest": self.digests[condition], "code_version": code}
        with tracking.job_run(self.store, "run", "key", everything, config or {}, tags) as run:
            kept = {f"tables/{name}.parquet": table for name, table in (tables or {}).items()}
            run.record({"test_score": 80.0, "fit_seconds": 1.0, **(metrics or {})}, {}, kept)


def keep_all(keep, data):
    """One run of every cell that the report asks for."""
    for classifier, features, wrong in METHODS:
        config = configured("train", f"classifier={classifier}", f"features={features}", f"data={data}")
        config["protocol"] = {"name": "new_gears", **POOLS}
        trials = {} if classifier == "rf" else {"trial/1": 80.0, "trial/2": 100 * (1 - wrong)}
        keep("zero_shot", metrics=trials, tables={"predictions": predictions(wrong, classifier)}, config=config,
             classifier=classifier, features=features)  # fmt: skip
    for features, score in (("selection_3", 88.0), ("lines", 99.7)):
        cases = {f"test/{case}": score + i / 10 for i, case in enumerate(CASES)}
        keep("zero_shot_disturbed", "disturbed", cases, classifier="rf", features=features)
    for i, classifier in enumerate(("perceptron", "cnn", "minirocket")):
        for features, efficiencies in (("raw", ("True", "False")), ("selection_all", ("both", "none"))):
            for j, efficiency in enumerate(efficiencies):
                table = predictions(0.2 + 0.05 * i + 0.1 * j, (classifier, features, efficiency))
                keep("inputs", tables={"predictions": table}, classifier=classifier, features=features,
                     **{"features.efficiency": efficiency})  # fmt: skip
    for given, wrong in (("True", 0.2), ("False", 0.6)):
        keep("inputs_operating_point", tables={"predictions": predictions(wrong, given)}, classifier="extra_trees",
             features="harmonics", **{"features.operating_point": given})  # fmt: skip
    keep("no_reference", tables={"predictions": predictions(0.5, "Z0")}, classifier="cnn", features="raw")
    for adaptation, after, shots in (
        ("replay", 0.1, (1, 2, 5)),
        ("from_scratch", 0.6, (1, 2, 5)),
        ("coral", 0.3, (0,)),
    ):
        specimens, gears = adapted(after, 0.2, shots)
        few = {"protocol.variants": 5} if adaptation == "coral" else {}
        keep("transfer", metrics={"trial/1": 90.0 - 10 * after}, tables={"specimens": specimens, "gears": gears},
             classifier="perceptron", features="harmonics", adaptation=adaptation, **few)  # fmt: skip


def write_data(folder):
    """The data sets, the oracle, and the digests."""
    digests = {}
    grid = {"variants": 6, "speeds_rpm": [2000, 4000], "loads_nm": [7, 39], "population": {"count": 8}}
    said = {"configuration": yaml.safe_dump({"grid": grid, "gears": {}}), "swgsim": "0.1.0"}
    for condition, name, gears, noise in (
        ("bench", "gears-bench", 8, 1e-3), ("far", "far-bench", 3, 1e-3),
        ("disturbed", "paper-disturbed", 3, 1e-3), ("clean", "paper-clean", 3, 0.0),
    ):  # fmt: skip
        made = replace(recordings(gears=gears, variants=6, disturbance=noise), attributes=said)
        storage.write(folder / f"{name}.h5", [made], len(made))
        (folder / f"{name}.json").write_text(json.dumps({"seconds": 1.0, "cores": 2, "recordings": len(made)}))
        digests[condition] = storage.digest(folder / f"{name}.h5")
    p = predictions(0.05, "oracle")
    oracle = p[["row", *CLASSES]].join(p[list(CLASSES)].add_prefix(KNOWN))
    oracle.attrs = {"data": digests["bench"]}
    oracle.to_parquet(folder / "gears-bench-oracle.parquet")
    return digests


def test_whole_report_from_fabricated_runs(tmp_path):
    digests = write_data(tmp_path)
    out = tmp_path / "report"
    out.mkdir()
    figures = ("seconds", "recordings", "samples_per_second", "over_bare_step", "dataloader_loop_over_ours")
    fit = dict.fromkeys(figures, 9.0)
    (out / "benchmark.json").write_text(json.dumps({"training": fit}))
    config = configured("transfer_report", f"data={tmp_path}", f"tracking.folder={tmp_path / 'runs'}", f"out={out}")
    Keeper(tmp_path / "runs", {"bench": "old"})("zero_shot", classifier="rf", features="selection_1")
    with pytest.raises(ValueError, match=r"study zero_shot on the present .* experiment=zero_shot grid=gears"):
        job.run(config)
    keep_all(Keeper(tmp_path / "runs", digests), tmp_path)

    job.run(config)

    said = json.loads((out / "transfer.json").read_text())
    assert said["z1"]["best_method"] == "logistic regression on harmonics"
    assert said["z1"]["ratio"] == pytest.approx(said["z1"]["best_error"] / said["z1"]["forest_error"], abs=1e-4)
    assert said["z1"]["ci95"][0] < said["z1"]["ratio"] < said["z1"]["ci95"][1]
    assert list(said["z3"]) == ["1", "2", "5"]
    assert {row["best_method"] for row in said["z3"].values()} == {"MLP: replay"}
    assert said["gears"] == 6
    assert said["inputs"]["raw"]["mlp"] < said["inputs_without_efficiency"]["raw"]["mlp"]
    assert said["inputs"]["residual"] == {"mlp": None, "cnn": None, "minirocket": None}
    assert said["cnn_fit"] == fit
    assert said["disturbed"]["z1"] == [99.7, 99.8, 99.9]
    assert said["disturbed"]["forest_in_the_paper"] == [90.09, 86.2, 92.31]
    assert 0 < said["oracle_error"] < said["z1"]["best_error"]
    page = (out / "transfer.html").read_text()
    assert re.findall(r'(?:src|href)="(?!data:image/png;base64,|#|index\.html")', page) == []
    assert re.search(r"error is clearly higher [^:]*?with extra trees on harmonics, clearly lower with none", page)
    assert "gears of grid=far have" in page
    assert "experiment=transfer_map grid=gears" in page  # what is left out names its command
    assert page.count("✓ reached") + page.count("✗ missed") == 5
    assert "MLP: CORAL (trained on 5 variants)" in page
    assert "replay (trained on" not in page
    assert re.search(r"studies with runs of older code</td>\s*<td[^>]*>zero_shot, zero_shot_disturbed, inputs", page)


def test_runs_of_the_present_code_replace_older_ones_of_their_study(tmp_path):
    keep = Keeper(tmp_path, {"bench": "a", "foreign": "a+b", "changed": "a+c", "other": "c"})
    for study, condition, classifier, code in (
        ("inputs", "bench", "retired", "1"), ("inputs", "bench", "cnn", code_version()),
        ("no_reference", "bench", "cnn", "1"), ("transfer_map", "foreign", "rf", "1"),
        ("transfer_map", "changed", "knn", "1"), ("transfer", "other", "rf", "1"),
    ):  # fmt: skip
        keep(study, condition, code=code, classifier=classifier, features="harmonics")
    found = transfer_runs.present_runs(keep.store, ["a"], ["a", "b"])
    assert set(zip(found["study"], found["classifier"], strict=True)) == {
        ("inputs", "cnn"), ("no_reference", "cnn"), ("transfer_map", "rf")
    }  # fmt: skip
    assert transfer_runs.of_older_code(found) == ["no_reference", "transfer_map"]


def test_every_experiment_of_a_study_is_among_its_commands():
    found = {study: set() for study in transfer_runs.EXPERIMENTS}
    for path in (ROOT / "conf" / "experiment").glob("*.yaml"):
        study = yaml.safe_load(path.read_text()).get("study")
        if study in found and not path.stem.endswith("_small"):
            found[study].add(path.stem)
    assert found == {study: set(names) for study, names in transfer_runs.EXPERIMENTS.items()}


def test_options_are_those_of_the_best_trial_the_first_of_equals():
    config = {"classifier": {"trials": [{"columns": 0.1}, {"columns": 0.2}, {"columns": 0.3}]}}
    for scores, chosen in (([80.0, 90.0, 85.0], 0.2), ([80.0, 90.0, 90.0], 0.2), ([90.0, 90.0, 80.0], 0.1)):
        run = pd.Series({f"trial/{number}": score for number, score in enumerate(scores, start=1)})
        assert carried.options_of(config, run, NewGears(**POOLS)) == {"columns": chosen}


def test_a_single_gear_has_no_temperature():
    table = predictions(0.2, "one gear")
    table = table[table["gear"] == table["gear"].min()].reset_index(drop=True)
    rows = [("efficiency", label, 5.0, 1.0) for label in CLASSES[1:]]
    drops = pd.DataFrame(rows, columns=["group", "label", "drop", "doubt"])
    section = practice.section("best", {"best": table}, None, "best", carried.Carried(drops, drops, 1))
    (judged,) = [part for part in section.parts if isinstance(part, Table) and "temperatures" in part.header]
    assert judged.rows[0][3:6] == ["-", "-", "-"]
    assert any("on the 1 gears of the first fold" in part for part in section.parts if isinstance(part, str))


def test_cnn_is_timed_on_no_more_recordings_than_the_data_set_has(monkeypatch, tmp_path):
    monkeypatch.setattr("learn.methods.training_benchmark.measure", lambda recordings: {"recordings": recordings})
    assert [cnn_fit(tmp_path / "none.json", count)["recordings"] for count in (320, 33_000)] == [320, 4320]
    (tmp_path / "kept.json").write_text(json.dumps({"training": {"recordings": 7}}))
    assert cnn_fit(tmp_path / "kept.json", 320) == {"recordings": 7}


def test_oracle_of_another_data_set_is_refused(tmp_path):
    write_data(tmp_path)
    path, judged = tmp_path / "gears-bench-oracle.parquet", predictions(0.1, "any")
    with pytest.raises(ValueError, match=r"another data set .* scripts/oracle.py grid=gears condition=bench"):
        transfer_runs.oracle(path, "other", judged)
    unknown = judged.assign(row=judged["row"] + 10_000)
    with pytest.raises(ValueError, match=r"says nothing of gear 1"):
        transfer_runs.oracle(path, storage.digest(tmp_path / "gears-bench.h5"), unknown)


def test_methods_judged_on_different_specimens_are_not_paired():
    table = pd.DataFrame({"gear": [1, 1], "label": "healthy", "variant": [0, 1], "error": [0.0, 1.0]})
    assert list(transfer_runs.paired({"a": table, "b": table})["b"]) == [0.0, 1.0]
    with pytest.raises(ValueError, match="b was judged on 1 specimens that are not the 2 of a"):
        transfer_runs.paired({"a": table, "b": table[:1]})


def errors_of(**methods):
    """Constant errors of methods on six gears with two specimens."""
    rows = [(gear, "healthy", variant) for gear in range(6) for variant in range(2)]
    return pd.DataFrame(rows, columns=["gear", "label", "variant"]).assign(
        **{name: value + 0.1 * np.arange(12) % 0.3 for name, value in methods.items()}
    )


def zero_of(best, forest=30.0, oracle=5.0):
    errors = errors_of(best=best, forest=forest, oracle=oracle, second=oracle).rename(
        columns={"best": sentences.SIMPLE, "forest": results.FOREST, "second": results.ORACLE_OF_SESSION}
    )
    names = [sentences.SIMPLE, results.FOREST]
    return results.zero_shot(errors, pd.Series([90.0, np.nan], names), pd.Series(1.0, names))


def few_of(zero, after, before=10.0):
    def table(shots, error):
        keys = zero.errors[["gear", "label", "variant"]]
        return keys.assign(shots=shots, error=error, unadapted=before)

    scratch = pd.concat([table(5, after + 5), table(10, after - 0.5)])
    both = pd.concat([table(5, after), table(10, after)])
    return results.few_shot(zero.errors, {"MLP: replay": both, "MLP: from scratch": scratch})


@pytest.mark.parametrize(("best", "reached"), [(6.0, (True, True)), (9.0, (True, False)), (12.0, (False, False))])
def test_goals_on_the_bench_follow_the_numbers(best, reached):
    zero = zero_of(best)
    assert (sentences.against_forest(zero).reached, sentences.against_oracle(zero).reached) == reached
    assert zero.best == zero.chosen == sentences.SIMPLE


def test_goal_with_shots_names_the_oracle_only_where_it_is_above():
    hard, easy = zero_of(9.0, oracle=8.0), zero_of(9.0, oracle=2.0)
    assert "The oracle that knows the session is at 0.27" in sentences.with_few_shots(hard, few_of(hard, 8.0)).sentence
    goal = sentences.with_few_shots(easy, few_of(easy, 5.0))
    assert goal.reached
    assert "oracle" not in goal.sentence


def test_disturbed_goal_needs_every_case():
    cases = pd.DataFrame([[90.0] * 3, [80.0] * 3, [100.0, 99.6, 99.4]],
                         index=["the paper's own figures", transfer_studies.PAPER_FOREST, "x on lines"])  # fmt: skip
    assert not sentences.disturbed(cases).reached
    cases.iloc[2, 2] = 99.5
    assert sentences.disturbed(cases).reached


def test_forgetting_counts_the_best_method_at_any_number_of_shots():
    zero = zero_of(9.0)
    few = few_of(zero, 5.0)
    lost = pd.DataFrame({"method": "MLP: replay", "shots": [5, 10], "forgotten": [1.0, 2.5], "worst": 3.0})
    assert not sentences.forgetting(few, lost).reached
    assert sentences.forgetting(few, lost.assign(forgotten=1.0)).reached


def test_plain_sentences_say_what_does_not_pay():
    zero = zero_of(9.0)
    plain = " ".join(sentences.fancy_against_simple(zero, pd.DataFrame(), few_of(zero, 10.0)))
    assert re.search(r"specimens \(Z3\), fewer errors [^:]*: none; not clearly: MLP: replay \(\+0\.0\)", plain)
    assert "not below the 9.1 % that logistic regression on harmonics" in plain
    assert "From 10 shots on, MLP: from scratch (9.5 %)" in plain
    gains = " ".join(sentences.fancy_against_simple(zero, pd.DataFrame(), few_of(zero, 4.0)))
    assert re.search(r"fewer errors [^:]*: MLP: replay \(-6\.0\); not clearly: none", gains)


def test_json_has_no_interval_with_few_gears():
    zero = zero_of(9.0)
    zero = replace(zero, table=zero.table.assign(ratio_low=np.nan, ratio_high=np.nan))
    cases = pd.DataFrame([[90.0] * 3, [80.0] * 3], index=["paper", transfer_studies.PAPER_FOREST])
    inputs = pd.DataFrame({"input": ["raw"], "method": ["cnn"], "efficiency": [True], "error": [12.0]})
    fit = dict.fromkeys(
        ("seconds", "recordings", "samples_per_second", "over_bare_step", "dataloader_loop_over_ours"), 1
    )
    said = content(zero, few_of(zero, 5.0), inputs, cases, fit, 1.0)
    assert said["z1"]["ci95"] == [None, None]
    assert said["inputs"]["raw"] == {"mlp": None, "cnn": 12.0, "minirocket": None}
    json.dumps(said, allow_nan=False)


def test_physics_is_checked_by_what_costs_most_beyond_doubt():
    rows = [("efficiency", "reduced_damping", 30.0, 1.0), ("torque ripple", "reduced_damping", 1.0, 0.5),
            ("efficiency", "reduced_stiffness", 9.0, 1.0), ("torque ripple", "reduced_stiffness", 4.0, 1.0),
            ("efficiency", "root_tooth_crack", 9.0, 1.0), ("gauge offsets", "root_tooth_crack", 8.5, 1.0),
            ("efficiency", "tip_tooth_crack", 3.0, 4.0), ("torque ripple", "tip_tooth_crack", 0.1, 0.2)]  # fmt: skip
    drops = pd.DataFrame(rows, columns=["group", "label", "drop", "doubt"])
    damping, stiffness, root, tip = carried.physics_checked(drops)
    assert "most recall is lost with efficiency (30.0 points), as its physics says" in damping
    assert "its physics names torque ripple (torque ripple 4.0)" in stiffness
    assert "with efficiency, as much as with gauge offsets (9.0 points), as its physics says" in root
    assert "no single group costs recall beyond chance" in tip


def test_lines_are_named_beyond_doubt_and_ties_are_counted():
    lines = [("a", 9.0, 1.0), ("b", 8.5, 1.0), ("c", 8.4, 1.0), ("d", 8.2, 1.0), ("e", 2.0, 1.0), ("f", 0.5, 1.0)]
    drops = pd.DataFrame([(*line, "tip_tooth_crack") for line in lines], columns=["group", "drop", "doubt", "label"])
    said = carried.lines_said(drops)[-1]
    assert said.endswith("a (9.0), b (8.5) and c (8.4); 1 more cost as much as the first, within the doubt.")
    assert carried.lines_said(drops.assign(doubt=10.0))[-1].endswith("none.")


def test_every_feature_of_the_harmonics_has_its_group():
    names = settings.representation({"name": "harmonics"}).learning_set([recordings(gears=2, variants=1)]).names
    groups = {group: [names[i] for i in columns] for group, columns in carried.groups_of(names).items()}
    assert sum(map(len, groups.values())) == len(names)
    assert set(groups["operating point"]) == {"speed", "load", "temperature", *ERRORS}
    assert {"s0[0]", "|s1..s4[0]| wave 2"} <= set(groups["gauge offsets"])
    assert all("[0]" not in name for name in groups["torque ripple"])
    common = {f"|s1..s4[{order}]| wave 0" for order in (2, 4)}
    assert common <= set(groups["torque ripple"])
    lines = {line: {names[i] for i in columns} for line, columns in carried.lines_of(names).items()}
    assert common <= lines["mean[2]"] | lines["mean[4]"]
    assert lines["mean[2]"] == {"|s1..s4[2]| wave 0", "Re mean[2] / healthy", "Im mean[2] / healthy"}


def test_sets_of_new_gears_keep_their_promise():
    sets = transfer_judging.conformal(predictions(0.1, "sets"), nominal=0.8)
    assert sets["coverage"].mean() >= 0.75
    assert sets["mean_size"].max() < len(CLASSES)


def test_parts_of_a_line_are_one_group():
    names = ("Re s0[2]", "Im s0[2]", "Re mean[2] / healthy", "|s1..s4[2]| wave 1", "log eta_rel", "s1[0]", "speed")
    assert carried.lines_of(names) == {
        "efficiency": [4], "s1[0]": [5], "|s1..s4[2]| wave 1": [3], "s0[2]": [0, 1], "mean[2]": [2],
        "operating point": [6],
    }  # fmt: skip


def test_costliest_lines_come_first():
    rows = [("a", "healthy", 1.0), ("a", "x", 2.0), ("b", "x", 9.0), ("c", "x", 0.5)]
    drops = pd.DataFrame(rows, columns=["group", "label", "drop"])
    assert list(carried.costliest(drops, 2)["group"]) == ["b", "a", "a"]


def test_map_names_the_best_method_without_adaptation():
    specimens, _ = adapted(0.05, 0.2, (5,))
    place = {"features": "harmonics", "target": "few-bench", "protocol.sources": "2", "features.acquisitions": "1"}
    names = ("rf", "extra_trees", "rf")
    plain = pd.DataFrame([{**place, "classifier": name, "adaptation": "none"} for name in names])
    tables = {"0": predictions(0.5, "worse"), "1": predictions(0.0, "better"), "2": predictions(0.0, "outdated")}
    best = map_study.best_unadapted(plain, tables)
    adapts = pd.DataFrame([{**place, "classifier": "perceptron", "adaptation": "replay"}])
    table = map_study.transfer_map(adapts, {"0": specimens}, best)
    assert list(table["best"]) == ["extra trees on harmonics (of 2)"]
    assert table["best_low"].item() > 0 > table["high"].item()
    parts = transfer_adapted.where_it_pays(table, "2").parts
    assert "Draws of the shots for each gear: 2." in parts[0]
    assert "clearly better in 0 of 1 cases and clearly worse in 1." in parts[1]
    assert parts[-1].rows[0][6] == "yes"
    alone = map_study.transfer_map(adapts, {"0": specimens}, {})
    assert "is not compared here" in transfer_adapted.where_it_pays(alone, "1").parts[1]


def test_map_tells_gain_from_harm():
    specimens, _ = adapted(0.05, 0.2, (5,))
    harmed, _ = adapted(1.5, 0.2, (5,))
    rows = [{"classifier": "perceptron", "features": "harmonics", "adaptation": "replay", "target": target,
             "protocol.sources": "2", "features.acquisitions": "1"}
            for target in ("far-bench", "few-bench")]  # fmt: skip
    table = map_study.transfer_map(pd.DataFrame(rows), {"0": specimens, "1": harmed}, {})
    where = ("gears far outside the sources", "other gears of the sources' population")
    assert list(table["scenario"]) == [f"{target}: 2 source gears, 1 reference acquisition" for target in where]
    verdicts = [row[6] for row in transfer_adapted.where_it_pays(table, "1").parts[-1].rows]
    assert verdicts == ["yes", "harms"]


def test_robustness_sets_the_same_gears_beside_an_unseen_one():
    rows = [{"classifier": "rf", "classifier.trees": trees, "classifier.depth": depth, "protocol": protocol,
             "test_score": 90.0 + int(depth) - 10 * (protocol == "leave_one_gear_out")}
            for trees in ("10", "100") for depth in ("3", "7")
            for protocol in ("grouped_folds", "leave_one_gear_out")]  # fmt: skip
    table = transfer_studies.robustness(pd.DataFrame(rows))
    assert list(table["setting"].unique()) == ["depth 3", "depth 7"]
    assert list(table["size"]) == [10, 100, 10, 100]
    assert (table["gap"] == 10).all()


def test_parameters_of_a_run_name_its_method():
    config = configured("train", "classifier=perceptron", "features=residual", "adaptation=l2_sp")
    assert transfer_runs.method_of(flat(config)) == "MLP on residual signals: L2-SP"
