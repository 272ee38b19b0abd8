"""Days of recordings of a joint, as its drive logs them."""

from typing import NamedTuple
from zlib import crc32

import numpy as np
from jaxtyping import Float
from scipy.signal import lfilter

from robots.draw import Truth, draw
from robots.plant import CYCLE, Plant, moved
from robots.trajectories import PROGRAMMES, Limits
from swgsim.joint.recording import JointRecording

SETTLING = 1.0  # s, in which the joint stands under control before a recording
PAUSE, WARM_UP = 240.0, 1800.0  # s, from one recording to the next; time constant of the temperature: estimates
REFERENCE = 20.0  # deg C, of the drawn viscous friction
REST = 8.0  # s, of a recording at standstill


class Campaign(NamedTuple):
    """Recordings in motion and at standstill, and the truth."""

    recordings: tuple[JointRecording, ...]
    at_rest: tuple[JointRecording, ...]
    truth: Truth


def joint(seed: int, kind: str = "healthy") -> Campaign:
    """Record a joint on two or three days, 8 to 12 times in motion, and once a day at standstill.

    Parameters
    ----------
    seed : int
        Same seed and kind, same numbers.
    kind : str
        One of :data:`robots.draw.KINDS`.
    """
    rng = np.random.default_rng([seed, crc32(kind.encode())])
    truth = draw(kind, rng)
    days, daily = [(2, 4), (2, 5), (2, 6), (3, 3), (3, 4)][rng.integers(5)]
    speeds = _speeds(truth.limits, daily, rng)
    forms = [PROGRAMMES[truth.programme][k] for k in rng.integers(len(PROGRAMMES[truth.programme]), size=daily)]
    moving, at_rest = [], []
    for day in range(1, days + 1):
        base = rng.uniform(-1, 1) if truth.carried else None
        payload = rng.uniform(0.7, 1.3) if truth.payloads else 1.0
        ambient = rng.normal(22, 2)
        for k, (form, speed) in enumerate(zip(forms, speeds, strict=True)):
            warm = ambient + truth.warming * (1 - np.exp(-k * PAUSE / WARM_UP)) - REFERENCE
            thin = np.exp(-truth.viscous_rate * warm)
            plant = truth.plant._replace(gravity=payload * truth.plant.gravity, viscous=thin * truth.plant.viscous)
            demand = form(truth.limits._replace(speed=speed), rng)
            moving.append(_recorded(f"day{day}_run{k}", f"day{day}", truth, plant, demand, base, rng))
        still = np.zeros((3, round(REST / CYCLE)))
        at_rest.append(_recorded(f"day{day}_rest", f"day{day}", truth, plant, still, base, rng))
    return Campaign(tuple(moving), tuple(at_rest), truth)


def _speeds(limits: Limits, count: int, rng: np.random.Generator) -> Float[np.ndarray, " run"]:
    """Peak speeds of a day's runs, over a decade or two; the slowest one ends a movement within about a minute."""
    slowest = min(max(0.02, 2 * np.pi * limits.amplitude / 30), 0.5 * limits.speed)
    return np.geomspace(slowest, limits.speed, count) * rng.uniform(0.7, 1, count)


def _recorded(
    name: str, session: str, truth: Truth, plant: Plant, demand: Float[np.ndarray, "3 cycle"], base: float | None,
    rng: np.random.Generator,
) -> JointRecording:  # fmt: skip
    """One recording."""
    before = round(SETTLING / CYCLE)
    tilt = truth.phase + (base or 0.0)
    states = moved(plant, truth.drive, np.pad(demand, ((0, 0), (before, 0))), tilt)
    angle, _, found, current, load, acceleration = states[:, before:]
    kept = slice(None, None, round(1 / CYCLE) // truth.rate)
    q = np.floor(angle / truth.drive.resolution) * truth.drive.resolution
    current = current + rng.normal(0, truth.current_zero) + rng.normal(0, truth.current_noise, len(q))
    signals = {"q": q, "omega": states[2, before - truth.late : len(found) + before - truth.late], "current": current}
    body = plant.motor + plant.link
    if truth.signal == "T_sensor":
        body = plant.link
        keep = np.exp(-2 * np.pi * truth.sensor_bandwidth * CYCLE)
        sensed, _ = lfilter([1 - keep], [1, -keep], load, zi=[keep * load[0]])
        noise = rng.normal(0, truth.torque_noise, len(q))
        signals["T_sensor"] = sensed + rng.normal(0, truth.torque_zero) + noise
    if truth.rigid_factor is not None:
        rigid = body * acceleration + plant.gravity * np.cos(angle + tilt)
        signals["T_rigid"] = truth.rigid_factor * rigid
    signals = {each: values[kept] for each, values in signals.items()}
    return JointRecording(
        name, "virtual robot", "joint", session, np.arange(len(signals["q"])) / truth.rate, signals,
        posture=None if base is None else np.stack([np.full_like(signals["q"], base), signals["q"]]),
        gear_ratio=plant.ratio if truth.ratio_known else None,
        torque_constant=truth.constant_known,
    )  # fmt: skip
