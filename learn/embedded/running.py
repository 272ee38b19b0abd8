"""Decisions of a program that was built with the bench, on this machine or in the emulator."""

from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from jaxtyping import Float, Int

from learn.embedded.machines import Machine, call, require_tools
from swgsim.storage.labelled_signals import SENSORS

MAGIC = 0x53574752
HEADER = np.dtype([("magic", "<u4"), ("recordings", "<u4"), ("samples", "<u4"), ("counted", "<u4")])
OPERATION = ("n_in", "T_out", "efficiency", "temperature")
PARTS = ("window", "push", "decide", "features", "classify")

# One instruction takes 2^7 ns of the emulated time, in which the board's timers tick every 40 ns (bench/meter.h).
COUNTED = ("-icount", "shift=7")


@dataclass(frozen=True)
class Decisions:
    """What a program decided on recordings.

    Attributes
    ----------
    results : array (recording,)
        Number of the class; or less than 0, no decision: the reasons are the bits of ``swg_fault`` in its negative.
    probabilities : array (recording, class)
        All 0 where there is no decision.
    instructions : dict of array (recording,), or None
        By part: all samples of the ``window``, the longest single ``push`` of them, ``decide``, and the two parts of
        that: ``features`` and ``classify``, which are 0 where there is no decision. None where they were not counted.
    stack : int or None
        Largest stack of pushing and deciding [bytes]; None where it was not counted.
    """

    results: Int[np.ndarray, " recording"]
    probabilities: Float[np.ndarray, "recording class"]
    instructions: dict[str, Int[np.ndarray, " recording"]] | None
    stack: int | None


def decide(
    program: Path,
    machine: Machine,
    recordings: Float[np.ndarray, "recording sensor sample"],
    operations: Float[np.ndarray, "recording quantity"],
    *,
    counted: bool = False,
) -> Decisions:
    """Let a program decide on recordings, one after the other.

    Parameters
    ----------
    program : Path
        Of :func:`learn.embedded.machines.build`.
    machine : Machine
        That it was built for.
    recordings : array (recording, sensor, sample)
        Signals of the gauges [mV/V]; samples behind a whole window are not used.
    operations : array (recording, quantity)
        Speed [rpm], load [N m], efficiency and temperature [degC] of each.
    counted : bool
        Count instructions and stack, which takes the emulator several times as long.

    Raises
    ------
    ValueError
        If instructions are to be counted without an emulator, or the emulator is not installed.
    RuntimeError
        If the program fails; with its message.
    """
    require_tools(machine)
    if counted and machine.emulator is None:
        raise ValueError(f"instructions cannot be counted on {machine.name}: take an emulated machine")
    command = [*(machine.emulator or ()), *(COUNTED if counted else ())]
    command += ["-kernel"] if machine.emulator else []
    with TemporaryDirectory(prefix="swg-") as folder:
        _write(Path(folder) / "recordings.bin", recordings, operations, counted)
        call([*command, str(program.resolve())], Path(folder))
        raw = (Path(folder) / "decisions.bin").read_bytes()
    return _decisions(raw, counted)


def _write(path: Path, recordings: np.ndarray, operations: np.ndarray, counted: bool) -> None:
    samples = recordings.shape[-1]
    recording = [("operation", "<f4", (len(OPERATION),)), ("sample", "<f4", (samples, len(SENSORS)))]
    body = np.empty(len(recordings), recording)
    body["operation"], body["sample"] = operations, np.moveaxis(recordings, 1, 2)
    header = np.array((MAGIC, len(recordings), samples, counted), HEADER)
    path.write_bytes(header.tobytes() + body.tobytes())


def _decisions(raw: bytes, counted: bool) -> Decisions:
    (classes,) = np.frombuffer(raw, "<u4", count=1)
    numbers = [("result", "<i4"), ("stack", "<u4"), *((part, "<u4") for part in PARTS)]
    read = np.frombuffer(raw, [*numbers, ("probability", "<f4", (classes,))], offset=classes.nbytes)
    return Decisions(
        read["result"].astype(int),
        read["probability"].copy(),
        {part: read[part].astype(int) for part in PARTS} if counted else None,
        int(read["stack"].max(initial=0)) if counted else None,
    )
