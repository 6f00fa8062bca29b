"""The map of a finished study as rasters of Rockyfor3D's names."""
import os

import numpy as np
from osgeo import gdal

from grids import Bad, write

# name there, band here, factor, what it is, whole numbers; where no rock came counts and shares are 0, all else nodata
RASTERS = (
    ("E_95CI", "KineticEnergy95", 1e-3, "kJ, of translation and rotation", False),
    ("Ph_95CI", "HeightOverGround95", 1.0, "m, of the rock's lowest point over the ground, upright: Rockyfor3D's is measured "
     "otherwise", False),
    ("E_mean", "KineticEnergyMean", 1e-3, "kJ; the name is from memory", False),
    ("Nr_deposited", "StoppingPoints", 1.0, "rocks", True),
    ("Nr_passages", "Passages", 1.0, "entries of rocks, one that comes back counts again; the name is from memory", True),
    ("Reach_probability", "ReachProbability", 100.0, "% of all released rocks; Rockyfor3D's refers to the source cells that feed a "
     "cell", False),
    ("EL_angles", "EnergyLineAngle", 1.0, "degrees", False))
ZERO = "Nr_deposited", "Nr_passages", "Reach_probability"


def convert(source, target):
    path = os.path.join(source, "hazard.tif")
    if not os.path.exists(os.path.join(source, "results.json")):
        raise Bad(f"{source} is not the folder of a finished study: it has no results.json")
    if not os.path.exists(path):
        raise Bad(f"{source} has no hazard.tif: the study needs a \"map\"")
    try:
        data = gdal.OpenEx(path, gdal.OF_RASTER, allowed_drivers=["GTiff"])
        numbers = {data.GetRasterBand(k + 1).GetDescription(): k + 1 for k in range(data.RasterCount)}
        rocks = data.GetRasterBand(numbers["Rocks"]).ReadAsArray()
    except (RuntimeError, KeyError, AttributeError):
        raise Bad(f"{path} is not the map of a study") from None
    west, cell, _, north, _, _ = data.GetGeoTransform()
    notes = ["The cells lie between the nodes of the DEM: rasters begin half a cell further in, with one row and column less."]
    for name, band, factor, what, whole in RASTERS:
        found = next((one for one in numbers if one == band or band == "EnergyLineAngle" and one.startswith(band)), None)
        if not found:
            notes.append(f"{name}: the map has no {band}")
            continue
        values = factor * data.GetRasterBand(numbers[found]).ReadAsArray().astype(float)
        values[rocks == 0] = 0.0 if name in ZERO else np.nan
        write(os.path.join(target, name + ".asc"), values, west, north, cell, data.GetProjection(), whole)
        notes.append(f"{name}.asc: {found}, {what}")
    with open(os.path.join(target, "notes.txt"), "w", encoding="utf-8") as file:
        file.write("\n".join(notes) + "\n")
    return "\n".join(notes)
