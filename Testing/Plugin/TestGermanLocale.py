# Locale
"""Under de_DE.UTF-8, where 3,5 is three and a half, slope, structures and rocks are read from the same files as
the same numbers, the motion has the same bits, and what is written has decimal points."""

import locale

from helpers import columns_of, errors_of, write_text

from paraview import servermanager
from paraview.simple import DEMtoCFEMesh, Delete, OutputPort, RockBlocks, RockfallSimulation, SaveData, \
    UpdatePipeline

layers = {
    "EmbankmentFile": write_text("dam.csv", "WKT,height,width,slope,phi\n"
                                            '"LINESTRING(106.25 5.5,104.75 43.25)",3.25,1.5,3:2,35.5\n'),
    "TreeFile": write_text("trees.geojson", '{"type":"FeatureCollection","features":[' + ",".join(
        '{"type":"Feature","geometry":{"type":"Point","coordinates":[%.2f,%.2f]},"properties":'
        '{"diameter":32.5,"height":"21.5"}}' % (40.25 + 5 * k, 48.75 + k) for k in range(5)) + "]}"),
    "BarrierFile": write_text("net.csv", "WKT,height,capacity\n"
                                         '"LINESTRING(97.75 43.5,98.25 90.75)",4.5,1000.5\n'),
    "RestitutionLayer": write_text("zones.csv", 'WKT,class\n"POLYGON((0 0,60.5 0,60.5 100,0 100,0 0))",rock\n'),
    "RestitutionTable": write_text("table.csv", "class,rv,rv_deviation\nrock,0.85,0.05\n"),
}
sources = write_text("sources.csv", "x,y,z,volume,shape\n" + "".join(
    f"5.5,{10.25 + 9 * k},60.75,0.75,cube\n" for k in range(9)))
commas = write_text("commas.csv", "x,y,diameter,height\n50.5,50.5,\"32,5\",21.5\n")


def run(name):
    """All results as texts: arrays with all digits, and the files."""
    slope = DEMtoCFEMesh(RoughnessDeviation=0.1, TreesBreak=1, **layers)
    rocks = RockBlocks(FileName=sources, Terrain=slope)
    fall = RockfallSimulation(Terrain=slope, Rocks=rocks, EndTime=20, Iterations=2)
    UpdatePipeline(proxy=fall)
    texts = [repr(columns_of(servermanager.Fetch(fall, idx=3)))]
    met = servermanager.Fetch(fall, idx=4)
    assert met.GetNumberOfPoints() > 3, met.GetNumberOfPoints()
    texts.append(repr([met.GetPoint(k) for k in range(met.GetNumberOfPoints())]))
    for file, proxy in ((name + ".csv", OutputPort(fall, 3)), (name + "-met.csv", OutputPort(fall, 4)),
                        (name + "-paths.csv", OutputPort(fall, 1))):
        SaveData(file, proxy=proxy)
        with open(file) as written:
            texts.append(written.read())
    bad = DEMtoCFEMesh(TreeFile=commas)
    texts.append(repr(errors_of(bad)))
    assert '"diameter"' in texts[-1] and "32,5" in texts[-1], texts[-1]
    for proxy in (fall, rocks, slope, bad):
        Delete(proxy)
    return texts


plain = run("plain")
locale.setlocale(locale.LC_ALL, "de_DE.UTF-8")
assert locale.localeconv()["decimal_point"] == ","
german = run("german")
locale.setlocale(locale.LC_ALL, "C")
for k, (a, b) in enumerate(zip(plain, german)):
    # Names of objects in messages have addresses.
    assert a == b or k == len(plain) - 1, f"result {k} differs:\n{a[:400]}\n{b[:400]}"
print("a decimal comma changes nothing")
