"""OpenEXR's compression PIZ: 16-bit values, Haar wavelets, Huffman codes.

Source: the format as OpenEXR's ImfPizCompressor, ImfHuf and ImfWav define it (there is no other description). A block
begins with the values that occur, as bits of a map; wavelets work on their ranks, plane by plane; one table of codes
serves all planes. Values of 32 bits are two planes, low halves first.
"""

from __future__ import annotations

import struct

import numpy as np

from importer.images.exr_header import Damaged
from importer.images.huffman import decoded


def unpacked_piz(packed: bytes, width: int, height: int, halves: list[int]) -> bytes:
    """`halves`: of each channel, how many values of 16 bits a pixel has. The result is as in an unpacked block: by
    line, each channel's values."""
    first, last = struct.unpack_from("<HH", packed)
    at = 4
    bits = np.zeros(8192, np.uint8)
    if first <= last:
        if last >= 8192 or len(packed) < at + last - first + 1:
            raise Damaged("a block's map of values is damaged")
        bits[first:last + 1] = np.frombuffer(packed, np.uint8, last - first + 1, at)
        at += last - first + 1
    is_used = np.unpackbits(bits, bitorder="little").astype(bool)
    is_used[0] = True  # zero is never in the map
    value_of_rank = np.zeros(1 << 16, "<u2")
    ranks = np.flatnonzero(is_used)
    value_of_rank[:len(ranks)] = ranks
    (length,) = struct.unpack_from("<i", packed, at)
    if not 0 <= length <= len(packed) - at - 4:
        raise Damaged("a block is truncated")
    values = decoded(packed[at + 4:at + 4 + length], width * height * sum(halves))
    lines, start = [], 0
    for half in halves:
        plane = values[start:start + width * height * half].reshape(height, width, half)
        for k in range(half):
            _undo_wavelets(plane[:, :, k], is_14_bit=len(ranks) - 1 < 1 << 14)
        lines.append(value_of_rank[plane].reshape(height, -1))
        start += width * height * half
    return np.concatenate(lines, axis=1).tobytes()


def _undo_wavelets(plane: np.ndarray, is_14_bit: bool) -> None:
    """In place, from the coarsest level on: squares of four values, and pairs at an odd last column or line."""
    height, width = plane.shape
    undo = _pair_14 if is_14_bit else _pair_16
    step = 1 << (min(height, width).bit_length() - 1)
    while step > 1:
        half = step // 2
        rows, columns = height // step, width // step
        top, bottom = plane[0:rows * step:step], plane[half:rows * step:step]
        near, far = slice(0, columns * step, step), slice(half, columns * step, step)
        square = [undo(top[:, k], bottom[:, k]) for k in (near, far)]
        top[:, near], top[:, far] = undo(square[0][0], square[1][0])
        bottom[:, near], bottom[:, far] = undo(square[0][1], square[1][1])
        if width & half:
            k = columns * step
            top[:, k], bottom[:, k] = undo(top[:, k], bottom[:, k])
        if height & half:
            line = plane[rows * step]
            line[near], line[far] = undo(line[near], line[far])
        step = half


def _pair_14(low: np.ndarray, high: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Mean and difference to two values below 2^14, in signed numbers."""
    mean, difference = low.astype(np.int16).astype(np.int32), high.astype(np.int16).astype(np.int32)
    first = mean + (difference & 1) + (difference >> 1)
    return first.astype(np.uint16), (first - difference).astype(np.uint16)


def _pair_16(low: np.ndarray, high: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The same modulo 2^16, with an offset of 2^15."""
    mean, difference = low.astype(np.int32), high.astype(np.int32)
    second = (mean - (difference >> 1)) & 0xFFFF
    return ((difference + second - 0x8000) & 0xFFFF).astype(np.uint16), second.astype(np.uint16)
