"""Maps with hillshade, contours, legend, scale bar, north arrow and a frame with coordinates, at a round scale."""
import math

import numpy as np
from contourpy import contour_generator
from matplotlib.colors import BoundaryNorm, LightSource, ListedColormap, LogNorm, Normalize
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Polygon, Rectangle
from matplotlib.patheffects import withStroke
import matplotlib.pyplot as plt

import gis
from figures import GREY, INK, PAGE, new, picture, place

MOST = 1500  # cells across a picture
LEFT, RIGHT, TOP = 15.0, 5.0, 4.0  # mm beside the frame
BESIDE = 122.0  # mm from the left: legend and colours before it, scale bar and north arrow behind
LONGEST_BAR = 32.0  # mm
DOTS = 2.5  # mm from one to the next where too few rocks came
DOT = {"marker": "o", "ms": 1.5, "mfc": "white", "mec": INK, "mew": 0.35}
ROUND = (1.0, 1.25, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 7.5, 8.0, 10.0)
KEY = 11.0  # mm, what the legend takes under the colours
FOREST = 8.0  # m from stem to stem within the outline of a forest, at most so many
# Told from each other in grey by their strokes.
EMBANKMENT = {"color": "#7a4b12", "lw": 3.0}
NET = {"color": "#0b3d91", "lw": 1.6, "ls": (0, (2, 1))}
EDGE = {"color": "#1f5a26", "lw": 1.3, "ls": (0, (1, 1))}
LYING = {"color": "#6b3f1d", "lw": 1.2}


def nice(value, steps=(1.0, 2.0, 5.0, 10.0)):
    """The least of these steps times a power of ten that is not below a value."""
    power = 10.0 ** math.floor(math.log10(value))
    return next(step for step in steps if step * power >= value * (1.0 - 1e-9)) * power


