"""Dynamic input/output model of the gear, eqs. (1) to (6), for many runs at once.

========  ==================================  ==============================
equation  quantity                            where
========  ==================================  ==============================
(1)       accelerations phi_in'', phi_out''   :meth:`Drive.derivative`
(2)       stiffness torque T_stiff            :meth:`Drive.stiffness_torque`
(3)       twist Delta phi_k                   :meth:`Drive.twist`
(4)       wedge angle alpha_in                :class:`Drive`, ``tan_in``
(5)       friction torque T_fric              :meth:`Drive.friction_torque`
(6)       sliding speed phi_b'                :meth:`Drive.sliding_speed`
========  ==================================  ==============================

Frame: the flex spline is clamped. phi_in is the angle of the wave generator relative to the flex spline, which is the
angle that the gauges feel. phi_out is the angle of the circular spline, the output. The paper writes eqs. (3) and (6)
for angles relative to the circular spline, so phi_in - phi_out and -phi_out replace phi_in and phi_out.

The equations of motion follow from virtual work of T_stiff on Delta phi_k and of T_fric on phi_b. As phi_err depends on
phi_in, its slope is part of the input's lever. Some published equations leave it out; ``error_lever`` is 0 then:

    J_in  phi_in''  = T_motor - (tan(alpha_in) + error_lever dphi_err/dphi_in) T_stiff
    J_out phi_out'' = T_out - T_load,   T_out = T_stiff / tan(alpha_tooth) - T_fric / sin(alpha_tooth)

Effects may add to T_stiff, T_fric and T_load, brake the input, or add to the torque of the motor.
"""

from collections.abc import Iterable, Sequence
from copy import copy
from dataclasses import dataclass, fields

import numpy as np
from jaxtyping import Complex, Float

from swgsim.effects.base import Effect, Extra, Instant, overrides
from swgsim.effects.sense import sense
from swgsim.gear.gear import OperatingPoint, Transmission

PHI_IN, OMEGA_IN, PHI_OUT, OMEGA_OUT, SPEED_ERROR = range(5)
# Arrays (run,) at one instant, or (time, run) at several.
State = Float[np.ndarray, "5 *any run"]


@dataclass(frozen=True)
class Torques:
    """Torques [N m] and sliding speed [rad/s], each an array (run,) or (time, run); a constant load may stay (run,).

    Attributes
    ----------
    T_motor, T_wedge : array
        Torque that drives the input, and torque that brakes it: wave generator and losses.
    T_in : array
        Torque at the input flange, behind the rotor with its share of J_in.
    T_stiff, T_fric : array
        Eqs. (2) and (5).
    T_out, T_flange : array
        Torque that the gear transmits, and torque at the output flange, behind a share of J_out.
    T_load : array
        Torque of the load.
    sliding : array
        Eq. (6).
    """

    T_motor: Float[np.ndarray, "*any run"]
    T_in: Float[np.ndarray, "*any run"]
    T_wedge: Float[np.ndarray, "*any run"]
    T_stiff: Float[np.ndarray, "*any run"]
    T_fric: Float[np.ndarray, "*any run"]
    T_out: Float[np.ndarray, "*any run"]
    T_flange: Float[np.ndarray, "*any run"]
    T_load: Float[np.ndarray, "*constant run"]
    sliding: Float[np.ndarray, "*any run"]


