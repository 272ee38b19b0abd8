"""Files as people have them, each with the map that reads it: the examples of docs/formats.md.

Run ``python tests/tables/formats.py`` to write the page anew.
"""

import gzip
import json
import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from textwrap import dedent

import h5py
import numpy as np
import openpyxl
import pandas as pd
import pyuff
from asammdf import MDF, Signal
from format_fixtures import function
from nptdms import ChannelObject, TdmsWriter
from scipy.io import savemat

HEAD = Path(__file__).parent / "formats_head.md"
PAGE = Path(__file__).parents[2] / "docs" / "formats.md"
TIME = np.arange(120) / 1000
PHI = 0.2 + 209.0 * TIME
GAUGES = {"phi_in": PHI, "T_out": 39.5 + 0.1 * np.cos(2 * PHI), "s1": 0.06 + 0.17 * np.cos(2 * PHI)}
Q = 0.8 * np.sin(20.0 * TIME)
OMEGA = 16.0 * np.cos(20.0 * TIME)
JOINT = {"q": Q, "omega": OMEGA, "current": 2.0 + 0.1 * OMEGA}
FACTS = """facts: {gear: A17, session: monday, n_in_rpm: 2000, T_out_nm: 39.5, repeat: 1}
"""
ROBOT = """robot: my robot
files: ['*']
"""


@dataclass(frozen=True)
class Example:
    """Files, and the map that reads them.

    Attributes
    ----------
    title : str
    of : dict
        Truth by channel or signal, in SI units or those of :data:`swgsim.recordings.recording.CHANNELS`.
    write : callable
        Writes the files into a folder.
    text : str
        The map, without what all maps of gauges or joints have.
    tolerance : float
        Of the numbers in the files, relative to the largest one.
    """

    title: str
    of: dict[str, np.ndarray]
    write: Callable[[Path], None]
    text: str
    tolerance: float = 1e-8

    @property
    def map(self) -> str:
        """The whole map."""
        common = (FACTS if "n_in_rpm" not in self.text else "") if "s1" in self.of else ROBOT
        text = dedent(self.text)
        parts = (text, common) if "s1" in self.of else (common, text)
        return "\n".join(part.strip("\n") for part in parts if part) + "\n"


def table(
    name: str,
    columns: dict[str, np.ndarray],
    *,
    before: str = "",
    units: str = "",
    header: bool = True,
    separator: str = ",",
    decimal: str = ".",
    encoding: str = "utf-8",
) -> Callable[[Path], None]:
    """A writer of one text file."""

    def write(folder: Path) -> None:
        rows = [separator.join(columns)] if header else []
        rows += [units] if units else []
        cells = zip(*columns.values(), strict=True)
        rows += [separator.join(shown(cell).replace(".", decimal) for cell in row) for row in cells]
        text = before + "\n".join(rows) + "\n"
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(gzip.compress(text.encode(encoding)) if name.endswith(".gz") else text.encode(encoding))

    return write


def shown(cell: object) -> str:
    """A cell with ten digits."""
    return f"{cell:.10g}" if isinstance(cell, float) else str(cell)


def below(name: str, before: str, *tables: dict[str, np.ndarray]) -> Callable[[Path], None]:
    """A writer of one text file with several tables below one another."""

    def write(folder: Path) -> None:
        text = ""
        for columns in tables:
            table(name, columns, before=text + before, separator="\t")(folder)
            text = (folder / name).read_text(encoding="utf-8") + "\n"

    return write


def json_lines(path: Path) -> None:
    """The messages of a robot, one in each line."""
    rows = zip(SECONDS.tolist(), NANOSECONDS.tolist(), Q, OMEGA, JOINT["current"], strict=True)
    path.write_text(
        "\n".join(
            json.dumps({"stamp": {"sec": sec, "nanosec": ns}, "position": [9.0, q], "velocity": [9.0, w], "i": i})
            for sec, ns, q, w, i in rows
        ),
        encoding="utf-8",
    )