def fewer(values, extent, most=MOST):
    """A raster of at most so many cells across, and its extent: of cells that come together the largest value, so
    that none is lost."""
    k = -(-max(values.shape) // most)
    if k <= 1:
        return values, extent
    rows, columns = (-(-size // k) for size in values.shape)
    whole = np.full((rows * k, columns * k), -np.inf)
    whole[:values.shape[0], :values.shape[1]] = np.where(np.isnan(values), -np.inf, values)
    largest = whole.reshape(rows, k, columns, k).max(axis=(1, 3))
    west, east, south, north = extent
    cell = k * (east - west) / values.shape[1]
    return np.where(np.isinf(largest), np.nan, largest), (west, west + cell * columns, north - cell * rows, north)


class Sheet:
    """A map of a part of the slope, at the largest round scale at which it fits a width and height in mm."""

    def __init__(self, slope, extent, highest, below, pale=False):
        west, east, south, north = extent
        widest = PAGE - LEFT - RIGHT
        self.scale = nice(max((east - west) / widest, (north - south) / highest) * 1000.0, ROUND)
        self.wide, self.high = ((d * 1000.0 / self.scale) for d in (east - west, north - south))
        self.below = below + 10.0
        self.figure = new(PAGE, self.high + self.below + TOP)
        self.left = LEFT + 0.5 * (widest - self.wide)
        self.axes = place(self.figure, self.left, self.below, self.wide, self.high)
        self.axes.set(xlim=(west, east), ylim=(south, north))
        self.slope, self.extent = slope, extent
        self.handles = []
        self.relief(pale)
        self.frame()

    def mm(self, length):
        """Metres of a length on paper."""
        return length * self.scale / 1000.0

    def relief(self, pale):
        """Hillshade and contours; pale where colours of cells are to be told from it in grey."""
        slope = self.slope
        step = max(1, -(-max(slope.heights.shape) // MOST))
        heights = slope.heights[::step, ::step]
        cell = slope.cell * step
        low, high = np.nanmin(heights), np.nanmax(heights)
        shade = LightSource(azdeg=315, altdeg=45).hillshade(np.where(np.isnan(heights), low, heights), dx=cell, dy=cell)
        shade[np.isnan(heights)] = np.nan
        west, north = slope.west - 0.5 * cell, slope.north + 0.5 * cell
        place_ = (west, west + cell * heights.shape[1], north - cell * heights.shape[0], north)
        self.axes.imshow(shade, extent=place_, cmap="gray", vmin=-9.0 if pale else -1.3, vmax=1.0, interpolation="bilinear", aspect="auto")
        self.interval = nice(max((high - low) / 18.0, 0.1), (1.0, 2.0, 2.5, 5.0, 10.0))
        x = slope.west + cell * np.arange(heights.shape[1])
        y = slope.north - cell * np.arange(heights.shape[0])
        levels = np.arange(math.ceil(low / self.interval), math.floor(high / self.interval) + 1) * self.interval
        if len(levels) and min(heights.shape) > 1:
            thick = [0.7 if round(level / self.interval) % 5 == 0 else 0.3 for level in levels]
            lines = self.axes.contour(x, y, heights, levels=levels, colors="#5c4a2e", linewidths=thick, zorder=3)
            self.axes.clabel(lines, [level for level, width in zip(levels, thick) if width > 0.5], fontsize=5.5, fmt="%g")
            self.handles.append(Line2D([], [], color="#5c4a2e", lw=0.7, label=f"contours, {self.interval:g} m"))

    def frame(self):
        axes = self.axes
        for axis, wide in ((axes.xaxis, self.wide), (axes.yaxis, self.high)):
            low, high = axes.get_xlim() if axis is axes.xaxis else axes.get_ylim()
            step = nice((high - low) / max(wide / 28.0, 1.5))
            axis.set_ticks(np.arange(math.ceil(low / step), math.floor(high / step) + 1) * step)
            axis.set_major_formatter(lambda v, _: f"{v:.0f}" if step >= 1 else f"{v:.1f}")
        axes.tick_params(direction="in", top=True, right=True, length=3)
        axes.tick_params(axis="x", pad=4)
        for label in axes.get_yticklabels():
            label.set(rotation=90, va="bottom" if label.get_position()[1] < axes.get_ylim()[0] + self.mm(8.0) else "center")
        axes.grid(color=INK, alpha=0.18, linewidth=0.3)
        self.scale_bar()

    def scale_bar(self):
        """With the north arrow, under the map, where they hide nothing."""
        axes = place(self.figure, BESIDE, 4.0, PAGE - BESIDE, 13.0)
        axes.set(xlim=(0.0, PAGE - BESIDE), ylim=(0.0, 13.0))
        axes.axis("off")
        length = nice(self.mm(LONGEST_BAR / 2.5))
        long = length * 1000.0 / self.scale
        for k in range(4):
            axes.add_patch(Rectangle((3.0 + 0.25 * k * long, 6.0), 0.25 * long, 1.2, fc=(INK, "white")[k % 2], ec=INK, lw=0.5))
        for at in (0.0, 0.5, 1.0):
            axes.text(3.0 + at * long, 5.2, f"{at * length:g}" + (" m" if at == 1.0 else ""), ha="center", va="top", fontsize=6)
        x, y = PAGE - BESIDE - 7.0, 1.0
        for side, colour in ((-1, INK), (1, "white")):
            axes.add_patch(Polygon([(x, y + 6.5), (x + side * 2.2, y), (x, y + 1.4)], closed=True, fc=colour, ec=INK, lw=0.5))
        axes.text(x, y + 7.0, "N", ha="center", va="bottom", fontsize=8, fontweight="bold")

    def mark(self, study, stems=True):
        """Structures and lines with their names, and releases. Without stems a forest is an outline."""
        slope, axes = study.slope, self.axes
        if len(slope.trees):
            places = slope.trees[:, 1:3] + slope.origin
            if stems:
                places = places[::-(-len(places) // 20000)]
                style = {"marker": "o", "mfc": "#cfe8cf", "mec": EDGE["color"]}
                axes.plot(*places.T, ls="", ms=1.6, mew=0.35, zorder=4, **style)
                self.handles.append(Line2D([], [], ls="", ms=2.5, mew=0.5, label="stems", **style))
            else:
                for edge in outlines(places, max(FOREST, self.mm(2.0))):
                    axes.plot(*edge.T, zorder=4, path_effects=cased(EDGE), **EDGE)
                self.handles.append(Line2D([], [], label="outline of the stems", **EDGE))
        for axis in slope.lying_axes:
            axes.plot(*axis.T, zorder=4, **LYING)
        if len(slope.lying_axes):
            self.handles.append(Line2D([], [], label="stems that lie", **LYING))
        for rows, stem, kind, label, style in (
                (slope.embankments, "TerrainEmbankment", "embankment", "embankment", EMBANKMENT),
                (slope.barriers, "TerrainBarrier", "net", "net or fence", NET)):
            names = slope.texts(stem + "Names") or [""] * len(rows)
            named = set()
            for line, row, name in zip(slope.axes_of(stem + "Points", rows[:, -1]), rows, names):
                axes.plot(*line.T, zorder=5, path_effects=cased(style), **style)
                if row[0] not in named:  # parts of one
                    self.name(line, name or f"{kind} {row[0]:.0f}", "bottom")
                named.add(row[0])
            if len(rows):
                self.handles.append(Line2D([], [], label=label, **style))
        names = [str(study.lines["LineName"][k]) for k in study.given_lines()] if study.drawn_lines else []
        for k, line in enumerate(study.drawn_lines):
            axes.plot(*line.T, color="white", lw=2.6, zorder=5)
            axes.plot(*line.T, color="black", lw=1.4, zorder=6)
            if len(names) == len(study.drawn_lines):
                self.name(line, names[k], "top")
        if study.drawn_lines:
            self.handles.append(Line2D([], [], color="black", lw=1.4, label="lines of passings"))
        first = study.rocks["Iteration"] == study.rocks["Iteration"].min()
        places = np.stack([study.rocks[name][first] for name in ("StartX", "StartY")])
        axes.plot(*places[:, ::-(-places.shape[1] // 5000)], "^", ms=3.2, mfc="white", mec="black", mew=0.6, zorder=7)
        self.handles.append(Line2D([], [], ls="", marker="^", ms=4, mfc="white", mec="black", mew=0.6, label="releases"))

    def name(self, line, text, side):
        """A name along the middle of what is seen of a line."""
        at = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))])
        x, y = (np.interp(np.linspace(0.0, at[-1], 201), at, values) for values in line.T)
        west, east, south, north = self.extent
        seen = np.flatnonzero((x > west) & (x < east) & (y > south) & (y < north))
        if not len(seen):
            return
        k = min(max(seen[len(seen) // 2], 1), 199)
        angle = (math.degrees(math.atan2(y[k + 1] - y[k - 1], x[k + 1] - x[k - 1])) + 89.0) % 180.0 - 89.0
        aside = (2.5 if side == "bottom" else -2.5) * np.array([-math.sin(math.radians(angle)), math.cos(math.radians(angle))])
        self.axes.annotate(text, (x[k], y[k]), aside, textcoords="offset points", rotation=angle, rotation_mode="anchor",
                           ha="center", va=side, fontsize=6.5, zorder=8, parse_math=False,
                           path_effects=[withStroke(linewidth=1.8, foreground="white")])

    def legend(self, bottom, more=(), columns=2):
        handles = [*self.handles, *more]
        box = place(self.figure, LEFT, 0.0, BESIDE - LEFT, bottom)
        box.axis("off")
        box.legend(handles=handles, loc="center left", ncol=columns, frameon=False, handlelength=1.8,
                   columnspacing=0.9, borderpad=0.0)

    def show(self, values, cell_extent, cmap, norm):
        values, cell_extent = fewer(values, cell_extent)
        axes = self.axes
        limits = axes.axis()
        image = axes.imshow(np.ma.masked_invalid(values), extent=cell_extent, cmap=cmap, norm=norm,
                            interpolation="nearest", aspect="auto", zorder=2)
        axes.axis(limits)
        return image

    def bar(self, image, label, ticks=None):
        axes = place(self.figure, LEFT, KEY + 11.0, BESIDE - LEFT - 4.0, 3.0)
        bar = self.figure.colorbar(image, cax=axes, orientation="horizontal", ticks=ticks)
        bar.set_label(label, labelpad=1)
        bar.outline.set_linewidth(0.5)
        if ticks is not None:
            axes.set_xticklabels([f"{t:g}" for t in ticks])
            axes.minorticks_off()


def cased(style):
    """With a white edge, for dark cells."""
    return [withStroke(linewidth=style["lw"] + 1.2, foreground="white")]


def outlines(places, step):
    """Lines around cells with a stem and those between them."""
    low = places.min(axis=0) - 2.5 * step
    columns, rows = (np.ceil((places.max(axis=0) - low) / step) + 3).astype(int)
    stems, _, _ = np.histogram2d(*((places - low) / step).T, bins=(columns, rows), range=((0, columns), (0, rows)))

    def spread(cells):
        beside = np.pad(cells, 1)
        return np.any([beside[i:i + columns, j:j + rows] for i in range(3) for j in range(3)], axis=0)

    inside = ~spread(~spread(stems > 0))
    middles = (low[k] + step * (np.arange(count) + 0.5) for k, count in enumerate((columns, rows)))
    return contour_generator(*middles, inside.T.astype(float)).lines(0.5)


def scale_text(sheet):
    """With thin spaces, as in tables."""
    return f"1 : {sheet.scale:,.0f}".replace(",", "\u2009")


def part(name, low=0.3):
    """A colour map without its palest colours, which vanish on the relief."""
    return ListedColormap(plt.get_cmap(name)(np.linspace(low, 1.0, 256)))


def around(raster, slope):
    """Where anything passed, with a margin, within the slope; not narrower than a third of its length."""
    rows, columns = np.nonzero(raster.data.GetRasterBand(raster.numbers["Rocks"]).ReadAsArray() > 0)
    if not len(rows):
        return slope.extent()
    west, _, _, north = raster.extent
    box = [west + raster.cell * columns.min(), west + raster.cell * (columns.max() + 1),
           north - raster.cell * (rows.max() + 1), north - raster.cell * rows.min()]
    size = max(box[1] - box[0], box[3] - box[2])
    for low, high in ((0, 1), (2, 3)):
        more = max(0.06 * size, 0.5 * (size / 3.0 - (box[high] - box[low])))
        box[low], box[high] = box[low] - more, box[high] + more
    limits = slope.extent()
    return max(box[0], limits[0]), min(box[1], limits[1]), max(box[2], limits[2]), min(box[3], limits[3])


def site(study, under):
    """The map sheet, with a line of text under it."""
    sheet = Sheet(study.slope, study.slope.extent(), 150.0, 17.0)
    sheet.mark(study)
    more = []
    if study.map:
        west, east, south, north = around(study.map, study.slope)
        if (east - west) * (north - south) < 0.8 * np.prod([study.slope.east - study.slope.west,
                                                           study.slope.north - study.slope.south]):
            sheet.axes.add_patch(Rectangle((west, south), east - west, north - south, fill=False, ec=GREY, lw=1.0, ls="--",
                                           zorder=6))
            more = [Patch(fc="none", ec=GREY, ls="--", label="extent of the maps below")]
    sheet.legend(20.0, more)
    sheet.figure.text(0.5, 0.0, under, fontsize=6.5, ha="center", va="bottom")
    return picture(sheet.figure, f"Site, {scale_text(sheet)} where this page is printed at 100 %. Grid north is up; relief "
                   "lit from the north-west.")


def too_few(sheet, raster, quantile):
    """Dots where too few rocks came for a quantile, which are seen on dark and light; whether there are any."""
    if "HighestQuantile" not in raster:
        return False
    highest = raster.band("HighestQuantile")
    rows, columns = np.nonzero(highest < quantile)
    if not len(rows):
        return False
    west, east, south, north = raster.extent
    x, y = west + raster.cell * (columns + 0.5), north - raster.cell * (rows + 0.5)
    # One in each square of some mm: of its cells the one next to its middle.
    step = sheet.mm(DOTS)
    column, row = np.floor((x - west) / step), np.floor((y - south) / step)
    order = np.argsort((x - west - (column + 0.5) * step) ** 2 + (y - south - (row + 0.5) * step) ** 2, kind="stable")
    _, first = np.unique((row * math.ceil((east - west) / step + 1.0) + column)[order], return_index=True)
    limits = sheet.axes.axis()
    sheet.axes.plot(x[order][first], y[order][first], ls="", zorder=3, **DOT)
    sheet.axes.axis(limits)
    return True


def powers(low, high):
    ticks = [m * 10.0 ** e for e in range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1) for m in (1, 3)]
    return [t for t in ticks if low * 0.999 <= t <= high * 1.001]


def of_band(study, name, values, label, text, norm, ticks, cmap, quantile=None):
    sheet = Sheet(study.slope, around(study.map, study.slope), 78.0, KEY + 17.0, pale=True)
    image = sheet.show(values, study.map.extent, part(cmap), norm)
    few = quantile and too_few(sheet, study.map, quantile)
    sheet.mark(study, stems=False)
    sheet.bar(image, label, ticks)
    sheet.legend(KEY, columns=3)
    if few:
        text += " Dotted: too few rocks came for this quantile, the number is too low."
    return picture(sheet.figure, f"{text} {scale_text(sheet)}.", name)


def classes(study, values, kinds, text, name, quantile=None):
    sheet = Sheet(study.slope, around(study.map, study.slope), 78.0, 17.0, pale=True)
    values = np.where(values > 0, values, np.nan)
    sheet.show(values, study.map.extent, ListedColormap([colour for _, colour, _ in kinds]),
               BoundaryNorm(np.arange(len(kinds) + 1) + 0.5, len(kinds)))
    few = quantile and too_few(sheet, study.map, quantile)
    sheet.mark(study, stems=False)
    sheet.legend(17.0, [Patch(fc=colour, ec=INK, lw=0.4, label=label) for _, colour, label in kinds] +
                 ([Line2D([], [], ls="", label="too few rocks for 95 %", **DOT)] if few else []), columns=3)
    return picture(sheet.figure, f"{text} {scale_text(sheet)}.", name)


def results(study):
    """Maps of all that hazard.tif has of what an office asks for."""
    raster, made = study.map, []
    reach = 100.0 * raster.band("ReachProbability")
    low = max(np.nanmin(np.where(reach > 0, reach, np.nan)), 1e-4)
    low = 10.0 ** math.floor(math.log10(low))
    made.append(of_band(study, "ReachProbability", reach, "% of the released rocks", "Reach probability, of one released "
                        "rock.", LogNorm(low, 100.0), powers(low, 100.0), "YlGnBu"))
    if "KineticEnergy95" in raster:
        energy = raster.band("KineticEnergy95") / 1000.0
        high = nice(max(np.nanmax(energy), 10.0))
        made.append(of_band(study, "KineticEnergy95", np.clip(energy, 1e-3, None), "kJ", "Kinetic energy, 95 % quantile, "
                            "of translation and rotation.", LogNorm(max(high / 1e3, 1e-3), high),
                            powers(max(high / 1e3, 1e-3), high), "YlOrRd", 95))
    if "HeightOverGround95" in raster:
        height = np.clip(raster.band("HeightOverGround95"), 0.0, None)
        made.append(of_band(study, "HeightOverGround95", height, "m", "Height of the lowest point of the rocks over ground, "
                            "95 % quantile.", Normalize(0.0, nice(max(np.nanmax(height), 0.1), (1, 2, 3, 5, 10))), None,
                            "PuRd", 95))
    if "AnnualFrequency" in raster:
        rate = raster.band("AnnualFrequency")
        rate = np.where(rate > 0, rate, np.nan)
        low, high = (10.0 ** edge for edge in (math.floor(math.log10(np.nanmin(rate))), math.ceil(math.log10(np.nanmax(rate)))))
        made.append(of_band(study, "AnnualFrequency", rate, "1/a", "Annual frequency of rocks.", LogNorm(low, high),
                            powers(low, high), "YlGnBu"))
    periods = gis.periods_of(raster.numbers)
    thresholds = gis.thresholds_of(raster.numbers) or sorted(set(study.given["map"].get("EnergyThresholds", (30.0, 300.0))))
    kinds = gis.intensities(thresholds)
    for years, name in periods:
        made.append(classes(study, raster.band(name), kinds, f"Intensity class of the scenario of {years:g} years.", name))
    if not periods and "KineticEnergy95" in raster:
        made.append(classes(study, np.where(np.isnan(energy), 0, 1 + np.digitize(energy, thresholds)), kinds,
                            "Classes of the 95 % energy. No frequency is in them: where one rock comes, it is of this class.",
                            "Classes", 95))
    return made
