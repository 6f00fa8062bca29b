"""What a GIS wants beside the tables and the map of a study: types of columns (.csvt), the CRS (.prj), and styles of
QGIS (.qml) that name units and show energies in kJ. Classes are the same in all studies, so that maps compare."""
import itertools
import os
import re
from xml.sax.saxutils import quoteattr

from wholefile import write_csv, write_text

# The first that a column's name begins with, or is.
UNITS = tuple((re.compile(pattern), unit) for pattern, unit in (
    (r"EnergyLineAngle", "°"), (r"Energy(InKilojoules|Maximum$)|Design(Energy|Mass)InKilo|(Maximum|Service)EnergyLevel|BarrierCapacity", "kJ"),
    (r"(Max)?KineticEnergy|(Trans|Rot)\w*Energy|Energy|LastingLoss", "J"),
    (r"(Max)?Speed|Velocity", "m/s"), (r"RotationRate", "rad/s"), (r"(Horizontal|Vertical)Angle", "°"),
    (r"\w*Height|Width|Distance|Offset|RunOut|PathLength|(Start|Stop)?[XYZ]$", "m"), (r"(End)?Time$", "s"), (r"Mass$", "kg"),
    (r"Volume$", "m³"), (r"\w*Frequency", "1/a"), (r"ReturnPeriod", "a"), (r"(Highest)?Quantile$", "%")))
REACH = ("#e6f5c9", "#a8ddb5", "#7bccc4", "#43a2ca", "#0868ac", "#08306b")
ENERGY = ("#ffffb2", "#fed976", "#feb24c", "#fd8d3c", "#f03b20", "#bd0026", "#67000d")
HEIGHT = ("#f1eef6", "#d4b9da", "#c994c7", "#df65b0", "#dd1c77", "#980043", "#4d0021")
# Bands of the map: breaks, factor to what a person reads, unit, colours from light to dark.
RASTERS = tuple((re.compile(pattern), *rest) for pattern, *rest in (
    (r"ReachProbability$|ExceedanceProbability", (0.001, 0.01, 0.05, 0.1, 0.3, 1.0), 100.0, "%", REACH),
    (r"KineticEnergy", (1e4, 3e4, 1e5, 3e5, 1e6, 3e6, 1e12), 1e-3, "kJ", ENERGY),
    (r"HeightOverGround", (0.5, 1.0, 2.0, 3.0, 5.0, 10.0, 1e6), 1.0, "m", HEIGHT),
    (r"Speed", (5.0, 10.0, 15.0, 20.0, 30.0, 40.0, 1e6), 1.0, "m/s", ENERGY),
    (r"EnergyLineAngle", (25.0, 27.0, 30.0, 33.0, 36.0, 40.0, 90.0), 1.0, "°", HEIGHT[::-1]),
    (r"AnnualFrequency", (1e-5, 1e-4, 1e-3, 1e-2, 0.1, 1e6), 1.0, "1/a", REACH),
    (r"ReturnPeriod", (10.0, 30.0, 100.0, 300.0, 1000.0, 1e9), 1.0, "a", REACH[::-1])))
INTENSITY = ("#f0c419", "#e08a2e", "#8b0a1a")  # from weak to strong, of Intensity…
HEAD = "<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>\n"


def unit_of(name):
    return next((unit for pattern, unit in UNITS if pattern.match(name)), "")


def words(name):
    """The words of a name, with its unit: KineticEnergy95 is "Kinetic energy 95 (J)"."""
    text = re.sub(r"(?<=[a-z])(?=[A-Z0-9])|(?<=\d)(?=[A-Za-z])", " ", name.replace("InKilojoules", ""))
    text = text[:1] + text[1:].lower() if not text.isupper() else text
    unit = unit_of(name)
    return text + (f" ({unit})" if unit else "")