def lists(*columns: np.ndarray) -> list[str]:
    """Cells of a CSV with one list for each row."""
    return ['"[' + ", ".join(map(shown, row)) + ']"' for row in np.transpose(columns).tolist()]


def saved(name: str, save: Callable[[Path], object]) -> Callable[[Path], None]:
    """A writer of one binary file."""

    def write(folder: Path) -> None:
        save(folder / name)

    return write


def several(*writers: Callable[[Path], None]) -> Callable[[Path], None]:
    """A writer of several files."""

    def write(folder: Path) -> None:
        for each in writers:
            each(folder)

    return write


DEG, N = np.degrees, len(TIME)
ENGLISH = {"Time [s]": TIME, "Angle [deg]": DEG(PHI), "Torque [Nm]": GAUGES["T_out"], "Ch1 (mV/V)": GAUGES["s1"]}
GERMAN = {"Zeit": TIME, "Winkel [°]": DEG(PHI), "M_ab [Nm]": GAUGES["T_out"], "Brücke 1 [µV/V]": 1e3 * GAUGES["s1"]}
PLAIN = {"t": TIME, "angle": DEG(PHI), "torque": GAUGES["T_out"], "bridge": GAUGES["s1"]}
IN_ENGLISH = """
channels:
  t: {column: 'Time [s]', unit: s}
  phi_in: {column: 'Angle [deg]', unit: deg}
  T_out: {column: 'Torque [Nm]', unit: N m}
  s1: {column: 'Ch1 (mV/V)', unit: mV/V}
"""
IN_GERMAN = """
channels:
  t: {column: Zeit, unit: s}
  phi_in: {column: 'Winkel [°]', unit: °}
  T_out: {column: 'M_ab [Nm]', unit: N m}
  s1: {column: 'Brücke 1 [µV/V]', unit: µV/V}
"""
IN_PLAIN = """
channels:
  t: {column: t, unit: s}
  phi_in: {column: angle, unit: deg}
  T_out: {column: torque, unit: N m}
  s1: {column: bridge, unit: mV/V}
"""
LOG = {"t": TIME, "q": Q, "qd": OMEGA, "i": JOINT["current"]}
WEAKER = LOG | {"q": 0.9 * Q, "qd": 0.9 * OMEGA}
OF_LOG = """
time: {column: t, unit: s}
joints:
  elbow:
    gear_ratio: 100
    signals:
      q: {column: q, unit: rad}
      omega: {column: qd, unit: rad/s}
      current: {column: i, unit: A}
"""
SECONDS = np.floor(1.75e9 + TIME).astype(int)
NANOSECONDS = np.round((TIME % 1) * 1e9).astype(int)
STAMPS = pd.Timestamp("2026-03-12T10:22:31") + pd.to_timedelta(TIME, unit="s")

