"""What a rockfall study hands over: maps, exceedance curves and run-out statistics, as plots and as files.

Rocks of three volumes fall down a slope with a bench, made here as a GeoTIFF in UTM coordinates, onto a
road that is planned at its foot. Out come, in output/statistics,

    energy_histogram.png    the kinetic energy with which rocks pass the road
    exceedance.png          how often energy and height at the road exceed a value
    run_out_profile.png     the slope in section, the envelope and quantiles of the paths over it
    reach.png               the map of the reach probability
    hazard.tif              the hazard map for a GIS
    paths.gpkg, crossings.gpkg, dispersion.csv, lines.csv

Run it with

    bash Examples/run.sh [rockfall_statistics.py --output FOLDER --iterations N]
"""
import argparse
import os
import sys

here = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, here)

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from paraview.simple import *
from vtkmodules.util.numpy_support import vtk_to_numpy

import rockfall_tables as tables
from rockfall_tables import result

WEST, SOUTH, CELL = 400000.0, 5200000.0, 2.0  # m; UTM zone 32
COLUMNS, ROWS = 151, 81
ROAD = WEST + 215.0
VOLUMES = [0.2, 0.7, 2.0]  # m³
BARRIER_HEIGHT, BARRIER_CAPACITY = 3.0, 500.0  # m, kJ
INK, ROCK, WARM, COLD = "#222222", "#8a6d4b", "#c8502d", "#2d6ca2"


def arguments():
    parser = argparse.ArgumentParser(description="Hazard map, collector and statistics, as plots and files.")
    parser.add_argument("--output", default=os.path.join(os.path.dirname(here), "output", "statistics"),
                        help="folder for the results (output/statistics of this project)")
    parser.add_argument("--iterations", type=int, default=20, help="realisations per rock (20)")
    chosen = parser.parse_args()
    if chosen.iterations < 1:
        parser.error(f"--iterations is {chosen.iterations}, it must be at least 1")
    os.makedirs(chosen.output, exist_ok=True)
    return chosen


def profile(x):
    """Heights of the slope over its easting: 35° to a bench of 5°, 33° below it, then level."""
    return np.interp(x, [0, 70, 95, 195, 300],
                     [120 + 0, 120 - 49, 120 - 51.2, 120 - 116.1, 120 - 116.1])


def slope_heights():
    """Heights of the nodes from south to north, m, and their eastings and northings."""
    x, y = CELL * np.arange(COLUMNS), CELL * np.arange(ROWS)
    gully = 3.0 * np.exp(-((y - 80.0) / 25.0) ** 2)[:, None] * np.clip((195 - x) / 195, 0, 1)[None, :]
    return profile(x)[None, :] - gully, WEST + x, SOUTH + y


def write_slope(path):
    """An ESRI ASCII grid, with a gully that gathers the rocks."""
    heights = slope_heights()[0][::-1]
    with open(path, "w") as file:
        file.write(f"ncols {COLUMNS}\nnrows {ROWS}\nxllcenter {WEST}\nyllcenter {SOUTH}\n"
                   f"cellsize {CELL}\nNODATA_value -9999\n")
        file.writelines(" ".join(f"{h:.3f}" for h in row) + "\n" for row in heights)
    with open(os.path.splitext(path)[0] + ".prj", "w") as file:
        file.write('PROJCS["WGS 84 / UTM zone 32N",GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",'
                   '6378137,298.257223563]],PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433]],'
                   'PROJECTION["Transverse_Mercator"],PARAMETER["latitude_of_origin",0],'
                   'PARAMETER["central_meridian",9],PARAMETER["scale_factor",0.9996],'
                   'PARAMETER["false_easting",500000],PARAMETER["false_northing",0],UNIT["metre",1]]')
    return path


def write_sources(path):
    with open(path, "w") as file:
        file.write("x,y,z,shape,volume\n")
        for k in range(15):
            x, y = 6.0 + 2.0 * (k % 3), 52.0 + 4.0 * k
            shape = ("Dodecahedron", "Cube", "Octahedron")[k % 3]
            file.write(f"{WEST + x},{SOUTH + y},{profile(x) + 3.0},{shape},{VOLUMES[k // 3 % 3]}\n")
    return path


def finish(figure, path):
    figure.savefig(path, dpi=150)
    plt.close(figure)


