"""Figures as pictures in a page: PNG in data URIs, with the size in mm at which they are to be printed."""
import base64
import io

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

MM = 1.0 / 25.4  # inches
DPI = 200
INK, GREY = "#222222", "#777777"
PAGE = 174.0  # mm, what A4 has between its margins
# Lines that differ in grey, too.
STYLES = (("#1b4f91", "-"), ("#c8502d", "--"), ("#2b7a3d", ":"), ("#6a3d9a", "-."), ("#222222", (0, (5, 1, 1, 1, 1, 1))))

plt.rcParams.update({
    "font.size": 8, "axes.titlesize": 8, "axes.labelsize": 8, "xtick.labelsize": 7, "ytick.labelsize": 7,
    "legend.fontsize": 7, "axes.edgecolor": INK, "axes.linewidth": 0.6})


def new(width, height):
    """A figure of this size in mm."""
    return plt.figure(figsize=(width * MM, height * MM))


def place(figure, left, bottom, width, height):
    """Axes at these mm of the figure."""
    wide, high = (size / MM for size in figure.get_size_inches())
    return figure.add_axes((left / wide, bottom / high, width / wide, height / high))


def picture(figure, text, alt=""):
    """What the page takes of a figure, which is closed."""
    data = io.BytesIO()
    figure.savefig(data, dpi=DPI, format="png")
    width = figure.get_size_inches()[0] / MM
    plt.close(figure)
    return {"uri": "data:image/png;base64," + base64.b64encode(data.getvalue()).decode(), "width": round(width, 1),
            "text": text, "alt": alt or text}
