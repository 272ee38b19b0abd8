"""The command ``swg benchmark``: the chain against the obvious ways of doing the same."""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from learn.methods import training_benchmark
from swgsim.common.files import write_json
from swgsim.jobs import settings
from swgsim.studies import benchmark


def run(config: Mapping[str, Any]) -> None:
    """Print the ratios and keep them as <report>/benchmark.json."""
    config = dict(config)
    report, trained = Path(config.pop("report")), config.pop("trained")
    plan = settings.plan(config)
    nominal = plan.gears[0].transmission
    stiffnesses = [replace(nominal, k1=ratio * nominal.k1) for ratio in np.linspace(0.8, 1.0, 120)]
    result = {
        "chain_vs_solve_per_step": benchmark.chain_vs_solve_per_step(plan),
        "integrator_vs_solve_ivp": benchmark.integrator_vs_solve_ivp(stiffnesses, plan.grid.points),
        # About as many runs as the loop asks for at a time: more take longer in proportion, and integrating does not.
        # Friction over the output revolution is no part of a motion that repeats with the input's.
        "harmonic_balance_vs_integrating": benchmark.harmonic_balance_vs_integrating(
            [replace(each, b3=0.0) for each in stiffnesses[::10]], plan.grid.points
        ),
        "errors_by_recording_vs_dense": benchmark.errors_by_recording_vs_dense(),
        "further_errors_vs_anew": benchmark.further_errors_vs_anew(),
    }
    chain, integrator, balance, errors, further = result.values()
    result["training"] = training = training_benchmark.measure(trained)
    print(
        f"chain against one sparse solve per sample: {chain['ratio']:,.0f} times faster, "
        f"largest difference {chain['max_relative_difference']:.1e} of the signal"
    )
    print(
        f"batched integrator against solve_ivp: {integrator['ratio']:,.0f} times faster, "
        f"largest error {integrator['max_relative_error']:.1e} of the ripple"
    )
    print(
        f"periodic motion by harmonic balance against integrating: {balance['ratio']:,.0f} times faster, "
        f"largest difference {balance['max_relative_difference']:.1e}"
    )
    print(
        f"errors kept by recording against dense columns: {errors['ratio']:.1f} times faster, "
        f"{errors['ratio_of_bytes']:.1f} times fewer bytes, largest difference {errors['max_relative_difference']:.1e}"
    )
    print(
        f"further errors against all of them anew: {further['ratio']:.1f} times faster, "
        f"largest difference {further['max_relative_difference']:.1e}"
    )
    print(
        f"training a convolutional network on {training['recordings']} recordings: {training['seconds']:.1f} s, "
        f"{training['over_bare_step']:.2f} times the bare step; a DataLoader loop takes "
        f"{training['dataloader_loop_over_ours']:.2f} times as long"
    )
    write_json(report / "benchmark.json", result)
