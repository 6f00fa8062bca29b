"""Rocks fall down the steepest escarpment of a real DEM, from the raster to pictures and tables.

The DEM is the Jacksboro fault, Tennessee (SRTM, 1/1200° cells), from matplotlib's sample data. It
becomes a GeoTIFF and is reprojected and resampled to 10 m; rocks of eight shapes are released along
its steepest escarpment and simulated until they rest or leave. Run it with

    bash Examples/run.sh [jacksboro.py --output FOLDER --rocks N --frames N]

and find everything in output/jacksboro, the pictures in overview.png, map.png, oblique.png, rocks.png
and the movie rockfall.ogv. rocks.pvd, slope.vtp and trajectories.vtp open in ParaView.
"""
import argparse
import os
import sys
import time

here = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, here)

import numpy as np
from paraview import servermanager
from paraview.simple import *

import rockfall_pictures as pictures
import rockfall_release as release
import rockfall_tables as tables
import sample_dem
from rockfall_ground import Ground, hillshade

CELL = 10.0  # m

# The ground unless --ground says another. Hard ground, for comparison with published DDA: Rv in the
# middle of the 0.6 to 0.8 that Zheng et al. (2014) give as observed, and a friction that lies above the
# slope's angle. On it round rocks walk on for minutes.
GROUND = "Soil (assumed)"
HARD = {"RestitutionCoefficient": 0.7, "RestitutionDeviation": 0, "FrictionAngle": 35,
        "RoughnessMean": 0, "RoughnessDeviation": 0}

STEEP = 32.0  # Degrees. Beyond this the DEM has few, small areas: its faces of rock.
SEED = 20140
END = 1200.0  # s: long enough for the last slow roller on the valley's floor, on hard ground, too.
INTERVAL = 0.1  # s between samples

started = time.time()


def say(text):
    print(f"[{time.time() - started:5.1f} s] {text}", flush=True)


def arguments():
    parser = argparse.ArgumentParser(description="Rockfall at the Jacksboro fault, end to end.")
    parser.add_argument("--output", default=os.path.join(os.path.dirname(here), "output", "jacksboro"),
                        help="folder for the results (output/jacksboro of this project)")
    parser.add_argument("--rocks", type=int, default=120, help="how many rocks are released (120)")
    parser.add_argument("--frames", type=int, default=100,
                        help="frames of the movie and steps of the time series (100); 0 makes no movie")
    parser.add_argument("--ground", default=GROUND.split(" (")[0],
                        help="a preset of ground, or Hard: for comparison with published DDA "
                             f"({GROUND.split(' (')[0]})")
    chosen = parser.parse_args()
    if chosen.rocks < 1:
        parser.error(f"--rocks is {chosen.rocks}, it must be at least 1")
    if chosen.frames < 0:
        parser.error(f"--frames is {chosen.frames}, it must not be negative")
    try:
        os.makedirs(chosen.output, exist_ok=True)
    except OSError as error:
        parser.error(f"--output {chosen.output}: {error.strerror}")
    if not os.access(chosen.output, os.W_OK):
        parser.error(f"--output {chosen.output}: nothing can be written there")
    return chosen


def result(proxy, port=0):
    """What a filter made; pvbatch is its own server, so nothing is copied."""
    data = proxy.GetClientSideObject().GetOutputDataObject(port)
    if data is None or data.GetNumberOfElements(6 if data.IsA("vtkTable") else 0) == 0:
        raise SystemExit(f"{proxy.GetXMLLabel()} made nothing; the message above says why.")
    return data


def set_ground(slope, name):
    presets = {label.split(" (")[0].lower(): label for label in slope.GetProperty("Preset").Available[1:]}
    if name.lower() == "hard":
        for field, value in HARD.items():
            setattr(slope, field, value)
    elif name.lower() in presets:
        slope.Preset = presets[name.lower()]
    else:
        raise SystemExit(f"--ground {name}: must be Hard or one of " +
                         ", ".join(label.split(" (")[0] for label in presets.values()))


def simulate(slope, rocks):
    simulation = RockfallSimulation(
        Terrain=slope, Rocks=rocks, EndTime=END, OutputInterval=INTERVAL, Seed=SEED)
    said = [0.0]

    def tell(filter, _):
        share = filter.GetProgress()
        if share >= said[0] + 0.1:
            said[0] = share
            say(f"  {100 * share:.0f} % of the rocks came to their end")

    observer = simulation.GetClientSideObject().AddObserver("ProgressEvent", tell)
    simulation.UpdatePipeline(0.0)
    simulation.GetClientSideObject().RemoveObserver(observer)
    return simulation