def energy_histogram(crossings, path):
    """Of the first passing of each rock, by volume."""
    data = crossings.GetPointData()
    first = vtk_to_numpy(data.GetArray("Passing")) == 0
    energy = vtk_to_numpy(data.GetArray("KineticEnergy"))[first] / 1e3
    volume = vtk_to_numpy(data.GetArray("Volume"))[first]
    figure, axes = plt.subplots(figsize=(7, 4.5), layout="constrained")
    groups = [energy[np.isclose(volume, v)] for v in VOLUMES]
    axes.hist(groups, bins=20, stacked=True, color=[COLD, ROCK, WARM],
              label=[f"{v:g} m³ ({len(g)} rocks)" for v, g in zip(VOLUMES, groups)])
    axes.axvline(BARRIER_CAPACITY, color=INK, linestyle="--", linewidth=1)
    axes.annotate("capacity", (BARRIER_CAPACITY, 0.97), xycoords=("data", "axes fraction"), ha="right",
                  va="top", rotation=90)
    axes.set(xlabel="Kinetic energy at the road, kJ", ylabel="Rocks", title="Energy at the road")
    axes.legend()
    finish(figure, path)


def exceedance(curves, path):
    figure, both = plt.subplots(1, 2, figsize=(9, 4), layout="constrained", sharey=True)
    for axes, name, unit, scale, limit in (
            (both[0], "KineticEnergy", "Kinetic energy, kJ", 1e-3, BARRIER_CAPACITY),
            (both[1], "HeightOverGround", "Height over ground, m", 1.0, BARRIER_HEIGHT)):
        axes.step(np.asarray(curves[name]) * scale, 100 * np.asarray(curves["ShareOfPassing"]),
                  where="post", color=WARM)
        axes.axvline(limit, color=INK, linestyle="--", linewidth=1)
        axes.set(xlabel=unit, xlim=(0, None), ylim=(0, 102))
        axes.grid(alpha=0.3)
    both[0].set_ylabel("Passing rocks that have at least as much, %")
    figure.suptitle("Exceedance at the road; dashed: the barrier")
    finish(figure, path)


def run_out_profile(paths, path):
    """The slope in section with the heights of the paths over it, and where they end."""
    x = np.arange(0.0, CELL * (COLUMNS - 1) + 0.5, 2.0)
    heights = np.full((len(paths.block), len(x)), np.nan)
    ends = []
    for rock in range(len(paths.block)):
        own = paths.of(rock)
        along, height = paths.points[own, 0] - WEST, paths.height[own]
        farthest = np.maximum.accumulate(along)  # what rolls back counts where it was first
        seen = np.concatenate([[True], np.diff(farthest) > 0])
        inside = (x >= along[0]) & (x <= farthest[-1])
        heights[rock, inside] = np.interp(x[inside], farthest[seen], height[seen])
        ends.append(along[-1])
    figure, (axes, below) = plt.subplots(2, 1, figsize=(9, 6), layout="constrained", sharex=True,
                                         height_ratios=[3, 1])
    ground = profile(x)
    reached = (~np.isnan(heights)).sum(axis=0)
    here = reached > 0
    ordered = np.nanquantile(heights[:, here], [0.5, 0.95, 1.0], axis=0)
    axes.fill_between(x, ground, ground.min() - 5, color="#d9cfc1")
    axes.plot(x, ground, color=ROCK)
    axes.fill_between(x[here], ground[here], ground[here] + ordered[2], color=WARM, alpha=0.2,
                      label="envelope")
    axes.plot(x[here], ground[here] + ordered[1], color=WARM, label="95 %")
    axes.plot(x[here], ground[here] + ordered[0], color=COLD, label="median")
    axes.axvline(ROAD - WEST, color=INK, linestyle="--", linewidth=1)
    axes.set(ylabel="Height, m", title="Heights over ground along the slope; dashed: the road")
    axes.legend()
    below.plot(x, 100 * reached / len(paths.block), color=INK, label="reached")
    below.hist(ends, bins=x, weights=np.full(len(ends), 100 / len(ends)), color=ROCK, label="ended")
    below.set(xlabel="Distance, m", ylabel="Rocks, %")
    below.legend()
    finish(figure, path)


