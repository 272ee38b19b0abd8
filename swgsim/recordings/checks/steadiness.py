"""Check that load and speed are steady: a recording is of one operating point."""

from collections.abc import Iterator

import numpy as np

from swgsim.recordings.checks.angle import angle_is_sound
from swgsim.recordings.checks.defect import Defect
from swgsim.recordings.checks.thresholds import SPEED_REFUSES, TORQUE_REFUSES
from swgsim.recordings.files.assembly import unwrapped
from swgsim.recordings.recording import Recording

STEADINESS_PARTS = 4
REMEDY = "cut it into recordings of one operating point each, such as by 'parts' of a map"


def steadiness_defects(recording: Recording) -> Iterator[Defect]:
    """Defects of a load or speed that differs between the quarters of a recording.

    A quarter has one revolution of the wave generator or more, so that the torques of its orders are averaged.
    """
    turns = recording.point.n_in_rpm / 60 * (recording.time[-1] - recording.time[0])
    if turns < STEADINESS_PARTS:
        return
    quarters = np.array_split(np.arange(len(recording.time)), STEADINESS_PARTS)
    if "T_out" in recording.channels:
        loads = [float(recording.channels["T_out"][rows].mean()) for rows in quarters]
        share, least = TORQUE_REFUSES
        if np.ptp(loads) > max(share * abs(recording.point.T_out), least):
            found = f"means of {min(loads):.4g} to {max(loads):.4g} N m in its quarters"
            yield Defect("unsteady_load", "refuse", recording.name, "T_out", found, "one load", REMEDY)
    if angle_is_sound(recording):
        phi = unwrapped(recording.channels["phi_in"])
        ends = [(rows[0], rows[-1]) for rows in quarters]
        rates = [(phi[last] - phi[first]) / (recording.time[last] - recording.time[first]) for first, last in ends]
        if np.ptp(rates) > SPEED_REFUSES * recording.point.omega_in:
            low, high = (float(rate) * 30 / np.pi for rate in (min(rates), max(rates)))
            found = f"speeds of {low:.4g} to {high:.4g} rpm in its quarters"
            yield Defect("unsteady_speed", "refuse", recording.name, "phi_in", found, "one speed", REMEDY)
