"""Closed walls of some thickness with a doorway each."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from shapes import rectangle
from unwrap import Island


@dataclass(frozen=True)
class Wall:
    """Along x around the origin, standing at y = 0; `doorway`: half its width, height; `at`: its middle."""

    length: float
    height: float
    thickness: float
    doorway: tuple[float, float]
    at: float = 0.0

    def _arch(self, side: float) -> Island:
        """The face towards +z (side -1: -z), an upside-down U around the doorway."""
        half, height, top = self.length / 2, self.height, self.doorway[1]
        first, last = side * self.at - self.doorway[0], side * self.at + self.doorway[0]
        outline = np.array([(-half, 0), (first, 0), (first, top), (last, top),
                            (last, 0), (half, 0), (half, height), (-half, height)])
        triangles = np.array([(0, 1, 2), (0, 2, 7), (7, 2, 3), (7, 3, 6), (3, 5, 6), (3, 4, 5)])
        depth = np.full((len(outline), 1), self.thickness / 2)
        positions = np.hstack([outline, depth]) * (side, 1, side)
        return Island(positions, np.tile((0.0, 0.0, side), (len(outline), 1)), outline, triangles)

    def islands(self) -> list[Island]:
        half, height, t, (door, top) = self.length / 2, self.height, self.thickness / 2, self.doorway
        left, right = self.at - door, self.at + door
        pier_left, pier_right = (half + left) / 2, (half - right) / 2  # half the widths beside the doorway
        return [
            self._arch(1.0), self._arch(-1.0),
            rectangle((half, height / 2, 0), (0, height / 2, 0), (0, 0, t)),
            rectangle((-half, height / 2, 0), (0, 0, t), (0, height / 2, 0)),
            rectangle((0, height, 0), (0, 0, t), (half, 0, 0)),
            rectangle((self.at, top, 0), (door, 0, 0), (0, 0, t)),
            rectangle((left, top / 2, 0), (0, top / 2, 0), (0, 0, t)),
            rectangle((right, top / 2, 0), (0, 0, t), (0, top / 2, 0)),
            rectangle((half - pier_right, 0, 0), (pier_right, 0, 0), (0, 0, t)),
            rectangle((pier_left - half, 0, 0), (pier_left, 0, 0), (0, 0, t))]
