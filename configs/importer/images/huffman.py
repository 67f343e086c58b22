"""The Huffman codes of OpenEXR's PIZ.

A loop over bits would be slow here. Instead the code that begins at a bit is looked up for all bits of the stream at
once; what is left to a loop is to go from each code to the next. Source: OpenEXR's ImfHuf.
"""

from __future__ import annotations

import struct

import numpy as np

from importer.images.exr_header import Damaged

_SYMBOLS = (1 << 16) + 1  # one more for runs
_SHORT = 16  # bits of codes that are looked up in a table
_LONGEST = 57  # of codes that fit in eight bytes at any bit of the first one
_MOST_BITS = 1 << 25  # of a block; each takes some 20 bytes here, and 32 lines of 8192 pixels have a third of it
_FEW_ZEROS, _MANY_ZEROS, _LEAST_MANY = 59, 63, 6


def decoded(packed: bytes, count: int) -> np.ndarray:
    """`count` values of 16 bits."""
    low, high, _, bits, _ = struct.unpack_from("<5I", packed)
    if not (low < _SYMBOLS and high < _SYMBOLS):
        raise Damaged("a block's table of codes is damaged")
    lengths, size = _lengths(packed[20:], low, high)
    body = packed[20 + size:]
    if bits > 8 * len(body):
        raise Damaged("a block is truncated")
    if bits > _MOST_BITS:
        raise Damaged("a block of compression PIZ is too large; 'oiiotool IN.exr --compression zip -o OUT.exr' changes it")
    windows = _Windows(body, bits)
    starts, symbols, ends = _codes(windows, lengths, bits, high)
    is_run = symbols == high
    if len(symbols) == 0 or is_run[0]:
        raise Damaged("a block has no first value")
    repeats = np.ones(len(symbols), np.int64)
    repeats[is_run] = windows.short(ends[is_run] - 8) >> (_SHORT - 8)
    source = np.maximum.accumulate(np.where(is_run, 0, np.arange(len(symbols))))
    if int(repeats.sum()) != count:
        raise Damaged("a block has more or fewer values than pixels")
    return np.repeat(symbols[source].astype(np.uint16), repeats)


class _Windows:
    """The bits from a position on, the first ones on the left."""

    def __init__(self, data: bytes, bits: int) -> None:
        padded = np.frombuffer(data[:bits // 8 + 1] + bytes(16), np.uint8)
        self._bytes = padded

    def short(self, at: np.ndarray) -> np.ndarray:
        """16 bits."""
        byte = at >> 3
        three = (self._bytes[byte].astype(np.int32) << 16) | (self._bytes[byte + 1].astype(np.int32) << 8) \
            | self._bytes[byte + 2]
        return (three >> (8 - (at & 7))) & 0xFFFF

    def all_short(self, bits: int) -> np.ndarray:
        """16 bits from each position on."""
        size = (bits + 7) // 8
        b = self._bytes[:size + 2].astype(np.int32)
        three = (b[:size] << 16) | (b[1:size + 1] << 8) | b[2:]
        return ((three[:, None] >> np.arange(8, 0, -1, dtype=np.int32)) & 0xFFFF).reshape(-1)[:bits]

    def long(self, at: np.ndarray) -> np.ndarray:
        """64 bits, of which the last seven may be missing."""
        eight = self._bytes[(at >> 3)[:, None] + np.arange(8)].copy().view(">u8")[:, 0].astype(np.uint64)
        return eight << (at & 7).astype(np.uint64)


def _lengths(packed: bytes, low: int, high: int) -> tuple[np.ndarray, int]:
    """The length of each symbol's code, 0 for those without, and the bytes that say so: six bits for each symbol from
    `low` to `high`, where 59 to 62 stand for two to five zeros, and 63 for six and more by the next eight bits."""
    lengths = np.zeros(_SYMBOLS + 1, np.int64)
    bits = min(8 * len(packed), 14 * (high - low + 1) + 8)
    windows = memoryview(_Windows(packed, bits).all_short(bits))
    symbol, at = low, 0
    while symbol <= high:
        if at + 6 > bits:
            raise Damaged("a block's table of codes is truncated")
        length = windows[at] >> 10
        if length < _FEW_ZEROS:
            lengths[symbol] = length
            symbol += 1
            at += 6
        elif length < _MANY_ZEROS:
            symbol += length - _FEW_ZEROS + 2
            at += 6
        else:
            symbol += ((windows[at] >> 2) & 0xFF) + _LEAST_MANY
            at += 14
    if symbol > high + 1 or lengths.max() > _LONGEST:
        raise Damaged("a block's table of codes is damaged")
    return lengths[:_SYMBOLS], (at + 7) // 8


def _first_codes(counts: np.ndarray) -> np.ndarray:
    """The lowest code of each length; longer codes are lower ones (ImfHuf, hufCanonicalCodeTable)."""
    first = np.zeros(_LONGEST + 1, np.int64)
    code = 0
    for length in range(_LONGEST, 0, -1):
        first[length] = code
        code = (code + int(counts[length])) >> 1
        if code >> length:
            raise Damaged("a block's table of codes is damaged")
    return first


def _codes(windows: _Windows, lengths: np.ndarray, bits: int, run: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Where each code of the stream begins, its symbol, and where it ends; a run's ends behind its count of 8 bits."""
    counts = np.bincount(lengths, minlength=_LONGEST + 1)
    first = _first_codes(counts)
    order = np.argsort(lengths, kind="stable")  # by length, then by symbol, as codes are given out
    begin = np.cumsum(counts) - counts
    length_of, symbol_of = np.zeros(1 << _SHORT, np.uint8), np.zeros(1 << _SHORT, np.int32)
    for n in range(1, _SHORT + 1):
        span = slice(int(first[n]) << (_SHORT - n), int(first[n] + counts[n]) << (_SHORT - n))
        if span.stop > 1 << _SHORT:
            raise Damaged("a block's table of codes is damaged")
        length_of[span] = n
        symbol_of[span] = np.repeat(order[begin[n]:begin[n] + counts[n]], 1 << (_SHORT - n))
    short = windows.all_short(bits)
    size, symbols = length_of[short].astype(np.int32), symbol_of[short]
    long = np.flatnonzero(size == 0)
    if counts[_SHORT + 1:].any() and len(long):
        size[long], symbols[long] = _long_codes(windows.long(long), first, counts, order, begin)
    ends = np.arange(bits, dtype=np.int32) + size
    ends[symbols == run] += 8
    ends[size == 0] = bits + 1  # no code begins there
    starts = _followed(ends, bits)
    return starts, symbols[starts], ends[starts]


def _long_codes(window: np.ndarray, first: np.ndarray, counts: np.ndarray, order: np.ndarray,
                begin: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Lengths and symbols; 0 where no code fits."""
    size, symbol = np.zeros(len(window), np.int32), np.zeros(len(window), np.int32)
    for n in np.flatnonzero(counts[_SHORT + 1:]) + _SHORT + 1:
        rank = (window >> np.uint64(64 - n)).astype(np.int64) - first[n]
        found = (size == 0) & (rank >= 0) & (rank < counts[n])
        size[found], symbol[found] = n, order[begin[n] + rank[found]]
    return size, symbol


def _followed(ends: np.ndarray, bits: int) -> np.ndarray:
    """From the first code on, each where the one before ends."""
    following = memoryview(ends)
    starts = []
    at = 0
    while at < bits:
        starts.append(at)
        at = following[at]
    if at != bits:
        raise Damaged("a block's codes do not end with it")
    return np.array(starts, np.int64)
