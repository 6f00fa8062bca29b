"""The pictures and the movie of the mass fall: the real polyhedra in their real size."""
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from paraview.simple import *

import scenario
from rockfall_ground import Ground, cells, hillshade, make_polydata
from rockfall_tables import Trajectories
from rockfall_view import (INK, RELEASED, SANDSTONE, cast_shadows, flat, move, new_view, plain, produce,
                           python_filter, seen_at, show_slope, write, write_lines)

ROAD_COLOUR, BANK_COLOUR, PATH = [0.32, 0.33, 0.36], [0.13, 0.45, 0.25], [0.45, 0.05, 0.45]
SKY = (0.86, 0.91, 0.97)


def ground_of(slope):
    return Ground(slope.GetClientSideObject().GetOutputDataObject(0))


def strip(ground, x0, x1, lift=0.05, step=0.5):
    """The ground between two x, a little raised, over the whole width."""
    x, y = np.arange(x0, x1 + step / 2, step), np.arange(0.5, scenario.WIDTH - 0.25, step)
    grid = np.stack(np.meshgrid(x, y, indexing="ij"), -1)
    z = ground.height(grid[..., 0], grid[..., 1]) + lift
    node = np.arange(z.size).reshape(z.shape)
    polydata = make_polydata(np.concatenate([grid, z[..., None]], -1).reshape(-1, 3))
    polydata.SetPolys(cells(np.stack(
        [node[:-1, :-1], node[1:, :-1], node[1:, 1:], node[:-1, 1:]], -1).reshape(-1, 4)))
    return produce(polydata)


def show_ground(view, ground, bank):
    patch = produce(ground.patch(0.0, scenario.LENGTH, 0.0, scenario.WIDTH,
                                 hillshade(60.0, smooth=1)))
    show_slope(patch, view)
    levels = np.arange(18.0, 66.0)
    for every, width in ((levels, 1.0), (levels[levels % 5 == 0], 2.5)):
        lines = Contour(Input=patch, ContourBy=["POINTS", "Elevation"], Isosurfaces=every.tolist())
        flat(lines, view, [0.42, 0.38, 0.28], LineWidth=width, by=[0, 0, 0.04])
    flat(strip(ground, *scenario.ROAD), view, ROAD_COLOUR)
    middle = 0.5 * (scenario.ROAD[0] + scenario.ROAD[1])
    flat(strip(ground, middle - 0.25, middle + 0.25, 0.1), view, [1.0] * 3)
    if bank:
        half = scenario.TOP / 2
        flat(strip(ground, scenario.CREST - half, scenario.CREST + half, 0.1), view, BANK_COLOUR)


def show_rocks(view, simulation, ground, name):
    plain(OutputPort(simulation, 0), view, SANDSTONE, Representation="Surface With Edges",
          EdgeColor=[0.25, 0.13, 0.05], LineWidth=1.0, Ambient=0.35, Diffuse=0.75, Interpolation="Flat")
    shadow = python_filter(OutputPort(simulation, 0), name, lambda data: cast_shadows(data, ground))
    flat(shadow, view, [0.3, 0.32, 0.22])


def paths_of(simulation, iteration):
    """Polylines of one iteration."""
    data = simulation.GetClientSideObject().GetOutputDataObject(1)
    paths = Trajectories(data)
    number = np.array([data.GetCellData().GetArray("Iteration").GetValue(k)
                       for k in range(len(paths.block))])
    own = [np.arange(paths.starts[k], paths.starts[k + 1]) for k in np.nonzero(number == iteration)[0]]
    ends = np.cumsum([len(o) for o in own])
    polydata = make_polydata(paths.points[np.concatenate(own)])
    polydata.SetLines(cells(np.split(np.arange(ends[-1]), ends[:-1])))
    return produce(polydata)


