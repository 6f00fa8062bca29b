"""What is seen first: the main job, Examples/jacksboro.py, as it is run without arguments but for the movie, and a
new study of its elevation file. Nothing walks on for minutes, speeds are those of field surveys, and the view says
which ground it is."""
# Renders

import os
import sys

import numpy as np
from helpers import rows_of, run_script
from paraview import servermanager
from paraview.simple import FindSource, GetActiveView, GetRepresentation, OutputPort, SaveData

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
SLOW = 1.5  # m/s

said, message = run_script(os.path.join(ROOT, "Examples", "jacksboro.py"), "--output", "out", "--frames", "0")
assert message is None, message
assert "ground: Soil (assumed)" in said, said
assert all(os.path.getsize(os.path.join("out", name)) > 10000 for name in ("overview.png", "map.png", "oblique.png"))

summary = rows_of("out/summary.csv")
assert len(summary) == 120 and {row["Fate"] for row in summary} <= {"rested", "left"}, summary
last = max(float(row["Time_s"]) for row in summary)
fast = np.percentile([float(row["MaxSpeed_m_s"]) for row in summary], 95)
data = np.genfromtxt("out/trajectories.csv", delimiter=",", skip_header=1, usecols=(0, 2, 6, 7, 8))
row, whole = 0.0, 0.0  # of the slowest rock, s
for block in np.unique(data[:, 0]):
    own = data[data[:, 0] == block]
    slow = np.linalg.norm(own[:, 2:], axis=1) < SLOW
    steps = np.diff(own[:, 1])
    whole = max(whole, steps[slow[1:]].sum())
    at = 0.0
    for step, walks in zip(steps, slow[1:]):
        at = at + step if walks else 0.0
        row = max(row, at)
print(f"last at rest {last:.1f} s, speed 95 % {fast:.1f} m/s, below {SLOW} m/s {row:.1f} s in a row, {whole:.1f} s in all")
assert last <= 90.0 and fast <= 30.0 and row <= 10.0 and whole <= 30.0

# --- Rockfall, New Study of an Elevation File.
sys.path.insert(0, os.path.join(ROOT, "Plugin", "window"))
import rockfall_study  # noqa: E402

study = rockfall_study.new_study(os.path.abspath("out/jacksboro.tif"))
SaveData("first.csv", proxy=OutputPort(study["fall"], 3), FieldAssociation="Row Data")
speeds = [float(row["MaxSpeed"]) for row in rows_of("first.csv")]
fast = np.percentile(speeds, 95)
print(f"first picture: speed of {len(speeds)} rocks, 95 % {fast:.1f} m/s")
assert len(speeds) == 200 and fast <= 30.0
words = FindSource("Ground")
assert GetRepresentation(words, GetActiveView()).Visibility
assert servermanager.Fetch(words).GetColumn(0).GetValue(0) == "Ground: Meadow (field data)"
