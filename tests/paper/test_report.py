"""The report from end to end on a small grid, and its messages when something is missing."""

import json
import re
from pathlib import Path

import pandas as pd
import pytest
from fabricated import recordings
from hydra import compose, initialize_config_dir
from omegaconf import OmegaConf
from prepared_store import store_in
from test_paper import runs_like_the_paper

from learn import tracking
from learn.paper import paper_page as report
from learn.paper import paper_report
from learn.paper.choices import choices
from learn.paper.fitted import fitted
from learn.paper.published_tables import PROTOCOLS, compare
from swgsim.common.style import Picture
from swgsim.jobs.generate_data_set import run as generate
from swgsim.storage import storage
from swgsim.storage.labelled_signals import CLASSES
from swgsim.studies.examples import SEVEREST
from swgsim.studies.finding import Finding

pytestmark = pytest.mark.end_to_end
ROOT = Path(__file__).parents[2]
DATASET = {"recordings": 912, "seconds": 1.5, "recordings_per_second": 608.0, "peak_memory_mib": 500.0, "cores": 2}


def finding(number):
    return Finding(f"C{number}", f"claim <{number}>", "limit", number != 3, f"{number} %", "note & reason")


def written(grid="paper", shift=-2.5):
    fold = {"features": ["selection_1"], "classifier": ["rf"], "random": [99.0], "grouped": [96.0], "difference": [3.0]}
    return report.Report(
        grid=grid,
        dataset=DATASET,
        tables={name: compare(name, runs_like_the_paper(name, shift)) for name in PROTOCOLS},
        folds={"table7": pd.DataFrame(fold).set_index(["features", "classifier"])},
        findings=[finding(n) for n in range(1, 19)],
        choices=[("Window", "600 samples")],
        fitted=fitted() if grid == "paper" else None,
        statistics=report.statistics([recordings(variants=1)]),
        pictures=[Picture("Fig. 6", "Look here.", b"\x89PNG one")],
        seconds=100.0,
        seconds_are="the steps added up",
        steps={"generation": 1.5, "report": 10.0},
        versions={"swgsim": "0.1.0"},
    )


def test_json_has_what_is_asked_for():
    content = json.loads(written().json())
    assert content["dataset"] == DATASET
    assert set(content["tables"]) == set(PROTOCOLS)
    assert all({"ours", "paper", "mean_absolute_difference"} <= set(table) for table in content["tables"].values())
    assert content["tables"]["table7"]["mean_absolute_difference"] == pytest.approx(2.5)
    assert content["tables"]["table7"]["ours"]["selection 1, test"]["rf"] == pytest.approx(97.31)
    assert list(content["claims"]) == [f"C{n}" for n in range(1, 19)]
    assert content["claims"]["C3"] == {"holds": False, "figure": "3 %", "note": "note & reason"}
    assert content["seconds"] == 100.0


def test_page_is_one_file_that_escapes_text_and_links_to_what_exists():
    page = written().html()
    assert re.findall(r'(?:src|href)="(?!data:image/png;base64,|#)', page) == []
    assert "http" not in page
    assert "claim &lt;3&gt;" in page
    assert "note &amp; reason" in page
    assert "2000\u00a0rpm, 39\u00a0N\u00a0m" in page
    assert 'href="transfer.html"' in written().html(beyond=True)


def test_first_lines_say_what_holds_and_what_does_not():
    lead = written().html().split("<nav>")[0]
    assert "17 of 18 claims" in lead
    assert re.search(r"Not reproduced:</b> C3\.", lead)
    assert re.search(r"Table\sVII 2\.5 points\s+\(30 cells; fitted choices: [\d.]+\)", lead)
    assert "small grid" not in lead
    assert lead.index("RF is best on Selections 1 and 2") < lead.index("17 of 18 claims")
    assert "This is the small grid" in written("small").html()


def test_every_cell_stands_beside_its_score_with_the_fitted_choices():
    page = written().html()
    assert page.count("<i>") == 1 + sum(len(compare(name, runs_like_the_paper(name)).cells) for name in PROTOCOLS)
    assert "<i>" not in written("small").html().replace("<i>1,2-&gt;3</i>", "")


def test_cell_is_white_when_both_agree_and_full_at_the_limit():
    assert report.shade(0).endswith(",0.00)")
    assert report.shade(30) == report.shade(45) == "rgba(0,114,178,0.60)"
    assert report.shade(-30) != report.shade(30)


def test_missing_cell_names_the_command():
    runs = runs_like_the_paper("table9").query("classifier != 'knn'")
    with pytest.raises(ValueError, match=r"9 of 45 cells .* first is knn, .* 'swg train grid=paper experiment=table9'"):
        report.complete(compare("table9", runs), "table9", "swg train grid=paper")


