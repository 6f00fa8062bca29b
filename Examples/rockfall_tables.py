"""The results of Rockfall Simulation as numbers and as CSV tables."""
import csv

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy


def result(proxy, port=0):
    """What a filter made; pvbatch is its own server, so nothing is copied."""
    proxy.UpdatePipeline()
    data = proxy.GetClientSideObject().GetOutputDataObject(port)
    error = data.GetFieldData().GetAbstractArray("Error") if data else None
    if data is None or error:
        raise SystemExit(error.GetValue(0) if error else f"{proxy.GetXMLLabel()} made nothing.")
    return data


def columns_of(table):
    """A vtkTable as {name: array or list of texts}."""
    result = {}
    for k in range(table.GetNumberOfColumns()):
        column = table.GetColumn(k)
        if column.IsNumeric():
            result[column.GetName()] = vtk_to_numpy(column)
        else:
            result[column.GetName()] = [column.GetValue(i) for i in range(column.GetNumberOfTuples())]
    return result


class Trajectories:
    """The polylines of the simulation's second output as arrays over all samples.

    `starts` has the number of each rock's first sample, and one more entry at the end."""

    def __init__(self, polydata):
        lines = polydata.GetLines()
        order = vtk_to_numpy(lines.GetConnectivityArray())
        self.starts = vtk_to_numpy(lines.GetOffsetsArray())
        self.points = vtk_to_numpy(polydata.GetPoints().GetData())[order]
        data = polydata.GetPointData()
        self.time, self.velocity, self.speed, self.rotation, self.height = (
            vtk_to_numpy(data.GetArray(name))[order]
            for name in ("Time", "Velocity", "Speed", "RotationRate", "HeightOverGround"))
        self.block = vtk_to_numpy(polydata.GetCellData().GetArray("BlockId"))

    def of(self, rock):
        return slice(self.starts[rock], self.starts[rock + 1])

    def places(self, rock, times):
        """Centroids of one rock at these times."""
        own = self.of(rock)
        return np.stack([np.interp(times, self.time[own], self.points[own, k]) for k in range(3)], -1)


def write_trajectories(trajectories, shapes, path):
    """One row per rock and sample: where its centroid is and how fast it moves and turns."""
    with open(path, "w") as file:
        file.write("BlockId,Shape,Time,Cx,Cy,Cz,Vx,Vy,Vz,Ryz,Rzx,Rxy\n")
        for rock, block in enumerate(trajectories.block):
            own = trajectories.of(rock)
            values = np.column_stack([trajectories.time[own], trajectories.points[own],
                                      trajectories.velocity[own], trajectories.rotation[own]])
            row = f"{block},{shapes[rock]},%.2f,%.3f,%.3f,%.3f,%.4f,%.4f,%.4f,%.4f,%.4f,%.4f"
            file.write("".join((row % tuple(v)) + "\n" for v in values.tolist()))
    return len(trajectories.time)


SUMMARY = {  # column: (column of the simulation's table, format)
    "BlockId": ("BlockId", "d"), "Shape": ("Shape", "s"), "Volume_m3": ("Volume", ".3f"),
    "Mass_kg": ("Mass", ".1f"), "Fate": ("Fate", "s"), "Time_s": ("EndTime", ".2f"),
    "StartX": ("StartX", ".2f"), "StartY": ("StartY", ".2f"), "StartZ": ("StartZ", ".2f"),
    "StopX": ("StopX", ".2f"), "StopY": ("StopY", ".2f"), "StopZ": ("StopZ", ".2f"),
    "RunOut_m": ("RunOut", ".2f"), "PathLength_m": ("PathLength", ".2f"),
    "MaxSpeed_m_s": ("MaxSpeed", ".2f"), "MaxKineticEnergy_kJ": ("MaxKineticEnergy", ".2f"),
    "MaxHeightOverGround_m": ("MaxHeightOverGround", ".2f"), "Impacts": ("Impacts", "d"),
}


def write_summary(summary, path):
    with open(path, "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(SUMMARY)
        for row in range(len(summary["BlockId"])):
            writer.writerow([
                format(summary[name][row] * (1e-3 if unit.endswith("_kJ") else 1), style)
                for unit, (name, style) in SUMMARY.items()])


def write_dispersion(dispersion, path):
    names = "Group Trajectories L W Theta LateralMin LateralMax LateralDeviation".split()
    with open(path, "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["Shape", "Trajectories", "L_m", "W_m", "Theta_degrees", "LateralMin_m",
                         "LateralMax_m", "LateralDeviation_m"])
        for row in range(len(dispersion["Group"])):
            values = [dispersion[name][row] for name in names]
            writer.writerow(values[:2] + [f"{v:.2f}" for v in values[2:]])


def print_tables(summary, dispersion):
    """Fates and dispersion per shape."""
    fates = sorted(set(summary["Fate"]) | {"rested"}, key=lambda f: f != "rested")
    shape, fate = np.array(summary["Shape"]), np.array(summary["Fate"])
    angle = dict(zip(dispersion["Group"], dispersion["Theta"]))
    print(f"{'shape':14}{'rocks':>6}" + "".join(f"{f:>14}" for f in fates) +
          f"{'run-out, m':>16}{'max speed, m/s':>16}{'dispersion angle':>18}")
    for name in sorted(set(shape)) + ["all"]:
        own = (shape == name) | (name == "all")
        runs, speeds = summary["RunOut"][own], summary["MaxSpeed"][own]
        print(f"{name:14}{own.sum():6d}" + "".join(f"{(fate[own] == f).sum():14d}" for f in fates) +
              f"{np.median(runs):8.0f}-{runs.max():<7.0f}{speeds.max():16.1f}" +
              (f"{angle[name]:16.1f}°" if name in angle else ""))
    print("(run-out: median and longest)")