TEXT = (
    Example("CSV with names and units of your own", GAUGES, table("run1.csv", {**ENGLISH, "Status": ["OK"] * N}),
            IN_ENGLISH),
    Example("CSV from Excel in most of Europe: semicolons, decimal commas, text of Windows", GAUGES,
            table("run1.csv", GERMAN, separator=";", decimal=",", encoding="cp1252"),
            "separator: ';'\ndecimal: ','\nencoding: cp1252" + IN_GERMAN),
    Example("Unicode text from Excel", GAUGES,
            table("run1.txt", GERMAN, separator="\t", decimal=",", encoding="utf-16"),
            "separator: tab\ndecimal: ','\nencoding: utf-16" + IN_GERMAN
            + "facts: {gear: A17, session: monday}\nfiles:\n  run1.txt: {n_in_rpm: 2000, T_out_nm: 39.5, repeat: 1}"),
    Example("ASCII export of catman: lines before the names, a row of units", GAUGES,
            table("run1.asc", GERMAN, separator="\t", decimal=",", encoding="cp1252", units="[s]\t[°]\t[Nm]\t[µV/V]",
                  before="HBM-Datei\nDATUM: 12.03.2026\nKanäle: 3\nAbtastrate: 1000 Hz\n\n"),
            "separator: tab\ndecimal: ','\nencoding: cp1252\nheader_row: 6\nfirst_row: 8" + IN_GERMAN),
    Example("LabVIEW measurement file", GAUGES,
            table("run1.lvm", {"X_Value": TIME, **dict(list(ENGLISH.items())[1:]), "Comment": [""] * N}, separator="\t",
                  before="LabVIEW Measurement\nSeparator\tTab\n***End_of_Header***\n\nChannels\t3\n"
                  "***End_of_Header***\n"),
            "separator: tab\nheader_row: 7" + IN_ENGLISH.replace("'Time [s]'", "X_Value")),
    Example("PicoScope: a row of units, then a blank row", GAUGES,
            table("run1.csv", ENGLISH, units="(s),(deg),(Nm),(mV/V)\n"), "first_row: 4" + IN_ENGLISH),
    Example("Comments before and between the rows", GAUGES,
            table("run1.dat", PLAIN, before="# bench 3, firmware 1.12\n# 2026-03-12\n"), "comment: '#'" + IN_PLAIN),
    Example("Compressed text", GAUGES, table("run1.csv.gz", PLAIN), IN_PLAIN),
    Example("No names: columns have numbers from 1", GAUGES,
            table("run1.csv", PLAIN, header=False), "header: false" + IN_PLAIN.replace("column: t,", "column: 1,")
            .replace("angle", "2").replace("torque", "3").replace("bridge", "4")),
    Example("Speed, load and repeat in the name of the file", GAUGES, table("2000rpm_39.5Nm_1.csv", PLAIN),
            r"path: '(?P<n_in_rpm>\d+)rpm_(?P<T_out_nm>[\d.]+)Nm_(?P<repeat>\d+)\.csv'" + IN_PLAIN
            + "facts: {gear: A17, session: monday}"),
    Example("Speed, load and repeat in lines before the names", GAUGES,
            table("run1.asc", GERMAN, separator="\t", decimal=",", before="Prüfstand 3\nDrehzahl: 2000 1/min\n"
                  "Drehmoment: 39,5 Nm, Lauf 1\n\n"),
            "separator: tab\ndecimal: ','\nheader_row: 5\nhead:\n- 'Drehzahl: (?P<n_in_rpm>[0-9]+)'\n"
            "- 'Drehmoment: (?P<T_out_nm>[0-9,]+) Nm, Lauf (?P<repeat>[0-9]+)'" + IN_GERMAN
            + "facts: {gear: A17, session: monday}"),
    Example("One file for each channel", GAUGES,
            several(*(table(f"run1_{name}.csv", {"t": TIME, "value": PLAIN[name]})
                      for name in ("angle", "torque", "bridge"))),
            r"""
            path: '(?P<recording>run\d+)_(?P<signal>[a-z]+)\.csv'
            channels:
              t: {file: angle, column: t, unit: s}
              phi_in: {file: angle, column: value, unit: deg}
              T_out: {file: torque, column: value, unit: N m}
              s1: {file: bridge, column: value, unit: mV/V}
            """),
    Example("No time, but a sampling rate", GAUGES, table("run1.csv", PLAIN),
            "sampling_rate_hz: 1000" + IN_PLAIN.replace("  t: {column: t, unit: s}\n", "")),
    Example("Lost readings: their rows are left out, at most ten", GAUGES,
            table("run1.csv", PLAIN | {"bridge": [*GAUGES["s1"][:-1], "ERR"]}),
            "lost: {values: [ERR], leave_out: 10}" + IN_PLAIN),
    Example("Counts of an encoder, volts of an amplifier, own factor and offset", GAUGES,
            table("run1.csv", {"t": TIME, "counts": PHI * 4096 / (2 * np.pi), "torque": (GAUGES["T_out"] - 3) / 20,
                               "volts": 5 * GAUGES["s1"]}),
            """
            channels:
              t: {column: t, unit: s}
              phi_in: {column: counts, unit: counts, per_revolution: 4096}
              T_out: {column: torque, unit: N m, factor: 20, offset: 3}
              s1: {column: volts, unit: V, full_scale: '10 V = 2 mV/V'}
            """),
    Example("Two recorders with two clocks: a signal is interpolated to the time of the others", GAUGES,
            table("run1.csv", {"t": TIME, "angle": DEG(PHI), "bridge": GAUGES["s1"], "t2": TIME,
                               "torque": GAUGES["T_out"]}),
            IN_PLAIN.replace("column: torque,", "column: torque, time: t2,")),
    Example("Strain of a half bridge in µm/m, with another sign", GAUGES,
            table("run1.csv", PLAIN | {"bridge": GAUGES["s1"] / -0.001}),
            IN_PLAIN.replace("unit: mV/V", "unit: µm/m, gauge_factor: 2.0, active_arms: 2, inverted: true")),
    Example("Log of a robot separated by blanks, as by RTDE", JOINT, table("run1.txt", LOG, separator="  "),
            "separator: blanks" + OF_LOG),
    Example("Time in seconds and nanoseconds, as ROS writes it", JOINT,
            table("run1.csv", {"secs": SECONDS, "nsecs": NANOSECONDS, **dict(list(LOG.items())[1:])}),
            OF_LOG.replace("{column: t, unit: s}", "{columns: [secs, nsecs], units: [s, ns]}")),
    Example("Time in nanoseconds", JOINT, table("run1.csv", LOG | {"t": SECONDS * 10**9 + NANOSECONDS}),
            OF_LOG.replace("unit: s}", "unit: ns}"), 1e-6),
    Example("Time stamps by ISO 8601", JOINT, table("run1.csv", LOG | {"t": [each.isoformat() for each in STAMPS]}),
            OF_LOG.replace("unit: s}", "unit: iso}"), 1e-6),
    Example("Time stamps of another form", JOINT,
            table("run1.csv", LOG | {"t": STAMPS.strftime("%d.%m.%Y %H:%M:%S.%f")}),
            OF_LOG.replace("unit: s}", "unit: '%d.%m.%Y %H:%M:%S.%f'}"), 1e-6),
    Example("Time of day, also over midnight", JOINT,
            table("run1.csv", LOG | {"t": (STAMPS + pd.Timedelta(hours=13.6247)).strftime("%H:%M:%S.%f")}),
            OF_LOG.replace("unit: s}", "unit: '%H:%M:%S.%f'}"), 1e-6),
    Example("A counter of microseconds that is full after 32 bit", JOINT,
            table("run1.csv", LOG | {"t": (2**32 - 50_000 + np.round(1e6 * TIME).astype(int)) % 2**32}),
            OF_LOG.replace("unit: s}", "unit: us, bits: 32}"), 1e-6),
    Example("Lists in cells, as exports of ROS 2 have them", JOINT,
            table("run1.csv", {"t": TIME, "position": lists(9 + 0 * Q, Q), "velocity": lists(0 * Q, OMEGA),
                               "effort": lists(0 * Q, JOINT["current"])}),
            OF_LOG.replace("column: qd", "column: 'velocity[2]'").replace("column: q,", "column: 'position[2]',")
            .replace("column: i", "column: 'effort[2]'")),
    Example("JSON lines: one message in each line", JOINT, saved("run1.jsonl", json_lines),
            OF_LOG.replace("{column: t, unit: s}", "{columns: [stamp.sec, stamp.nanosec], units: [s, ns]}")
            .replace("column: qd", "column: 'velocity[2]'").replace("column: q,", "column: 'position[2]',")),
    Example("Several recordings in one file: a column that names them", JOINT,
            table("day1.csv", {"run": np.repeat([1, 2], N), **{k: np.append(LOG[k], WEAKER[k]) for k in LOG}}),
            "each: '[0-9]+'\nrows: {run: '{each}'}" + OF_LOG),
    Example("Several recordings in one file: tables below one another, each with its row of names", JOINT,
            below("day1.txt", "Trace of drive 3\n\n", LOG, WEAKER),
            "each: '[0-9]+'\nsheet: '{each}'\nseparator: tab\nheader_row: 3" + OF_LOG),
    Example("Objects of a CiA 402 drive", JOINT,
            table("run1.csv", {"t": TIME, "6064h": np.round(Q * 1e8), "606Ch": np.round(OMEGA * 1e8),
                               "6077h": JOINT["current"] / 0.005}),
            f"""
            time: {{column: t, unit: s}}
            joints:
              elbow:
                signals:
                  q: {{column: 6064h, unit: counts, per_revolution: {2e8 * np.pi!r}}}
                  omega: {{column: 606Ch, unit: counts/s, per_revolution: {2e8 * np.pi!r}}}
                  current: {{column: 6077h, unit: permille, rated: 5 A}}
            """, 1e-7),
    Example("Angle and velocity of the motor", JOINT, table("run1.csv", LOG | {"q": 100 * Q, "qd": 100 * OMEGA}),
            OF_LOG.replace("rad}", "rad, at: motor}").replace("rad/s}", "rad/s, at: motor}")),
    Example("Torque of the motor in N m, as ABB writes it, or as effort in ROS",
            {"q": Q, "omega": OMEGA, "T_motor": JOINT["current"]}, table("run1.csv", LOG),
            OF_LOG.replace("current: {column: i, unit: A}", "T_motor: {column: i, unit: N m}")),
    Example("No velocity: it is the slope of the angle", JOINT, table("run1.csv", {k: LOG[k] for k in ("t", "q", "i")}),
            OF_LOG.replace("{column: qd, unit: rad/s}", "{from: q, smoothed_s: 0.005}"), 1e-2),
    Example("Long table: one row for each joint and time", JOINT,
            table("run1.csv", {"name": ["elbow", "wrist"] * N, **{k: np.repeat(v, 2) for k, v in LOG.items()}}),
            OF_LOG.replace("unit: s}", "unit: s, rows: {name: elbow}}").replace("rad}", "rad, rows: {name: elbow}}")
            .replace("rad/s}", "rad/s, rows: {name: elbow}}").replace("unit: A}", "unit: A, rows: {name: elbow}}")),
    Example("One file for each signal, joints one after another in one column", JOINT,
            several(*(table(f"{name}.txt", {"": np.stack([values] * 7, axis=1).ravel()}, header=False)
                      for name, values in (("positions", Q), ("velocities", OMEGA), ("currents", JOINT["current"]))),
                    table("time.txt", {"": TIME}, header=False)),
            r"""
            path: '(?P<signal>[a-z]+)\.txt'
            header: false
            interleaved: 7
            time: {file: time, column: 1, unit: s}
            joints:
              elbow:
                signals:
                  q: {file: positions, column: 4, unit: rad}
                  omega: {file: velocities, column: 4, unit: rad/s}
                  current: {file: currents, column: 4, unit: A}
            """),
    Example("A finding that you accept knowingly", JOINT | {"omega": 1.5 * OMEGA},
            table("run1.csv", LOG | {"qd": 1.5 * OMEGA}), "accept: [velocity_scale]" + OF_LOG),
)  # fmt: skip

