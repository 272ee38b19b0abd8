"""Page of the library of effects, with a picture of the signature of each effect by channel and order."""

import inspect
import sys
from collections.abc import Sequence
from pathlib import Path
from textwrap import wrap

import numpy as np
from jaxtyping import Float
from matplotlib import colormaps
from matplotlib.colors import LogNorm

from swgsim.common import style
from swgsim.common.files import write_text
from swgsim.common.numbers import significant
from swgsim.effects.base import PLACES, Effect
from swgsim.effects.library import SEARCHED
from swgsim.effects.quantity import quantities, size_of
from swgsim.gear.gear import Gear
from swgsim.identification.interharmonics.named_interharmonics import has_sidelines, is_random
from swgsim.identification.report.engineering_units import parameter_words, value_text
from swgsim.studies.effect_signature import (
    ORDERS,
    OTHER_SETTINGS,
    OWN,
    REVOLUTIONS,
    ROUNDING_SHARE,
    SHOWN_CHANNELS,
    USUAL,
    Signature,
    signatures,
)

# Effects that change means only get a common panel if there are as many.
FEWEST_MEANS = 3


def picture(found: Sequence[Signature]) -> bytes:
    """One panel per effect: what it changes, over channels and orders, on a logarithmic scale.

    If several effects change means only, they share the last panel, over effects and channels. Channels that no effect
    changes are left out.
    """
    shares = np.array(
        [np.maximum(half_orders(each.share[0]), ROUNDING_SHARE) for each in found]
    )  # (effect, channel, half)
    changed = np.flatnonzero((shares > ROUNDING_SHARE).any(axis=(0, 2)))
    shares, channels = shares[:, changed], [SHOWN_CHANNELS[channel] for channel in changed]
    means = (shares[..., 1:] <= ROUNDING_SHARE).all(axis=(1, 2))
    means &= means.sum() >= FEWEST_MEANS
    count = int((~means).sum() + means.any())
    columns = min(4, count)
    rows = int(np.ceil(count / columns))
    drawing = style.figure(1.4 + 2.4 * columns, 0.8 + 2.0 * rows)
    alike = not means.any()
    axes = drawing.subplots(rows, columns, squeeze=False, sharex=alike, sharey=alike)
    for axis in axes.flat[count:]:
        axis.set_axis_off()
    # Changes that are rounding are white.
    white_below = colormaps["YlGnBu"].with_extremes(under="white")
    norm = LogNorm(ROUNDING_SHARE * (1 + 1e-9), 1)
    colours = {"norm": norm, "cmap": white_below, "aspect": "auto", "interpolation": "nearest"}
    for axis, number in zip(axes.flat, np.flatnonzero(~means), strict=False):
        extent = (-0.25, ORDERS + 0.25, len(channels) - 0.5, -0.5)
        image = axis.imshow(shares[number], extent=extent, **colours)
        axis.set_title(title(found[number]), fontsize=8, loc="left")
        axis.set_yticks(range(len(channels)), channels, fontsize=7)
        axis.set_xticks(range(0, ORDERS + 1, 2))
    for axis in axes.flat[max(count - columns, 0) : count]:
        axis.tick_params(labelbottom=True)
        axis.set_xlabel("order")
    if means.any():
        axis = axes.flat[count - 1]
        axis.imshow(shares[means][..., 0], **colours)
        axis.set_title("order 0 only", fontsize=8, loc="left")
        axis.set_yticks(range(means.sum()), [found[i].kind.title() for i in np.flatnonzero(means)], fontsize=7)
        axis.set_xticks(range(len(channels)), channels, fontsize=7)
        axis.set_xlabel("")
    drawing.colorbar(image, ax=axes, label="change, share of\nthe channel's largest line")
    return style.png(drawing)


def title(signature: Signature) -> str:
    """Name of the effect, its growth, and its operating point if it is not the usual one."""
    load, speed = signature.growth
    grows = f"10 x load: {load}, 2 x speed: {speed}"
    at = [] if signature.setting == USUAL else wrap(f"at {signature.setting}", 40)
    return "\n".join([signature.kind.title(), *at, grows])


