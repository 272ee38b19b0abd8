"""One gear at one operating point, simulated: the chain without its batches."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
from jaxtyping import Float
from matplotlib.figure import Figure

from swgsim.chain import SECTORS, Run, channels_of, simulate_runs
from swgsim.common import style
from swgsim.common.files import replacing
from swgsim.effects import Effect
from swgsim.effects.text import in_words
from swgsim.gear import Conditions, Gear, OperatingPoint, Window
from swgsim.recordings.recording import CHANNELS, Recording
from swgsim.storage import SENSORS


@dataclass(frozen=True, repr=False)
class SimulatedRun:
    """The signals of one simulated run.

    Attributes
    ----------
    run : Run
        Gear, operating point, effects and conditions.
    time : array (time,)
        [s].
    channels : mapping
        Name of :data:`swgsim.recordings.CHANNELS` to array (time,): angle ``phi_in`` [rad], speed ``n_in`` [rpm],
        torques ``T_in`` and ``T_out`` [N m], bridges ``s0`` to ``s4`` [mV/V].
    efficiency : float
        P_out / P_in over whole revolutions.
    """

    run: Run
    time: Float[np.ndarray, " time"]
    channels: Mapping[str, Float[np.ndarray, " time"]]
    efficiency: float

    @property
    def signals(self) -> Float[np.ndarray, "5 time"]:
        """The bridge signals s0 to s4 [mV/V]."""
        return np.array([self.channels[sensor] for sensor in SENSORS])

    @property
    def title(self) -> str:
        """Gear, operating point and effects in words."""
        effects = ", ".join(map(in_words, self.run.effects)) or "healthy"
        point = self.run.point
        return f"gear {self.run.gear.number}, {point.n_in_rpm:g} rpm, {point.T_out:g} N m: {effects}"

    def table(self) -> pd.DataFrame:
        """One row per sample: time and all channels under the column names of recordings, such as ``s1_mv_v``."""
        columns = {CHANNELS[name].column: values for name, values in self.channels.items()}
        return pd.DataFrame({"t_s": self.time, **columns})

    def recording(self, name: str = "simulated", *, session: str = "1", repeat: int = 1) -> Recording:
        """The run as a recording, which :func:`swgsim.commission` and :func:`swgsim.identify` take."""
        gear, point = f"gear {self.run.gear.number}", self.run.point
        return Recording(name, gear, session, point, repeat, self.time, self.channels, self.run.conditions)

    def plot(self, compare: "SimulatedRun | None" = None) -> Figure:
        """The five bridge signals over the angle of the wave generator.

        Parameters
        ----------
        compare : SimulatedRun, optional
            Drawn in grey behind it, such as the healthy gear.
        """
        figure = style.figure(7.0, 7.5)
        panels = figure.subplots(len(SENSORS), 1, sharex=True)
        for axes, sensor in zip(panels, SENSORS, strict=True):
            for each, colour in ((compare, "#aaaaaa"), (self, style.SENSOR_COLOURS[sensor])):
                if each is not None:
                    axes.plot(np.degrees(each.channels["phi_in"]), each.channels[sensor], color=colour)
            style.label(axes, "", f"{sensor} [mV/V]")
        panels[-1].set_xlabel("angle of the wave generator [°]")
        panels[0].set_title(
            self.title + ("" if compare is None else f"\n(grey: {compare.title})"), loc="left", fontsize=9
        )
        return figure

    def save(self, path: str | Path) -> None:
        """Write the table as CSV, all of it or nothing."""
        with replacing(Path(path)) as temporary:
            self.table().to_csv(temporary, index=False)

    def __repr__(self) -> str:
        """Operating point, effects and size in one line."""
        return f"<SimulatedRun {self.title}; {len(self.time)} samples, efficiency {100 * self.efficiency:.1f} %>"

    def _repr_html_(self) -> str:
        return style.html_figure(self.plot(), self.title)


def simulate(
    gear: Gear,
    point: OperatingPoint,
    *effects: Effect,
    window: Window | None = None,
    conditions: Conditions | None = None,
    start_angle: float = 0.0,
    sectors: int = SECTORS,
) -> SimulatedRun:
    """Simulate one gear in its steady state.

    Parameters
    ----------
    gear : Gear
    point : OperatingPoint
        Speed [rpm] and load [N m].
    effects : Effect
        Faults and other physical effects (:mod:`swgsim.effects`).
    window : Window, optional
        Sampling; 600 samples at 10 kHz if not given. Its noise and quantisation are left to the acquisition.
    conditions : Conditions, optional
        Temperature and the like.
    start_angle : float
        Angle of the wave generator at the first sample [rad].
    sectors : int
        Sectors of the flex spline's truss, even; more are finer.

    Returns
    -------
    SimulatedRun
        Ideal signals.

    Raises
    ------
    ValueError
        If the motion has no steady state, the window holds less than one revolution, or a value is beyond its limits.

    Examples
    --------
    >>> import swgsim as swg
    >>> sim = swg.simulate(swg.Gear(), swg.OperatingPoint(2000, 39), swg.effects.RootToothCrack(0.03, theta=1.0))
    >>> sim.signals.shape
    (5, 600)
    """
    window = window or Window()
    run = Run(gear, point, effects, start_angle, conditions or Conditions())
    simulation = simulate_runs([run], window, sectors)
    channels = channels_of(simulation, 0, window.samples)
    return SimulatedRun(run, window.time, channels, float(simulation.efficiency[0]))