def map_picture(slopes, simulations, stops, shown, path):
    """Two maps, one over the other: iteration `shown` without collisions and with them."""
    size = (1700, 1000)
    view = new_view(size)
    ground = ground_of(slopes[False])
    gap = 8.0  # m between the maps, which stand one over the other
    for k, name in enumerate(("with collisions", "without collisions")):
        up = k * (scenario.WIDTH + gap)
        patch = produce(ground.patch(0.0, scenario.LENGTH, 0.0, scenario.WIDTH, hillshade(60.0, smooth=1)))
        shift = dict(by=[0.0, up, 0.0])
        move(show_slope(patch, view), [0.0, up, 0.0])
        levels = np.arange(18.0, 66.0, 2.0)
        lines = Contour(Input=patch, ContourBy=["POINTS", "Elevation"], Isosurfaces=levels.tolist())
        flat(lines, view, [0.42, 0.38, 0.28], LineWidth=1.0, by=[0.0, up, 0.1])
        flat(strip(ground, *scenario.ROAD), view, ROAD_COLOUR, **shift)
        flat(strip(ground, scenario.CREST - 0.25, scenario.CREST + 0.25, 0.3), view, BANK_COLOUR, **shift)
        flat(paths_of(simulations[name], shown), view, PATH, LineWidth=1.5, by=[0.0, up, 20.0])
        own = stops[name][shown * scenario.ROCKS:(shown + 1) * scenario.ROCKS] + [0.0, up, 60.0]
        dots = make_polydata(own)
        dots.SetVerts(cells(np.arange(len(own))[:, None]))
        flat(produce(dots), view, INK, Representation="Points", PointSize=9.0, RenderPointsAsSpheres=0)
    tall = 2 * scenario.WIDTH + gap
    view.CameraParallelProjection = 1
    view.CameraParallelScale = 0.5 * tall * 1.12
    focus = [scenario.LENGTH * 0.5 + 22.0, 0.5 * tall + 0.02 * tall]
    view.CameraFocalPoint, view.CameraPosition = focus + [0.0], focus + [1000.0]
    view.CameraViewUp = [0.0, 1.0, 0.0]
    write(view, "41 rocks of one iteration: paths (purple) and where they end (black)", (0.02, 0.95), 26, bold=True)
    right = scenario.LENGTH + 3.0
    for k, name in enumerate(("with collisions", "without collisions")):
        on_road = (stops[name][:, 0] >= scenario.ROAD[0]).reshape(-1, scenario.ROCKS).sum(axis=1)
        u, v = seen_at(view, (right, k * (scenario.WIDTH + gap) + 0.55 * scenario.WIDTH, 0.0))
        text = f"{name}:\n{on_road[shown]} come to the road,\nmean of {len(on_road)}: {on_road.mean():.1f}"
        write(view, text, (u, v), 24, bold=True)
        u, v = seen_at(view, (right, k * (scenario.WIDTH + gap) + 0.2 * scenario.WIDTH, 0.0))
        write_lines(view, ["grey: road", "green: crest of the", "embankment planned", "contours: 2 m"], (u, v), 20)
    bar = make_polydata([[0.0, -2.5, 70.0], [20.0, -2.5, 70.0]])
    bar.SetLines(cells([[0, 1]]))
    flat(produce(bar), view, INK, LineWidth=6)
    u, v = seen_at(view, (21.0, -3.6, 0.0))
    write(view, "20 m; downhill is to the right", (u, v), 18)
    SaveScreenshot(path, view, ImageResolution=list(size))
    Delete(view)


def look_uphill(view):
    """From over the road's far side, a little from the side."""
    view.CameraViewUp, view.CameraViewAngle = [0.0, 0.0, 1.0], 30.0
    middle = np.array([0.50 * scenario.LENGTH, 0.5 * scenario.WIDTH, 36.0])
    away = np.array([0.80, -0.62, 0.42])
    view.CameraFocalPoint = middle.tolist()
    view.CameraPosition = (middle + 185.0 * away / np.linalg.norm(away)).tolist()