class Drive:
    """The equations of motion of many runs at once.

    The rows of a state are phi_in [rad], omega_in [rad/s], phi_out [rad], omega_out [rad/s] and the integral of the
    speed error [rad], which belongs to the speed control of the input.

    Parameters
    ----------
    transmissions, points : sequences of equal length
        One gear and one operating point per run.
    effects : sequence of tuples of Effect, optional
        The effects on the drive of each run.
    """

    def __init__(
        self,
        transmissions: Sequence[Transmission],
        points: Sequence[OperatingPoint],
        effects: Sequence[tuple[Effect, ...]] = (),
    ) -> None:
        if not transmissions or len(transmissions) != len(points):
            raise ValueError(f"{len(transmissions)} gears and {len(points)} operating points: expected one per run")
        self.transmissions, self.points = tuple(transmissions), tuple(points)
        numbers = [f.name for f in fields(Transmission) if f.name != "kinematic_error"]
        self.p = p = {name: np.array([getattr(t, name) for t in transmissions], float) for name in numbers}
        self.omega = np.array([point.omega_in for point in points])
        self.T_load = np.array([point.T_out for point in points])
        self.sin_t, self.cos_t, self.tan_t = (f(p["alpha_tooth"]) for f in (np.sin, np.cos, np.tan))
        self.tan_in = 1 / ((p["N"] + 1) * self.tan_t)  # eq. (4)
        rate = 2 * np.pi * p["control_frequency"]
        self.gain_p, self.gain_i = 2 * p["control_damping"] * rate * p["J_in"], rate**2 * p["J_in"]
        self.error = self._error_amplitudes()
        self.effects = tuple(effects) or ((),) * len(self)
        acting = [(i, effect) for i, own in enumerate(self.effects) for effect in own if overrides(effect, "drive")]
        distinct = dict.fromkeys(effect for _, effect in acting)
        self.acting = [(effect, _together(sorted({i for i, each in acting if each == effect}))) for effect in distinct]

    def _error_amplitudes(self) -> dict[int, Complex[np.ndarray, " run"]]:
        """Complex amplitude of the kinematic error per order, as a twist [rad]."""
        amplitudes: dict[int, np.ndarray] = {}
        for i, transmission in enumerate(self.transmissions):
            for term in transmission.kinematic_error:
                row = amplitudes.setdefault(term.order, np.zeros(len(self), complex))
                row[i] += term.amplitude / self.tan_t[i] * np.exp(1j * term.phase)
        return amplitudes

    def __len__(self) -> int:
        return len(self.omega)

    @property
    def period(self) -> Float[np.ndarray, " run"]:
        """Time of one revolution of the wave generator [s]."""
        return 2 * np.pi / self.omega

    def repeated(self, times: int) -> "Drive":
        """Every run ``times`` times, repeats next to each other."""
        return self.part([run for run in range(len(self)) for _ in range(times)])

    def part(self, runs: Iterable[int]) -> "Drive":
        """The runs of these numbers, which may come more than once."""
        chosen = [(self.transmissions[run], self.points[run], self.effects[run]) for run in runs]
        return Drive(*zip(*chosen, strict=True))

    def with_more_load(self, added: float) -> "Drive":
        """The same with a load torque that is higher by so much [N m]; it may be higher than any operating point's."""
        more = copy(self)
        more.T_load = self.T_load + added
        return more

    def phi_err(self, phi_in: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Kinematic error phi_err of eq. (3) as a twist [rad], and its slope over phi_in.

        An error e at the output is e / tan(alpha_tooth) as a twist.
        """
        error = slope = np.zeros(phi_in.shape)
        turns = {1: np.exp(1j * phi_in)}
        for order, amplitude in self.error.items():
            term = amplitude * _power(turns, order)
            error = error + term.imag
            slope = slope + order * term.real
        return error, slope

    def twist(self, phi_in: np.ndarray, phi_out: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Twist of the stiffness, eq. (3).

        Delta phi_k = tan(alpha_in) phi_in - phi_out / tan(alpha_tooth) + phi_err: with phi_in - phi_out for phi_in and
        -phi_out for phi_out the terms of phi_out add up to this.

        Parameters
        ----------
        phi_in, phi_out : arrays
            Angles of wave generator and output relative to the flex spline [rad].

        Returns
        -------
        twist : array
            Delta phi_k [rad].
        slope : array
            dphi_err / dphi_in [-].
        """
        phi_err, slope = self.phi_err(phi_in)
        return self.tan_in * phi_in - phi_out / self.tan_t + phi_err, slope

    def stiffness_torque(self, twist: np.ndarray) -> np.ndarray:
        """T_stiff = k1 Delta phi_k + k2 (Delta phi_k)^3 [N m], eq. (2).

        Parameters
        ----------
        twist : array
            Delta phi_k [rad]; k1 is in N m/rad, k2 in N m/rad^3.
        """
        return (self.p["k1"] + self.p["k2"] * twist * twist) * twist

    def sliding_speed(self, omega_out: np.ndarray) -> np.ndarray:
        """Sliding speed along the flank, eq. (6): phi_b' = omega_out / sin(alpha_tooth) [rad/s].

        The paper's minus sign belongs to its phi_out relative to the circular spline.
        """
        return omega_out / self.sin_t

    def unloaded_friction(
        self, sliding: np.ndarray, phi_out: np.ndarray, added: np.ndarray | float = 0.0
    ) -> np.ndarray:
        """The terms of eq. (5) that do not depend on the load, with the friction torque of effects [N m].

        b0 + b1 phi_b' + b2 phi_b'^3 + b3 sin(theta_b - phi_out); the terms without phi_b' have its sign, which is
        smooth near standstill. The paper has sin(phi_out + theta_b), as its phi_out has the other sign. Parameters are
        those of :meth:`friction_torque`.
        """
        p = self.p
        against = sense(sliding) * (p["b0"] + p["b3"] * np.sin(p["theta_b"] - phi_out))
        return (p["b1"] + p["b2"] * sliding * sliding) * sliding + (against + added)

    def friction_torque(
        self, sliding: np.ndarray, phi_out: np.ndarray, T_stiff: np.ndarray, added: np.ndarray | float
    ) -> np.ndarray:
        """Friction torque at the flank, eq. (5) [N m].

        T_fric = :meth:`unloaded_friction` + mu F_n; mu has no unit. The massless tooth is in equilibrium on the
        driving flank, T_stiff = F_n sin(alpha_tooth) + T_fric cos(alpha_tooth), which gives the normal force F_n [N m].

        Parameters
        ----------
        sliding : array
            phi_b' [rad/s]; b1 is in N m s/rad, b2 in N m s^3/rad^3, b0 and b3 in N m.
        phi_out : array
            Angle of the output [rad]; theta_b is in rad.
        T_stiff : array
            Eq. (2), with effects [N m].
        added : array or float
            Friction torque of effects [N m].
        """
        mu, sign = self.p["mu"], sense(sliding)
        friction = self.unloaded_friction(sliding, phi_out, added)
        F_n = np.abs(T_stiff - friction * self.cos_t) / (self.sin_t + mu * sign * self.cos_t)
        return friction + mu * sign * F_n

    def torques(self, state: State) -> Torques:
        """All torques of a state: eqs. (2), (3), (5), (6), the effects and the speed control."""
        phi_in, omega_in, phi_out, omega_out, speed_error = state
        p = self.p
        twist, slope = self.twist(phi_in, phi_out)
        T_stiff, sliding = self.stiffness_torque(twist), self.sliding_speed(omega_out)
        twist_rate = (self.tan_in + slope) * omega_in - omega_out / self.tan_t
        extra = self.extra(Instant(phi_in, omega_in, phi_out, omega_out, twist, twist_rate, T_stiff, sliding))
        T_stiff = T_stiff + extra.T_stiff
        T_fric = self.friction_torque(sliding, phi_out, T_stiff, extra.T_fric)
        T_out = T_stiff / self.tan_t - T_fric / self.sin_t
        T_motor = self.gain_p * (self.omega - omega_in) + self.gain_i * speed_error + extra.T_motor
        T_wedge = (self.tan_in + p["error_lever"] * slope) * T_stiff + extra.T_loss
        T_in = T_motor - p["rotor_share"] * (T_motor - T_wedge)
        T_load = self.T_load + extra.T_load
        T_flange = T_out - p["load_share"] * (T_out - T_load)
        return Torques(T_motor, T_in, T_wedge, T_stiff, T_fric, T_out, T_flange, T_load, sliding)

    def extra(self, now: Instant) -> Extra:
        """Sum of the torques of all effects."""
        if not self.acting:
            return Extra()
        instants, total = np.stack(now), np.zeros((len(Extra._fields), *now.phi_in.shape))
        for effect, runs in self.acting:
            added = effect.drive(Instant(*instants[..., runs]))
            for row, torque in zip(total, added, strict=True):
                if isinstance(torque, np.ndarray) or torque:
                    row[..., runs] += torque
        return Extra(*total)

    def derivative(self, state: State, torques: Torques) -> State:
        """Rates of the state, eq. (1): phi'' = f(phi, phi', n_in,d, T_out,d) [rad/s^2].

        Parameters
        ----------
        state : array (5, run) or (5, time, run)
        torques : Torques
            Those of the state; J_in and J_out are in kg m^2.
        """
        rate = np.empty_like(state)
        rate[PHI_IN] = state[OMEGA_IN]
        rate[OMEGA_IN] = (torques.T_motor - torques.T_wedge) / self.p["J_in"]
        rate[PHI_OUT] = state[OMEGA_OUT]
        rate[OMEGA_OUT] = (torques.T_out - torques.T_load) / self.p["J_out"]
        rate[SPEED_ERROR] = self.omega - state[OMEGA_IN]
        return rate

    def step(self, state: State, torques: Torques, dt: Float[np.ndarray, " run"]) -> State:
        """One step of the classical Runge-Kutta method of order 4; ``torques`` are those at ``state``."""
        k1 = self.derivative(state, torques)
        middle = state + 0.5 * dt * k1
        k2 = self.derivative(middle, self.torques(middle))
        middle = state + 0.5 * dt * k2
        k3 = self.derivative(middle, self.torques(middle))
        end = state + dt * k3
        k4 = self.derivative(end, self.torques(end))
        return state + dt / 6 * (k1 + 2 * (k2 + k3) + k4)


def _power(known: dict[int, np.ndarray], order: int) -> np.ndarray:
    """An integer power by repeated multiplication, as a complex power is much slower; results are kept in ``known``."""
    if order not in known:
        known[order] = _power(known, order // 2) * _power(known, order - order // 2)
    return known[order]


def _together(runs: list[int]) -> slice | np.ndarray:
    """Indices of runs; a slice, which copies nothing, if they are consecutive."""
    first, last = runs[0], runs[-1]
    return slice(first, last + 1) if last - first == len(runs) - 1 else np.array(runs)
