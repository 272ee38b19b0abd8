"""The library of effects as a page with pictures: what each one changes, by channel and order."""

import inspect
import sys
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from jaxtyping import Float
from matplotlib.colors import LogNorm

from swgsim import style
from swgsim.chain import Run, simulate_turns
from swgsim.conditions import Conditions
from swgsim.effects.base import PLACES, Effect
from swgsim.effects.library import SEARCHED
from swgsim.effects.quantity import quantities, size_of
from swgsim.files import write_text
from swgsim.gear import Gear, OperatingPoint
from swgsim.loop.sidelines import has_sidelines, is_random
from swgsim.recording import Recording

POINTS = (OperatingPoint(2000.0, 70.0), OperatingPoint(2000.0, 7.0), OperatingPoint(4000.0, 70.0))
# Warm and late, so that effects of temperature and time show.
CONDITIONS = Conditions(temperature=35.0, elapsed=3600.0)
SHOWN = ("n_in", "T_in", "T_out", "s0", "s1", "s2", "s3", "s4")
REVOLUTIONS, SAMPLES, ORDERS = 12, 64, 12
# Changes below this share of a channel's largest line are rounding.
LEAST = 1e-6


def typical(kind: type[Effect]) -> Effect:
    """An effect of typical size; choices and positions are their first or default values."""
    values = {name: quantity.typical for name, quantity in quantities(kind).items()}
    if values.get("sensor") == 0:
        values["sensor"] = 1
    return kind(**values)


def spectrum(recording: Recording) -> Float[np.ndarray, "channel line"]:
    """Amplitudes over time at twelfths of an order, which are nearly those over the angle."""
    values = np.array([recording.channels[name] for name in SHOWN])
    lines = 2 * np.abs(np.fft.rfft(values, axis=1)) / values.shape[1]
    lines[:, 0] /= 2
    return lines[:, : REVOLUTIONS * ORDERS + 1]


def changes(effects: Sequence[Effect], gear: Gear) -> Float[np.ndarray, "effect point channel line"]:
    """What each effect changes, as a share of the channel's largest line without it."""
    acting: list[tuple[Effect, ...]] = [(), *((effect,) for effect in effects)]
    runs = [Run(gear, point, each, conditions=CONDITIONS) for each in acting for point in POINTS]
    recordings = simulate_turns(runs, REVOLUTIONS, SAMPLES)
    values = np.array([[r.channels[name] for name in SHOWN] for r in recordings])
    found = values.reshape(len(effects) + 1, len(POINTS), len(SHOWN), -1)
    difference = np.fft.rfft(found[1:] - found[0], axis=-1) * 2 / found.shape[-1]
    size = np.array([spectrum(recording)[:, 1:].max(axis=1) for recording in recordings[: len(POINTS)]])
    return np.abs(difference[..., : REVOLUTIONS * ORDERS + 1]) / size[None, :, :, None]


def picture(place: str, kinds: Sequence[type[Effect]], shares: Float[np.ndarray, "effect channel half"]) -> bytes:
    """One panel per effect: what it changes, over channels and orders, on a logarithmic scale."""
    columns = 4
    rows = int(np.ceil(len(kinds) / columns))
    drawing = style.figure(11, 0.8 + 1.8 * rows)
    axes = drawing.subplots(rows, columns, squeeze=False, sharex=True, sharey=True)
    for axis in axes.flat[len(kinds) :]:
        axis.set_axis_off()
    for axis, kind, share in zip(axes.flat, kinds, shares, strict=False):
        image = axis.imshow(
            np.maximum(share, LEAST), norm=LogNorm(LEAST, 1), aspect="auto", interpolation="nearest",
            extent=(-0.25, ORDERS + 0.25, len(SHOWN) - 0.5, -0.5),
        )  # fmt: skip
        axis.set_title(kind.title(), fontsize=9, loc="left")
        axis.set_yticks(range(len(SHOWN)), SHOWN, fontsize=7)
        axis.set_xticks(range(0, ORDERS + 1, 2))
    for axis in axes[-1]:
        axis.set_xlabel("order")
    drawing.colorbar(image, ax=axes, label="change, share of the channel's largest line")
    return style.png(drawing)


def half_orders(share: Float[np.ndarray, "*batch line"]) -> Float[np.ndarray, "*batch half"]:
    """The largest change around every half order."""
    step = REVOLUTIONS // 2
    halves = np.arange(2 * ORDERS + 1) * step
    return np.stack([share[..., max(h - step // 2, 0) : h + step // 2 + 1].max(axis=-1) for h in halves], axis=-1)


def rows(kinds: Sequence[type[Effect]], shares: Float[np.ndarray, "effect point channel line"]) -> list[str]:
    """One row of a table per effect: its sizes, and how its largest change goes with load and speed."""
    found = []
    for kind, share in zip(kinds, shares, strict=True):
        declared = quantities(kind)
        name = size_of(kind)
        size = declared[name]
        inner = ", ".join(other for other in declared if other != name) or "-"
        largest = np.unravel_index(share[0].argmax(), share[0].shape)
        top, light, fast = (float(each[largest]) for each in share)
        load, speed = (f"{top / light:.2g}" if light > LEAST else "-", f"{fast / top:.2g}" if top > LEAST else "-")
        where = f"{SHOWN[largest[0]]}, order {largest[1] / REVOLUTIONS:.3g}" if top > LEAST else "none here"
        says = (inspect.getdoc(kind) or "").split("\n\n")[0].replace("\n", " ")
        found.append(
            f"| `{kind.name()}` | {says} | {name} {size.low:g} to {size.high:g} {size.unit}, typically "
            f"{size.typical:.2g} | {inner} | {where} | {top:.1e} | {load} | {speed} |"
        )
    return found


def page(folder: Path) -> None:
    """Write ``effects.md`` and a picture for every place."""
    text = [HEAD]
    for place in PLACES:
        kinds = [kind for kind in SEARCHED if kind.place == place]
        shares = changes([typical(kind) for kind in kinds], Gear())
        file = folder / "effects" / f"{place.replace(' ', '_')}.png"
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(picture(place, kinds, half_orders(shares[:, 0])))
        text += [f"## {place.capitalize()}", f"![Effects of place {place}](effects/{file.name})", HEADER]
        text[-1] = "\n".join([HEADER, *rows(kinds, shares)])
    write_text(folder / "effects.md", "\n\n".join(text) + "\n")


# Another phase in every recording, and no line between the orders to tell it by.
UNTESTED = [kind.name() for kind in SEARCHED if is_random(kind) and not has_sidelines(kind)]
HEAD = f"""# The library of effects

Made by `make docs` from the code: {len(SEARCHED)} effects, by the place of the chain at which they act. A loop
searches all of them but {", ".join(UNTESTED)}, whose phase is another one in every recording. The pictures show what
an effect of typical size changes at 2000 rpm and 70 N m (the gear at 35 degC, an hour into the session), by channel
and order, as a share of the channel's largest line. Choices (an order, a gauge) are at their default or first value.
Load and speed say by what factor the largest change grows from 7 to 70 N m and from 2000 to 4000 rpm; the share is of
a line that may itself grow. The full physics, signature and source of every effect are in its docstring in
`swgsim/effects/`; rows such as SE20 are those of [physics.md](physics.md)."""
HEADER = (
    "| effect | physics | size | inner parameters | largest change | share | 70 / 7 N m | 4000 / 2000 rpm |\n"
    "|---|---|---|---|---|---|---|---|"
)

if __name__ == "__main__":
    page(Path(sys.argv[1]))