def oblique_picture(slopes, simulations, path, end):
    """The rocks at rest, after the shown iteration with collisions."""
    view = new_view((1600, 1000), SKY)
    ground = ground_of(slopes[False])
    show_ground(view, ground, True)
    name = "with collisions"
    show_rocks(view, simulations[name], ground, "oblique")
    flat(paths_of(simulations[name], int(simulations[name].ShownIteration)), view, PATH, LineWidth=1.5)
    view.ViewTime = end
    look_uphill(view)
    write(view, "41 rocks that have hit each other: on the step, at the foot, on the road and beyond", (0.02, 0.945), 28, bold=True)
    wide = scenario.ROAD[1] - scenario.ROAD[0]
    write_lines(view, ["Rocks in their real shape and size", "purple: paths", "green: crest of the embankment planned",
                       f"grey: road, {wide:g} m wide", "contours: 1 m"], (0.02, 0.04), 22)
    SaveScreenshot(path, view, ImageResolution=list(view.ViewSize))
    Delete(view)


def movie(slopes, simulations, path, frames, end):
    view = new_view((1280, 720), SKY)
    view.UseFXAA = 0
    ground = ground_of(slopes[False])
    show_ground(view, ground, False)
    show_rocks(view, simulations["with collisions"], ground, "movie")
    look_uphill(view)
    write(view, "41 rocks that hit and push each other", (0.02, 0.93), 24, bold=True)
    clock = AnnotateTime()
    clock.Format = "Time: {time:.1f} s"
    shown = Show(clock, view)
    shown.WindowLocation, shown.Position, shown.FontSize, shown.Color = "Any Location", [0.86, 0.93], 24, INK
    animation = GetAnimationScene()
    animation.PlayMode = "Sequence"
    animation.StartTime, animation.EndTime, animation.NumberOfFrames = 0.0, 0.7 * end, frames
    SaveAnimation(path, view, ImageResolution=list(view.ViewSize), FrameRate=int(np.ceil(frames / (0.7 * end))),
                  FrameWindow=[0, frames - 1])
    Delete(view)


def stops_picture(stops, path):
    """How far rocks come, over all iterations, under the section through the slope."""
    figure, (above, below) = plt.subplots(
        2, 1, figsize=(10, 6.5), sharex=True, gridspec_kw={"height_ratios": [1.0, 1.2]})
    x = np.linspace(0.0, scenario.LENGTH, 1000)
    z = scenario.height(x, scenario.WIDTH / 2)
    above.fill_between(x, z, z.min() - 3.0, color="#d9d2bd")
    above.plot(x, z, color="#5a5140")
    above.plot(x, z + scenario.embankment(x, 0.0), color="#21733f", lw=1.2, ls="--", label="embankment planned")
    above.axvspan(*scenario.ROAD, color="0.55", alpha=0.5, label="road")
    above.axhline(scenario.STEP, color="0.3", lw=0.8, ls=":", label=f"Z = {scenario.STEP} m")
    above.set_ylabel("height (m)")
    above.set_ylim(z.min() - 3.0, z.max() + 2.0)
    above.legend(loc="upper center", frameon=False)  # between the hillside and the road
    iterations = len(stops["with collisions"]) / scenario.ROCKS
    edges = np.arange(0.0, scenario.LENGTH + 2.0, 2.0)
    for name, colour in (("without collisions", "#3274a1"), ("with collisions", "#c03d3e")):
        below.hist(np.minimum(stops[name][:, 0], scenario.LENGTH - 0.01), edges, histtype="step", lw=2,
                   color=colour, label=name, weights=np.full(len(stops[name]), 1.0 / iterations))
    below.axvspan(*scenario.ROAD, color="0.55", alpha=0.5)
    below.set_xlabel("where rocks end, x (m); the last column has those that leave the slope")
    below.set_ylabel("rocks per iteration in 2 m")
    below.legend(frameon=False)
    figure.tight_layout()
    figure.savefig(path, dpi=110)
    plt.close(figure)
