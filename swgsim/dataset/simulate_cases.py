"""From planned cases to labelled signals: bench, chain, acquisition and table."""

from dataclasses import replace

import numpy as np

from swgsim.bench.scatter import Shaft
from swgsim.chain.chain import Run, Simulation, simulate
from swgsim.common.seeds import generator
from swgsim.dataset.grid import Case
from swgsim.dataset.plan import Plan
from swgsim.effects.base import Effect
from swgsim.storage.labelled_signals import LabelledSignals, facts


def record(plan: Plan, cases: list[Case]) -> LabelledSignals:
    """Simulate some cases of a plan."""
    runs = [replace(case.run, effects=(*_declared(plan, case), *case.run.effects)) for case in cases]
    temperature = np.full(len(cases), np.nan)
    if plan.bench:
        gears = list(dict.fromkeys(run.gear for run in runs))
        units = {gear: plan.bench.unit(gear, generator("unit", plan.grid.seed, gear.number)) for gear in gears}
        for i, (case, run) in enumerate(zip(cases, runs, strict=True)):
            gear, imperfections = units[run.gear]
            planned = Run(gear, run.point, (*imperfections, *run.effects))
            runs[i], temperature[i] = plan.bench.run(planned, generator("bench run", case.seed))
    simulation = simulate(runs, plan.window, plan.sectors)
    signals, efficiency = _acquire(plan, cases, simulation)
    variants = [case.variant for case in cases]
    table = facts({
        "gear": [case.run.gear.number for case in cases],
        "label": [variant.label for variant in variants],
        "variant": [variant.number for variant in variants],
        "severity": [variant.severity for variant in variants],
        "position": [variant.position for variant in variants],
        "n_in_rpm": [case.run.point.n_in_rpm for case in cases],
        "T_out_nm": [case.run.point.T_out for case in cases],
        "efficiency": efficiency,
        "temperature_c": temperature,
        "reference": [case.reference for case in cases],
        "seed": np.array([case.seed for case in cases], dtype="u8"),
    })  # fmt: skip
    return LabelledSignals(signals, table, plan.window.rate, plan.attributes)


def _declared(plan: Plan, case: Case) -> tuple[Effect, ...]:
    """The declared effects of the plan in one recording, with its random phases."""
    return tuple(
        effect.drawn(generator("declared effect", case.seed, number)) for number, effect in enumerate(plan.effects)
    )


def _acquire(plan: Plan, cases: list[Case], simulation: Simulation) -> tuple[np.ndarray, np.ndarray]:
    """Recorded signals (float32) [mV/V] and efficiency [-]."""
    signals = np.empty(simulation.signals.shape, "f4")
    efficiency = simulation.efficiency.copy()
    motion = simulation.motion
    P_in = (motion.T_in * motion.omega_in).mean(axis=1)
    omega_in, omega_out = motion.omega_in.mean(axis=1), motion.omega_out.mean(axis=1)
    for i, (case, ideal, m) in enumerate(zip(cases, simulation.signals, simulation.of_run, strict=True)):
        rng = generator("acquisition", case.seed)
        if plan.bench:
            session = plan.session(case.run.gear, case.reference, case.day)
            ideal = plan.bench.signals(ideal, rng)
            shaft = Shaft(P_in[m], omega_in[m], omega_out[m], efficiency[i])
            efficiency[i] = plan.bench.efficiency(shaft, session, rng)
        signals[i] = plan.window.acquire(ideal, rng)
    return signals, efficiency