OF_LOG_IN = OF_LOG.replace("column: t,", "column: time,")


def save_matlab_73(path: Path) -> None:
    """As MATLAB does: HDF5 with transposed rows, behind a block of 512 bytes; a struct is a group."""
    with h5py.File(path, "w", userblock_size=512) as file:
        group = file.create_group("bench")
        group.attrs["MATLAB_class"] = np.bytes_("struct")
        for name, values in PLAIN.items():
            group.create_dataset(name, data=values[None]).attrs["MATLAB_class"] = np.bytes_("double")


def save_hdf5(path: Path) -> None:
    """Groups and variables."""
    with h5py.File(path, "w") as file:
        for name, values in PLAIN.items():
            file[f"bench/{name}"] = values


def trials(number: int) -> np.ndarray:
    """A struct array."""
    found = np.zeros((1, number), dtype=[(name, "O") for name in LOG])
    for trial in range(number):
        found[0, trial] = tuple(values + trial * (name == "i") for name, values in LOG.items())
    return found


def save_episodes(path: Path) -> None:
    """A group for each episode, with the joints in columns."""
    with h5py.File(path, "w") as file:
        for name, values in LOG.items():
            for episode in range(2):
                own = values + episode * (name == "i")
                file[f"data/demo_{episode}/{name}"] = np.stack([3 * own, own], axis=1)


