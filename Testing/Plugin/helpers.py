"""What the plugin's tests share."""

import contextlib
import csv
import ctypes
import io
import os
import re
import runpy
import sys
import tempfile

from paraview.simple import Delete, GetSources, UpdatePipeline

UTM16 = ('PROJCS["WGS 84 / UTM zone 16N",GEOGCS["WGS 84",DATUM["WGS_1984",'
         'SPHEROID["WGS 84",6378137,298.257223563]],PRIMEM["Greenwich",0],'
         'UNIT["degree",0.0174532925199433]],PROJECTION["Transverse_Mercator"],'
         'PARAMETER["latitude_of_origin",0],PARAMETER["central_meridian",-87],'
         'PARAMETER["scale_factor",0.9996],PARAMETER["false_easting",500000],'
         'PARAMETER["false_northing",0],UNIT["metre",1]]')
WGS84 = ('GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563]],'
         'PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433]]')


def write_text(name, text):
    """Writes a file into the test's folder; returns its full name."""
    with open(name, "w") as file:
        file.write(text)
    return os.path.abspath(name)


def write_grid(name, rows, corner=(700000, 4000000), cell=10, crs=UTM16):
    """An ESRI ASCII grid of these rows of words, north row first, with its CRS beside it."""
    head = (f"ncols {len(rows[0])}\nnrows {len(rows)}\nxllcorner {corner[0]}\n"
            f"yllcorner {corner[1]}\ncellsize {cell}\nNODATA_value -9999\n")
    if crs:
        write_text(os.path.splitext(name)[0] + ".prj", crs)
    return write_text(name, head + "\n".join(" ".join(map(str, row)) for row in rows) + "\n")


def incline(columns=31, rows=21, drop=5.0):
    """Heights that fall along +x."""
    return [[round(drop * (columns - 1 - c), 3) for c in range(columns)] for _ in range(rows)]


def flush_all():
    """What Python has written, and what C++ has: std::cout is C's stdout, which waits in a buffer."""
    sys.stdout.flush()
    sys.stderr.flush()
    ctypes.CDLL(None).fflush(None)


def messages_of(action):
    """Runs action() and returns all that the process wrote meanwhile."""
    flush_all()
    with tempfile.TemporaryFile() as caught:
        kept = [os.dup(1), os.dup(2)]
        os.dup2(caught.fileno(), 1)
        os.dup2(caught.fileno(), 2)
        try:
            action()
        finally:
            flush_all()
            for number, old in enumerate(kept, start=1):
                os.dup2(old, number)
                os.close(old)
        caught.seek(0)
        return caught.read().decode()


def outside_mpi():
    """The environment without what MPI put into it for this process: for a process that starts MPI."""
    return {name: value for name, value in os.environ.items()
            if not name.startswith(("OMPI_", "PMIX_", "PRTE_")) or "ALLOW_RUN_AS_ROOT" in name}


def errors_of(proxy, *ports):
    """Updates the proxy, and whatever of it ports name, and returns the errors this makes."""
    def update():
        UpdatePipeline(proxy=proxy)
        for port in ports or [0]:
            proxy.GetDataInformation(port).GetNumberOfPoints()
        UpdatePipeline(proxy=proxy)
    text = messages_of(update)
    return re.findall(r"ERR\| (.*?)(?:\x1b|$)", text, re.MULTILINE)


def is_empty(proxy, port=0):
    info = proxy.GetDataInformation(port)
    return info.GetNumberOfPoints() == 0 and info.GetNumberOfCells() == 0 and \
        info.GetNumberOfRows() == 0


def columns_of(table):
    """A fetched vtkTable as {column name: [values]}."""
    result = {}
    for c in range(table.GetNumberOfColumns()):
        result[table.GetColumnName(c)] = [
            table.GetValue(r, c).ToString() if not table.GetValue(r, c).IsNumeric()
            else table.GetValue(r, c).ToDouble() for r in range(table.GetNumberOfRows())]
    return result


def run_script(script, *arguments):
    """Runs a script in this process, which is quicker than another one: what it prints, and its exit
    message (None: it came to its end)."""
    told, argv, message = io.StringIO(), sys.argv, None
    sys.argv = [script, *arguments]
    try:
        with contextlib.redirect_stdout(told), contextlib.redirect_stderr(told):
            runpy.run_path(script, run_name="__main__")
    except SystemExit as ended:
        message = str(ended)
    finally:
        sys.argv = argv
    return told.getvalue(), message


def delete_sources():
    """Deletes all sources of the pipeline."""
    for source in list(GetSources().values()):
        Delete(source)


def rows_of(path):
    """A CSV file as a list of {column name: text}."""
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def files_of(folder):
    """The bytes of every file of a folder, by name."""
    result = {}
    for name in sorted(os.listdir(folder)):
        with open(os.path.join(folder, name), "rb") as file:
            result[name] = file.read()
    return result
