"""The base class of effects: the places of the chain that an effect may change.

Angles and signs, for all effects:

- ``theta`` is a position around the flex spline [rad]. It is 0 at gauge s1, pi/2 at s2, pi at s3 and 3 pi/2 at s4.
- ``psi`` or ``phi_in`` is the angle of the wave generator relative to the flex spline [rad]: the position of its major
  axis. It grows with positive rotation, which goes from s1 to s2.
- An effect with a ``theta`` is fixed to the flex spline. A wave cos(order phi_in + phase) has its phase at phi_in = 0.
- Torques are positive in the sense of rotation at the input, and against it at the load. ``T_out`` is positive when
  the gear drives the load.
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cache
from typing import ClassVar, NamedTuple

import numpy as np
from jaxtyping import Float

from swgsim.effects.quantity import Role, quantities
from swgsim.gear.conditions import Conditions
from swgsim.gear.gear import Gear, OperatingPoint

# Values over psi, the angle of the wave generator, and theta, the position around the flex spline (both [rad]).
Psi = Float[np.ndarray, " psi"]
Theta = Float[np.ndarray, " theta"]
Field = Float[np.ndarray, "psi theta"]
# Samples of one channel over time, of s0 to s4, and of all channels by name.
Samples = Float[np.ndarray, " time"]
Signals = Float[np.ndarray, "5 time"]
Channels = Mapping[str, Samples]

PLACES = ("gear", "drive", "wave generator", "mesh", "structure", "gauge", "acquisition")
# Places whose effects show in the gauges by the structure of the flex spline.
BY_STRUCTURE = ("wave generator", "mesh", "structure")


@dataclass(frozen=True)
class Crack:
    """A root tooth crack: bars of the toothed band that cross from one sector to the next have less stiffness.

    :func:`swgsim.chain.influence.change_by_cracks`
    computes the change of the signals; the truss stays as it is.

    Attributes
    ----------
    angle : float
        Position of the crack, from gauge s1 [rad].
    stiffness_ratio : float
        Remaining stiffness of one tooth pitch of the rim, above 0 up to 1.
    """

    angle: float
    stiffness_ratio: float


class Instant(NamedTuple):
    """State of the drive of several runs at one instant or at several: arrays (run,) or (time, run).

    Angles and twist [rad], speeds [rad/s], torque [N m].
    """

    phi_in: np.ndarray
    omega_in: np.ndarray
    phi_out: np.ndarray
    omega_out: np.ndarray
    twist: np.ndarray  # Delta phi_k, eq. (3)
    twist_rate: np.ndarray
    T_stiff: np.ndarray  # eq. (2)
    sliding: np.ndarray  # speed along the flank, eq. (6)


class Extra(NamedTuple):
    """Torques [N m] that an effect adds to the equations of motion: arrays as in :class:`Instant`, or numbers.

    ``T_motor`` drives the input, and its torque flange shows it. ``T_loss`` brakes the input behind the flange.
    ``T_stiff`` and ``T_fric`` add to eqs. (2) and (5), ``T_load`` to the load torque.
    """

    T_motor: np.ndarray | float = 0.0
    T_loss: np.ndarray | float = 0.0
    T_stiff: np.ndarray | float = 0.0
    T_fric: np.ndarray | float = 0.0
    T_load: np.ndarray | float = 0.0


@dataclass(frozen=True, eq=False)
class Scene:
    """State of the gear while signals are recorded.

    Attributes
    ----------
    time : array (time,)
        Since the trigger, evenly spaced [s].
    phi_in : array (time,)
        Angle of the wave generator relative to the flex spline, unwrapped [rad].
    T_out : array (time,)
        Torque transmitted to the output [N m].
    point : OperatingPoint
    conditions : Conditions
    """

    time: Samples
    phi_in: Samples
    T_out: Samples
    point: OperatingPoint
    conditions: Conditions


@dataclass(frozen=True)
class Effect:
    """A physical effect; a subclass overrides the methods of the places at which it acts.

    The methods of this base class change nothing. Fields over the circumference are sampled at the wave-generator
    angles ``psi`` and at equally spaced positions ``theta``. A subclass declares its parameters by the functions of
    :mod:`swgsim.effects.quantity`, which check them against their bounds.

    Attributes
    ----------
    place : str
        One of :data:`PLACES`.
    sharp : bool
        Whether the effect makes corners in signals. Only dense sampling gives their order lines correctly.

    Raises
    ------
    ValueError
        If a parameter is beyond its bounds; the message names value and bounds.
    """

    place: ClassVar[str] = ""
    sharp: ClassVar[bool] = False

    def __post_init__(self) -> None:
        title = self.title()
        for name, quantity in quantities(type(self)).items():
            quantity.check(title, name, getattr(self, name))

    @classmethod
    def name(cls) -> str:
        """The registered name, such as ``cam_form`` of the class CamForm."""
        return _in_snake_case(cls.__name__)

    @classmethod
    def title(cls) -> str:
        """The name in words."""
        return cls.name().replace("_", " ").replace("stribeck", "Stribeck")

    def at(self, point: OperatingPoint, conditions: Conditions) -> "Effect":
        """The effect at an operating point and under the conditions of a recording."""
        return self

    def drawn(self, rng: np.random.Generator) -> "Effect":
        """The effect in one recording: phases that differ from recording to recording are drawn."""
        random = [name for name, quantity in quantities(type(self)).items() if quantity.role is Role.RANDOM]
        return replace(self, **{name: float(rng.uniform(0, 2 * np.pi)) for name in random})

    def parts(self) -> tuple["Effect", ...]:
        """Independent parts of the effect, each with its own size, such as hum in the cable of each gauge."""
        return (self,)

    def gear(self, gear: Gear) -> Gear:
        """A gear with changed parameters."""
        return gear

    def drive(self, now: Instant) -> Extra:
        """Torques to add to the equations of motion; they have the period of one wave-generator revolution."""
        return Extra()

    def wave_generator(self, displacement: Field, psi: Psi, theta: Theta) -> Field:
        """Radial displacement [m] that the wave generator imposes on the sleeve."""
        return displacement

    def engaged(self, depth: Field, psi: Psi, theta: Theta) -> Field:
        """Depth of engagement [m], in proportion to which teeth share the force; by default the displacement."""
        return depth

    def mesh(self, share: Field, psi: Psi, theta: Theta) -> Field:
        """Share of the tangential force at each angle; the chain scales the shares to the sum 1."""
        return share

    def carried(self, share: Field, psi: Psi, theta: Theta) -> Field:
        """Share of the tangential force at each angle after a loss that other angles do not take over."""
        return share

    def cracks(self) -> tuple[Crack, ...]:
        """Root cracks: positions where the rim has less stiffness."""
        return ()

    def gauge(self, signals: Signals, scene: Scene) -> Signals:
        """The bridge signals [mV/V]."""
        return signals

    def acquisition(self, channels: Channels, scene: Scene) -> Channels:
        """Every recorded channel by its name (:data:`swgsim.recordings.recording.CHANNELS`), in its unit."""
        return channels


@cache  # a search makes very many effects
def _in_snake_case(name: str) -> str:
    return re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", name).lower()


def overrides(effect: Effect, *methods: str) -> bool:
    """Whether an effect has its own version of one of these methods."""
    kind: type = type(effect)
    return _overrides(kind, methods)


@cache  # not the function above, as mypy takes no class of effects for hashable
def _overrides(kind: type, methods: tuple[str, ...]) -> bool:
    return any(getattr(kind, method) is not getattr(Effect, method) for method in methods)