def type_of(name, column, places):
    """As a .csvt has it."""
    if name in places:
        return places[name]
    kind = column.dtype
    return {"i": "Integer64" if kind.itemsize > 4 else "Integer", "u": "Integer", "f": "Real"}.get(kind.kind, "String")


def labels_of(breaks, factor, unit):
    last = breaks[-1] >= 1e6
    bounds = [f"{factor * edge:g}" for edge in breaks]
    made = [f"{low} to {high} {unit}" for low, high in zip(bounds, bounds[1:])]
    if last:
        made[-1] = f"above {bounds[-2]} {unit}"
    return [f"up to {bounds[0]} {unit}", *made]


def thresholds_of(bands):
    """Energies between the classes of a map with these bands, ascending, kJ."""
    return sorted(float(name[21:-2]) for name in bands if name.startswith("ExceedanceProbability"))


def periods_of(bands):
    """Return periods with a class of intensity, ascending, a, and the names of their bands."""
    return sorted((float(name[9:-1]), name) for name in bands if name.startswith("Intensity"))


def intensities(thresholds):
    """Value, colour and label of each class between ascending thresholds, kJ."""
    edges = [f"{one:g}" for one in thresholds]
    labels = [f"below {edges[0]} kJ", *(f"{a} to {b} kJ" for a, b in zip(edges, edges[1:])), f"above {edges[-1]} kJ"] if edges else \
        ["of any energy"]
    if len(labels) == len(INTENSITY):
        labels = [f"{word}, {label}" for word, label in zip(("weak", "medium", "strong"), labels)]
    ramp = [[int(colour[k:k + 2], 16) for k in (1, 3, 5)] for colour in INTENSITY]
    made = []
    for k, label in enumerate(labels):
        at = k / max(1, len(labels) - 1) * (len(ramp) - 1)
        low = min(int(at), len(ramp) - 2)
        mixed = (round(a + (at - low) * (b - a)) for a, b in zip(ramp[low], ramp[low + 1]))
        made.append((k + 1, "#" + "".join(f"{part:02x}" for part in mixed), label))
    return made


def raster_style(name, band, thresholds=(30.0, 300.0)):
    """The style of one band, or None for those without one."""
    if name.startswith("Intensity"):
        entries = "".join(f'<paletteEntry value="{value}" alpha="255" color="{colour}" label={quoteattr(label)}/>'
                          for value, colour, label in intensities(thresholds))
        renderer = (f'<rasterrenderer type="paletted" band="{band}" opacity="0.8" alphaBand="-1" nodataColor="">'
                    f"<rasterTransparency/><colorPalette>{entries}</colorPalette></rasterrenderer>")
    else:
        found = next((rest for pattern, *rest in RASTERS if pattern.match(name)), None)
        if not found:
            return None
        breaks, factor, unit, colours = found
        # Where nothing came there is no colour: shares are 0 there, all else is nodata.
        items = ['<item value="0" alpha="0" color="#ffffff" label="none"/>'] if breaks[-1] <= 1.0 or unit == "1/a" else []
        items += [f'<item value="{"inf" if edge >= 1e6 else repr(edge)}" alpha="255" color="{colour}" label={quoteattr(label)}/>'
                  for edge, colour, label in zip(breaks, colours, labels_of(breaks, factor, unit))]
        renderer = (f'<rasterrenderer type="singlebandpseudocolor" band="{band}" opacity="0.8" alphaBand="-1" nodataColor="" '
                    f'classificationMin="0" classificationMax="{breaks[-1]!r}"><rasterTransparency/><rastershader>'
                    f'<colorrampshader colorRampType="DISCRETE" classificationMode="1" clip="0" minimumValue="0" '
                    f'maximumValue="{breaks[-1]!r}" labelPrecision="4">{"".join(items)}</colorrampshader></rastershader>'
                    "</rasterrenderer>")
    return (HEAD + '<qgis version="3.22" hasScaleBasedVisibilityFlag="0" styleCategories="Symbology">\n<pipe>' + renderer +
            '<brightnesscontrast brightness="0" contrast="0" gamma="1"/><huesaturation colorizeOn="0" saturation="0"/>'
            "</pipe>\n<blendMode>0</blendMode>\n</qgis>\n")


