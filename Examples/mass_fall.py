"""A mass fall above a road: 41 rocks that collide, the same ones that do not, and an embankment.

After Zheng et al. (2014), section 3.4: rocks fall from a mountainside onto a gentle step above a road. Each
iteration draws restitution and friction anew. How many rocks come to the road is counted with collisions
and without, and with an embankment of 3.5 m planned at the foot; confidence intervals are over
iterations, because the rocks of one iteration are not independent. The mountainside is invented, see
mass_fall_parts/scenario.py and docs/mass_falls.md. Run it with

    bash Examples/run.sh mass_fall.py [--output FOLDER --iterations N --time-step S --frames N]

and find in output/mass_fall counts.csv and counts.txt, map.png, oblique.png, stops.png, and the movie
mass_fall.ogv; rocks.pvd, a time series of the most typical iteration, opens in ParaView.
"""
import argparse
import os
import sys
import time

here = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [here, os.path.join(here, "mass_fall_parts")]

import numpy as np
from paraview.simple import *

import mass_fall_pictures as pictures
import scenario
from counts import interval, typical, write_counts
from rockfall_tables import columns_of

SEED, END, INTERVAL = 20143, 30.0, 0.1
# Of rocks on rocks nothing is published: the slope's restitution is far less than this for inclined
# impacts, and the friction is that of rock joints.
ROCK_RESTITUTION, ROCK_FRICTION = 0.5, 30.0

started = time.time()


def say(text):
    print(f"[{time.time() - started:6.1f} s] {text}", flush=True)


def arguments():
    parser = argparse.ArgumentParser(description="A mass fall with collisions and without.")
    parser.add_argument("--output", default=os.path.join(os.path.dirname(here), "output", "mass_fall"))
    parser.add_argument("--iterations", type=int, default=20, help="realisations of each case (20)")
    parser.add_argument("--time-step", type=float, default=scenario.TIME_STEP,
                        help="of lasting contact, s (0.001)")
    parser.add_argument("--frames", type=int, default=120, help="frames of the movie (120); 0 makes none")
    chosen = parser.parse_args()
    if chosen.iterations < 2:
        parser.error(f"--iterations is {chosen.iterations}, it must be at least 2")
    if chosen.frames < 0:
        parser.error(f"--frames is {chosen.frames}, it must not be negative")
    os.makedirs(chosen.output, exist_ok=True)
    return chosen


def result(proxy, port=0):
    data = proxy.GetClientSideObject().GetOutputDataObject(port)
    if data is None or data.GetNumberOfElements(6 if data.IsA("vtkTable") else 0) == 0:
        raise SystemExit(f"{proxy.GetXMLLabel()} made nothing; the message above says why.")
    return data


def make_slope(folder, name, with_embankment):
    grid = scenario.write_grid(os.path.join(folder, name), with_embankment)
    slope = DEMtoCFEMesh(
        FileName=grid, RestitutionCoefficient=scenario.RESTITUTION,
        RestitutionDeviation=scenario.RESTITUTION_DEVIATION, FrictionAngle=scenario.FRICTION,
        FrictionAngleDeviation=scenario.FRICTION_DEVIATION, RoughnessMean=0, RoughnessDeviation=0)
    UpdatePipeline(proxy=slope)
    return slope


def make_rocks(folder, slope):
    """Rocks on the ground, whose centroids have the paper's mean height."""
    aim = scenario.START
    for _ in range(6):
        table = scenario.write_rocks(os.path.join(folder, "rocks.csv"), aim)
        rocks = RockBlocks(Terrain=slope, FileName=table, TargetCRS="", AttitudeLaw="As given")
        height = RockfallSimulation(Terrain=slope, Rocks=rocks, EndTime=1e-3, TrajectoryOutput="Nothing")
        UpdatePipeline(proxy=height)
        mean = columns_of(result(height, 3))["StartZ"].mean()
        Delete(height)
        if abs(mean - scenario.START) < 5e-4:
            return rocks, mean
        aim += scenario.START - mean
        Delete(rocks)
    raise SystemExit(f"the rocks' mean height is {mean:.3f} m instead of {scenario.START} m")


