"""From values of the choices to the configuration of the chain and of the features, as in conf/grid/paper_fitted."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from swgsim.common.seeds import generator

Config = Mapping[str, Any]
Values = Mapping[str, float]


def changes(values: Values, base: Config) -> dict[str, Any]:
    """What the values change in a configuration.

    Gauge errors and differences of kinematic errors keep one pattern each, which the values scale.

    Parameters
    ----------
    values : mapping
        Choice to value, each of conf/paper_choices.yaml.
    base : mapping
        ``grid``, ``window`` and ``gears`` of the paper's preset.

    Returns
    -------
    dict
        ``grid``, ``window``, ``gears`` and ``features``, to be merged with the base.
    """
    return {
        "grid": {"severities": _severities(values, base["grid"]["severities"])},
        "window": {"samples": round(1e-3 * values["window"] * base["window"]["rate"])},
        "gears": {name: _gear(values, gear) for name, gear in base["gears"].items()},
        "features": {
            "orders": int(values["components"]),
            "floor": _short(values["floor"]),
            "whole_revolutions": bool(values["whole_revolutions"]),
        },
    }


def merged(base: Config, changed: Config) -> dict[str, Any]:
    """A nested configuration with some values changed.

    >>> merged({"window": {"rate": 1e4, "samples": 600}}, {"window": {"samples": 500}})
    {'window': {'rate': 10000.0, 'samples': 500}}
    """
    result = dict(base)
    for key, value in changed.items():
        nested = isinstance(value, Mapping) and isinstance(result.get(key), Mapping)
        result[key] = merged(result[key], value) if nested else value
    return result


def _severities(values: Values, usual: Mapping[str, list[float]]) -> dict[str, list[float]]:
    slightest = 1 - values["slightest_change"]
    return {
        "reduced_damping": [usual["reduced_damping"][0], _short(slightest)],
        "reduced_stiffness": [usual["reduced_stiffness"][0], _short(slightest)],
        "eccentric_wave_generator": _rounded(usual["eccentric_wave_generator"], times=values["eccentricity"]),
        # A power keeps a crack between none (1) and a rim that is cut (0).
        "root_tooth_crack": [_short(level ** values["root_crack"]) for level in usual["root_tooth_crack"]],
        "tip_tooth_crack": _rounded(usual["tip_tooth_crack"], times=values["tip_crack"]),
    }


def _gear(values: Values, gear: Config) -> dict[str, Any]:
    number, gauges, transmission = gear["number"], gear["gauges"], gear["transmission"]
    factor = values[f"gauge_errors_{number}"]
    errors = {name: _rounded(gauges[name], times=factor) for name in ("offset", "position", "grid_angle")}
    gain = [_short(1 + factor * (each - 1)) for each in gauges["gain"]]
    kinematic_error = _errors(values, transmission, number)
    return {
        "transmission": {"J_out": _short(values["load_inertia"]), "kinematic_error": kinematic_error},
        "gauges": {"gain": gain, **errors},
    }


def _errors(values: Values, transmission: Config, number: int) -> list[dict[str, float]]:
    """The orders of the kinematic error; those of gears 2 and 3 move away from gear 1 in fixed random directions."""
    terms = transmission["kinematic_error"]
    rng = generator("kinematic error of a gear", number)
    larger, later = rng.normal(size=len(terms)), rng.uniform(-np.pi, np.pi, len(terms))
    difference = 0.0 if number == 1 else values["kinematic_difference"]
    return [
        {
            "order": term["order"],
            "amplitude": _short(term["amplitude"] * values["kinematic_error"] * np.exp(difference * larger[i])),
            "phase": _short(term["phase"] + difference * later[i]),
        }
        for i, term in enumerate(terms)
    ]


def _rounded(numbers: list[float], times: float) -> list[float]:
    return [_short(times * each) for each in numbers]


def _short(value: float) -> float:
    """Four significant digits, as a person writes them."""
    return float(f"{value:.4g}")