def save_series(simulation, times, path):
    """The rocks at some of the simulation's times, as a series that ParaView opens."""
    every = np.array(simulation.TimestepValues)
    steps = np.unique(np.abs(every[:, None] - times).argmin(axis=0))
    series = ExtractTimeSteps(Input=OutputPort(simulation, 0), TimeStepIndices=steps.tolist())
    folder = os.path.splitext(path)[0]  # of the steps' files; those of an earlier run may be more
    for old in os.listdir(folder) if os.path.isdir(folder) else []:
        if old.endswith(".vtp"):
            os.remove(os.path.join(folder, old))
    SaveData(path, proxy=series, WriteTimeSteps=1, DataMode="Binary")
    Delete(series)


def main():
    chosen = arguments()
    if "RockfallSimulation" not in globals():
        raise SystemExit("The plugin RockfallDDA is not loaded: run this with bash Examples/run.sh.")
    in_folder = lambda name: os.path.join(chosen.output, name)

    dem = in_folder("jacksboro.tif")
    rows, columns, elevation = sample_dem.write_geotiff(
        sample_dem.find_sample("jacksboro_fault_dem.npz"), dem)
    say(f"DEM: {rows} x {columns} cells, {elevation.min()} to {elevation.max()} m, written as {dem}")

    # The triangles are only looked at from afar here; the rocks fall on every CFE.
    slope = DEMtoCFEMesh(FileName=dem, CellSize=CELL, MaximumDisplayCells=400000)
    set_ground(slope, chosen.ground)
    slope.UpdatePipeline()
    ground = Ground(result(slope))
    say(f"Slope: {ground.rows} x {ground.columns} nodes of {ground.cell:g} m; ground: {ground.name}")

    area_rows, area_columns, angles = release.steepest_escarpment(ground, STEEP)
    heights = ground.height(*ground.centre(area_rows, area_columns))
    say(f"Steepest escarpment: {len(angles)} connected cells over {STEEP:g}°, {angles.mean():.1f}° "
        f"on average, {angles.max():.1f}° at most, {heights.min():.0f} to {heights.max():.0f} m")
    sources = release.place_rocks(ground, area_rows, area_columns, chosen.rocks, SEED)
    release.write_sources(sources, in_folder("sources.csv"))
    rocks = RockBlocks(FileName=in_folder("sources.csv"))
    rocks.UpdatePipeline()
    result(rocks)

    say(f"Simulating {chosen.rocks} rocks until they rest or leave; they do not touch each other")
    simulation = simulate(slope, rocks)
    paths = tables.Trajectories(result(simulation, 1))
    summary = tables.columns_of(result(simulation, 3))
    angle = DispersionAngle(Input=OutputPort(simulation, 1), GroupBy="Shape")
    angle.UpdatePipeline()
    dispersion = tables.columns_of(result(angle))
    moving = int((np.array(summary["FateCode"]) == 2).sum())
    say(f"{moving} rocks still move after {END:g} s" if moving else
        f"The last rock came to its end after {summary['EndTime'].max():.0f} s")

    samples = tables.write_trajectories(paths, summary["Shape"], in_folder("trajectories.csv"))
    tables.write_summary(summary, in_folder("summary.csv"))
    tables.write_dispersion(dispersion, in_folder("dispersion.csv"))
    say(f"Tables: {samples} samples of {chosen.rocks} rocks")

    # The movie shows the time in which three of four rocks stop; the series ends with the last one.
    shown = np.linspace(0.0, np.percentile(summary["EndTime"], 75), max(chosen.frames, 2))
    save_series(simulation, np.append(shown, summary["EndTime"].max()), in_folder("rocks.pvd"))
    SaveData(in_folder("trajectories.vtp"), proxy=OutputPort(simulation, 1), DataMode="Binary")
    scene = pictures.Scene(ground, simulation, paths, summary)
    scene.save_slope(in_folder("slope.vtp"))
    say(f"Time series: {len(shown) + 1} steps")

    for name, draw in (("overview.png", scene.overview), ("map.png", scene.map),
                       ("oblique.png", scene.oblique), ("rocks.png", scene.close_up)):
        draw(in_folder(name))
        say(f"Picture: {name}")
    if chosen.frames:
        say(f"Movie: {chosen.frames} frames of {shown[-1]:.0f} s")
        scene.movie(in_folder("rockfall.ogv"), shown, say)

    print()
    tables.print_tables(summary, dispersion)
    print(f"\nIn {chosen.output}:")
    for name in sorted(os.listdir(chosen.output)):
        path = in_folder(name)
        if os.path.isdir(path):
            print(f"  {name}/ ({len(os.listdir(path))} files of rocks.pvd)")
        else:
            print(f"  {name} ({os.path.getsize(path) / 1024:.0f} kB)")
    say("Done")


main()