def half_orders(share: Float[np.ndarray, "*batch line"]) -> Float[np.ndarray, "*batch half"]:
    """The largest change around every half order."""
    step = REVOLUTIONS // 2
    halves = np.arange(2 * ORDERS + 1) * step
    return np.stack([share[..., max(h - step // 2, 0) : h + step // 2 + 1].max(axis=-1) for h in halves], axis=-1)


def row(signature: Signature) -> str:
    """A row of the table: effect, size, largest change, growth with load and speed, and pattern over the gauges."""
    kind = signature.kind
    channel, line = signature.where
    # A bar as in |T| would end the cell.
    physics = (inspect.getdoc(kind) or "").split("\n\n")[0].replace("\n", " ").replace("|", "\\|")
    largest = f"{SHOWN_CHANNELS[channel]}, order {line / REVOLUTIONS:.3g}: {significant(100 * signature.top[0])} %"
    cells = f"`{kind.name()}`: {physics}", sizes(kind), largest, " / ".join(signature.growth), signature.over_gauges
    return f"| {' | '.join(cells)} |"


def sizes(kind: type[Effect]) -> str:
    """Bounds and typical size in engineering units, and the names of the other parameters.

    >>> from swgsim.effects import EccentricWaveGenerator
    >>> sizes(EccentricWaveGenerator)
    'eccentricity (r): 0 to 150 µm, typically 50 µm; theta; unequal'
    """
    declared = quantities(kind)
    name = size_of(kind)
    size = declared[name]
    low, high, typical = (
        value_text(kind.name(), name, {"value": value, "unit": size.unit})
        for value in (size.low, size.high, size.typical)
    )
    unit = high.partition(" ")[2]
    text = (
        f"{parameter_words(kind.name(), name)} ({name}): {low.removesuffix(f' {unit}')} to {high}, typically {typical}"
    )
    return "; ".join([text, *(other for other in declared if other != name)])


def page(folder: Path) -> None:
    """Write ``effects.md`` and a picture for every place."""
    text = [HEAD]
    for place in PLACES:
        found = signatures([kind for kind in SEARCHED if kind.place == place], Gear())
        file = folder / "effects" / f"{place.replace(' ', '_')}.png"
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(picture(found))
        text += [f"## {place.capitalize()}", f"![Effects of place {place}](effects/{file.name})"]
        text.append("\n".join([HEADER, *map(row, found)]))
    write_text(folder / "effects.md", "\n\n".join(text) + "\n")


# Phase differs in every recording, and there is no interharmonic line.
UNTESTED = [kind.name() for kind in SEARCHED if is_random(kind) and not has_sidelines(kind)]
HEAD = f"""# The library of effects

Made by `make docs` from the code: {len(SEARCHED)} effects, by the place of the chain at which they act. The
identification searches all of them except {", ".join(UNTESTED)}: its phase differs in every recording, and it makes no
interharmonic line.

The pictures show the change by an effect of typical size, by channel and order, as a share of the channel's largest
line other than the mean. White is no change. The operating point is {USUAL}, with the gear at 35 °C, an hour into the
session. Choices such as an order are at their default or first value; a gauge is s1, or all of them where that is the
default. Effects that change nothing there are shown at other points:

{chr(10).join(f"- `{kind.name()}` at {each}: {each.reason}." for kind, each in OTHER_SETTINGS.items())}

In the tables, *size* has bounds and typical size, and then the other parameters. *Growth* has two factors by which the
largest change grows: from a tenth of the load to the load shown, and from the speed shown to twice that. "-" means
no change at a tenth of the load, 0 no change at that order at twice the speed. *Over gauges* is the pattern of the
gauge line that changes most, by sign and phase. It is "several patterns" if no single one has {OWN:.0%} of its power.

The docstrings in `swgsim/effects/` have the full physics and the source of every effect. Rows such as SE20 are those of
[physics.md](physics.md)."""
HEADER = "| effect | size | largest change | growth: load / speed | over gauges |\n|---|---|---|---|---|"

if __name__ == "__main__":
    page(Path(sys.argv[1]))
