"""Test rocks as polyhedra, and the sources that release them.

Of the rocks, the mass and the size along three axes are known. Their form here is a box whose edges
and corners are cut off (26 faces, like the EOTA blocks, stretched): by so much that the volume gives
the mass at the density of the rock.
"""
import math
import os

import numpy as np
from paraview.simple import AppendGeometry, RockBlocks

from field_test import FolderError

DENSITY = 2700.0  # kg/m³, crystalline rock; assumed, the data has none
GAP = 0.05  # m between the lowest vertex and the ground at release


def filled_share(cut):
    """Volume of the polyhedron over its box's. Vertices: (1, c, c) and the like, with all signs."""
    c = cut
    return c * c + c * (1 - c * c) + (1 - c)**2 * (1 + 2 * c) / 6


def vertices(block, density=DENSITY):
    """The polyhedron's 24 vertices about its centroid, (24, 3), m."""
    box = math.prod(block.size)
    share = block.mass / density / box
    if not filled_share(0.0) < share < 1.0:
        raise FolderError(
            f'block "{block.id}": {block.mass:g} kg in {" x ".join(f"{s:g}" for s in block.size)} m '
            f"fill {100 * share:.0f} % of that box at {density:g} kg/m³, it must be 17 to 100 %")
    low, high = 0.0, 1.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if filled_share(middle) < share else (low, middle)
    corners = []
    for axis in range(3):
        for signs in np.ndindex(2, 2, 2):
            corner = low * (1.0 - 2.0 * np.array(signs))
            corner[axis] /= low
            corners.append(corner)
    return np.array(corners) * np.array(block.size) / 2


class Sources:
    """The rocks of all runs, each run with a number of attitudes, drawn anew in each iteration.

    `rocks` is the pipeline's object, `run` the number of the run of each of its rocks. A rock stands
    on the terrain; `raised` is how far that is above the release of the table, per run, in m."""

    def __init__(self, test, ground, attitudes, folder):
        parts, self.run, self.raised = [], [], []
        for block in sorted(test.blocks.values(), key=lambda b: b.id):
            runs = [k for k, run in enumerate(test.runs) if run.block == block.id]
            if not runs:
                continue
            corners = vertices(block)
            shape = os.path.join(folder, f"shape_{len(parts) + 1}.csv")
            np.savetxt(shape, corners, fmt="%.9f", delimiter=",")
            table = os.path.join(folder, f"sources_{len(parts) + 1}.csv")
            with open(table, "w") as file:
                file.write("x,y,z,shape,vx,vy,vz\n")
                for k in runs:
                    run = test.runs[k]
                    centre = float(ground.height(*run.start[:2])) + 0.5 * np.mean(block.size)
                    self.raised.append(centre - run.start[2])
                    numbers = [*run.start[:2], self.standing(run, corners, ground), *run.velocity]
                    words = [f"{n:.9g}" for n in numbers]
                    file.write((",".join(words[:3] + ["file"] + words[3:]) + "\n") * attitudes)
                    self.run += [k] * attitudes
            parts.append(RockBlocks(
                FileName=table, Shape="From File", ShapeFileName=shape, ScaleToVolume=0,
                AttitudeLaw="Random", Density=DENSITY,
                FirstBlockId=len(self.run) - len(runs) * attitudes + 1))
        self.run = np.array(self.run)
        self.rocks = AppendGeometry(Input=parts)

    @staticmethod
    def standing(run, corners, ground):
        """Height of the centroid of a rock whose lowest vertex is just above the ground."""
        x, y = run.start[0] + corners[:, 0], run.start[1] + corners[:, 1]
        east = ground.west + (ground.columns - 1) * ground.cell
        inside = ground.west < x.min() and x.max() < east and \
            ground.south < y.min() and y.max() < ground.north
        heights = ground.height(x, y) if inside else np.array([np.nan])
        if not np.isfinite(heights).all():
            raise FolderError(f'run "{run.id}": its release at x {run.start[0]:g}, y {run.start[1]:g} '
                              "m is outside the terrain or where it has no data")
        return float((heights - corners[:, 2]).max()) + GAP
