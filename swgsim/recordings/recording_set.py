"""Result of reading: recordings, defects that were found in them, a table and a picture."""

from collections.abc import Iterator
from dataclasses import dataclass
from html import escape
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from swgsim.recordings.checks.defect import Defect, summary
from swgsim.recordings.checks.order_2 import angle_of
from swgsim.recordings.recording import Recording
from swgsim.storage.labelled_signals import SENSORS

if TYPE_CHECKING:
    from matplotlib.axes import Axes


@dataclass(frozen=True, repr=False, eq=False)
class RecordingSet:
    """Recordings of one source, in its order; ``for``, ``len`` and an index or a name give the single ones.

    Attributes
    ----------
    recordings : tuple of Recording
    defects : tuple of Defect
        Findings of the checks.
    source : str
        Folder or file, for texts.
    """

    recordings: tuple[Recording, ...]
    defects: tuple[Defect, ...] = ()
    source: str = ""

    def __iter__(self) -> Iterator[Recording]:
        return iter(self.recordings)

    def __len__(self) -> int:
        return len(self.recordings)

    def __getitem__(self, which: int | str) -> Recording:
        if isinstance(which, int):
            return self.recordings[which]
        names = [recording.name for recording in self]
        if which not in names:
            raise ValueError(f"no recording {which!r} in {self.source or 'the set'}; choose from {', '.join(names)}")
        return self.recordings[names.index(which)]

    def table(self) -> pd.DataFrame:
        """One row per recording.

        Columns: name, gear, session, speed_rpm, load_nm, repeat, duration_s, channels.
        """
        rows = [
            {
                "name": each.name,
                "gear": each.gear,
                "session": each.session,
                "speed_rpm": each.point.n_in_rpm,
                "load_nm": each.point.T_out,
                "repeat": each.repeat,
                "duration_s": each.duration,
                "channels": " ".join(each.channels),
            }
            for each in self
        ]
        return pd.DataFrame(rows)

    def plot(self, which: int | str = 0, axes: "Axes | None" = None) -> "Axes":
        """Draw the gauges of one recording over the angle of the wave generator within a revolution.

        Parameters
        ----------
        which : int or str
            Number or name of the recording.
        axes : matplotlib Axes, optional
            Where to draw; by default in a new figure.

        Returns
        -------
        matplotlib Axes

        Raises
        ------
        ValueError
            If there is no such recording, or it has no gauges.
        """
        recording = self[which]
        gauges = [sensor for sensor in SENSORS if sensor in recording.channels]
        if not gauges:
            raise ValueError(
                f"recording {recording.name} has no gauge; its channels are {', '.join(recording.channels)}"
            )
        if axes is None:
            from matplotlib import pyplot

            axes = pyplot.subplots(layout="constrained")[1]
        angle = np.degrees(angle_of(recording)) % 360
        for sensor in gauges:
            axes.plot(angle, recording.channels[sensor], ".", markersize=2, label=f"$s_{sensor[1:]}$")
        axes.set(xlabel="angle of the wave generator [°]", ylabel="gauge signal [mV/V]", title=str(recording.name))
        axes.set_xticks(range(0, 361, 90))
        axes.legend(markerscale=4)
        return axes

    def __repr__(self) -> str:
        return "\n".join([self._headline(), *([summary(self.defects)] if self.defects else [])])

    def _repr_html_(self) -> str:
        """HTML of a notebook: headline, table and defects."""
        defects = f"<pre>{escape(summary(self.defects))}</pre>" if self.defects else ""
        return f"<p>{escape(self._headline())}</p>{self.table().to_html(index=False)}{defects}"

    def _headline(self) -> str:
        """One line with counts."""
        if not self.recordings:
            return "RecordingSet: empty"
        gears = ", ".join(dict.fromkeys(each.gear for each in self))
        sessions = ", ".join(dict.fromkeys(each.session for each in self))
        points = len({each.point for each in self})
        source = f" from {self.source}" if self.source else ""
        return (
            f"RecordingSet{source}: {len(self)} recordings at {points} operating points; gear {gears}; "
            f"session {sessions}; channels {' '.join(self[0].channels)}; {len(self.defects)} defects"
        )
