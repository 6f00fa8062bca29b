"""The site of the structures' example, as files: a slope, rocks' sources, and three layers of structures.

A rock face stands over a wooded hillside with a flat gully, above a road. The forest's stems are drawn, with a
fixed seed, as an inventory would have them; an embankment guards one half of the road, a net the other.
"""
import os

import numpy as np

WEST, SOUTH, CELL = 500000.0, 5170000.0, 2.0  # m; UTM zone 32
LENGTH, WIDTH = 210.0, 130.0                  # m, along x (downhill) and y
ROAD = (170.0, 176.0)                         # x of its two sides, m from WEST
# Along x: the rock face, the forest's hillside, its foot, the level strip of the road.
PROFILE = ([0.0, 14.0, 134.0, 166.0, LENGTH], [118.0, 102.0, 10.0, 3.0, 1.5])
FOREST_X, FOREST_Y = (35.0, 115.0), (4.0, 126.0)
STEMS = 400  # a hectare
DAM = ((153.0, 6.0), (150.0, 36.0), (153.0, 62.0))  # the crest's axis
NET = ((153.0, 68.0), (150.0, 96.0), (153.0, 124.0))
DAM_HEIGHT, DAM_WIDTH = 5.0, 1.5                    # m
NET_HEIGHT, NET_CAPACITY = 5.0, 1000.0              # m, kJ
UTM32 = ('PROJCS["WGS 84 / UTM zone 32N",GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",'
         '6378137,298.257223563]],PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433]],'
         'PROJECTION["Transverse_Mercator"],PARAMETER["latitude_of_origin",0],'
         'PARAMETER["central_meridian",9],PARAMETER["scale_factor",0.9996],'
         'PARAMETER["false_easting",500000],PARAMETER["false_northing",0],UNIT["metre",1]]')


def height(x, y):
    """The profile with its corners rounded, and two gullies that fade out at the foot."""
    x, y = np.asarray(x, float), np.asarray(y, float)
    reach = np.linspace(-6.0, 6.0, 13)
    profile = sum(np.interp(x + r, *PROFILE) for r in reach) / len(reach)
    fade = np.clip((140.0 - x) / 60.0, 0.0, 1.0) * np.clip(x / 20.0, 0.0, 1.0)
    gullies = sum(np.exp(-((y - middle) / 15.0) ** 2) for middle in (36.0, 94.0))
    return profile - 3.5 * fade * gullies


def write_slope(path):
    """An ESRI ASCII grid."""
    x = np.arange(0.0, LENGTH + 0.5 * CELL, CELL)
    y = np.arange(0.0, WIDTH + 0.5 * CELL, CELL)[::-1]
    with open(path, "w") as file:
        file.write(f"ncols {len(x)}\nnrows {len(y)}\nxllcenter {WEST}\nyllcenter {SOUTH}\n"
                   f"cellsize {CELL}\nNODATA_value -9999\n")
        file.writelines(" ".join(f"{h:.3f}" for h in height(x, north)) + "\n" for north in y)
    with open(os.path.splitext(path)[0] + ".prj", "w") as file:
        file.write(UTM32)
    return path


def write_sources(path, count):
    """Rocks of 0.2 to 1.2 m³ in the face, of shapes that are met in jointed rock."""
    random = np.random.default_rng(3)
    shapes = ("box", "octahedron", "dodecahedron", "eota221")
    with open(path, "w") as file:
        file.write("x,y,z,shape,volume,lx,ly,lz\n")
        for k in range(count):
            x = random.uniform(3.0, 12.0)
            y = 10.0 + (WIDTH - 20.0) * (k + 0.5) / count
            shape, volume = shapes[k % len(shapes)], round(random.uniform(0.2, 1.2), 3)
            edges = [f"{e:.3f}" for e in np.array([1.4, 1.0, 1 / 1.4]) * volume ** (1 / 3)]
            file.write(f"{WEST + x:.2f},{SOUTH + y:.2f},{height(x, y) + 2.5:.2f},{shape},{volume},"
                       f"{','.join(edges) if shape == 'box' else ',,'}\n")
    return path


def stems():
    """Places (m from WEST, SOUTH), diameters (cm) and heights (m), no two stems nearer than 1.5 m."""
    random = np.random.default_rng(7)
    wanted = int(STEMS * np.diff(FOREST_X)[0] * np.diff(FOREST_Y)[0] / 1e4)
    kept = np.empty((0, 2))
    while len(kept) < wanted:
        place = np.array([random.uniform(*FOREST_X), random.uniform(*FOREST_Y)])
        if not len(kept) or np.hypot(*(kept - place).T).min() > 1.5:
            kept = np.vstack([kept, place])
    diameters = np.clip(random.lognormal(np.log(30.0), 0.3, wanted), 12.0, 70.0)
    return kept, diameters, 1.3 + 24.0 * (1.0 - np.exp(-diameters / 22.0))


def line_text(points):
    return ",".join(f"{WEST + x:.2f} {SOUTH + y:.2f}" for x, y in points)


def write_trees(path):
    with open(path, "w") as file:
        file.write("x,y,diameter,height\n")
        for (x, y), diameter, tall in zip(*stems()):
            file.write(f"{WEST + x:.2f},{SOUTH + y:.2f},{diameter:.0f},{tall:.1f}\n")
    return path


def write_embankment(path):
    """Steep towards the mountain, 1 in 1 and a half towards the road."""
    with open(path, "w") as file:
        file.write("WKT,name,height,width,slope_up,slope_down,phi\n"
                   f'"LINESTRING({line_text(DAM)})",dam,{DAM_HEIGHT},{DAM_WIDTH},0.5,1.5,35\n')
    return path


def write_net(path):
    with open(path, "w") as file:
        file.write("WKT,name,height,capacity\n"
                   f'"LINESTRING({line_text(NET)})",net,{NET_HEIGHT},{NET_CAPACITY}\n')
    return path


def write_road(path):
    """The road's uphill side: what passes it has come to the road."""
    with open(path, "w") as file:
        file.write(f'WKT,name\n"LINESTRING({line_text([(ROAD[0], 0.0), (ROAD[0], WIDTH)])})",road\n')
    return path
