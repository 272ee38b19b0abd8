"""From a hidden effect to scores: record the gear, close the loop, generate the data sets, train and test."""

import hashlib
import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import pandas as pd
from threadpoolctl import threadpool_limits

from learn import tracking
from learn.jobs import identity
from learn.sim_to_real import judging
from learn.sim_to_real.judging import Pair, judged
from learn.sim_to_real.scores import scores
from learn.sim_to_real.verdicts import Finished
from swgsim.bench.scatter import Bench
from swgsim.bench.virtual_bench import Sessions, record_sessions
from swgsim.common.compute import Engine
from swgsim.common.version import code_version
from swgsim.effects import text
from swgsim.effects.base import Effect
from swgsim.effects.library import SEARCHED, listed, named
from swgsim.gear.acquisition import Window
from swgsim.gear.gear import Gear, OperatingPoint
from swgsim.gear.population import Population
from swgsim.identification.commissioning.commissioning import learn_unit
from swgsim.identification.data.measured import Measured
from swgsim.identification.data.model import Model
from swgsim.identification.fit.unit import Unit
from swgsim.identification.report.answer import answer
from swgsim.identification.report.identification import Identification
from swgsim.identification.report.report_fields import report
from swgsim.jobs import generate_data_set as generation
from swgsim.jobs import settings
from swgsim.recordings.recording import Recording
from swgsim.storage import storage

STUDY = "sim_to_real"


def study_all(config: Mapping[str, Any], store: tracking.Store) -> list[Finished]:
    """Study every undeclared effect of a resolved configuration of ``conf/sim_to_real.yaml``.

    Effects with a finished run in the store are not computed again.

    Raises
    ------
    ValueError
        If there is no undeclared effect, or a choice is unknown or beyond its limits; the message names it.
    """
    if not config["undeclared"]:
        raise ValueError("undeclared has no effects, so nothing would be studied: leave at least one, such as none")
    hidden = {name: settings.effects(entries) for name, entries in config["undeclared"].items()}
    keys = {name: key(config, name) for name in hidden}
    missing = [name for name in hidden if _finished(store, keys[name]).empty]
    if missing:
        with threadpool_limits(1):
            bench = TestBench.of(config)
            unit = learn_unit(Measured.of(bench.recorded((), "commissioning")), Unit(Model(bench.nominal)))
        for whose, gear, mesh in _sides(config, bench, unit):
            data_set(config, f"{whose}-none", gear, (), mesh, number=whose == "bench")
        tasks = ((config, store, name, keys[name], bench, unit) for name in missing)
        for _ in Engine.of(config).results(study, tasks, len(missing)):
            pass
    return [_read(store, name, _finished(store, keys[name])) for name in hidden]


def key(config: Mapping[str, Any], name: str) -> str:
    """Sixteen hexadecimal digits that change when the result for an undeclared effect may change."""
    without = ("undeclared", "data", "out", "workers", "tracking")
    decisive = {each: value for each, value in config.items() if each not in without}
    digest = hashlib.sha256(json.dumps([name, config["undeclared"][name], decisive], sort_keys=True).encode())
    digest.update(f"{code_version('identification')} {identity.code_version()}".encode())
    for source in (Path(__file__), Path(judging.__file__)):
        digest.update(source.read_bytes())
    return digest.hexdigest()[:16]


@dataclass(frozen=True)
class TestBench:
    """A unit of the series on the virtual bench.

    Attributes
    ----------
    nominal, unit : Gear
        The nominal gear of the series, which the model knows, and the true unit.
    sessions : Sessions
    bench : Bench
    window : Window
    sectors : int
    seed : int
    """

    nominal: Gear
    unit: Gear
    sessions: Sessions
    bench: Bench
    window: Window
    sectors: int
    seed: int

    @classmethod
    def of(cls, config: Mapping[str, Any]) -> "TestBench":
        """The bench of a configuration."""
        nominal = settings.gear(config["gear"])
        series = settings.build(Population, config["spread"], count=1)
        unit = replace(series.draw(nominal, config["unit"])[0], number=nominal.number)
        grid = config["grid"]
        points = tuple(OperatingPoint(float(n), float(T)) for n in grid["speeds_rpm"] for T in grid["loads_nm"])
        return cls(
            nominal, unit,
            settings.build(Sessions, config["sessions"], points=points),
            settings.build(Bench, config["condition"]["bench"]),
            Window(rate=config["window"]["rate"], quantum=config["quantum"]),
            config["bench_mesh"]["sectors"], config["seed"],
        )  # fmt: skip

    def recorded(self, effects: Sequence[Effect], session: str) -> tuple[Recording, ...]:
        """Recordings of the healthy unit."""
        return record_sessions(
            self.unit, effects, replace(self.sessions, name=session), self.bench,
            seed=self.seed, window=self.window, sectors=self.sectors,
        )  # fmt: skip


