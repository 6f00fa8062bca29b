"""Programs of this folder and Examples/validation/impact_folds.py as they are called, on data made here.

    python3 programs.py CHANTSURA LONGSLOPES LUIMPACTS
"""
import os
import re
import subprocess
import sys

CHANT_SURA, LONG_SLOPES, LU_IMPACTS = sys.argv[1:]
ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
FOLDS = os.path.join(ROOT, "Examples", "validation", "impact_folds.py")


def said(*command):
    ran = subprocess.run(command, capture_output=True, text=True)
    assert ran.returncode == 0, (command, ran.stderr)
    return ran.stdout


def refused(words, *command):
    ran = subprocess.run(command, capture_output=True, text=True)
    assert ran.returncode == 1 and words in ran.stderr, (command, ran.returncode, ran.stderr)


def folds(*tables):
    return said(sys.executable, FOLDS, *tables)


# --- Two grounds, of which each is right on one track and wrong on the other: a track that is held out is
# foretold by the ground that is wrong on it. A choice that had seen it would do well.
RIGHT = "0.30 | 0.10 0.20 0.30 0.40 0.50 0.50  | 100 100 125 1.25 5.0 6.0 | 100% 0.10 0.10 0.10"
WRONG = "0.30 | 0.60 0.70 0.80 0.90 1.00 0.00* | 100 100 400 4.00 5.0 9.0 | 100% 0.10 0.10 0.10"
for name, rows in (("preset.txt", (RIGHT, WRONG)), ("other.txt", (WRONG, RIGHT)), ("short.txt", (RIGHT,))):
    with open(name, "w") as file:
        file.write("impact E1/E0\n" + "".join(f"{track}_impact_00 {row}\n" for track, row in zip("AB", rows)))
text = folds("preset.txt", "other.txt")
assert "A is foretold by other.txt" in text and "B is foretold by preset.txt" in text, text
# Pinball losses 0.014 where right, 0.204 where wrong.
assert ("held out: 0 of 2 within 5 to 95 %, rotational energy median 4.00 (4.00 to 4.00) of 2, pinball loss "
        "1.87 of that of preset.txt") in text, text
assert "preset.txt: 1 within 5 to 95 %, rotational energy median 2.62 (1.25 to 4.00)" in text, text
refused("two tables at least", sys.executable, FOLDS, "preset.txt")
refused("the tables have different impacts", sys.executable, FOLDS, "preset.txt", "short.txt")
refused("no impacts of chantSura", sys.executable, FOLDS, "preset.txt", FOLDS)

# --- What chantSura writes is what impact_folds.py reads. Level ground; energies that no impact leaves.
RADIUS = 0.27  # m
os.makedirs("impacts", exist_ok=True)
with open("impacts/terrain_rf16.asc", "w") as file:
    file.write("ncols 60\nnrows 60\nxllcorner 1000\nyllcorner 2000\ncellsize 0.1\n" + (" ".join(["100"] * 60) + "\n") * 60)
with open("impacts/observed_contact_events.csv", "w") as file:
    file.write("event_id,source_trajectory_id,source_segment_id,next_segment_id,x_m,y_m,z_m,incoming_vx_mps,incoming_vy_mps,"
               "incoming_vz_mps,pre_impact_kinetic_j,post_impact_kinetic_j,mass_kg,radius_m\n")
    for track, left in (("RF1", 2.4e3), ("RF2", 2.1e4)):
        file.write(f"{track}_impact_00,{track},{track}a,{track}b,1003,2003,{100 + RADIUS},7,0,-7,1e4,{left},210,{RADIUS}\n")
with open("impacts/observed_trajectories.csv", "w") as file:
    file.write("segment_id,omega_x_radps,omega_y_radps,omega_z_radps,rotational_j\n")
    for track in ("RF1", "RF2"):
        file.write(f"{track}a,0,5,0,80\n{track}b,0,20,0,1200\n{track}b,0,20,0,1200\n")
for name, compaction in (("soft.txt", "1.5"), ("firm.txt", "0.45")):
    with open(name, "w") as file:
        file.write(said(CHANT_SURA, "impacts", "--iterations", "20", "--set", f"ScarCompaction={compaction}"))
text = open("firm.txt").read()
inside = int(re.search(r"^(\d) of 2 inside", text, re.M).group(1))
# Of one what the impacts leave, of the other more than came.
assert re.search(r"^RF1_impact_00 +0\.24 \|.* 0\.\d\d  \|", text, re.M), text
assert re.search(r"^RF2_impact_00 +2\.10 \|.* 1\.00\* \|", text, re.M) and inside == 1, text
assert f"firm.txt: {inside} within 5 to 95 %" in folds("firm.txt", "soft.txt"), (text, folds("firm.txt", "soft.txt"))
refused('no parameter "Stickiness"', CHANT_SURA, "impacts", "--set", "Stickiness=1")

# --- longSlopes: a row for each fall, and the ratio of the last two run-outs.
for more in ((), ("--mix", "--meadow", "--ground", "soil")):
    text = said(LONG_SLOPES, "--iterations", "2", "--set", "endTime=60", *more)
    rows = [[float(v) for v in re.findall(r"[\d.]+", line)] for line in text.splitlines()[1:5]]
    assert [row[:3] for row in rows] == [[35, 258, 1], [40, 150, 1], [35, 100, 0.1], [35, 100, 10]], text
    for row in rows:
        slope, drop, _, speed, jump, runout, reach, farthest, last = row
        assert 5 < speed < 80 and 0 < jump < 50 and runout > 5 and 20 < farthest <= reach < 60 and last > 5, row
    ratio = float(text.split()[-1])  # of run-outs that are printed to a decimetre
    assert abs(ratio * rows[2][5] - rows[3][5]) < 0.05 * (1 + ratio) + 5e-4 * rows[2][5], text
text = said(LONG_SLOPES, "--iterations", "2", "--set", "endTime=30", "--jumps")
rows = [[float(v) for v in re.findall(r"[\d.]+", line)] for line in text.splitlines()[1:]]
assert [row[0] for row in rows] == [0.1, 1, 10, 100] and all(abs(r[3] - r[1] / r[2]) < 2e-3 for r in rows), text
refused("not understood", LONG_SLOPES, "impacts")

# --- luImpacts: the wheel digs deeper in ground that is softer.
def depths(factor):
    text = said(LU_IMPACTS, "--iterations", "20", "--set", f"ScarDepthFactor={factor}")
    return [float(v) for v in re.findall(r"\d+\.\d+", text)]


assert len(depths(0.125)) == len(depths(0.2)) and depths(0.125) != depths(0.2)