def save_sheets(path: Path) -> None:
    """A sheet for each recording, behind an overview."""
    book = openpyxl.Workbook()
    book.active.append(["Overview"])
    for repeat in (1, 2):
        page = book.create_sheet(f"2000 rpm, 39.5 Nm, {repeat}")
        for row in (list(PLAIN), *pd.DataFrame(PLAIN).to_numpy().tolist()):
            page.append(row)
    book.save(path)


def save_tdms(path: Path) -> None:
    """Channels of one group, whose time is in their properties."""
    with TdmsWriter(path) as writer:
        channels = (ChannelObject("bench", name, values, {"wf_increment": 1e-3}) for name, values in PLAIN.items())
        writer.write_segment([each for each in channels if each.channel != "t"])


def save_mdf(path: Path) -> None:
    """Channels of one group, with their time."""
    with MDF(version="4.10") as file:
        file.append([Signal(values, TIME, name=name) for name, values in PLAIN.items() if name != "t"])
        file.save(path, overwrite=True)


def save_uff(path: Path) -> None:
    """Functions of data set 58 over even times."""
    functions = [
        function(name, np.asarray(values), abscissa_min=0.0, abscissa_inc=1e-3, x=TIME)
        for name, values in PLAIN.items()
        if name != "t"
    ]
    pyuff.UFF(str(path)).write_sets(functions, "overwrite")


