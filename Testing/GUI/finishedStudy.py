"""A finished batch study for the tests of the window: pvbatch finishedStudy.py folder, beside hill.asc of makeData.py."""
import json
import os
import runpy
import sys

folder = os.path.abspath(sys.argv[1])
beside = os.path.dirname(folder)
report = os.path.join(folder, "report.html")
if os.path.exists(report):
    os.remove(report)  # of the last time
with open(os.path.join(beside, "study.csv"), "w") as file:
    file.write("x,y,z,shape,volume\n2600300,1200450,1240,cube,1\n")
with open(os.path.join(beside, "study.json"), "w") as file:
    json.dump({"terrain": {"FileName": "hill.asc", "Preset": "Meadow (field data)"}, "rocks": {"FileName": "study.csv"},
               "simulation": {"EndTime": 5, "TrajectoryOutput": "Thinned"}, "map": {}, "iterations": 2, "chunk": 2}, file)
script = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "Examples", "study.py")
sys.argv = [script, folder, os.path.join(beside, "study.json")]
runpy.run_path(script, run_name="__main__")
