"""Style of all figures: colours for colour-blind readers (Okabe and Ito), labels, PNG."""

import base64
import html
import io
from collections.abc import Mapping
from dataclasses import dataclass

import matplotlib
from matplotlib.axes import Axes
from matplotlib.figure import Figure

CLASS_COLOURS: Mapping[str, str] = {
    "healthy": "#000000",
    "reduced_damping": "#0072B2",
    "reduced_stiffness": "#56B4E9",
    "eccentric_wave_generator": "#E69F00",
    "root_tooth_crack": "#D55E00",
    "tip_tooth_crack": "#009E73",
}
SENSOR_COLOURS: Mapping[str, str] = {
    "s0": "#000000",
    "s1": "#0072B2",
    "s2": "#E69F00",
    "s3": "#56B4E9",
    "s4": "#D55E00",
}
DOTS_PER_INCH = 130


@dataclass(frozen=True)
class Picture:
    """A picture as PNG with title and caption."""

    title: str
    caption: str
    png: bytes


def words(name: str) -> str:
    """A class name in words.

    >>> words("root_tooth_crack")
    'root tooth crack'
    """
    return name.replace("_", " ")


def figure(width: float, height: float) -> Figure:
    """An empty figure [inch] without a window, which need not be closed."""
    return Figure(figsize=(width, height), layout="constrained")


def label(axes: Axes, x: str, y: str, title: str = "") -> None:
    """Name both axes with their units, and draw a light grid."""
    axes.set_xlabel(x)
    axes.set_ylabel(y)
    axes.set_title(title, loc="left", fontsize=10)
    axes.grid(color="#dddddd", linewidth=0.6)
    axes.set_axisbelow(True)


def png(picture: Figure) -> bytes:
    """The figure as PNG; equal figures give equal bytes."""
    buffer = io.BytesIO()
    with matplotlib.rc_context({"savefig.facecolor": "white"}):
        picture.savefig(buffer, format="png", dpi=DOTS_PER_INCH, metadata={"Software": None})
    return buffer.getvalue()


def html_figure(picture: Figure, title: str) -> str:
    """A picture with its title as HTML, for notebooks."""
    data = base64.b64encode(png(picture)).decode()
    name = html.escape(title)
    return f'<figure><figcaption>{name}</figcaption><img alt="{name}" src="data:image/png;base64,{data}"></figure>'