def save_xlsx(path: Path) -> None:
    """A sheet with a title above the names."""
    book = openpyxl.Workbook()
    book.active.title = "data"
    for row in (
        ["Bench 3"],
        list(PLAIN),
        *zip(*(np.asarray(values).tolist() for values in PLAIN.values()), strict=True),
    ):
        book.active.append(row)
    book.save(path)


COUNTS = np.stack([PHI * 3600 / np.pi, GAUGES["T_out"] * 500, GAUGES["s1"] * 1e5], axis=1)
SHARES = np.array([[1.5], [1.0], [2.5]])  # of three joints
STRUCTS = {
    "time": TIME,
    "Joint_state": {"q": SHARES * Q, "dq": SHARES * OMEGA},
    "Motor": {"i": JOINT["current"]},
}
BINARY = (
    Example("MATLAB: variables whose names differ by file", GAUGES,
            saved("run1.mat", lambda path: savemat(path, {f"X097_{name}": values for name, values in PLAIN.items()})),
            IN_PLAIN.replace("column: ", "column: X*_")),
    Example("MATLAB: structs, one with matrices of all joints", JOINT,
            saved("run1.mat", lambda path: savemat(path, STRUCTS)),
            OF_LOG_IN.replace("column: qd", "column: 'Joint_state.dq[2]'")
            .replace("column: q,", "column: 'Joint_state.q[2]',").replace("column: i", "column: Motor.i")),
    Example("MATLAB: a table, saved by save('run1.mat', '-struct', 's') after s = table2struct(T, 'ToScalar', true)",
            GAUGES, saved("run1.mat", lambda path: savemat(path, PLAIN)), IN_PLAIN),
    Example("MATLAB 7.3: a struct", GAUGES, saved("run1.mat", save_matlab_73),
            IN_PLAIN.replace("column: ", "column: bench.")),
    Example("Bare numbers of a card for data acquisition: counts of 16 bits, channels in turn", GAUGES,
            saved("run1.bin", lambda path: np.round(COUNTS).astype("<i2").tofile(path)),
            """
            raw: '<i2'
            interleaved: 3
            sampling_rate_hz: 1000
            channels:
              phi_in: {column: 1, unit: counts, per_revolution: 7200}
              T_out: {column: 2, unit: counts, full_scale: 30000 counts = 60 N m}
              s1: {column: 3, unit: counts, full_scale: 30000 counts = 0.3 mV/V}
            facts: {gear: A17, session: monday}
            files: {run1.bin: {n_in_rpm: 2000, T_out_nm: 39.5, repeat: 1}}
            """, 1e-4),
    Example("HDF5: variables in a group", GAUGES, saved("run1.h5", save_hdf5),
            IN_PLAIN.replace("column: ", "column: bench/")),
    Example("Parquet", GAUGES, saved("run1.parquet", lambda path: pd.DataFrame(PLAIN).to_parquet(path)), IN_PLAIN),
    Example("Several recordings in one file: elements of a struct array of MATLAB", JOINT,
            saved("day1.mat", lambda path: savemat(path, {"trials": trials(2)})),
            "each: 'trials.[0-9]+.'" + OF_LOG.replace("column: ", "column: '{each}.").replace(", unit", "', unit")),
    Example("Several recordings in one file: groups of HDF5, such as episodes", JOINT,
            saved("day1.h5", save_episodes),
            "each: 'data/demo_[0-9]+'\nrate_hz: 1000" + OF_LOG.replace("time: {column: t, unit: s}\n", "")
            .replace("column: ", "column: '{each}/").replace(", unit", "[2]', unit")),
    Example("Several recordings in one file: sheets of Excel", GAUGES, saved("day1.xlsx", save_sheets),
            r"each: '(?P<n_in_rpm>[0-9]+) rpm, (?P<T_out_nm>[0-9.]+) Nm, (?P<repeat>[0-9]+)'"
            "\nsheet: '{each}'" + IN_PLAIN + "facts: {gear: A17, session: monday}"),
    Example("Excel: a sheet with a title above the names", GAUGES, saved("run1.xlsx", save_xlsx),
            "sheet: data\nheader_row: 2" + IN_PLAIN),
    Example("TDMS: the time is that of the channels", GAUGES, saved("run1.tdms", save_tdms),
            IN_PLAIN.replace("column: t,", "column: time,")),
    Example("MDF 4: the time is that of the channels", GAUGES, saved("run1.mf4", save_mdf),
            IN_PLAIN.replace("column: t,", "column: time,")),
    Example("UFF58: the time is that of the functions", GAUGES, saved("run1.uff", save_uff),
            IN_PLAIN.replace("column: t,", "column: time,").replace("column: angle", "column: 'angle*'")
            .replace("column: torque", "column: 'torque*'").replace("column: bridge", "column: 'bridge*'")),
)  # fmt: skip

