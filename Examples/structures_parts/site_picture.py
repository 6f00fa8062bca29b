"""The picture of the structures' example: the same rocks without structures and with all of them."""
import numpy as np
from paraview.simple import *
from vtkmodules.util.numpy_support import vtk_to_numpy

import slope_site as site
from rockfall_ground import Ground, add_array, cells, hillshade, make_polydata
from rockfall_tables import Trajectories
from rockfall_view import INK, flat, new_view, plain, points_source, produce, seen_at, show_slope, \
    show_speed, speed_bar, write

ROAD, STEM, BANK, NET = [0.36, 0.37, 0.40], [0.13, 0.36, 0.16], [0.86, 0.55, 0.20], [0.0, 0.28, 0.75]
GAP = 24.0  # m between the two sites
TOP_SPEED = 30.0  # m/s, the end of the colours
EMBANKMENTS, TREES, BARRIERS = range(3)  # StructureKind


def local(points, across):
    """Metres from the site's corner, small enough for a picture's single precision."""
    return points - [site.WEST, site.SOUTH - across, 0.0]


def ground_patch(ground, across):
    patch = ground.patch(site.WEST, site.WEST + site.LENGTH, site.SOUTH, site.SOUTH + site.WIDTH,
                         hillshade(45.0, 40.0, smooth=1))
    points = local(vtk_to_numpy(patch.GetPoints().GetData()), across)
    patch.SetPoints(make_polydata(points).GetPoints())
    return produce(patch)


def road_strip(ground, across):
    x, y = np.arange(site.ROAD[0], site.ROAD[1] + 0.5, 1.0), np.arange(0.0, site.WIDTH + 0.5, 1.0)
    grid = np.stack(np.meshgrid(x, y, indexing="ij"), -1)
    z = ground.height(site.WEST + grid[..., 0], site.SOUTH + grid[..., 1]) + 0.15
    node = np.arange(z.size).reshape(z.shape)
    polydata = make_polydata((np.concatenate([grid, z[..., None]], -1) + [0.0, across, 0.0]).reshape(-1, 3))
    polydata.SetPolys(cells(np.stack([node[:-1, :-1], node[1:, :-1], node[1:, 1:], node[:-1, 1:]],
                                     -1).reshape(-1, 4)))
    return produce(polydata)


def structures_of(slope, kind, across):
    """The faces of one kind, from the second output of DEM to CFE Mesh."""
    data = slope.GetClientSideObject().GetOutputDataObject(1)
    polys = data.GetPolys()
    corners, begins = (vtk_to_numpy(a) for a in (polys.GetConnectivityArray(), polys.GetOffsetsArray()))
    own = np.nonzero(vtk_to_numpy(data.GetCellData().GetArray("StructureKind")) == kind)[0]
    polydata = make_polydata(local(vtk_to_numpy(data.GetPoints().GetData()), across))
    polydata.SetPolys(cells([corners[begins[k]:begins[k + 1]] for k in own]))
    return produce(polydata)


def paths_and_ends(fall, across):
    """The paths of the first iteration with their speeds, and where they end."""
    data = fall.GetClientSideObject().GetOutputDataObject(1)
    paths = Trajectories(data)
    first = np.nonzero(vtk_to_numpy(data.GetCellData().GetArray("Iteration")) == 0)[0]
    own = [np.arange(paths.starts[k], paths.starts[k + 1]) for k in first]
    ends = np.cumsum([len(o) for o in own])
    points = local(paths.points, across)
    polydata = make_polydata(points[np.concatenate(own)])
    polydata.SetLines(cells(np.split(np.arange(ends[-1]), ends[:-1])))
    add_array(polydata.GetPointData(), "Speed", paths.speed[np.concatenate(own)])
    return produce(polydata), points[[o[-1] for o in own]]


def show_site(view, slope, fall, across):
    ground = Ground(slope.GetClientSideObject().GetOutputDataObject(0))
    patch = ground_patch(ground, across)
    show_slope(patch, view)
    lines = Contour(Input=patch, ContourBy=["POINTS", "Elevation"],
                    Isosurfaces=np.arange(5.0, 120.0, 5.0).tolist())
    flat(lines, view, [0.45, 0.42, 0.32], LineWidth=1.0, by=[0.0, 0.0, 0.1])
    flat(road_strip(ground, across), view, ROAD)
    data = slope.GetClientSideObject().GetOutputDataObject(1)
    if data.GetNumberOfCells():
        plain(structures_of(slope, TREES, across), view, STEM, Representation="Surface With Edges",
              EdgeColor=STEM, LineWidth=1.0, Ambient=0.35, Diffuse=0.7)
        plain(structures_of(slope, EMBANKMENTS, across), view, BANK, Ambient=0.35, Diffuse=0.7,
              Interpolation="Flat")
        plain(structures_of(slope, BARRIERS, across), view, NET, Representation="Surface With Edges",
              EdgeColor=NET, LineWidth=1.5, Opacity=0.6, Ambient=1.0, Diffuse=0.0)
    paths, ends = paths_and_ends(fall, across)
    show_speed(paths, view, TOP_SPEED).LineWidth = 2.0
    flat(points_source(ends, 0.9), view, INK)


def draw(shown, shares, path):
    """`shown`: names, slopes and simulations; `shares`: per cent of the rocks that come to the road."""
    view = new_view((1700, 1000))
    for k, (_, slope, fall) in enumerate(shown):
        show_site(view, slope, fall, k * (site.WIDTH + GAP))
    wide = len(shown) * (site.WIDTH + GAP) - GAP
    middle = np.array([0.46 * site.LENGTH, 0.5 * wide + 10.0, 42.0])
    away = np.array([0.80, 0.0, 0.72])
    view.CameraViewUp, view.CameraViewAngle = [0.0, 0.0, 1.0], 30.0
    view.CameraFocalPoint = middle.tolist()
    view.CameraPosition = (middle + 530.0 * away / np.linalg.norm(away)).tolist()
    speed_bar(view, (0.925, 0.30), 0.42)
    write(view, "The same rocks of one iteration, without structures and with them", (0.02, 0.95), 26, bold=True)
    write(view, "dots: where rocks end; green: stems; ochre: embankment; blue: net; grey: road; contours: 5 m; bar: 50 m across; "
          "downhill is towards the viewer", (0.02, 0.915), 20)
    foot = site.LENGTH + 3.0
    scale = make_polydata([[foot, 0.0, 0.5], [foot, 50.0, 0.5]])
    scale.SetLines(cells([[0, 1]]))
    flat(produce(scale), view, INK, LineWidth=6)
    for k, (name, _, _) in enumerate(shown):
        u, v = seen_at(view, (site.LENGTH, k * (site.WIDTH + GAP) + 0.5 * site.WIDTH, 0.0))
        write(view, f"{name}: {shares[name]:.0f} % of all iterations' rocks come to the road", (u, v - 0.055), 20,
              bold=True, centred=True)
    SaveScreenshot(path, view, ImageResolution=list(view.ViewSize))
    Delete(view)
