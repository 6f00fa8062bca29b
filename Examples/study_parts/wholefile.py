"""Files that are whole when they have their name, whatever happens: written beside it, looked at, and
renamed. And the lock of a folder that one study at a time may write into."""
import csv
import errno
import fcntl
import io
import os
import socket
import zipfile

import numpy as np
from vtkmodules.vtkCommonCore import vtkAbstractArray, vtkDataArray
from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

UNFINISHED = ".unfinished-"
LOCK = UNFINISHED + "lock"
XML_END = b"</VTKFile>"
ROWS = 10000  # of a table that are text at once
RANGES = (vtkAbstractArray.PER_COMPONENT(), vtkAbstractArray.PER_FINITE_COMPONENT(),
          vtkDataArray.L2_NORM_RANGE(), vtkDataArray.L2_NORM_FINITE_RANGE())


def unfinished(path):
    head, tail = os.path.split(os.path.abspath(path))
    return os.path.join(head, UNFINISHED + tail)


def keep(path):
    """Gives an unfinished file its name. It is on the disk before, and its name after."""
    other = unfinished(path)
    with open(other, "rb") as file:
        if os.fstat(file.fileno()).st_size == 0:
            raise OSError(errno.EIO, "nothing was written", path)
        os.fsync(file.fileno())
    os.replace(other, path)
    folder = os.open(os.path.dirname(other), os.O_RDONLY)
    try:
        os.fsync(folder)
    finally:
        os.close(folder)


def whole(path, blocks):
    """Writes blocks of bytes, one after the other: all of them, or none under this name."""
    other = unfinished(path)
    written = 0
    try:
        with open(other, "wb") as file:
            for data in blocks:
                file.write(data)
                written += len(data)
            file.flush()
            os.fsync(file.fileno())
            size = os.fstat(file.fileno()).st_size
        if size != written:
            raise OSError(errno.EIO, f"only {size} of {written} bytes were written", path)
        keep(path)
    except OSError as error:
        if os.path.exists(other):
            os.remove(other)
        raise OSError(error.errno, error.strerror, path) from None


def write_text(path, text):
    whole(path, [text.encode()])


def cell(value):
    """A cell that no spreadsheet takes for a formula: text that begins like one gets a ' before it."""
    if not isinstance(value, str) or not value.startswith(("=", "+", "-", "@", "\t", "\r")):
        return value
    try:
        float(value)
        return value
    except ValueError:
        return "'" + value


def texts_of(column):
    """What csv writes of a column: numbers are no formulas."""
    values = column.tolist()
    return values if column.dtype.kind in "iuf" else map(cell, values)


def csv_blocks(tables):
    """The text of tables of the same columns as one. Only some rows of it are in memory at once."""
    names = None
    for table in tables:
        text = io.StringIO(newline="")
        writer = csv.writer(text, lineterminator="\n")
        if names is None:
            names = list(table)
            writer.writerow(map(cell, names))
        for first in range(0, len(table[names[0]]), ROWS):
            writer.writerows(zip(*(texts_of(table[name][first:first + ROWS]) for name in names)))
            yield text.getvalue().encode()
            text.seek(0)
            text.truncate()
        yield text.getvalue().encode()


def write_csv(path, tables):
    """Tables of the same columns as one."""
    whole(path, csv_blocks(tables))


def write_npz(path, columns):
    """np.savez puts the time of day into its file; this does not."""
    made = io.BytesIO()
    with zipfile.ZipFile(made, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, values in columns.items():
            data = io.BytesIO()
            np.save(data, values)
            archive.writestr(zipfile.ZipInfo(name + ".npy", (1980, 1, 1, 0, 0, 0)), data.getvalue(),
                             compress_type=zipfile.ZIP_DEFLATED)
    whole(path, [made.getvalue()])


def forget_ranges(data):
    """Those of its arrays: VTK keeps them as keys, and its writer puts these into the file in an order
    that depends on who asked for them, so not the same on other ranks (findings/vtk_ranges_change_files.sh)."""
    arrays = [data.GetPoints().GetData()] if data.GetPoints() else []
    for fields in (data.GetPointData(), data.GetCellData(), data.GetFieldData()):
        arrays += map(fields.GetAbstractArray, range(fields.GetNumberOfArrays()))
    for array in arrays:
        for key in RANGES:
            array.GetInformation().Remove(key)


def write_polydata(path, data):
    """VTK's writer makes the text; on a full disk it ends the process, or says that all is well."""
    forget_ranges(data)
    writer = vtkXMLPolyDataWriter()
    writer.SetInputData(data)
    writer.WriteToOutputStringOn()
    writer.SetDataModeToBinary()
    made = writer.Write() == 1 and writer.GetOutputString()
    made = made.encode() if isinstance(made, str) else made
    if not made or not made.rstrip().endswith(XML_END):
        raise OSError(errno.ENOMEM, "VTK could not make its text", path)
    whole(path, [made])


def ends_as_xml(path):
    """Whether a file of write_polydata() has its end."""
    with open(path, "rb") as file:
        file.seek(max(0, os.path.getsize(path) - 2 * len(XML_END)))
        return file.read().rstrip().endswith(XML_END)


class Lock:
    """Of a folder. It goes with its process, however that ends."""

    def __init__(self, folder):
        self.path = os.path.join(folder, LOCK)
        while True:
            self.file = open(self.path, "a+", encoding="utf-8")
            try:
                fcntl.flock(self.file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except OSError as error:
                if error.errno not in (errno.EAGAIN, errno.EACCES):
                    raise OSError(error.errno, error.strerror, self.path) from None
                self.file.seek(0)
                raise BlockingIOError(errno.EAGAIN, self.file.read().strip(), self.path) from None
            try:
                if os.path.samestat(os.fstat(self.file.fileno()), os.stat(self.path)):
                    break  # else somebody removed it while this waited
            except FileNotFoundError:
                pass
            self.file.close()
        self.file.truncate(0)
        self.file.write(f"process {os.getpid()} on {socket.gethostname()}\n")
        self.file.flush()

    def release(self):
        """Once only: the next one may have made its own by then."""
        if not self.file.closed:
            try:
                os.remove(self.path)
            except OSError:
                pass  # it went with its folder
            self.file.close()