def test_runs_of_another_data_set_do_not_count(tmp_path):
    store = store_in(tmp_path)
    parameters = {"study": "table7", "grid": "small", "classifier": "rf", "protocol": "random_folds"}
    with tracking.job_run(store, "a run", "key", parameters, {}, {"data_digest": "old"}) as run:
        run.record({"test_score": 90.0}, {}, {})
    assert len(report.runs_of_tables(store, "small", {"clean": "old"}, "")) == 1
    for grid, digest in (("small", "new"), ("paper", "old")):
        with pytest.raises(ValueError, match=rf"no finished run .* grid={grid} .*'swg train x experiment.*table10"):
            report.runs_of_tables(store, grid, {"clean": digest}, "swg train x")


def test_data_sets_of_different_code_do_not_belong_together():
    report.require_same_code({"clean": "1", "disturbed": "1"}, "paper")
    with pytest.raises(ValueError, match=r"clean by 1, disturbed by 2\. Make them again .* grid=paper .* data=data'"):
        report.require_same_code({"clean": "1", "disturbed": "2"}, "paper")


def test_statistics_have_one_row_per_operating_point():
    rows = report.statistics([recordings(variants=2), recordings(variants=2)])
    assert [row["operating point"] for row in rows] == [
        "2000 rpm, 7 N m",
        "2000 rpm, 39 N m",
        "4000 rpm, 7 N m",
        "4000 rpm, 39 N m",
    ]
    assert len({len(row) for row in rows}) == 1


@pytest.mark.parametrize(("efficiency", "verdict"), [(0.728, "outside"), (0.775, "within")])
def test_choices_state_what_b1_means_against_the_catalogue(efficiency, verdict):
    config = {
        "window": {"samples": 600, "rate": 1e4},
        "grid": {"speeds_rpm": [2000, 4000], "variants": 60, "positions": 20, "references": 20,
                 "severities": {"reduced_damping": [0.67, 0.99], "eccentric_wave_generator": [2e-5, 1e-4]}},
    }  # fmt: skip
    catalogue = {"0.52": (efficiency, 0.074), "0.254": (0.769, 0.051)}
    text = dict(choices(config, {"amplitude": 2.8e-4, "offset": 2.8e-4}, catalogue, orders=6, floor=1e-6))
    assert f"is {verdict} the catalogue's range" in text["b1"]
    assert "2 or 4 revolutions" in text["Window"]
    assert "20, 100 µm" in text["Severities of Table V"]


def configured(name, *overrides):
    with initialize_config_dir(str(ROOT / "conf"), version_base="1.3"):
        return OmegaConf.to_container(compose(name, list(overrides)), resolve=True)


def runs_of(digests):
    """One finished run for every cell of the paper's tables, with random and with grouped folds."""
    recall = {f"recall/{label}": 90.0 for label in CLASSES}
    tables = []
    for table, protocol in PROTOCOLS.items():
        facts = {"data_digest": digests["disturbed" if table in ("table8", "table10") else "clean"], "fit_seconds": 1.0}
        for folds in {protocol, protocol.replace("random", "grouped")}:
            tables.append(runs_like_the_paper(table).assign(protocol=folds, **facts, **recall))
    return pd.concat(tables, ignore_index=True)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A folder with the tiniest data sets that have what the report needs."""
    folder = tmp_path_factory.mktemp("data")
    sizes = ["grid.variants=4", "grid.positions=4", "grid.references=1", "mesh.sectors=40", "workers=1"]
    single = ["eccentric_wave_generator", "root_tooth_crack", "tip_tooth_crack"]
    severe = [f"grid.severities.{label}=[{SEVEREST[label][0]}]" for label in single]
    generate(configured("generate", "grid=small", f"data={folder}", *sizes, *severe, "condition=disturbed"))
    return folder


@pytest.mark.slow
def test_whole_report_from_a_small_data_set(folder, monkeypatch):
    digests = {condition: storage.digest(folder / f"small-{condition}.h5") for condition in ("clean", "disturbed")}
    monkeypatch.setattr(report, "finished_runs", lambda *_, **__: runs_of(digests))
    whole = paper_report.report_of(configured("report", "grid=small", f"data={folder}"), began=0.0)
    content, page = json.loads(whole.json()), whole.html()
    assert content["tables"]["table9"]["mean_absolute_difference"] == pytest.approx(0)
    assert list(content["claims"]) == [f"C{n}" for n in range(1, 19)]
    assert [key for key in content["claims"] if content["claims"][key]["holds"]][-1] == "C18"
    assert page.count("data:image/png;base64,") == len(whole.pictures) == 9
    assert page.count("holds</td>") + page.count("does not hold</td>") == 18
    assert all(f.claim and f.limit and f.figure for f in whole.findings)
    assert all(f.note for f in whole.findings[:10])
    assert all(p.title and p.caption and p.png[:8] == b"\x89PNG\r\n\x1a\n" for p in whole.pictures)


@pytest.mark.parametrize(("grid", "out"), [("paper", "report"), ("small", "report/small")])
def test_each_grid_has_its_own_page(grid, out, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(paper_report, "report_of", lambda *_: written(grid))
    paper_report.run(configured("report", f"grid={grid}"))
    assert {path.name for path in (tmp_path / out).iterdir()} == {"index.html", "report.json"}