def reach_map(image, path):
    columns, rows, _ = (n - 1 for n in image.GetDimensions())
    reach = vtk_to_numpy(image.GetCellData().GetArray("ReachProbability")).reshape(rows, columns)
    bounds = image.GetBounds()
    figure, axes = plt.subplots(figsize=(9, 4.5), layout="constrained")
    shown = axes.imshow(np.where(reach > 0, 100 * reach, np.nan), origin="lower", cmap="YlOrRd",
                        extent=bounds[:4], vmin=0)
    heights, east, north = slope_heights()
    lines = axes.contour(east, north, heights, np.arange(10, 120, 10), colors="0.45", linewidths=0.6)
    x = CELL * np.arange(COLUMNS)
    labels = [(WEST + np.interp(level, profile(x)[::-1], x[::-1]), SOUTH + 16) for level in lines.levels]
    axes.clabel(lines, fontsize=7, fmt="%d m", manual=labels)
    axes.axvline(ROAD, color=INK, linestyle="--", linewidth=1)
    axes.ticklabel_format(useOffset=False, style="plain")
    axes.set(xlabel="Easting, m", ylabel="Northing, m", title="Reach probability; dashed: the road; contours: 10 m")
    figure.colorbar(shown, label="Rocks that come through a cell, %", shrink=0.7)
    finish(figure, path)


def main():
    chosen = arguments()
    in_folder = lambda name: os.path.join(chosen.output, name)
    slope = DEMtoCFEMesh(FileName=write_slope(in_folder("slope.asc")), RestitutionCoefficient=0.75,
                         RestitutionDeviation=0.05, FrictionAngle=25, FrictionAngleDeviation=3,
                         RoughnessDeviation=0.1)
    rocks = RockBlocks(FileName=write_sources(in_folder("sources.csv")), AttitudeLaw="As given")
    fall = RockfallSimulation(Terrain=slope, Rocks=rocks, EndTime=60, Iterations=chosen.iterations,
                              OutputInterval=0.1)
    paths = tables.Trajectories(result(fall, 1))
    print(f"{len(paths.block)} trajectories")

    hazard = RockfallHazardMap(Input=OutputPort(fall, 1), CellSize=4, CropToTrajectories=0)
    reach_map(result(hazard), in_folder("reach.png"))
    road = PolyLineSource(Points=[ROAD, SOUTH, 0, ROAD, SOUTH + CELL * (ROWS - 1), 0])
    collector = TrajectoryCollector(Input=OutputPort(fall, 1), Lines=road, Terrain=slope,
                                    BarrierHeight=BARRIER_HEIGHT, BarrierCapacity=BARRIER_CAPACITY)
    crossings = result(collector)
    line = tables.columns_of(result(collector, 1))
    print(f"{line['Rocks'][0]} of them reach the road: {100 * line['Share'][0]:.1f} ± "
          f"{100 * line['ShareError'][0]:.1f} %")
    if line["Rocks"][0]:
        print(f"a barrier of {BARRIER_HEIGHT:g} m and {BARRIER_CAPACITY:g} kJ catches "
              f"{100 * line['CaughtShare'][0]:.0f} ± {100 * line['CaughtShareError'][0]:.0f} % of them")
        energy_histogram(crossings, in_folder("energy_histogram.png"))
        exceedance(tables.columns_of(result(collector, 2)), in_folder("exceedance.png"))
    run_out_profile(paths, in_folder("run_out_profile.png"))

    by_volume = DispersionAngle(Input=OutputPort(fall, 1), GroupBy="Volume", ClassLimits=[0.5, 1.0],
                                AutomaticDirection=0, Direction=[1, 0, 0])
    table = tables.columns_of(result(by_volume))
    print(f"{'volume, m³':14}{'rocks':>6}{'run-out: mean':>15}{'95 %':>8}{'longest, m':>12}{'angle':>8}")
    for row in range(len(table["Group"])):
        print(f"{table['Group'][row]:14}{table['Trajectories'][row]:6d}{table['RunOutMean'][row]:15.1f}"
              f"{table['RunOut95'][row]:8.1f}{table['RunOutMaximum'][row]:12.1f}"
              f"{table['Theta'][row]:7.1f}°")

    SaveData(in_folder("hazard.tif"), proxy=hazard)
    SaveData(in_folder("paths.gpkg"), proxy=OutputPort(fall, 1))
    if line["Rocks"][0]:
        SaveData(in_folder("crossings.gpkg"), proxy=OutputPort(collector, 0))
    SaveData(in_folder("lines.csv"), proxy=OutputPort(collector, 1))
    SaveData(in_folder("dispersion.csv"), proxy=OutputPort(by_volume, 0))
    print("In " + chosen.output + ": " + ", ".join(sorted(os.listdir(chosen.output))))


main()
