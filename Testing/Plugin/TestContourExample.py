"""The example that makes a slope of contour lines runs and leaves its picture; what it prints is what the
page says: the largest error falls from 8 m to 1 m."""

import contextlib
import io
import os
import re
import runpy

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))

if os.path.exists("contours.png"):
    os.remove("contours.png")
said = io.StringIO()
with contextlib.redirect_stdout(said):
    runpy.run_path(os.path.join(ROOT, "Examples", "contours.py"))
errors = [float(e) for e in re.findall(r"largest error ([\d.]+) m", said.getvalue())]
print(said.getvalue())
if len(errors) != 2 or not 7.9 < errors[0] < 8.1 or not errors[1] < 1.1:
    raise SystemExit(f"the largest errors are {errors}")
if not os.path.getsize("contours.png") > 10000:
    raise SystemExit("there is no picture")
