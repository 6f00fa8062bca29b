"""The mountainside, the rocks and the embankment of the mass fall, as numbers.

Zheng et al. (2014), section 3.4 and table 4, say how many rocks there are, how large and how heavy, from
what mean height they start, that most stop on a gentle step at Z = 33.605 m, that a road lies at the foot
and that an embankment of 3.5 m is planned there. The slope's raster is not published: this one is
invented, in closed form, with those heights.
"""
import numpy as np

# Along x, from the source to the foot, m: a rock face over a steep hillside, the step, a second hillside,
# the strip at the foot for the embankment, the ditch, the road.
PROFILE = {
    "start": (0.0, 62.0),
    "face": (10.0, 52.0),
    "step": (34.0, 34.3),
    "edge": (58.0, 33.0),
    "foot": (82.0, 20.0),
    "road": (94.0, 19.6),
    "far": (112.0, 19.6),
}
ROAD = (94.0, 102.0)  # x of its two sides, m
STEP = 33.605         # m
WIDTH = 60.0          # m, along y
LENGTH = 112.0        # m
CELL = 0.5            # m
HOLLOW = 5.0          # m, how much higher the sides of the slope are than its middle
SOURCE_X, SOURCE_Y = (5.0, 22.0), (22.0, 38.0)  # m, where rocks are released
SHAPES = ["cube", "octahedron", "dodecahedron", "icosahedron", "eota111", "eota221"]

# The embankment: crest at x = 88 m, 3.5 m over the strip, 1 m wide on top, steep towards the hill.
CREST, TALL, TOP = 88.0, 3.5, 1.0
HILLSIDE_FACE, VALLEY_FACE = 1.5, 0.8  # rise over run

# The paper's numbers.
ROCKS, VOLUME, MASS, START = 41, 25.600, 63957.0, 48.259
SMALLEST, LARGEST = 0.170, 1.330
DENSITY = MASS / VOLUME
RESTITUTION, RESTITUTION_DEVIATION = 0.8, 0.05
FRICTION, FRICTION_DEVIATION = 10.0, 0.05
YOUNG, POISSON, TIME_STEP = 1e9, 0.2, 0.001


def profile(x):
    """Height along the middle, corners rounded over some metres."""
    corners = np.array(list(PROFILE.values()))
    reach = np.linspace(-2.0, 2.0, 41)
    weights = np.cos(np.pi * reach / 5.0)
    return sum(w * np.interp(np.asarray(x, float) + r, *corners.T)
               for r, w in zip(reach, weights)) / weights.sum()


def height(x, y):
    """The hillside, a hollow that gathers the rocks towards the middle; the foot and the road are even."""
    x, y = np.asarray(x, float), np.asarray(y, float)
    across = (y - WIDTH / 2) / (WIDTH / 2)
    hollow = HOLLOW * across**2
    fade = np.clip((PROFILE["foot"][0] - x) / 20.0, 0.0, 1.0)
    return profile(x) + hollow * fade * fade * (3.0 - 2.0 * fade)


def embankment(x, y):
    """Height of the embankment over the ground."""
    x = np.asarray(x, float)
    towards_hill = TALL - HILLSIDE_FACE * (CREST - TOP / 2 - x)
    towards_road = TALL - VALLEY_FACE * (x - CREST - TOP / 2)
    return np.clip(np.minimum(np.minimum(towards_hill, towards_road), TALL), 0.0, None) + 0.0 * y


def write_grid(path, with_embankment, cell=CELL):
    """An ESRI ASCII grid of the nodes."""
    x = np.arange(0.0, LENGTH + cell / 2, cell)
    y = np.arange(WIDTH, -cell / 2, -cell)
    grid = height(x[None, :], y[:, None])
    if with_embankment:
        grid = grid + embankment(x[None, :], y[:, None])
    with open(path, "w") as file:
        # A grid's cells stand about its nodes.
        file.write(f"ncols {len(x)}\nnrows {len(y)}\nxllcorner {-cell / 2}\nyllcorner {-cell / 2}\n"
                   f"cellsize {cell}\nNODATA_value -9999\n")
        for row in grid:
            file.write(" ".join(f"{z:.4f}" for z in row) + "\n")
    return path


def volumes(seed=1):
    """41 volumes of the paper's range and sum: a truncated power law, brought to the sum."""
    random = np.random.default_rng(seed)
    u = np.sort(random.random(ROCKS - 2))
    low, high = 0.0, 1.0
    for _ in range(60):
        # Between a law with many small rocks and one with many large ones.
        bend = 0.5 * (low + high)
        power = 8.0 ** (1.0 - 2.0 * bend)
        inner = SMALLEST + (LARGEST - SMALLEST) * u**power
        low, high = (bend, high) if inner.sum() < VOLUME - SMALLEST - LARGEST else (low, bend)
    return random.permutation(np.concatenate([[SMALLEST], inner, [LARGEST]]))


def write_rocks(path, aim=START, seed=1):
    """A table of rock sources: on the rock face, apart from each other; `aim` is their mean height if they
    stand half their size over ground."""
    random = np.random.default_rng(seed)
    sizes = volumes(seed)
    radii = 0.5 * np.sqrt(3.0) * np.cbrt(sizes)  # of cubes, which have the largest of all shapes
    x0, x1, y0, y1 = *SOURCE_X, *SOURCE_Y
    places = []
    for radius in sorted(radii, reverse=True):
        for _ in range(100000):
            place = np.array([random.uniform(x0, x1), random.uniform(y0, y1)])
            if all(np.hypot(*(place - other)) > 1.02 * (radius + r) for other, r in places):
                places.append((place, radius))
                break
        else:
            raise RuntimeError("the rock face is too small for these rocks")
    order = np.argsort(-radii, kind="stable")
    spots = np.empty((ROCKS, 2))
    for k, (place, _) in zip(order, places):
        spots[k] = place
    # Along x to where the mean height is the paper's; rocks stand about half their size over ground.
    low, high = -4.0, 8.0
    for _ in range(60):
        shift = 0.5 * (low + high)
        mean = np.mean(height(spots[:, 0] + shift, spots[:, 1]) + 0.45 * np.cbrt(sizes))
        low, high = (shift, high) if mean > aim else (low, shift)
    spots[:, 0] += shift
    with open(path, "w") as table:
        table.write("x,y,height,shape,volume,density,young,poisson,rx,ry,rz,source,source_id\n")
        for (x, y), volume in zip(spots, sizes):
            angles = random.uniform(0.0, 360.0, 3)
            table.write(f"{x:.4f},{y:.4f},0.05,{random.choice(SHAPES)},{volume:.6f},{DENSITY:.6f},"
                        f"{YOUNG:g},{POISSON:g},{angles[0]:.2f},{angles[1]:.2f},{angles[2]:.2f},face,1\n")
    return path