def simulate(slope, rocks, collide, chosen):
    simulation = RockfallSimulation(
        Terrain=slope, Rocks=rocks, RockRockContact=int(collide), TimeStep=chosen.time_step,
        EndTime=END, OutputInterval=INTERVAL, Iterations=chosen.iterations, Seed=SEED,
        RockRestitution=ROCK_RESTITUTION, RockFrictionAngle=ROCK_FRICTION)
    UpdatePipeline(proxy=simulation)
    summary = columns_of(result(simulation, 3))
    numerical = -np.asarray(summary["EnergyDamping"]) - np.asarray(summary["EnergyNumerical"])
    say(f"  energy from nowhere: {100 * np.maximum(0.0, numerical.sum()) / summary['EnergyReleased'].sum():.3f} % "
        f"of what was released; {int(np.sum(summary['UnsettledSteps']))} unsettled steps of "
        f"{int(np.sum(summary['ContactSteps']))}; {int(np.sum(np.array(summary['FateCode']) == 2))} rocks "
        f"still move at {END:g} s")
    return simulation, summary


def counts_of(summary, iterations):
    """Per iteration: rocks on the step, behind the embankment's crest, and on the road or beyond."""
    x, number = np.asarray(summary["StopX"]), np.asarray(summary["Iteration"])
    step = (x > scenario.PROFILE["step"][0] - 3.0) & (x < scenario.PROFILE["edge"][0] + 1.0)
    foot = (x >= scenario.PROFILE["edge"][0] + 1.0) & (x < scenario.ROAD[0])
    road = x >= scenario.ROAD[0]
    return {name: np.bincount(number[which], minlength=iterations)
            for name, which in (("step", step), ("foot", foot), ("road", road))}


chosen = arguments()
in_folder = lambda name: os.path.join(chosen.output, name)
say("Slope, embankment, rocks")
slopes = {False: make_slope(chosen.output, "slope.asc", False),
          True: make_slope(chosen.output, "slope_embankment.asc", True)}
rocks, mean = make_rocks(chosen.output, slopes[False])
cases, simulations, stops = {}, {}, {}
for bank in (False, True):
    for collide in (False, True):
        name = ("with collisions" if collide else "without collisions") + (", embankment" if bank else "")
        say(name)
        simulation, summary = simulate(slopes[bank], rocks, collide, chosen)
        if not cases:
            volume, mass = (np.asarray(summary[k])[:scenario.ROCKS].sum() for k in ("Volume", "Mass"))
            say(f"  {scenario.ROCKS} rocks of {volume:.3f} m³ and {mass:.0f} kg, from Z = {mean:.3f} m")
        cases[name] = counts_of(summary, chosen.iterations)
        stops[name] = np.stack([summary[k] for k in ("StopX", "StopY", "StopZ")], -1)
        simulations[name] = simulation
        on_step = np.asarray(summary["StopX"])
        on_step = (on_step > scenario.PROFILE["step"][0] - 3.0) & (on_step < scenario.PROFILE["edge"][0] + 1.0)
        say("  on the road {:.2f}, 95 % {:.2f} to {:.2f}; rocks on the step lie at Z = {:.3f} m".format(
            *interval(cases[name]["road"]), np.asarray(summary["StopZ"])[on_step].mean()))

write_counts(cases, in_folder("counts.csv"), in_folder("counts.txt"))
print(open(in_folder("counts.txt")).read())

shown = typical(cases)
say(f"Pictures, of iteration {shown}")
simulations["with collisions"].ShownIteration = shown
pictures.stops_picture(stops, in_folder("stops.png"))
pictures.map_picture(slopes, simulations, stops, shown, in_folder("map.png"))
pictures.oblique_picture(slopes, simulations, in_folder("oblique.png"), END)
if chosen.frames:
    say(f"Movie: {chosen.frames} frames")
    together = simulations["with collisions"]
    SaveData(in_folder("rocks.pvd"), proxy=OutputPort(together, 0), WriteTimeSteps=1)
    pictures.movie(slopes, simulations, in_folder("mass_fall.ogv"), chosen.frames, END)
say("Done: " + chosen.output)
