"""The report of the transfer study from its runs: what each part rests on is found, and both files are written."""

import time
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pandas as pd

from learn.evaluation.bootstrap import gear_errors, specimens
from learn.paper.paper_page import versions
from learn.transfer_report import adapted, input_studies, optional, practice, results, sections, sentences, studies
from learn.transfer_report import runs as runs_of
from learn.transfer_report.carried import carried, refit
from learn.transfer_report.content import cnn_fit, content, how_made
from learn.transfer_report.evidence import Evidence, gathered
from learn.transfer_report.novelty import novelty
from learn.transfer_report.spectrum import disturbance_beside_faults
from learn.transfer_report.transfer_page import Section, TransferReport
from swgsim.common.files import write_text
from swgsim.storage import storage


@dataclass(frozen=True)
class Unadapted:
    """The main comparison: methods without adaptation on gears never seen.

    Attributes
    ----------
    runs : DataFrame
        By method.
    predictions, oracles : mapping
        Method or oracle to its table of predictions.
    zero : ZeroShot
    """

    runs: pd.DataFrame
    predictions: Mapping[str, pd.DataFrame]
    oracles: Mapping[str, pd.DataFrame]
    zero: results.ZeroShot


def run(config: Mapping[str, Any]) -> dict[str, float]:
    """Write ``transfer.html`` and ``transfer.json``, as a resolved ``conf/transfer_report.yaml`` says.

    Returns
    -------
    dict
        Number of goals that were reached, and the seconds that the report took.

    Raises
    ------
    ValueError
        If a data set, the oracle or a study is missing, with the command to make it.
    """
    began = time.time()
    report = report_of(gathered(config), Path(config["out"]) / "benchmark.json", began, config["started"])
    folder = Path(config["out"])
    folder.mkdir(parents=True, exist_ok=True)
    write_text(folder / "transfer.json", report.json())
    write_text(folder / "transfer.html", report.html())
    reached = sum(goal.reached for goal in report.goals)
    print(f"{folder / 'transfer.html'}: {reached} of {len(report.goals)} goals reached; {time.time() - began:.1f} s")
    return {"goals_reached": reached, "seconds": time.time() - began}


def report_of(evidence: Evidence, benchmark: Path, began: float, started: float | None) -> TransferReport:
    """All that the report says.

    Parameters
    ----------
    evidence : Evidence
    benchmark : Path
        ``benchmark.json``, which need not be there.
    began, started : float
        Unix times at which the report and the whole began; None adds up the seconds of the single steps.
    """
    main = unadapted(evidence)
    zero = main.zero
    by_adaptation = runs_of.by_method(evidence.required("transfer"))
    few = results.few_shot(zero.errors, evidence.tables(by_adaptation, "specimens"))
    forgotten = results.forgetting(evidence.tables(by_adaptation, "gears"))
    of_inputs = evidence.required("inputs")
    signals = evidence.tables(of_inputs, "predictions")
    inputs = input_studies.inputs(of_inputs, signals)
    cases = studies.disturbed_cases(evidence.required("zero_shot_disturbed"))
    clean = evidence.beside(f"{evidence.grids['disturbed']}-clean")
    spectrum, change = disturbance_beside_faults(clean, evidence.paths["disturbed"]) if clean else (None, None)
    labelled = int(by_adaptation["protocol.labelled"].iloc[0])
    parts = [
        sections.disturbed(cases, spectrum, change),
        sections.new_gears(zero, optional.no_reference(evidence, of_inputs, signals)),
        sections.inputs(inputs, optional.operating_point(evidence)),
        adapted.transfer(
            zero,
            few,
            forgotten,
            str(by_adaptation["draws"].iloc[0]),
            labelled,
            runs_of.few_variants(by_adaptation),
        ),
        optional.where_it_pays(evidence),
        practice_of(evidence, main),
        optional.harder(evidence),
        optional.size(evidence),
    ]
    fit = cnn_fit(benchmark, evidence.made["bench"]["recordings"])
    seconds = time.time() - (started or began) + (0 if started else evidence.seconds)
    facts = how_made(
        evidence.configuration,
        by_adaptation.iloc[0],
        zero.gears,
        [*runs_of.trials(main.runs), *runs_of.trials(by_adaptation)],
        fit,
        seconds,
        "on the clock" if started else "the steps added up",
        versions(storage.attributes(evidence.paths["bench"])["swgsim"], evidence.digests),
    )
    facts.append(("studies with runs of older code", sentences.listed(runs_of.of_older_code(evidence.runs))))
    return TransferReport(
        grid=evidence.grids["bench"],
        content=content(zero, few, inputs, cases, fit, seconds),
        goals=sentences.goals(cases, zero, few, forgotten),
        plain=[
            *sentences.chosen_by(zero, runs_of.development_scores(by_adaptation), few),
            *sentences.fancy_against_simple(zero, input_studies.networks_compared(of_inputs, signals), few),
        ],
        levels=sections.levels(labelled),
        sections=[*parts, sections.made(facts)],
    )


def unadapted(evidence: Evidence) -> Unadapted:
    """The main comparison, with the oracles.

    Raises
    ------
    ValueError
        If the study or the oracle is missing, with the command to make it.
    """
    runs = runs_of.by_method(evidence.required("zero_shot"))
    predictions = evidence.tables(runs, "predictions")
    bench = evidence.paths["bench"]
    said = runs_of.oracle(
        bench.with_name(f"{bench.stem}-oracle.parquet"), evidence.digests["bench"], next(iter(predictions.values()))
    )
    oracles = dict(zip(results.ORACLES, said, strict=True))
    errors = runs_of.paired({name: specimens(table) for name, table in {**predictions, **oracles}.items()})
    zero = results.zero_shot(errors, runs_of.development_scores(runs), runs["fit_seconds"].astype(float))
    return Unadapted(runs, predictions, oracles, zero)


def practice_of(evidence: Evidence, main: Unadapted) -> Section:
    """What a practitioner reads, of the best method beside the forest, two simple ones and the oracle."""
    shown = dict.fromkeys([main.zero.best, results.FOREST, sentences.SIMPLE, sentences.NETWORK])
    judged = {name: main.predictions[name] for name in shown if name in main.predictions}
    on_harmonics = main.zero.methods[main.zero.methods.index.str.endswith(" on harmonics")]["value"]
    refitted = str(on_harmonics.idxmin()) if len(on_harmonics) else main.zero.best
    return practice.section(
        main.zero.best,
        judged | {results.ORACLE: main.oracles[results.ORACLE]},
        novelty(evidence.paths["bench"], evidence.beside("far-bench"), gear_errors(main.zero.errors)[main.zero.best]),
        refitted,
        carried(refit(evidence.store, results.row_of(main.runs, refitted), evidence.paths["bench"])),
    )
