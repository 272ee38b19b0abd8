"""What the textbook model of a robot joint lacks: recordings in, an answer with report, figures and page out."""

import hashlib
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from datetime import date
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from swgsim.common.configured import conf_folder
from swgsim.common.files import replacing, write_json, write_text
from swgsim.common.numbers import significant
from swgsim.common.plain_yaml import plain
from swgsim.common.version import code_version
from swgsim.effects.library import listed, named
from swgsim.effects.text import as_text
from swgsim.joint.days import Days, days
from swgsim.joint.effects import SEARCHED
from swgsim.joint.intake.read import JointRecordings, read_joints
from swgsim.joint.ladder import forward_selection
from swgsim.joint.naming import sizes
from swgsim.joint.recording import JointRecording
from swgsim.joint.remaining import RemainingLine, remaining
from swgsim.joint.report import report
from swgsim.joint.split import Patterns, select
from swgsim.joint.term import Term
from swgsim.joint.validation import Validation

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from pandas import DataFrame

    from swgsim.common.style import Picture

# Folder of the shipped column maps.
SOURCES = conf_folder() / "sources"


@dataclass(frozen=True, eq=False, repr=False)
class JointAnswer:
    """Answer of :func:`identify_joint`.

    Attributes
    ----------
    report : mapping
        Content of ``report.json``.
    validation : Validation
        Models with and without effects, with their errors on held-out recordings.
    by_day : Days or None
        Friction by session.
    lines : tuple of RemainingLine
        Lines that remain in the residual.
    digest : str
        Sixteen hexadecimal digits that depend on the recordings and the split.
    """

    report: Mapping[str, Any]
    validation: Validation
    by_day: Days | None
    lines: tuple[RemainingLine, ...]
    digest: str

    @property
    def sentence(self) -> str:
        """The verdict in one sentence."""
        return str(self.report["sentence"])

    def __repr__(self) -> str:
        error, unit = self.report["error"], self.report["unit"]
        both = {
            when: f"{significant(each['fit'])} {unit}, on recordings not seen {significant(each['heldout'])} {unit}"
            for when, each in ((when, error[when]) for when in ("before", "after"))
        }
        floor, by_day = self.report["noise_floor"], self.by_day.days if self.by_day else ()
        sessions = ", ".join(f"{day.session} {significant(day.share)}" for day in by_day) or self.report["no_days"]
        return "\n".join(
            [
                f"textbook model explains {self.report['explains']}",
                self.sentence,
                f"error before   {both['before']}",
                f"error after    {both['after']}",
                f"noise at rest  {significant(floor)}" + (f" {unit}" if floor is not None else ""),
                f"effects found  {self.report['lacks'] or 'none'}",
                f"friction by session, relative to all: {sessions}",
                *([f"contradicted   {self.report['contradicted']}"] if self.report["contradicted"] else []),
                *(f"fitted size    {each['title']}: {sizes(each)}" for each in self.report["effects"]),
                *(f"likely cause   {each}" for each in self.report["likely"]),
            ]
        )

    @cached_property
    def pictures(self) -> "dict[str, tuple[Picture, Figure]]":
        """Pictures of the page by name, as PNG with title and caption, and as figure of matplotlib."""
        from swgsim.joint.figures import pictures  # imports matplotlib, which takes a second

        return pictures(self.validation, self.by_day, self.lines, self.report)

    @property
    def figures(self) -> "dict[str, Figure]":
        """Figures of matplotlib by name."""
        return {name: drawn for name, (_, drawn) in self.pictures.items()}

    def table(self) -> "DataFrame":
        """One row for each accepted or refused effect, with its errors [unit of the signal]."""
        from pandas import DataFrame

        return DataFrame(self.report["rungs"])

    def save(self, folder: str | Path) -> None:
        """Write ``report.json``, ``effects.yaml``, ``page.html`` and the figures; each file is complete or absent."""
        from swgsim.joint.pages import page

        folder = Path(folder)
        html = page(self.report, {name: picture for name, (picture, _) in self.pictures.items()})
        write_json(folder / "report.json", self.report)
        write_text(folder / "effects.yaml", as_text(self.validation.ladder.top.terms))
        write_text(folder / "page.html", html)
        for name, (picture, _) in self.pictures.items():
            with replacing(folder / f"{name}.png") as aside:
                aside.write_bytes(picture.png)


def recordings_of(source: str | Path, folder: str | Path) -> JointRecordings:
    """Read the joint recordings of a folder.

    Parameters
    ----------
    source : str or Path
        Name of a shipped column map, such as ``"ur10e"``, or the file of your own (docs/joint_recordings.md).
    folder : str or Path
        Folder with the files that the source describes.

    Raises
    ------
    FileDefect
        If source and files do not agree, or a file cannot be read.
    ValueError
        If the source is unknown; it lists the shipped ones.
    """
    return read_joints(Path(folder), source_path(source))


