"""The bench of a case: the unit, its commissioning, the recordings to examine, and the truth at unseen points."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from swgsim.bench.scatter import Bench
from swgsim.bench.virtual_bench import Instruments, Sessions, biases_of, record_sessions
from swgsim.blind.sealed import Sealed
from swgsim.blind.strata import FULL
from swgsim.chain.chain import Run, simulate_turns
from swgsim.common.seeds import generator
from swgsim.effects import OutputPosition
from swgsim.effects.base import Effect
from swgsim.gear.acquisition import Window
from swgsim.gear.conditions import Conditions
from swgsim.gear.gear import Gear, OperatingPoint
from swgsim.gear.population import Population
from swgsim.identification.data.features import Layout, features
from swgsim.identification.data.model import SAMPLES_PER_TURN, Model, Situation
from swgsim.identification.fit.priors import of_unit
from swgsim.recordings.recording import Recording

# Spread of the units: somewhat smaller than the declared prior of a series (swgsim.identification.fit.priors).
SERIES = Population(
    1, b1_ratio=(0.9, 1.1), k1_ratio=(0.9, 1.1), b0_ratio=(0.92, 1.08), mu_ratio=(0.92, 1.08), w0_ratio=(0.99, 1.01),
    gain=0.01, offset=0.01, position=0.005, grid_angle=0.005, kinematic_error=(1.0, 1.0),
)  # fmt: skip
# Kinematic error of a unit about the nominal one, in spreads that the loop declares.
KINEMATIC = 0.7
# Session of the recordings to examine.
QUESTION = "question"
# Where nothing was recorded: speed and load between those that were, warm and late in the session.
UNSEEN = tuple(Situation(OperatingPoint(3000.0, T), Conditions(28.0, 1800.0)) for T in (20.0, 55.0))


@dataclass(frozen=True)
class Setting:
    """What all cases of a set have in common.

    Attributes
    ----------
    gear : Gear
        The nominal one.
    bench : Bench
    window : Window
        Sampling rate.
    library : tuple of effect classes
    revolutions : int
        Of every recording.
    sectors : tuple of int
        Meshes of the bench; they differ from the model's mesh.
    seed : int
    """

    gear: Gear
    bench: Bench
    window: Window
    library: tuple[type[Effect], ...]
    revolutions: int
    sectors: tuple[int, ...]
    seed: int

    def given(self, case: Sealed) -> tuple[type[Effect], ...]:
        """The library that the loop is given for a case."""
        return tuple(kind for kind in self.library if kind.name() not in case.taken_out)


def unit_of(seed: int, setting: Setting) -> Gear:
    """The unit of a case before it ran in."""
    gear = SERIES.draw(setting.gear, seed)[0]
    nominal = setting.gear.transmission.kinematic_error
    gear = replace(gear, transmission=replace(gear.transmission, kinematic_error=nominal))
    model, rng = Model(gear), generator("kinematic error of a unit", seed)
    for name, declared in of_unit(setting.gear).items():
        if name.startswith("kinematic error"):
            model = declared.at(model, declared.value(model) + KINEMATIC * declared.sd * rng.standard_normal())
    return model.gear


def commissioning(seed: int, sectors: int, setting: Setting) -> tuple[Recording, ...]:
    """Recordings of the unit in its healthy state."""
    plan = Sessions(FULL.points, FULL.repeats, revolutions=setting.revolutions, name="commissioning")
    return record_sessions(
        unit_of(seed, setting), (), plan, setting.bench, seed=seed, window=setting.window, sectors=sectors
    )


def in_question(case: Sealed, setting: Setting, effects: Sequence[Effect]) -> tuple[Recording, ...]:
    """Recordings of the unit with some effects."""
    rng = generator("conditions of a case", case.seed)
    plan = Sessions(
        case.points, case.repeats, revolutions=setting.revolutions, name=QUESTION, warming=rng.uniform(3, 9)
    )
    bench, instruments = setting.bench, Instruments()
    if case.hard:
        bench = replace(
            bench,
            load=bench.load * rng.uniform(1.5, 2.5),
            index_angle=bench.index_angle * rng.uniform(1, 2),
            noise=bench.noise * rng.uniform(1, 2.5),
            zero_drift=bench.zero_drift * rng.uniform(1, 2),
        )
        instruments = replace(instruments, wander=2 * instruments.wander)
        plan = replace(plan, warming=rng.uniform(8, 15), pause=120.0)
    return record_sessions(
        _run_in(unit_of(case.seed, setting), case), effects, plan, bench, seed=case.seed + 1, window=setting.window,
        sectors=case.sectors, instruments=instruments,
    )  # fmt: skip


def unseen(case: Sealed, setting: Setting, layout: Layout) -> Float[np.ndarray, "situation feature"]:
    """What the bench would record where nothing was recorded, in the session in question and without any noise, over
    all positions of the output.
    """
    gear = _run_in(unit_of(case.seed, setting), case)
    positions = (OutputPosition(0.0), OutputPosition(np.pi))
    runs = [Run(gear, s.point, (*case.acting, p), conditions=s.conditions) for s in UNSEEN for p in positions]
    recordings = simulate_turns(runs, 1, SAMPLES_PER_TURN, case.sectors)
    found = np.array([features(recording, layout) for recording in recordings])
    # Of the session that in_question records; hard cases have the same flanges.
    biases, mean = biases_of(setting.bench, case.seed + 1, QUESTION), layout.order == 0
    zeros = biases.T_in * (mean & (layout.channel == "T_in")) + biases.T_out * (mean & (layout.channel == "T_out"))
    return found.reshape(len(UNSEEN), len(positions), -1).mean(axis=1) + zeros


def _run_in(gear: Gear, case: Sealed) -> Gear:
    t = gear.transmission
    return replace(gear, transmission=replace(t, b1=t.b1 * case.run_in[0], k1=t.k1 * case.run_in[1]))