EXAMPLES = (*TEXT, *BINARY)


def first_rows(folder: Path) -> str:
    """Names and first rows of the text files of an example."""
    found = []
    for path in sorted(each for each in folder.rglob("*") if each.is_file())[:2]:
        encoding = "utf-16" if path.read_bytes()[:2] == b"\xff\xfe" else "utf-8" if text_of(path, "utf-8") else "cp1252"
        rows = "" if path.suffix == ".gz" or not text_of(path, encoding) else text_of(path, encoding)
        lines = [line[:110] for line in rows.split("\n")]
        start = next((row for row, line in enumerate(lines) if re.match(r"[\d-]", line)), 0)  # of the numbers
        lines = lines[: start + 2]
        found.append(
            "\n".join([path.relative_to(folder).as_posix(), *(f"    {line}".rstrip() for line in lines if rows)])
        )
    return "\n".join(found)


def text_of(path: Path, encoding: str) -> str:
    """Text of a file; empty if it is none."""
    try:
        return path.read_bytes().decode(encoding)
    except UnicodeDecodeError:
        return ""


def page() -> str:
    """The page docs/formats.md."""
    sections = []
    for example in EXAMPLES:
        with TemporaryDirectory() as folder:
            example.write(Path(folder))
            rows = first_rows(Path(folder))
        sections.append(f"## {example.title}\n\n```text\n{rows}\n```\n\n```yaml\n{example.map}```\n")
    return "\n".join([HEAD.read_text(encoding="utf-8"), *sections])


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