def identify_joint(
    recordings: JointRecordings,
    joint: str | None = None,
    signal: str | None = None,
    holdout: Patterns | JointRecordings = None,
    without: Patterns = None,
    *,
    searched: str | Sequence[str] | None = None,
    library: str | Sequence[str] | None = None,
    progress: Callable[[str], None] = lambda _: None,
    bar: bool = False,
) -> JointAnswer:
    """Find effects that the textbook model of a joint lacks, and test them on held-out recordings.

    Parameters
    ----------
    recordings : JointRecordings
        As :func:`recordings_of` reads them.
    joint, signal : str, optional
        Joint, and signal to explain (``T_sensor`` or ``current``); needed if the recordings have several.
    holdout : str, sequence of str or JointRecordings
        Held-out recordings: patterns of sessions or runs, in a list or separated by commas, or recordings of another
        folder.
    without : str or sequence of str, optional
        Patterns of sessions or runs that are not used.
    searched, library : str or sequence of str, optional
        Names of effects to test (all by default), and import paths ``module:Class`` of further effects.
    progress : callable
        Receives one line of text for each step.
    bar : bool
        Whether to show a progress bar of the candidates of each step.

    Raises
    ------
    ValueError
        If all recordings were refused, or a choice is unknown or missing; it lists the choices.

    Examples
    --------
    >>> recordings = recordings_of("ur10e", "my_logs")  # doctest: +SKIP
    >>> answer = identify_joint(recordings, joint="joint_2", holdout="*_12harm")  # doctest: +SKIP
    >>> answer.sentence, answer.table(), answer.save("answer")  # doctest: +SKIP
    """
    start = time.perf_counter()
    kinds = effects_of(searched, library)
    judging = holdout if isinstance(holdout, JointRecordings) else None
    patterns = str(holdout.folder) if isinstance(holdout, JointRecordings) else holdout
    case = select(recordings, judging, joint, signal, patterns, without)
    validation = Validation(forward_selection(case.table, kinds, progress, bar=bar), case.heldout, case.floor)
    tables = validation.table, validation.heldout
    progress("comparing sessions, and searching lines that remain")
    by_day = days(validation.ladder.top, tables)
    lines = remaining([(validation.ladder.top, table) for table in tables])
    used = (*case.table.recordings, *case.heldout.recordings)
    known = {f"{each.name} {each.joint}" for each in used} | {each.name for each in used}
    defects = (*recordings.defects, *(judging.defects if judging else ()))
    content = report(validation, by_day, lines, case.left_out) | {
        "noise_floor_how": case.floor_how,
        "defects": [str(each) for each in defects if each.recording in known or each.severity == "refuse"],
        "seconds": round(time.perf_counter() - start, 1),
        "date": date.today().isoformat(),
        "folder": str(recordings.folder),
        "version": code_version("joint"),
    }
    return JointAnswer(content, validation, by_day, lines, _digest(used, f"{joint} {signal} {patterns} {without}"))


def source_path(source: str | Path) -> Path:
    """File of a source: its own path, or a name of conf/sources.

    Raises
    ------
    ValueError
        If it does not exist; it lists the shipped sources of robots.
    """
    path = Path(source) if Path(source).suffix else SOURCES / f"{source}.yaml"
    if not path.is_file():
        # Column maps of gauges are in the same folder.
        maps = {each.stem: plain(each.read_text(encoding="utf-8")) for each in SOURCES.glob("*.yaml")}
        names = ", ".join(sorted(name for name, content in maps.items() if "joints" in content))
        raise ValueError(
            f"source={source} is not a file: choose from {names}, or give the path of your own "
            "(docs/joint_recordings.md)"
        )
    return path


def effects_of(searched: str | Sequence[str] | None, library: str | Sequence[str] | None) -> tuple[type[Term], ...]:
    """Effects to test: the named ones or all, and further ones from outside the project.

    Raises
    ------
    ValueError
        If one is unknown, or is an effect of the gauge chain; it lists the choices.
    """
    known = {kind.name(): kind for kind in SEARCHED}
    chosen = list(known) if searched is None else listed(searched)
    found: list[type[Term]] = []
    for name in (*chosen, *listed(library)):
        kind = known.get(name) or (named(name) if ":" in name else None)
        if kind is None or not issubclass(kind, Term):
            raise ValueError(
                f"{name!r} is no effect on a joint; choose from {', '.join(known)}, or give the import path "
                "module:Class of a class derived from swgsim.joint.term.Term"
            )
        found.append(kind)
    return tuple(dict.fromkeys(found))


def _digest(recordings: Sequence[JointRecording], choices: str) -> str:
    """Sixteen hexadecimal digits of the recordings and the choices."""
    digest = hashlib.sha256(choices.encode())
    for each in recordings:
        digest.update(f"{each.name} {each.joint} {each.session}".encode() + each.time.tobytes())
        for name in sorted(each.signals):
            digest.update(name.encode() + each.signals[name].tobytes())
    return digest.hexdigest()[:16]
