"""The Jacksboro fault, Tennessee (SRTM): a DEM that comes with matplotlib, as a GeoTIFF."""
import os

import numpy as np


def find_sample(name):
    """Path of a file of matplotlib's sample data (Debian: python-matplotlib-data)."""
    folders = ["/usr/share/matplotlib/mpl-data/sample_data", "/usr/share/matplotlib/sample_data"]
    try:
        import matplotlib
        folders.insert(0, os.path.join(matplotlib.get_data_path(), "sample_data"))
    except ImportError:
        pass
    for folder in folders:
        path = os.path.join(folder, name)
        if os.path.isfile(path):
            return path
    raise RuntimeError(f"{name} is not in {' or '.join(folders)}: install python-matplotlib-data.")


def write_geotiff(sample, path):
    """Writes the sample's elevations as a GeoTIFF in WGS 84 and returns (rows, columns, heights).

    Its bounds are the outer edges of the cells: they are as many cells apart as there are columns
    and rows (between centres it would be one less), and the centres then stand at whole multiples of
    3", as in SRTM. The file calls the northern bound ymin.
    """
    from PIL import Image, TiffImagePlugin  # comes with matplotlib
    data = np.load(sample)
    heights = data["elevation"]
    rows, columns = heights.shape
    west, east = sorted(float(data[k]) for k in ("xmin", "xmax"))
    south, north = sorted(float(data[k]) for k in ("ymin", "ymax"))
    dx, dy = float(data["dx"]), float(data["dy"])
    if abs((east - west) / dx - columns) > 0.01 or abs((north - south) / dy - rows) > 0.01:
        raise RuntimeError(f"{sample}: {columns} x {rows} cells of {dx} x {dy} degrees do not fill the "
                         f"bounds {west} to {east}, {south} to {north}.")
    tags = TiffImagePlugin.ImageFileDirectory_v2()
    for tag, kind, values in (
            (33550, 12, (dx, dy, 0.0)),                        # ModelPixelScale
            (33922, 12, (0.0, 0.0, 0.0, west, north, 0.0)),    # ModelTiepoint: the upper left corner
            (34735, 3, (1, 1, 0, 4,                            # GeoKeyDirectory with four keys:
                        1024, 0, 1, 2,                         # a geographic system,
                        1025, 0, 1, 1,                         # cells are areas,
                        2048, 0, 1, 4326,                      # WGS 84,
                        2054, 0, 1, 9102))):                   # in degrees
        tags.tagtype[tag] = kind
        tags[tag] = values
    # Float, because Pillow's 16-bit images are unsigned.
    Image.fromarray(heights.astype(np.float32), mode="F").save(
        path, format="TIFF", tiffinfo=tags, compression="tiff_deflate")
    return rows, columns, heights
