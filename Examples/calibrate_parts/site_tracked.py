"""The part of a slope that the observed rocks have seen: the convex hull of their releases and stops,
widened. A run-out that ends beyond it says no more than "at least as far as the edge".

The same as Testing/Calibration/trackedGround.h.
"""
import numpy as np


def convex_hull(places):
    """The corners, counter-clockwise, without places on the sides (Andrew's monotone chain)."""
    hull, ascending = [], sorted(set(map(tuple, np.asarray(places, float).tolist())))
    for half in (ascending, ascending[::-1]):
        begin = len(hull)
        for p in half:
            while len(hull) >= begin + 2 and turn(hull[-2], hull[-1], p) <= 0:
                hull.pop()
            hull.append(p)
        hull.pop()  # the first one of the other half
    return np.array(hull)


def turn(a, b, c):
    """Twice the area of a triangle, positive if it turns left."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


class TrackedGround:
    """What is inside has outward · place <= offset for all sides; `margin` in m."""

    def __init__(self, places, margin):
        hull = convex_hull(places)
        if len(hull) < 3:
            raise SystemExit("tracked ground: the sources and deposits are on one line, it needs three "
                             "places that are not")
        along = np.roll(hull, -1, axis=0) - hull
        self.outward = np.column_stack([along[:, 1], -along[:, 0]])
        self.outward /= np.linalg.norm(self.outward, axis=1)[:, None]
        self.offset = (self.outward * hull).sum(axis=1) + margin

    def holds(self, places):
        """Which places (n, 2) are inside."""
        return (np.asarray(places) @ self.outward.T <= self.offset).all(axis=1)

    def cut(self, starts, stops):
        """The stops, those outside moved to where the straight way from the start (inside) comes to
        the edge."""
        way = stops - starts
        out = way @ self.outward.T
        room = np.maximum(self.offset - starts @ self.outward.T, 0.0)
        share = np.where(out > 0, room / np.where(out > 0, out, 1.0), np.inf)
        return starts + np.minimum(share.min(axis=1), 1.0)[:, None] * way
