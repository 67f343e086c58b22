"""HDR-FLIP once more, from the papers alone (Andersson et al. 2020 and 2021): whole two-dimensional kernels, the
published colour spaces with all their constants, and bisection where the program solves. Slow and plain."""

from __future__ import annotations

import numpy as np

PPD = 0.7 * 3840 / 0.7 * np.pi / 180
RGB_TO_XYZ = np.array([[10135552 / 24577794, 8788810 / 24577794, 4435075 / 24577794],
                       [2613072 / 12288897, 8788810 / 12288897, 887015 / 12288897],
                       [1425312 / 73733382, 8788810 / 73733382, 70074185 / 73733382]])
WHITE = RGB_TO_XYZ.sum(axis=1)


def _filter(plane: np.ndarray, kernel: np.ndarray) -> np.ndarray:
    radius = kernel.shape[0] // 2
    padded = np.pad(plane, radius, mode="edge")
    height, width = plane.shape
    return sum(kernel[j, i] * padded[j:j + height, i:i + width]
               for j in range(kernel.shape[0]) for i in range(kernel.shape[1]))


def _grid(radius: int) -> tuple[np.ndarray, np.ndarray]:
    side = np.arange(-radius, radius + 1)
    return np.meshgrid(side, side)  # x along rows


def _sensitivity(*terms: tuple[float, float]) -> np.ndarray:
    """Sum of a sqrt(pi/b) exp(-pi^2 d^2 / b), d in degrees, on a grid as wide as the widest term of all needs."""
    x, y = _grid(int(np.ceil(3 * np.sqrt(0.04 / (2 * np.pi ** 2)) * PPD)))
    d2 = (x ** 2 + y ** 2) / PPD ** 2
    kernel = sum(a * np.sqrt(np.pi / b) * np.exp(-np.pi ** 2 * d2 / b) for a, b in terms)
    return kernel / kernel.sum()


def _balanced(kernel: np.ndarray) -> np.ndarray:
    return np.where(kernel > 0, kernel / kernel[kernel > 0].sum(), kernel / -kernel[kernel < 0].sum())


def _to_ycxcz(rgb: np.ndarray) -> np.ndarray:
    x, y, z = np.moveaxis(rgb @ RGB_TO_XYZ.T / WHITE, -1, 0)
    return np.stack([116 * y - 16, 500 * (x - y), 200 * (y - z)], axis=-1)


def _from_ycxcz(colour: np.ndarray) -> np.ndarray:
    y = (colour[..., 0] + 16) / 116
    xyz = np.stack([y + colour[..., 1] / 500, y, y - colour[..., 2] / 200], axis=-1) * WHITE
    return xyz @ np.linalg.inv(RGB_TO_XYZ).T


def _hunt_lab(rgb: np.ndarray) -> np.ndarray:
    t = rgb @ RGB_TO_XYZ.T / WHITE
    f = np.where(t > (6 / 29) ** 3, np.cbrt(t), t * (29 / 6) ** 2 / 3 + 4 / 29)
    lightness = 116 * f[..., 1] - 16
    a, b = 500 * (f[..., 0] - f[..., 1]), 200 * (f[..., 1] - f[..., 2])
    return np.stack([lightness, lightness / 100 * a, lightness / 100 * b], axis=-1)


def _hyab(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    d = a - b
    return np.abs(d[..., 0]) + np.sqrt(d[..., 1] ** 2 + d[..., 2] ** 2)


def _perceived(colour: np.ndarray) -> np.ndarray:
    kernels = [_sensitivity((1, 0.0047)), _sensitivity((1, 0.0053)), _sensitivity((34.1, 0.04), (13.5, 0.025))]
    filtered = np.stack([_filter(colour[..., c], kernels[c]) for c in range(3)], axis=-1)
    return _hunt_lab(np.clip(_from_ycxcz(filtered), 0, 1))


def _feature(luminance: np.ndarray, kind: str) -> np.ndarray:
    sigma = 0.5 * 0.082 * PPD
    x, y = _grid(int(np.ceil(3 * sigma)))
    bell = np.exp(-(x ** 2 + y ** 2) / (2 * sigma ** 2))
    kernel = _balanced(-x * bell if kind == "edge" else (x ** 2 / sigma ** 2 - 1) * bell)
    return np.sqrt(_filter(luminance, kernel) ** 2 + _filter(luminance, kernel.T) ** 2)


def ldr_flip(test: np.ndarray, reference: np.ndarray) -> np.ndarray:
    """Of linear images of height x width x 3 in [0, 1]."""
    colours = [_to_ycxcz(image) for image in (test, reference)]
    largest = _hyab(_hunt_lab(np.array([0.0, 1, 0])), _hunt_lab(np.array([0.0, 0, 1]))) ** 0.7
    difference = _hyab(_perceived(colours[0]), _perceived(colours[1])) ** 0.7
    colour = np.interp(difference, [0, 0.4 * largest, largest], [0, 0.95, 1])
    luminance = [(c[..., 0] + 16) / 116 for c in colours]
    features = [np.abs(_feature(luminance[0], kind) - _feature(luminance[1], kind)) for kind in ("edge", "point")]
    return colour ** (1 - np.sqrt(np.maximum(*features) / np.sqrt(2)))


def aces(x: np.ndarray) -> np.ndarray:
    y = 0.6 * x
    return np.clip(y * (2.51 * y + 0.03) / (y * (2.43 * y + 0.59) + 0.14), 0, 1)


def exposures(reference: np.ndarray) -> np.ndarray:
    luminance = np.maximum(reference, 0) @ np.array([0.2126, 0.7152, 0.0722])
    low, high = 0.0, 1e3
    for _ in range(200):
        middle = (low + high) / 2
        low, high = (middle, high) if aces(np.array(middle)) < 0.85 else (low, middle)
    start, stop = np.log2(low / luminance.max()), np.log2(low / np.median(luminance))
    return np.linspace(start, stop, max(2, int(np.ceil(stop - start))))


def hdr_flip(test: np.ndarray, reference: np.ndarray) -> np.ndarray:
    test, reference = np.maximum(test, 0), np.maximum(reference, 0)
    return np.max([ldr_flip(aces(test * 2 ** e), aces(reference * 2 ** e)) for e in exposures(reference)], axis=0)
