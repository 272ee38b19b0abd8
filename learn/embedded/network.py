"""Layers as C.

Weights are kept in single precision, or as integers of 16 or 8 bits with a scale for each row; activations stay in
single precision, which a Cortex-M4F computes as fast as integers.
"""

from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float, Int

from learn.embedded.layers import Dense, layers_of
from learn.embedded.source import Macros, array

WEIGHTS = {"float": "float", "int16": "int16_t", "int8": "int8_t"}


def quantised(
    weight: Float[np.ndarray, "row column"], numbers: str
) -> tuple[Float[np.ndarray, "row column"] | Int[np.ndarray, "row column"], Float[np.ndarray, " row"]]:
    """Stored weights, and the scale of each row that converts them back."""
    if numbers == "float":
        return weight, np.ones(len(weight))
    highest = np.iinfo(WEIGHTS[numbers].removesuffix("_t")).max
    scale = np.abs(weight).max(axis=1) / highest
    scale[scale == 0] = 1
    return np.rint(weight / scale[:, None]).astype(int), scale


def write(model: Any, folder: Path, numbers: str) -> tuple[tuple[str, ...], Macros]:
    """Write ``parameters.c`` of a trained model.

    Parameters
    ----------
    model : classifier
        Of :func:`layers_of`.
    folder : Path
    numbers : {"float", "int16", "int8"}
        Type of the stored weights.

    Returns
    -------
    tuple of str
        Names of the C files that go with it.
    Macros
        Their macros.
    """
    layers = layers_of(model)
    named = [(f"layer{i}", dense) for i, dense in enumerate(layers.dense)]
    named += [(f"block{i}", dense) for i, (_, dense) in enumerate(layers.blocks)]
    named += [("beside", layers.auxiliary)] if layers.auxiliary else []
    text = ['#include "parameters.h"\n']
    if layers.centre is not None and layers.spread is not None:
        text += [array("swg_centre", layers.centre), array("swg_spread", layers.spread)]
    text += [_arrays(name, dense, numbers) for name, dense in named]
    text += [f"const swg_dense swg_layer[] = {{{', '.join(_entry(*each) for each in named[: len(layers.dense)])}}};\n"]
    widest = max(max(dense.weight.shape) for _, dense in named)
    sizes: Macros = {
        "COMPRESSED": int(layers.centre is not None),
        "LAYERS": len(layers.dense),
        "WIDEST": widest,
        "WEIGHT": WEIGHTS[numbers],
    }
    files = ("dense.h", "dense.c", "parameters.h")
    if layers.auxiliary is None:
        _put(folder, text)
        return (*files, "perceptron.c"), sizes
    blocks = (
        f"{{{channels}, {dense.weight.shape[1] // channels}, {_entry(f'block{i}', dense)}}}"
        for i, (channels, dense) in enumerate(layers.blocks)
    )
    text += [f"const swg_convolution swg_block[] = {{{', '.join(blocks)}}};\n"]
    text += [f"const swg_dense swg_beside = {_entry('beside', layers.auxiliary)};\n"]
    signals = [len(dense.bias) * layers.points >> i for i, (_, dense) in enumerate(layers.blocks, start=1)]
    of_blocks: Macros = {
        "CHANNELS": layers.channels,
        "BLOCKS": len(layers.blocks),
        "PATCH": max(dense.weight.shape[1] for _, dense in layers.blocks),
        "LARGEST": max(*signals, layers.auxiliary.weight.shape[1] + layers.channels * layers.points),
    }
    _put(folder, text)
    return (*files, "convolutional.c"), {**sizes, **of_blocks}


def _put(folder: Path, text: list[str]) -> None:
    (folder / "parameters.c").write_text("\n".join(text))


def _arrays(name: str, dense: Dense, numbers: str) -> str:
    weight, scale = quantised(dense.weight, numbers)
    return (
        array(f"{name}_weight", weight, "swg_weight", "static const")
        + array(f"{name}_scale", scale, storage="static const")
        + array(f"{name}_bias", dense.bias, storage="static const")
    )


def _entry(name: str, dense: Dense) -> str:
    rows, columns = dense.weight.shape
    return f"{{{rows}, {columns}, {str(dense.rectified).lower()}, {name}_weight, {name}_scale, {name}_bias}}"
