"""A wall with a window, and the window's frame."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from shapes import box, rectangle
from unwrap import Island


@dataclass(frozen=True)
class WindowWall:
    """Along x around the origin, standing at y = 0, with its inner face in the plane z = 0 towards +z. The opening lies
    between `left` and `right`, `sill` and `top`."""

    length: float
    height: float
    thickness: float
    left: float
    right: float
    sill: float
    top: float

    def _face(self, side: float) -> Island:
        """Around the opening; side 1: the inner face, -1: the outer one, which looks towards -z."""
        half = self.length / 2
        x = np.array([-half, self.left, self.right, half])
        y = np.array([0, self.sill, self.top, self.height])
        if side < 0:
            x = -x[::-1]
        points = np.array([(a, b) for b in y for a in x])
        cells = [(i, j) for j in range(3) for i in range(3) if (i, j) != (1, 1)]
        corners = np.array([(4 * j + i, 4 * j + i + 1, 4 * j + i + 5, 4 * j + i + 4) for i, j in cells])
        triangles = np.concatenate([corners[:, [0, 1, 2]], corners[:, [0, 2, 3]]])
        depth = np.full((16, 1), 0.0 if side > 0 else self.thickness)
        positions = np.hstack([points, depth]) * (side, 1, side)
        return Island(positions, np.tile((0.0, 0.0, side), (16, 1)), points, triangles)

    def islands(self) -> list[Island]:
        """A closed surface: faces, the four sides of the opening, and the wall's own edges, which nobody sees."""
        half, mid, deep = self.length / 2, -self.thickness / 2, self.thickness / 2
        x, y = (self.left + self.right) / 2, (self.sill + self.top) / 2
        half_x, half_y = (self.right - self.left) / 2, (self.top - self.sill) / 2
        edges = []
        for first, last in ((0.0, self.sill), (self.sill, self.top), (self.top, self.height)):
            at, size = (first + last) / 2, (last - first) / 2
            edges += [rectangle((half, at, mid), (0, 0, -deep), (0, size, 0)),
                      rectangle((-half, at, mid), (0, 0, deep), (0, size, 0))]
        for first, last in ((-half, self.left), (self.left, self.right), (self.right, half)):
            at, size = (first + last) / 2, (last - first) / 2
            edges += [rectangle((at, self.height, mid), (size, 0, 0), (0, 0, -deep)),
                      rectangle((at, 0, mid), (size, 0, 0), (0, 0, deep))]
        return [
            self._face(1.0), self._face(-1.0),
            rectangle((x, self.sill, mid), (half_x, 0, 0), (0, 0, -deep)),
            rectangle((x, self.top, mid), (half_x, 0, 0), (0, 0, deep)),
            rectangle((self.left, y, mid), (0, 0, -deep), (0, half_y, 0)),
            rectangle((self.right, y, mid), (0, 0, deep), (0, half_y, 0)), *edges]

    def frame(self, bar: float, gap: float = 0.002) -> list[list[Island]]:
        """Jambs, sill, head and a cross of bars, each a box of its own, that close to nothing: the window is open."""
        x, y = (self.left + self.right) / 2, (self.sill + self.top) / 2
        width, height, z = self.right - self.left - 2 * gap, self.top - self.sill - 2 * gap, -0.6 * self.thickness
        inner_height = height - 2 * bar - 2 * gap
        cross = self.sill + 0.66 * (self.top - self.sill)
        half_bar = (width - 2 * bar - bar) / 2 - 2 * gap
        sides = [box((side, y, z), (bar, inner_height, bar))
                 for side in (self.left + gap + bar / 2, self.right - gap - bar / 2, x)]
        levels = [box((x, level, z), (width, bar, bar)) for level in (self.sill + gap + bar / 2, self.top - gap - bar / 2)]
        bars = [box((x + sign * (bar / 2 + gap + half_bar / 2), cross, z), (half_bar, bar * 0.8, bar * 0.8)) for sign in (-1, 1)]
        return sides + levels + bars
