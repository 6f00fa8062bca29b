"""A field experiment with single rocks, read from a folder of four files.

| file | columns that are read |
|---|---|
| block_metadata.csv | block_id, name, mass_kg, size_x_m, size_y_m, size_z_m |
| release_points.csv | trajectory_id, x_m, y_m, z_m, vx_mps, vy_mps, vz_mps, block_id |
| observed_deposition.csv | trajectory_id, x_m, y_m |
| terrain.asc | ESRI ASCII grid of elevations, in the coordinates of the tables |

Whatever is wrong with them ends the script with one message that names file, row, field and value.
"""
import csv
import math
import os

BLOCKS, RELEASES, DEPOSITIONS, TERRAIN = (
    "block_metadata.csv", "release_points.csv", "observed_deposition.csv", "terrain.asc")


class FolderError(SystemExit):
    """Something in the folder cannot be used."""


class Block:
    """A test rock: mass in kg, its size along three axes in m."""

    def __init__(self, row):
        self.id, self.name = row.text("block_id"), row.text("name")
        self.mass = row.number("mass_kg", positive=True)
        self.size = [row.number(f"size_{axis}_m", positive=True) for axis in "xyz"]


class Run:
    """One rock from its release to where it came to rest, m and m/s."""

    def __init__(self, row):
        self.id, self.block = row.text("trajectory_id"), row.text("block_id")
        self.start = [row.number(name) for name in ("x_m", "y_m", "z_m")]
        self.velocity = [row.number(name) for name in ("vx_mps", "vy_mps", "vz_mps")]
        self.stop = None


class Row:
    """A row of a table, with its place for messages."""

    def __init__(self, file, line, values):
        self.place, self.values = f"{file}, line {line}", values

    def fail(self, field, text):
        raise FolderError(f'{self.place}: field "{field}": {text}')

    def text(self, field):
        value = (self.values[field] or "").strip()
        if not value:
            self.fail(field, "is empty")
        return value

    def number(self, field, positive=False):
        text = self.text(field)
        try:
            value = float(text)
        except ValueError:
            self.fail(field, f'"{text}" is not a number')
        if not math.isfinite(value):
            self.fail(field, f'"{text}" is not a finite number')
        if positive and value <= 0.0:
            self.fail(field, f"{text} must be positive")
        return value


def read_table(folder, file, columns):
    path = os.path.join(folder, file)
    if not os.path.isfile(path):
        raise FolderError(f"{path}: there is no such file; the folder needs {BLOCKS}, {RELEASES}, "
                          f"{DEPOSITIONS} and {TERRAIN}")
    try:
        with open(path, newline="", encoding="utf-8-sig") as source:
            reader = csv.DictReader(source)
            names = [name.strip() for name in reader.fieldnames or []]
            for column in columns:
                if column not in names:
                    raise FolderError(f'{path}: there is no column "{column}"; '
                                      f"the header has {', '.join(names) or 'nothing'}")
            reader.fieldnames = names
            rows = []
            for values in reader:
                rows.append(Row(path, reader.line_num, values))
                if None in values or None in values.values():
                    have = sum(v is not None for k, v in values.items() if k is not None)
                    have += len(values.get(None, []))
                    raise FolderError(f"{rows[-1].place}: has {have} fields, the header {len(names)}"
                                      "; a comma as decimal mark?")
    except (UnicodeDecodeError, csv.Error) as error:
        raise FolderError(f"{path}: is not a CSV table in UTF-8: {error}")
    if not rows:
        raise FolderError(f"{path}: has no rows")
    return rows


def keyed(rows, field):
    """The rows by their key, which must be unique."""
    result = {}
    for row in rows:
        key = row.text(field)
        if key in result:
            row.fail(field, f'"{key}" is there twice, first at {result[key].place}')
        result[key] = row
    return result


def read_terrain_header(folder):
    """The path of the grid and the words of its header."""
    path = os.path.join(folder, TERRAIN)
    if not os.path.isfile(path):
        raise FolderError(f"{path}: there is no such file")
    header = {}
    with open(path, encoding="ascii", errors="replace") as source:
        for line in source:
            words = line.split()
            if len(words) != 2 or not words[0][0].isalpha():
                break
            header[words[0].lower()] = words[1]
    for name in ("ncols", "nrows", "xllcorner", "yllcorner", "cellsize"):
        if name not in header:
            raise FolderError(f'{path}: the header has no "{name}"')
        try:
            if not math.isfinite(float(header[name])):
                raise ValueError
        except ValueError:
            raise FolderError(f'{path}: field "{name}": "{header[name]}" is not a number')
    if float(header["cellsize"]) <= 0:
        raise FolderError(f'{path}: field "cellsize": {header["cellsize"]} must be positive')
    return path, header


class FieldTest:
    """All of a folder: blocks {id: Block}, runs [Run] in the order of the release table."""

    def __init__(self, folder):
        if not os.path.isdir(folder):
            raise FolderError(f"{folder}: there is no such folder")
        self.folder = folder
        self.terrain, self.header = read_terrain_header(folder)
        sizes = ["block_id", "name", "mass_kg", "size_x_m", "size_y_m", "size_z_m"]
        self.blocks = {key: Block(row) for key, row in keyed(
            read_table(folder, BLOCKS, sizes), "block_id").items()}
        releases = keyed(read_table(folder, RELEASES, [
            "trajectory_id", "x_m", "y_m", "z_m", "vx_mps", "vy_mps", "vz_mps", "block_id"]),
            "trajectory_id")
        stops = keyed(read_table(folder, DEPOSITIONS, ["trajectory_id", "x_m", "y_m"]),
                      "trajectory_id")
        self.runs = []
        for key, row in releases.items():
            run = Run(row)
            if run.block not in self.blocks:
                row.fail("block_id", f'"{run.block}" is not in {BLOCKS}')
            if key not in stops:
                row.fail("trajectory_id", f'run "{key}" has no row in {DEPOSITIONS}')
            run.stop = [stops[key].number("x_m"), stops[key].number("y_m")]
            self.runs.append(run)
        for key, row in stops.items():
            if key not in releases:
                row.fail("trajectory_id", f'run "{key}" has no row in {RELEASES}')

    def write_terrain(self, path, as_pixels):
        """The grid as the simulation reads it. GDAL takes xllcorner for the corner of a pixel; where
        it is the place of the south-west node, as in this data, it has to move by half a cell."""
        shift = 0.0 if as_pixels else 0.5 * float(self.header["cellsize"])
        with open(self.terrain, encoding="ascii", errors="replace") as source:
            lines = source.readlines()
        for k, line in enumerate(lines[:6]):
            name = line.split()[0].lower() if line.split() else ""
            if name in ("xllcorner", "yllcorner"):
                lines[k] = f"{name} {float(self.header[name]) - shift!r}\n"
        with open(path + ".part", "w", encoding="ascii", errors="replace") as target:
            target.writelines(lines)
        os.replace(path + ".part", path)