def study(config: Mapping[str, Any], store: tracking.Store, name: str, key: str, bench: TestBench, unit: Unit) -> None:
    """Close the loop on healthy recordings with one undeclared effect, train, test, and keep all as an MLflow run."""
    entries = config["undeclared"][name]
    hidden = settings.effects(entries)
    parameters = {"study": STUDY, "undeclared": name, "key": key}
    with threadpool_limits(1):
        found, answered = closed(config, name, bench.recorded(hidden, f"with {name}"), unit)
        (_, twin, mesh), (_, real, fine) = _sides(config, bench, unit)
        plain = data_set(config, "model-none", twin, (), mesh)
        bench_plain = data_set(config, "bench-none", real, (), fine, number=1)
        models = {
            "before": Pair(plain, plain),
            "after": Pair(plain, data_set(config, f"model-{name}-found", twin, found, mesh) if found else plain),
            "oracle": Pair(plain, data_set(config, f"model-{name}", twin, hidden, mesh) if hidden else plain),
        }
        acting = data_set(config, f"bench-{name}", real, hidden, fine, number=1) if hidden else bench_plain
        tags = {
            "data_digest": storage.digest(acting),
            "verdict": answered["verdict"],
            "sentence": answered["sentence"][:5000],
        }
        with tracking.job_run(store, f"{STUDY} {name}", key, parameters, config, tags) as job:
            predictions = judged(models, Pair(bench_plain, acting), config["methods"])
            kept = pd.DataFrame({"answer": [json.dumps({"hidden": text.entries(hidden), "loop": answered})]})
            tables = {"predictions": predictions, "loop": kept}
            job.record(
                metrics(scores(predictions)), {}, {f"tables/{each}.parquet": table for each, table in tables.items()}
            )


def closed(
    config: Mapping[str, Any], name: str, recordings: Sequence[Recording], unit: Unit
) -> tuple[tuple[Effect, ...], dict[str, Any]]:
    """Effects that the loop finds in recordings of a commissioned unit, and its report; writes the loop's page."""
    kinds = SEARCHED if config["searched"] is None else tuple(map(named, listed(config["searched"])))
    found = answer(recordings, unit, kinds, seed=config["seed"])
    fields = report(found, kinds, source=f"virtual bench with {name}")
    Identification(found, fields).save(Path(config["out"]) / STUDY / name)
    shown = {
        **{each: fields[each] for each in ("verdict", "sentence", "error")},
        "found": text.entries(found.effects),
        "rivals": [effect.name() for option, _ in found.decision.credible[1:] for effect in option.effects],
        "absorbed": [each["name"] for each in fields["absorbed"]],
    }
    return found.effects, shown


def data_set(
    config: Mapping[str, Any], name: str, gear: Gear, effects: Sequence[Effect], mesh: Mapping[str, Any],
    *, number: int = 0,
) -> Path:  # fmt: skip
    """A data set of one gear with effects on every run; it is generated unless it exists.

    Parameters
    ----------
    config : mapping
    name : str
    gear : Gear
    effects : sequence of Effect
    mesh : mapping
        Of conf/mesh.
    number : int
        Data sets of different numbers have other draws of severities, positions and errors.
    """
    chosen = {
        "grid": {**config["grid"], "name": f"{STUDY}-{name}", "seed": config["grid"]["seed"] + number},
        "condition": config["condition"],
        "window": config["window"],
        "mesh": mesh,
        "gears": {"unit": json.loads(json.dumps(asdict(gear)))},
        "effects": text.entries(effects),
        "data": config["data"],
        "workers": 1,
    }
    return Path(generation.run(chosen)["path"])


def metrics(result: pd.DataFrame) -> dict[str, float]:
    """Accuracy and false alarms under names that MLflow accepts."""
    return {
        f"{row['method']}/{row['day'].replace(' ', '_')}/{row['model']}/{what}": float(row[what])
        for _, row in result.iterrows()
        for what in ("accuracy", "false_alarms")
    }


def _sides(
    config: Mapping[str, Any], bench: TestBench, unit: Unit
) -> tuple[tuple[str, Gear, Mapping[str, Any]], tuple[str, Gear, Mapping[str, Any]]]:
    """The gear of the commissioned model and the true unit, each with its mesh."""
    return ("model", unit.model.gear, config["mesh"]), ("bench", bench.unit, config["bench_mesh"])


def _finished(store: tracking.Store, key: str) -> pd.DataFrame:
    return tracking.finished_runs(store, study=STUDY, key=key)


def _read(store: tracking.Store, name: str, runs: pd.DataFrame) -> Finished:
    run_id = str(runs.iloc[0]["run_id"])
    kept = json.loads(tracking.table_of(store, run_id, "tables/loop.parquet")["answer"].iloc[0])
    predictions = tracking.table_of(store, run_id, "tables/predictions.parquet")
    return Finished(name, kept["hidden"], kept["loop"], scores(predictions))