def symbol(name, colour):
    return (f'<symbol name="{name}" type="marker" alpha="1" clip_to_extent="1" force_rhr="0"><layer class="SimpleMarker" '
            f'enabled="1" locked="0" pass="0"><prop k="color" v="{rgb(colour)}"/><prop k="name" v="circle"/>'
            '<prop k="outline_color" v="35,35,35,255"/><prop k="outline_width" v="0.2"/><prop k="size" v="2"/>'
            '<prop k="size_unit" v="MM"/></layer></symbol>')


def rgb(colour):
    return ",".join(str(int(colour[k:k + 2], 16)) for k in (1, 3, 5)) + ",255"


def table_style(names, by=None):
    """Aliases with units, energies in kJ as further columns, and for points classes of a column."""
    aliases = "".join(f'<alias field={quoteattr(name)} index="{k}" name={quoteattr(words(name))}/>'
                      for k, name in enumerate(names))
    energies = [name for name in names if unit_of(name) == "J"]
    more = "".join(f'<field name={quoteattr(name + "_kJ")} type="6" typeName="double precision" subType="0" length="0" '
                   f'precision="0" comment="" expression={quoteattr(chr(34) + name + chr(34) + " / 1000")}/>'
                   for name in energies)
    renderer = '<renderer-v2 type="nullSymbol" symbollevels="0" enableorderby="0" forceraster="0"/>'
    if by:
        breaks, factor, unit, colours = next(rest for pattern, *rest in RASTERS if pattern.match(by))
        edges = [0.0, *(factor * edge for edge in breaks)]
        ranges = "".join(f'<range lower="{low!r}" upper="{high!r}" symbol="{k}" render="true" label={quoteattr(label)}/>'
                         for k, (low, high, label) in enumerate(zip(edges, edges[1:], labels_of(breaks, factor, unit))))
        symbols = "".join(symbol(k, colour) for k, colour in enumerate(colours))
        renderer = (f'<renderer-v2 type="graduatedSymbol" graduatedMethod="GraduatedColor" symbollevels="0" enableorderby="0" '
                    f'forceraster="0" attr={quoteattr(f"{chr(34)}{by}{chr(34)} * {factor!r}")}><ranges>{ranges}</ranges>'
                    f"<symbols>{symbols}</symbols></renderer-v2>")
    return (HEAD + '<qgis version="3.22" hasScaleBasedVisibilityFlag="0" styleCategories="AllStyleCategories">\n' +
            f"{renderer}\n<aliases>{aliases}</aliases>\n<expressionfields>{more}</expressionfields>\n</qgis>\n")


def write_table(path, tables, crs=None, by=None):
    """Tables of the same columns as one, with what belongs to it; with a CRS its columns X and Y are places,
    coloured `by` a column."""
    stem = os.path.splitext(path)[0]
    places = {"X": "CoordX", "Y": "CoordY"} if by else {}
    tables = iter(tables)
    first = next(tables)
    write_csv(path, itertools.chain([first], tables))
    write_text(stem + ".csvt", ",".join(f'"{type_of(name, column, places)}"' for name, column in first.items()) + "\n")
    write_text(stem + ".qml", table_style(list(first), by))
    if crs:
        write_text(stem + ".prj", crs)


def write_map_styles(path, names):
    """Of a map with these bands: what opens with it, its reach, and a style for every other band that has one."""
    stem = os.path.splitext(path)[0]
    for band, name in enumerate(names, 1):
        style = raster_style(name, band, thresholds_of(names))
        if style and not name.endswith("Error"):
            write_text(stem + (".qml" if name == "ReachProbability" else f"-{name}.qml"), style)
