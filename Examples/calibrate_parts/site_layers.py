"""A site from its JSON file and layers.

Deposits are read by Rock Blocks, like sources: any point layer, in any CRS, with `source_id`.
"""
import json
import os

import numpy as np
from paraview.simple import DEMtoCFEMesh, RockBlocks
from vtkmodules.util.numpy_support import vtk_to_numpy

from site_runs import Site, made_by, refuse, set_all
from site_scores import Observed

PARTS = ("terrain", "rocks", "simulation", "deposits", "search")
FILES = ("FileName", "File", "Layer", "Table")  # a property whose name ends so is a file
MOST_PARAMETERS = 10


def read_site(path):
    """The description with full paths and checked ranges."""
    try:
        with open(path, encoding="utf-8") as file:
            site = json.load(file)
    except OSError as error:
        refuse(f"{path}: {error.strerror}")
    except ValueError as error:
        refuse(f"{path} is not JSON: {error}")
    if not isinstance(site, dict):
        refuse(f"{path} must be an object with {', '.join(PARTS)}")
    for key, value in site.items():
        if key not in PARTS:
            refuse(f'{path}: there is no "{key}" in a site, it knows {", ".join(PARTS)}')
        if not isinstance(value, dict):
            refuse(f'{path}: "{key}" is {json.dumps(value)}, it must be an object')
    for part in PARTS:
        site.setdefault(part, {})
    for part in ("terrain", "rocks", "deposits"):
        if not site[part].get("FileName"):
            refuse(f'{path}: "{part}" has no FileName')
        for name, value in site[part].items():
            if name.endswith(FILES) and value:
                site[part][name] = os.path.join(os.path.dirname(os.path.abspath(path)), str(value))
                if not os.path.isfile(site[part][name]):
                    refuse(f"{path}: {part} {name}: there is no file {site[part][name]}")
    for name in site["deposits"]:
        if name not in ("FileName", "BySource", "TrackedMargin"):
            refuse(f'{path}: "deposits" knows FileName, BySource and TrackedMargin, not {name}')
    if not isinstance(site["deposits"].setdefault("BySource", False), bool):
        refuse(f'{path}: "BySource" of "deposits" must be true or false')
    margin = site["deposits"].get("TrackedMargin", 0)
    if type(margin) not in (int, float) or not np.isfinite(margin) or margin < 0:
        refuse(f'{path}: "TrackedMargin" of "deposits" is {json.dumps(margin)}, it must be a number of '
               "metres that is not negative")
    for name in ("Seed", "NumberOfThreads"):
        if name in site["simulation"]:
            refuse(f'{path}: "{name}" of "simulation" is an option of this script')
    if len(site["search"]) > MOST_PARAMETERS:
        refuse(f'{path}: "search" has {len(site["search"])} parameters, {MOST_PARAMETERS} at most')
    for name, span in site["search"].items():
        numbers = isinstance(span, list) and len(span) == 2 and all(
            type(v) in (int, float) and np.isfinite(v) for v in span)
        if not numbers or not span[0] < span[1]:
            refuse(f'{path}: search {name}: {json.dumps(span)} must be [least, greatest]')
    return site


def make(proxy, part, properties):
    """A proxy with these properties; a name that it has not is refused."""
    made = proxy()
    set_all(made, part, properties)
    made.UpdatePipeline()
    return made


def blocks_of(proxy):
    """Centre in plan and source number of every block, in the order of the simulation."""
    data = made_by(proxy)
    block = vtk_to_numpy(data.GetCellData().GetArray("BlockId"))
    source = vtk_to_numpy(data.GetCellData().GetArray("SourceId"))
    points = vtk_to_numpy(data.GetPoints().GetData())
    ids = vtk_to_numpy(data.GetPolys().GetConnectivityArray())
    offsets = vtk_to_numpy(data.GetPolys().GetOffsetsArray())
    numbers, first, of = np.unique(block, return_index=True, return_inverse=True)
    of = np.repeat(of.ravel(), np.diff(offsets))
    order = np.argsort(first, kind="stable")
    centres = np.empty((len(numbers), 2))
    for k in range(len(numbers)):
        own = points[np.unique(ids[of == order[k]])]
        centres[k] = own[:, :2].mean(axis=0)
    return centres, source[first[order]]


def make_site(description, seed, threads):
    """The pipeline, and the names of the deposits."""
    for name in description["search"]:
        if name in description["terrain"]:
            continue
    slope = make(DEMtoCFEMesh, "terrain", description["terrain"])
    for name in description["search"]:
        if not isinstance(getattr(slope, name, None), (int, float)):
            refuse(f'"search" {name}: DEM to CFE Mesh has no number of this name')
    rocks = make(RockBlocks, "rocks", {"Terrain": slope, **description["rocks"]})
    centres, source = blocks_of(rocks)
    layer = make(RockBlocks, "deposits", {
        "Terrain": slope, "FileName": description["deposits"]["FileName"], "PlaceOnGround": 1,
        "Volume": 0.001})
    stops, key = blocks_of(layer)
    names = [str(k + 1) for k in range(len(stops))]
    margin = description["deposits"].get("TrackedMargin")
    if description["deposits"]["BySource"]:
        for k, number in enumerate(key):
            if number not in source:
                refuse(f"{description['deposits']['FileName']}: deposit {k + 1} is of source "
                       f"{number}, and there are no rocks of it")
        start = np.array([centres[source == number].mean(axis=0) for number in key])
        group = [f"source {number}" for number in key]
        # Groups of single deposits say nothing that the deposits do not.
        if max(group.count(one) for one in set(group)) < 2:
            group = ["all"] * len(group)
        forecast = source
        # Rocks of sources without a deposit foretell none.
        observed = Observed(start, stops, key, group, margin)
    else:
        start = np.broadcast_to(centres.mean(axis=0), stops.shape)
        observed = Observed(start, stops, np.zeros(len(stops), int), ["all"] * len(stops), margin)
        forecast = np.zeros(len(centres), int)
    return Site(slope, rocks, observed, forecast,
                {**description["simulation"], "Seed": seed, "NumberOfThreads": threads}), names
