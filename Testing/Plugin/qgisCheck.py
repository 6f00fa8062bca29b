"""What QGIS makes of a finished study: every file opens with its own style, types, names and units, and a map of them
has the colours of the styles. Not run by the tests, as it takes QGIS (Debian: python3-qgis):

    QT_QPA_PLATFORM=offscreen /usr/bin/python3 Testing/Plugin/qgisCheck.py FOLDER [picture.png]
"""
import glob
import os
import sys

from qgis.core import (
    QgsApplication, QgsMapRendererParallelJob, QgsMapSettings, QgsRasterLayer, QgsVectorLayer, QgsWkbTypes)
from qgis.PyQt.QtCore import QSize
from qgis.PyQt.QtGui import QColor

folder = sys.argv[1]
application = QgsApplication([], False)
application.initQgis()

# The map: reach at first, each further style for the band of its name.
raster = QgsRasterLayer(os.path.join(folder, "hazard.tif"), "map")
assert raster.isValid() and raster.crs().isValid()
names = [raster.bandName(k + 1).split(": ")[-1].split(" (")[0] for k in range(raster.bandCount())]


def check_style(name):
    renderer = raster.renderer()
    band = renderer.band() if hasattr(renderer, "band") else renderer.inputBand()
    assert names[band - 1] == name, (name, names[band - 1])
    legend = [text for text, _ in renderer.legendSymbologyItems()]
    assert len(legend) >= 3, (name, legend)
    print(f"{name}: {renderer.type()}, {', '.join(legend)}")


check_style("ReachProbability")
styles = sorted(glob.glob(os.path.join(folder, "hazard-*.qml")))
assert len(styles) > 3, styles
for path in styles:
    message, good = raster.loadNamedStyle(path)
    assert good, (path, message)
    check_style(os.path.basename(path)[7:-4])
raster.loadNamedStyle(os.path.join(folder, "hazard.qml"))

# The tables: numbers are numbers, names have units, energies are there in kJ.
tables = sorted(glob.glob(os.path.join(folder, "*.csv")))
assert os.path.join(folder, "summary.csv") in tables
for path in tables:
    table = QgsVectorLayer(path, os.path.basename(path), "ogr")
    assert table.isValid(), path
    aliases = [table.attributeAlias(k) for k in range(table.fields().count())]
    texts = [field.name() for field in table.fields() if not field.isNumeric()]
    assert set(texts) <= {"Shape", "Fate", "SourceName", "LineName", "Class", "Kind", "Name"}, (path, texts)
    assert any(alias.endswith((" (J)", " (kJ)")) for alias in aliases), (path, aliases)
    for field in table.fields():
        if field.name().endswith("_kJ"):
            for feature in table.getFeatures():
                joules, kilojoules = feature[field.name()[:-3]], feature[field.name()]
                assert kilojoules == joules / 1000.0 or not joules, (path, field.name(), joules, kilojoules)
                break

layers = [raster]
path = os.path.join(folder, "crossings.csv")
if os.path.exists(path):
    points = QgsVectorLayer(path, "crossings", "ogr")
    assert points.geometryType() == QgsWkbTypes.PointGeometry and points.crs() == raster.crs(), points.crs().authid()
    renderer = points.renderer()
    assert renderer.type() == "graduatedSymbol", renderer.type()
    for feature in points.getFeatures():
        energy = feature["KineticEnergy"] / 1000.0
        assert any(one.lowerValue() <= energy <= one.upperValue() for one in renderer.ranges()), energy
    layers.insert(0, points)

settings = QgsMapSettings()
settings.setLayers(layers)
settings.setBackgroundColor(QColor("white"))
settings.setOutputSize(QSize(900, 600))
settings.setExtent(raster.extent())
settings.setDestinationCrs(raster.crs())
job = QgsMapRendererParallelJob(settings)
job.start()
job.waitForFinished()
image = job.renderedImage()
if len(sys.argv) > 2:
    image.save(sys.argv[2])
colours = {image.pixelColor(x, y).name() for x in range(0, 900, 7) for y in range(0, 600, 7)}
assert len(colours) > 4, colours
print(f"QGIS draws it, with {len(colours)} colours")
application.exitQgis()
