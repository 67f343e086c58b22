"""A clear sky with a sun as a Radiance picture in latitude and longitude: rows from the zenith, the middle towards -z, its
right half towards +x."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

WIDTH, HEIGHT = 512, 256
# Degrees above the horizon, and from -z towards -x: the sun stands on the left and a little behind the camera.
SUN_ELEVATION, SUN_AZIMUTH = 25.0, 110.0
SUN_IRRADIANCE = np.array((21.0, 18.5, 14.5))  # on a surface that faces it
ZENITH, HORIZON, GROUND = (np.array(c) for c in ((0.30, 0.57, 1.20), (1.40, 1.55, 1.70), (0.36, 0.32, 0.26)))
# The sun's disc is 0.53 degrees wide and a texel 0.7. It is a bump of a few texels with the same irradiance, as it would
# otherwise depend on where in a texel it stands.
SUN_DEVIATION = math.radians(0.45)


def sun_direction() -> np.ndarray:
    up, turn = math.radians(SUN_ELEVATION), math.radians(SUN_AZIMUTH)
    return np.array((-math.sin(turn) * math.cos(up), math.sin(up), -math.cos(turn) * math.cos(up)))


def _directions() -> np.ndarray:
    """Of the texels' centres, (height, width, 3)."""
    polar = (np.arange(HEIGHT)[:, None] + 0.5) * np.pi / HEIGHT
    turn = ((np.arange(WIDTH) + 0.5) / WIDTH - 0.5) * 2 * np.pi
    return np.stack(np.broadcast_arrays(np.sin(polar) * np.sin(turn), np.cos(polar), -np.sin(polar) * np.cos(turn)), axis=2)


def radiance() -> np.ndarray:
    """The CIE standard clear sky (CIE S 011/E:2003, type 12) in Rec. 709 colours of our own, and its sun."""
    directions = _directions()
    to_sun = np.arccos(np.clip(directions @ sun_direction(), -1, 1))[..., None]
    height = np.maximum(directions[..., 1:2], 0.01)  # the cosine of the angle from the zenith
    glow = 1 + 10 * (np.exp(-3 * to_sun) - math.exp(-1.5 * math.pi)) + 0.45 * np.cos(to_sun) ** 2
    whiteness = np.exp(-0.32 / np.maximum(height, 0.08))
    sky = (HORIZON + (ZENITH - HORIZON) * whiteness / math.exp(-0.32)) * (0.35 + 0.25 * glow)
    result = np.where(directions[..., 1:2] > 0, sky, GROUND)
    bump = np.exp(-((to_sun / SUN_DEVIATION) ** 2) / 2)
    solid_angle = np.sqrt(1 - directions[..., 1:2] ** 2) * (2 * np.pi / WIDTH) * (np.pi / HEIGHT)
    return result + SUN_IRRADIANCE * bump / (bump * solid_angle).sum()


def _rgbe(colours: np.ndarray) -> np.ndarray:
    """Bytes of RGB with a common exponent, (..., 4): Ward 1991."""
    mantissa, exponent = np.frexp(colours.max(axis=-1))
    scale = np.where(mantissa > 0, np.ldexp(256.0, -exponent), 0)
    rounded = np.minimum(np.floor(colours.round(6) * scale[..., None] + 0.5), 255)
    return np.concatenate([rounded, (exponent + 128)[..., None]], axis=-1).astype(np.uint8)


def _runs(values: np.ndarray) -> bytes:
    """A row of one component: 128 + n and a byte for n equal ones, else n and the bytes."""
    data, out, start = values.tobytes(), bytearray(), 0
    while start < len(data):
        end = start + 1
        while end < len(data) and end - start < 127 and data[end] == data[start]:
            end += 1
        if end - start > 2:
            out += bytes((128 + end - start, data[start]))
        else:
            while end < len(data) and end - start < 128 and data[end:end + 3] != data[end:end + 1] * 3:
                end += 1
            out += bytes((end - start,)) + data[start:end]
        start = end
    return bytes(out)


def write_sky(path: Path) -> int:
    """Writes the picture and returns the file's size in bytes."""
    rows = _rgbe(radiance())
    text = f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\nSOFTWARE=qtrace scene generator, CC0-1.0\n\n-Y {HEIGHT} +X {WIDTH}\n"
    out = bytearray(text.encode("ascii"))
    for row in rows:
        out += bytes((2, 2, WIDTH >> 8, WIDTH & 255)) + b"".join(_runs(row[:, c]) for c in range(4))
    path.write_bytes(out)
    return len(out)
