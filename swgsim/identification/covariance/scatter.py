"""Errors of single recordings: differences between repeats of the same gear at the same operating point."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from swgsim.effects import ParameterScatter
from swgsim.effects.frozen import FULL_LOAD
from swgsim.effects.kinematic_error_order import KinematicErrorOrder
from swgsim.gear.gear import CATALOGUE_LIMITS
from swgsim.identification.data.beat import BEATING, OF_ERROR, drifting
from swgsim.identification.data.features import Layout
from swgsim.identification.data.measured import Measured
from swgsim.identification.data.model import Model, Situation, predict

# Standard deviations that a test bench would state (conf/condition/bench.yaml); repeats correct them. Where two devices
# log the drive and the gauges, the gauges have a trigger of their own: it misses the other by 0.1 degree (an estimate,
# half the jitter of the index). The sizes of the beats (data/beat.py) are estimates too. Those at sums of two orders
# grow with the load: the stated ones are those of half the rated torque.
STATED = {
    "load": 0.005,
    "speed": 0.001,
    "trigger": 0.0035,
    "trigger of gauges": 0.0017,
    "viscous friction": 0.05,
    "dry friction": 0.02,
    "flank friction": 0.02,
    **{
        f"beat of order {order}, {wave}": 2e-6 if order in OF_ERROR else 2e-7
        for order in BEATING
        for wave in ("cosine", "sine")
    },
    "zero of n_in": 0.1,
    "zero of T_in": 0.001,
    "zero of T_out": 0.05,
    **{f"zero of s{sensor}": 0.001 for sensor in range(5)},
}
BEATS = tuple(kind for kind in STATED if kind.startswith("beat"))
# The stated values are good to this factor (standard deviation of the logarithm).
DOUBT = np.log(3.0)
# Those found by commissioning hold on another day to this factor.
CARRIED = np.log(1.5)
# Changes common to all recordings, or in proportion to temperature, time or load, are not errors of single recordings.
# Their prior, in stated standard deviations: per kelvin as thermal output, at full load as the gain of a gauge within
# its bounds (wide for friction and torques); the other two are estimates.
COMMON, PER_KELVIN, PER_HOUR, AT_FULL_LOAD = 20.0, 5.0, 20.0, 100.0
# Friction of a gear whose temperature was not recorded, as a share: 3 % per kelvin (physics.md DY3), and 5 K as the
# standard deviation of a gear that warms up over a session (an estimate).
UNRECORDED = 0.15
# Step of the differences: small against any nonlinearity, large against rounding.
STEP, BEAT_STEP = 1e-3, 1e-6


@dataclass(frozen=True)
class Scatter:
    """Standard deviations of the errors of single recordings.

    Attributes
    ----------
    sd : mapping
        Name as in :data:`STATED` to standard deviation, relative for load, speed and friction, else in the unit; of the
        beat in rad at the output.
    repeats : int
        Contrasts between repeats that the estimate rests on; 0 where nothing was repeated.
    doubt : array (kind, kind)
        Covariance of the logarithms of the standard deviations.
    """

    sd: dict[str, float]
    repeats: int
    doubt: Float[np.ndarray, "kind kind"]

    @classmethod
    def stated(cls, layout: Layout) -> "Scatter":
        """What a test bench states, without any repeats."""
        names = kinds(layout)
        return cls({name: STATED[name] for name in names}, 0, DOUBT**2 * np.eye(len(names)))

    @property
    def carried(self) -> "Scatter":
        """The prior for recordings of another session."""
        return replace(self, doubt=self.doubt + CARRIED**2 * np.eye(len(self.doubt)))

    @property
    def with_unrecorded_temperature(self) -> "Scatter":
        """Friction scatters at least by a warming that was not recorded; repeats in a row do not show it."""
        least = {name: UNRECORDED if name in ("viscous friction", "dry friction") else 0.0 for name in self.sd}
        return replace(self, sd={name: max(sd, least[name]) for name, sd in self.sd.items()})

    def drawn(self, rng: np.random.Generator, draws: int) -> Float[np.ndarray, "kind draw"]:
        """Factors on the standard deviations, as large as the repeats leave them."""
        root = np.linalg.cholesky(self.doubt + 1e-12 * np.eye(len(self.doubt)))
        return np.exp(root @ rng.standard_normal((len(root), draws)))

    def columns(self, directions: Float[np.ndarray, "situation feature kind"]) -> np.ndarray:
        """Directions scaled to one standard deviation."""
        return directions * np.array(list(self.sd.values()))


def kinds(layout: Layout) -> list[str]:
    """The errors that the channels can show."""
    return [
        kind for kind in STATED if not kind.startswith("zero of ") or kind.removeprefix("zero of ") in layout.channels
    ]


def directions(
    model: Model, situations: Sequence[Situation], layout: Layout
) -> Float[np.ndarray, "situation feature kind"]:
    """How the features of each situation move with a unit of every error."""

    def shifted(name: str) -> list[Situation]:
        values = [getattr(s.point, name) * (1 + by) for s, by in zip(situations, steps[name], strict=True)]
        return [
            replace(s, point=replace(s.point, **{name: value})) for s, value in zip(situations, values, strict=True)
        ]

    # Downwards where a step upwards leads beyond what a gear may bear.
    steps = {
        name: np.array([STEP if getattr(s.point, name) * (1 + STEP) <= most else -STEP for s in situations])
        for name, most in CATALOGUE_LIMITS.items()
    }
    t = model.gear.transmission
    viscous = model.plus(ParameterScatter(1 + STEP, 1.0))
    dry = replace(model, gear=model.gear.with_transmission(b0=t.b0 * (1 + STEP)))
    flanks = replace(model, gear=model.gear.with_transmission(mu=t.mu * (1 + STEP)))
    beats = [
        model.plus(KinematicErrorOrder(order, BEAT_STEP, phase)) for order in BEATING for phase in (np.pi / 2, 0.0)
    ]
    everywhere = [*situations, *shifted("T_out"), *shifted("n_in_rpm")]
    base, loaded, faster = np.split(predict([model], everywhere, layout)[0], 3)
    others = predict([viscous, dry, flanks, *beats], situations, layout)
    slopes = {
        "load": (loaded - base) / steps["T_out"][:, None],
        "speed": (faster - base) / steps["n_in_rpm"][:, None],
    }
    for kind, there in zip(("viscous friction", "dry friction", "flank friction", *BEATS), others, strict=True):
        slopes[kind] = (there - base) / (BEAT_STEP if kind in BEATS else STEP)
    found = []
    for kind in kinds(layout):
        if kind in slopes:
            found.append(slopes[kind])
        elif kind == "trigger":
            found.append(layout.turning(base))
        elif kind == "trigger of gauges":
            found.append(layout.turning(base) * layout.of_gauges)
        else:
            channel = kind.removeprefix("zero of ")
            found.append(np.broadcast_to((layout.channel == channel) & (layout.order == 0), base.shape).astype(float))
    return np.stack(found, axis=-1)


def of_recordings(model: Model, measured: Measured) -> Float[np.ndarray, "recording feature kind"]:
    """Change of each recording per unit of every error.

    Triggers turn recorded lines, not predicted ones. A beat drifts over the revolutions of each recording.
    """
    layout = measured.layout
    names = kinds(layout)
    moves = directions(model, measured.situations, layout)[measured.of_recording]
    moves[..., names.index("trigger")] = measured.turning
    moves[..., names.index("trigger of gauges")] = measured.turning * layout.of_gauges
    beats = [names.index(kind) for kind in BEATS]
    still = moves[..., beats].reshape(len(measured), len(layout.channels), -1, len(BEATING), 2)
    drift = drifting(measured.recordings, model.gear.transmission.N)
    drifted = np.einsum("rbij,rcjb->rcib", drift, still[..., 0] - 1j * still[..., 1])
    moves[..., beats] = np.stack([drifted.real, -drifted.imag], axis=-1).reshape(len(measured), len(layout), -1)
    return moves


def trends(
    directions: Float[np.ndarray, "recording feature kind"], situations: Sequence[Situation], layout: Layout
) -> Float[np.ndarray, "recording feature column"]:
    """How the features move with errors that are no errors of single recordings.

    Those that all recordings have in common, and friction and zeros that follow the temperature, then the time since
    their session began, then the load, alike in all sessions.
    """
    names = kinds(layout)
    moves = directions * np.array([STATED[name] for name in names])
    following = moves[..., [number for number, name in enumerate(names) if "friction" in name or "zero" in name]]
    laws = [
        PER_KELVIN * np.array([each.conditions.warmer for each in situations]),
        PER_HOUR * np.array([each.conditions.elapsed for each in situations]) / 3600,
        AT_FULL_LOAD * np.array([each.point.T_out for each in situations]) / FULL_LOAD,
    ]
    return np.concatenate([COMMON * moves, *(following * law[:, None, None] for law in laws)], axis=-1)
