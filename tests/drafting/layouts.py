"""Twenty logs in as many layouts, each with its truth in SI units. Made here; none is of a real bench."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from datetime import datetime, timedelta
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pandas as pd
from scipy.io import savemat

RAD, RPM = 180 / np.pi, 30 / np.pi
GEAR = {"gear": "A17", "session": "monday"}


@dataclass(frozen=True, eq=False)
class Case:
    """What a folder holds.

    Attributes
    ----------
    kind : str
        ``gauges`` or ``joints``.
    truth : mapping
        Recording or joint to its signals, in the units of the project.
    known : mapping
        Facts that no file holds.
    line : tuple of (str, str)
        The one correction: a text of the draft and what a user writes in its place.
    """

    kind: str
    truth: Mapping[str, Mapping[str, np.ndarray]]
    known: Mapping[str, Any] = field(default_factory=dict)
    line: tuple[str, str] = ("", "")


def gauges(rng: np.random.Generator, n_in: float = 1200.0, load: float = 39.0, samples: int = 3000) -> dict:
    """A gear in steady state: two cycles per revolution at each gauge, a slow swing of the speed."""
    t = np.arange(samples) / 5000
    w = n_in / RPM * (1 + 0.004 * np.sin(2 * np.pi * 7 * t))
    phi = np.cumsum(w) / 5000 + 0.3
    torque = load + 0.3 * np.sin(2 * phi) + 0.05 * rng.standard_normal(samples)
    found = {"t": t, "phi_in": phi, "n_in": w * RPM, "T_out": torque}
    found["T_in"] = torque / 80 + 0.02 * np.sin(4 * phi)
    for number in range(1, 5):
        place = phi - (number - 1) * np.pi / 2
        found[f"s{number}"] = 0.17 * np.cos(2 * place) + 0.0007 * load + 0.001 * rng.standard_normal(samples)
    found["s0"] = 0.03 * np.cos(2 * phi + 1) + 0.0015 * torque + 0.001 * rng.standard_normal(samples)
    return found


def joint(rng: np.random.Generator, seconds: float = 12.0, rate: float = 250.0, swing: float = 1.2) -> dict:
    """A joint that follows two sines, with friction, inertia and gravity."""
    t = np.arange(int(seconds * rate)) / rate
    f1, f2 = rng.uniform(0.15, 0.3), rng.uniform(0.5, 0.8)
    p1, p2 = rng.uniform(0, 2 * np.pi, 2)
    q = swing * np.sin(2 * np.pi * f1 * t + p1) + 0.2 * np.sin(2 * np.pi * f2 * t + p2)
    omega = swing * 2 * np.pi * f1 * np.cos(2 * np.pi * f1 * t + p1) + 0.4 * np.pi * f2 * np.cos(
        2 * np.pi * f2 * t + p2
    )
    torque = 2 * np.tanh(omega / 0.05) + 1.5 * omega + 6 * np.sin(q) + 0.05 * rng.standard_normal(len(t))
    return {
        "t": t,
        "q": q + 1e-5 * rng.standard_normal(len(t)),
        "omega": omega + 2e-3 * rng.standard_normal(len(t)),
        "T_sensor": torque,
        "current": torque / 7.6 + 0.02 * rng.standard_normal(len(t)),
    }


def rows(
    path: Path, before: str, columns: list, separator: str, decimal: str = ".", encoding: str = "utf-8",
    form: str = "%.8g", end: str = "",
) -> None:  # fmt: skip
    """Write a table of text."""
    cells = [[each if isinstance(each, str) else form % each for each in column] for column in columns]
    body = "\n".join(separator.join(row) + end for row in zip(*cells, strict=True))
    body = body.replace(".", decimal) if decimal != "." else body
    path.write_text(before + body + "\n", encoding=encoding)


def numbered(joints: list[dict], *more: str) -> dict:
    """Truth of several joints."""
    return {f"joint_{i}": {s: each[s] for s in ("t", "q", "omega", *more)} for i, each in enumerate(joints, 1)}


def catman(folder: Path, rng: np.random.Generator) -> Case:
    m = gauges(rng)
    names = ["Zeit  1 - default [s]", "Drehgeber Antrieb [°]", "Drehzahl Antrieb [1/min]", "Drehmoment Antrieb [Nm]",
             "Drehmoment Abtrieb [Nm]", *(f"DMS S{i} [mV/V]" for i in range(5))]  # fmt: skip
    before = "CATMAN\nDatei: prüfstand.tst\nDatum: 12.03.2026\nKanäle: 10\n\n" + "\t".join(names) + "\n"
    columns = [m["t"], m["phi_in"] * RAD, m["n_in"], m["T_in"], m["T_out"], *(m[f"s{i}"] for i in range(5))]
    rows(folder / "versuch.asc", before, columns, "\t", decimal=",", encoding="cp1252")
    return Case("gauges", {"versuch": m}, GEAR)


def labview(folder: Path, rng: np.random.Generator) -> Case:
    m = gauges(rng)
    channels = ["Angle (deg)", "Torque out (Nm)", *(f"Strain s{i} (mV/V)" for i in range(1, 5))]
    width = len(channels)
    before = (
        "LabVIEW Measurement\t\nWriter_Version\t2\nReader_Version\t2\nSeparator\tTab\nDecimal_Separator\t.\n"
        "Multi_Headings\tNo\nX_Columns\tOne\nTime_Pref\tRelative\nDate\t2026/03/12\nTime\t10:22:31.5\n"
        "***End_of_Header***\t\n\t\n"
        f"Channels\t{width}" + "\t" * width + "\n"
        "Samples"
        + "\t3000" * width
        + "\t\nDate"
        + "\t2026/03/12" * width
        + "\t\nTime"
        + "\t10:22:31.5" * width
        + "\t\n"
        "X_Dimension" + "\tTime" * width + "\t\nX0" + "\t0.0E+0" * width + "\t\nDelta_X" + "\t0.0002" * width + "\t\n"
        "***End_of_Header***" + "\t" * (width + 1) + "\nX_Value\t" + "\t".join(channels) + "\tComment\n"
    )
    columns = [m["t"], m["phi_in"] * RAD, m["T_out"], *(m[f"s{i}"] for i in range(1, 5))]
    rows(folder / "run_1.lvm", before, columns, "\t", end="\t")
    return Case("gauges", {"run_1": {n: m[n] for n in ("t", "phi_in", "T_out", "s1", "s2", "s3", "s4")}}, GEAR)


def german_excel(folder: Path, rng: np.random.Generator) -> Case:
    truth = {}
    for n_in, load, repeat in ((1000, 20, 1), (1000, 39, 1), (1500, 39, 1), (1500, 39, 2)):
        m = gauges(rng, n_in, load)
        stem = f"{n_in}rpm_{load}Nm_{repeat}"
        before = "Zeit in ms;Winkel in °;Drehzahl in U/min;Moment Abtrieb in Nm;Brücke 1 in mV/V;Brücke 2 in mV/V;"
        before += "Brücke 3 in mV/V;Brücke 4 in mV/V\n"
        columns = [
            m["t"] * 1e3,
            np.mod(m["phi_in"] * RAD, 360),
            m["n_in"],
            m["T_out"],
            *(m[f"s{i}"] for i in range(1, 5)),
        ]
        rows(folder / f"{stem}.csv", before, columns, ";", decimal=",", encoding="cp1252")
        truth[stem] = {n: m[n] for n in ("t", "phi_in", "n_in", "T_out", "s1", "s2", "s3", "s4")}
    return Case("gauges", truth, GEAR)


def picoscope(folder: Path, rng: np.random.Generator) -> Case:
    m = gauges(rng)
    before = "Time,Channel A,Channel B,Channel C,Channel D\n(ms),(V),(V),(V),(V)\n\n"
    rows(folder / "scope.csv", before, [m["t"] * 1e3, *(m[f"s{i}"] * 5 for i in range(1, 5))], ",")
    known = {**GEAR, "n_in_rpm": 1200, "T_out_nm": 39, "full_scale": "10 V = 2 mV/V"}
    return Case("gauges", {"scope": {n: m[n] for n in ("t", "s1", "s2", "s3", "s4")}}, known)


def rtde(folder: Path, rng: np.random.Generator) -> Case:
    joints = [joint(rng) for _ in range(6)]
    signals = {"actual_q": "q", "actual_qd": "omega", "actual_current": "current"}
    names = ["timestamp", *(f"target_q_{i}" for i in range(6))]
    names += [f"{name}_{i}" for name in signals for i in range(6)]
    columns = [joints[0]["t"] + 5000.0, *(each["q"] + 0.001 for each in joints)]
    columns += [each[s] for s in signals.values() for each in joints]
    rows(folder / "robot.csv", " ".join(names) + "\n", columns, " ", form="%.9g")
    truth = numbered(joints, "current")
    return Case("joints", truth)


def ros(folder: Path, rng: np.random.Generator) -> Case:
    joints = [joint(rng), joint(rng)]
    before = "header.seq,header.stamp.secs,header.stamp.nsecs,header.frame_id,name[0],name[1],position[0],position[1],"
    before += "velocity[0],velocity[1],effort[0],effort[1]\n"
    start = 1_700_000_123_200_000_000
    ns = start + np.round(joints[0]["t"] * 1e9).astype(int)
    seconds, nanoseconds = [str(each // 10**9) for each in ns], [str(each % 10**9) for each in ns]
    columns = [[str(i) for i in range(len(ns))], seconds, nanoseconds,
               ["world"] * len(ns), ["shoulder"] * len(ns), ["elbow"] * len(ns),
               *(each[s] for s in ("q", "omega", "T_sensor") for each in joints)]  # fmt: skip
    rows(folder / "joint_states.csv", before, columns, ",")
    truth = numbered(joints, "T_sensor")
    return Case("joints", {name: {"T_motor": own.pop("T_sensor"), **own} for name, own in truth.items()})


def nanoseconds(folder: Path, rng: np.random.Generator) -> Case:
    m = joint(rng)
    ns = [str(1_750_000_000_000_000_000 + int(each)) for each in np.round(m["t"] * 1e9)]
    rows(folder / "log.csv", "stamp,joint_1_pos_deg,joint_1_vel_rad_s,joint_1_torque_nm,mode\n",
         [ns, m["q"] * RAD, m["omega"], m["T_sensor"], ["AUTO"] * len(ns)], ",")  # fmt: skip
    return Case("joints", {"joint_1": {s: m[s] for s in ("t", "q", "omega", "T_sensor")}})


def iso(folder: Path, rng: np.random.Generator) -> Case:
    m = joint(rng)
    stamps = [
        (datetime(2026, 3, 12, 10, 22, 31) + timedelta(seconds=float(s))).isoformat("T", "milliseconds") for s in m["t"]
    ]
    before = "# recorder 4.2, axis test\n# operator: k\n"
    rows(folder / "axis.tsv", before + "Timestamp\tposition [rad]\tvelocity [rad/s]\tmotor current [mA]\n",
         [stamps, m["q"], m["omega"], m["current"] * 1e3], "\t")  # fmt: skip
    return Case("joints", {"joint_1": {s: m[s] for s in ("t", "q", "omega", "current")}})


def two_header_rows(folder: Path, rng: np.random.Generator) -> Case:
    for place in ("montag", "dienstag"):
        (folder / place).mkdir()
    truth = {}
    for name in ("montag/sinus_1", "montag/sinus_2", "dienstag/sinus_1"):
        m = joint(rng)
        rows(folder / f"{name}.csv", "Zeit;Winkel;Geschwindigkeit;Moment;Strom\nms;Grad;°/s;Nm;A\n",
             [m["t"] * 1e3, m["q"] * RAD, m["omega"] * RAD, m["T_sensor"], m["current"]], ";", decimal=",")  # fmt: skip
        truth[f"{name} joint_1"] = m
    return Case("joints", truth)


def no_header(folder: Path, rng: np.random.Generator) -> Case:
    joints = [joint(rng) for _ in range(3)]
    columns = [joints[0]["t"], *(each[s] for s in ("q", "omega", "current") for each in joints)]
    rows(folder / "traj.csv", "", columns, ",")
    truth = numbered(joints)
    return Case("joints", truth)


def matlab_struct(folder: Path, rng: np.random.Generator) -> Case:
    joints = [joint(rng) for _ in range(4)]
    state = {"t": joints[0]["t"], "q": np.array([each["q"] for each in joints]).T,
             "dq": np.array([each["omega"] for each in joints]).T,
             "tau": np.array([each["T_sensor"] for each in joints]).T}  # fmt: skip
    savemat(folder / "test1.mat", {"Joint_state": state, "robot": "arm"})
    truth = numbered(joints, "T_sensor")
    return Case("joints", truth)


def matlab_matrix(folder: Path, rng: np.random.Generator) -> Case:
    m = joint(rng)
    savemat(folder / "exp.mat", {"data": np.column_stack([m["t"], m["q"], m["omega"], m["current"]])})
    return Case("joints", {"joint_1": {s: m[s] for s in ("t", "q", "omega", "current")}},
                line=("# ??? current:", "current:"))  # fmt: skip


def hdf5(folder: Path, rng: np.random.Generator) -> Case:
    m = gauges(rng)
    with h5py.File(folder / "bench.h5", "w") as file:
        for name, signal, factor, unit in (("time", "t", 1, "s"), ("encoder", "phi_in", 1 / (2 * np.pi), "rev"),
                                           ("speed_motor", "n_in", 1 / RPM, "rad/s"), ("torque_load", "T_out", 1, "Nm"),
                                           ("torque_motor", "T_in", 1e3, "mNm")):  # fmt: skip
            file[f"daq/{name}"] = m[signal] * factor
            file[f"daq/{name}"].attrs["units"] = np.bytes_(unit.encode())
        for i in range(1, 5):
            file[f"daq/bridge{i}"] = m[f"s{i}"] * 1e3
            file[f"daq/bridge{i}"].attrs["units"] = np.bytes_(b"uV/V")
    return Case("gauges", {"bench": {n: m[n] for n in m if n != "s0"}}, GEAR)


def parquet(folder: Path, rng: np.random.Generator) -> Case:
    m = joint(rng)
    table = pd.DataFrame({"time_us": np.round(m["t"] * 1e6).astype("int64"), "theta": m["q"], "theta_dot": m["omega"],
                          "theta_cmd": m["q"] + 0.01, "i_q": m["current"], "tau_meas": m["T_sensor"]})  # fmt: skip
    table.to_parquet(folder / "run.parquet")
    return Case("joints", {"joint_1": m})


def one_file_per_signal(folder: Path, rng: np.random.Generator) -> Case:
    truth = {}
    for run in ("r1", "r2"):
        m = joint(rng)
        for name, signal in (("position", "q"), ("velocity", "omega"), ("current", "current")):
            rows(folder / f"{run}_{name}.csv", f"time_s;{name}\n", [m["t"], m[signal]], ";")
        truth[f"{run} joint_1"] = {s: m[s] for s in ("t", "q", "omega", "current")}
    return Case("joints", truth)


def several_axes(folder: Path, rng: np.random.Generator) -> Case:
    joints = [joint(rng) for _ in range(6)]
    what = ("Istposition [°]", "Istgeschwindigkeit [°/s]", "Sollposition [°]", "Motorstrom [A]", "Motortemperatur [°C]")
    names = ["Zeit [s]", *(f"A{i} {each}" for i in range(1, 7) for each in what)]
    columns = [joints[0]["t"]]
    for each in joints:
        columns += [each["q"] * RAD, each["omega"] * RAD, each["q"] * RAD + 0.02, each["current"], 40 + 0 * each["q"]]
    rows(folder / "kuka.txt", ";".join(names) + "\n", columns, ";", encoding="utf-8-sig")
    truth = numbered(joints, "current")
    return Case("joints", truth)


def drive_counts(folder: Path, rng: np.random.Generator) -> Case:
    m = joint(rng)
    counts, ratio = 131072, 101
    columns = [
        m["t"] * 1e3,
        np.round(m["q"] * ratio * counts / (2 * np.pi)),
        m["omega"] * ratio * RPM,
        m["current"] / 2.4 * 1e3,
    ]
    names = "Time [ms],Position actual value (6064h),Velocity actual value (606Ch) [rpm],Torque actual value (6077h)\n"
    rows(folder / "ethercat.csv", names, columns, ",", form="%.10g")  # fmt: skip
    return Case("joints", {"joint_1": {s: m[s] for s in ("t", "q", "omega", "current")}},
                {"gear_ratio": ratio, "rated": "2.4 A"})  # fmt: skip


def degrees_wrapped(folder: Path, rng: np.random.Generator) -> Case:
    m = joint(rng, swing=4.0)
    rows(folder / "spindle.dat", "t|angle|speed|torque\n",
         [m["t"], np.mod(m["q"] * RAD + 20, 360), m["omega"] * RPM, m["T_sensor"]], "|")  # fmt: skip
    return Case(
        "joints", {"joint_1": {"t": m["t"], "q": m["q"] + 20 / RAD, "omega": m["omega"], "T_sensor": m["T_sensor"]}}
    )


def motor_side(folder: Path, rng: np.random.Generator) -> Case:
    m = joint(rng)
    rows(folder / "joint.csv", "time,motor_position_rad,motor_velocity_rad_s,motor_current_a,link_torque_nm\n",
         [m["t"], m["q"] * 100, m["omega"] * 100, m["current"], m["T_sensor"]], ",")  # fmt: skip
    return Case("joints", {"joint_1": m}, line=("gear_ratio: 1 ", "gear_ratio: 100 "))


def microstrain(folder: Path, rng: np.random.Generator) -> Case:
    m = gauges(rng)
    before = "t (s),phi (rad),n (rpm),M_out (Nm),Ch0 (µm/m),Ch1 (µm/m),Ch2 (µm/m),Ch3 (µm/m),Ch4 (µm/m)\n"
    rows(
        folder / "m.csv",
        before,
        [m["t"], m["phi_in"], m["n_in"], m["T_out"], *(m[f"s{i}"] * 500 for i in range(5))],
        ",",
    )
    truth = {n: m[n] for n in m if n != "T_in"}
    return Case("gauges", {"m": truth}, {**GEAR, "gauge_factor": 2.0, "active_arms": 4})


ALL = (
    catman, labview, german_excel, picoscope, rtde, ros, nanoseconds, iso, two_header_rows, no_header, matlab_struct,
    matlab_matrix, hdf5, parquet, one_file_per_signal, several_axes, drive_counts, degrees_wrapped, motor_side,
    microstrain,
)  # fmt: skip
LAYOUTS: Mapping[str, Callable[[Path, np.random.Generator], Case]] = {each.__name__: each for each in ALL}
