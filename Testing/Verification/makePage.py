"""Runs the verification programs and makes of their results docs/data/verification.csv, with every figure,
docs/verification.md, with the worst of each claim, and the pictures.

    makePage.py --results FOLDER --form full|reduced [--docs FOLDER] [--run PROGRAM ...]
    makePage.py --docs FOLDER          the page anew, of the figures in docs/data/verification.csv

Every number on the page comes from the lines of JSON that the programs write; the words beside them are here and
in the programs. A program that fails or hangs does not keep the page from being made: it is on the page.
"""

import argparse
import collections
import csv
import datetime
import json
import math
import os
import pathlib
import re
import subprocess
import sys

GUARD = 4 * 3600  # s, of one program in the full form
COLUMNS = ["case", "test", "quantity", "value", "unit", "kind", "expected", "tolerance", "passed", "reason"]

# Claim, case as the programs name it, quantities that show it (a pattern), picture. In the order of the page.
# A claim may stand for several figures: the page shows the one that is nearest to its bar.
CLAIMS = [
    ("A block in flight is on its parabola, whatever Δt (relative error).", "Projectile with spin", "relative error", None),
    ("Free rotation keeps angular momentum (relative change).", "Torque-free rotation", "angular momentum", None),
    ("… and energy (relative change).", "Torque-free rotation", "energy", None),
    ("… and does not swell (METHOD 10.3).", "Torque-free rotation", "volume", None),
    ("A turning plate has the attitude of the closed form.", "Torque-free rotation", "attitude", None),
    ("A box flips about its middle axis on time.", "Torque-free rotation", "period of two flips", "flips"),
    ("An elastic rebound has the speed of its fall, whatever Δt and penalty (METHOD 9.1).", "Elastic rebound",
     "least ratio|mean ratio at E 1e11", "rebound"),
    ("No rebound makes energy (ratio of speeds).", "Elastic rebound", "greatest ratio", None),
    ("CFEs give the velocity history of a slope of blocks (share of the speed).", "Elastic rebound", "slope as block",
     "velocity-history"),
    ("Elastic drops of any shape in any attitude keep energy (share of the fall).", "Elastic drop in any attitude",
     "change of mechanical energy", None),
    ("… and, on planes, angular momentum.", "Elastic drop in any attitude", "change of angular momentum", None),
    ("A bounce keeps Rv² of the height.", "Restitution", "first bounce", "restitution"),
    ("Sliding and rolling are no impacts.", "Restitution", "way until it rests|way over that", None),
    ("Sliding follows ½ (g sin α − g cos α tan φ) t² in every direction (METHOD 9.2).", "Sliding", "error of the way",
     "sliding"),
    ("Below the friction angle nothing creeps.", "Sliding", "drift", None),
    ("A block slides, topples or stands by the closed forms.", "Slide or topple", ".", "topple-map"),
    ("A rocking block has Housner's (1963) quarter period.", "Rocking block", "first impact$", "rocking"),
    ("A round body rolls with 5/7 g sin α.", "Rolling", "acceleration", "rolling"),
    ("A ball that is pushed off slips, then rolls with 5/7 v₀.", "Rolling", "speed over v₀", "slip-to-roll"),
    ("Rolling resistance stops it at Azzoni's distance.", "Rolling", "distance to rest", None),
    ("A ball that lands obliquely sticks or slides by the closed form.", "Oblique impact of a ball", "error of v_t|v_n'/e",
     "oblique"),
    ("The finest Δt and the stiffest penalty give the known answer (relative error).", "Convergence", "relative error at",
     "convergence-Δt"),
    ("… and errors do not grow on the way there (last over first).", "Convergence", "over that at the first", "convergence-penalty"),
    ("No shot at jagged ground goes through.", "Tunnelling", "under the surface$|number that is none", None),
    ("One triangle and thousands are one plane.", "Internal edges", ".", None),
    ("The search looks at as many CFEs on 10⁶ cells as on 100.", "CFE search", "CFEs looked at", "search"),
    ("Run-outs are those of the ground, not of its cells (largest over smallest).", "Roughness and cells",
     "largest over smallest", None),
    ("Every joule is booked (remainder of what is released).", "Energy audit", "remainder", None),
    ("Columns, walls and arches stand.", "Piles that stand", "drift", None),
    ("… and the floor carries their weight.", "Piles that stand", "weight", None),
    ("Heaps of 1000 cubes overlap by less than 1 % of an edge.", "Heaps", "deepest overlap", "heap-repose"),
    ("… and all come to rest.", "Heaps", "at rest", None),
    ("Random scenes of many rocks make and lose no energy.", "Random scenes", "energy made|energy lost", None),
    ("… and have the same bits on one thread and two.", "Random scenes", "differ", None),
    ("Those of round rocks make and lose none.", "Random scenes of round rocks", "energy made|energy lost", None),
    ("Rocks on long slopes of talus are as fast as field surveys say.", "Long slopes", "speed, 95 %", None),
    ("… jump as high,", "Long slopes", "height over ground", None),
    ("… and get as far (reach angle).", "Long slopes", "reach angle, 5 %", None),
    ("Talus sorts: large blocks go farther (run-out of 10 m³ over that of 0.1 m³).", "Long slopes", "run-out of", None),
    ("Bare rock brakes no more than talus (ratio of speeds).", "Long slopes", "bedrock with boulders over", None),
    ("Nothing creeps on a meadow.", "Long slopes", "meadow at|rest", None),
    ("Unreasonable input ends with numbers, above the ground.", "Robustness", "number that is none|under the ground", None),
    ("… and makes no energy (share of that released).", "Robustness", "energy made", None),
]

# What cannot be claimed: case, quantities that show it, words.
NOT_SHOWN = [
    ("Shape test", "mean θ of 10 cubes over", "The paper's cubes spread twice as wide as its icosahedra (METHOD 9.3). Here cubes "
     "that lie on a face slide, keep to the fall line and spread less; they spread wider where friction or release make them "
     "tumble. θ is a range over ten paths."),
    ("Rolling", "speed after 4 s", "Beyond √(g r) a polyhedron hops from vertex to vertex; speed over that of a sphere."),
    ("Slope as blocks", "128 CFEs: time per step, slope as blocks", "What a step costs if the slope is fixed blocks, as before "
     "CFEs; for comparison only."),
]

PICTURES = {
    "flips": ("Torque-free rotation of a box of 2.5 × 3 × 1 m", "time, s", "spin about x, rad/s", {}),
    "velocity-history": ("Paper fig. 12: elastic rebound, drop of 2 m", "time, s", "vertical velocity, m/s", {}),
    "rebound": ("Paper fig. 13: rebound by modulus and penalty", "", "", {}),
    "block-cost": ("Cost of a step", "CFEs of the slope", "time per step, µs", {"x": "log", "y": "log", "marks": 1}),
    "restitution": ("Drop of 5 m", "time, s", "height over the floor, m", {}),
    "sliding": ("Paper fig. 14: sliding on 30°", "time, s", "way, m", {}),
    "topple-map": ("Block on an incline, φ 25°", "slope α, °", "b/h", {"scatter": True}),
    "rocking": ("Rocking block, 0.25 × 1 m, from α/2", "time, s", "tilt, °", {}),
    "rolling": ("Ball on 30°, Rv 0.8, φ 45°", "time, s", "speed, m/s", {}),
    "slip-to-roll": ("Ball pushed off at 2 m/s, φ 20°", "time, s", "m/s", {}),
    "ball": ("How round is round", "faces", "relative error of v = 5/7 v₀", {"x": "log", "y": "log", "marks": 1}),
    "oblique": ("Oblique impact of a ball, μ 0.364", "v_t / v_n", "v_t' / v_t", {}),
    "convergence-Δt": ("Convergence in the time step", "Δt, s", "relative error", {"x": "log", "y": "log", "marks": 1}),
    "convergence-penalty": ("Convergence in the penalty", "penalty, N/m", "relative error", {"x": "log", "y": "log",
                                                                                          "marks": True}),
    "heap-repose": ("Heaps of cubes of 0.6 m³", "friction angle, °", "slope of the heap, °", {"marks": 1}),
    "search": ("Search for contacts", "cells of the slope", "time per call, µs", {"x": "log", "y": "log", "marks": 1}),
    "theta": ("Dispersion angle of 10 iterations", "θ, °", "share of draws below", {}),
}


def file_of(name):
    return name.replace("Δ", "d") + ".png"


def read(folder):
    """All lines of all tests, and what became of each test."""
    lines, tests = [], {}
    for path in sorted(folder.glob("*.jsonl")):
        name = path.name[: -len(".jsonl")]
        ending = None
        for text in path.read_text(encoding="utf-8").splitlines():
            try:
                line = json.loads(text)
            except ValueError:
                continue  # cut off in the middle
            if line["kind"] == "end":
                ending = line
            elif line["kind"] != "begin":
                line["test"] = name
                lines.append(line)
        tests[name] = ending
    return lines, tests


def number(value):
    if value is None:
        return "none"
    if value == 0:
        return "0"
    if value == int(value) and abs(value) < 1e7:
        return f"{int(value):,}"
    size = abs(value)
    if 1e-3 <= size < 1e5:
        digits = max(0, 4 - int(math.floor(math.log10(size))) - 1)
        return f"{value:.{digits}f}".rstrip("0").rstrip(".") if size < 1e4 else f"{value:.0f}"
    return f"{value:.2e}"


def bar(line):
    kind = line["kind"]
    if kind == "within":
        return f"{number(line['expected'])} ± {number(line['tolerance'])}"
    if kind == "atMost":
        return f"≤ {number(line['expected'])}"
    if kind == "atLeast":
        return f"≥ {number(line['expected'])}"
    return f"({number(line['expected'])})" if line["expected"] is not None else ""


def cell(text):
    return text.replace("|", "\\|").replace("\n", " ")


def nearness(line):
    """How near a figure is to its bar: 1 is on it, more is beyond."""
    value, expected = line["value"], line["expected"]
    if value is None:
        return math.inf
    if line["kind"] == "within":
        return abs(value - expected) / line["tolerance"] if line["tolerance"] else (0.0 if value == expected else math.inf)
    if line["kind"] == "atMost":
        return value / expected if expected else (0.0 if value <= 0.0 else math.inf)
    return expected / value if value else math.inf


def figure(line):
    unit = f" {line['unit']}" if line["unit"] else ""
    return number(line["value"]) + unit


def draw(curves, folder):
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    plt.rcParams.update({"font.size": 8, "axes.grid": True, "grid.alpha": 0.3, "lines.linewidth": 1.1,
                         "legend.fontsize": 6.5, "savefig.dpi": 100, "figure.constrained_layout.use": True})
    by_plot = collections.defaultdict(list)
    for curve in curves:
        by_plot[curve["plot"]].append(curve)
    made = []

    def save(figure, name):
        figure.savefig(folder / file_of(name), metadata={"Software": None})
        plt.close(figure)
        made.append(name)

    def clean(values):
        return [math.nan if v is None else v for v in values]

    for name, (title, x_label, y_label, options) in PICTURES.items():
        if name not in by_plot:
            continue
        if name == "rebound":
            draw_rebound(by_plot[name], plt, save, clean)
            continue
        figure, axes = plt.subplots(figsize=(5.2, 3.3))
        for k, curve in enumerate(by_plot[name]):
            x, y = clean(curve["x"]), clean(curve["y"])
            exact = any(word in curve["label"] for word in ("closed form", "Housner", "5/7 g"))
            if options.get("scatter"):
                axes.scatter(x, y, s=14, marker="o^sD"[k % 4], label=curve["label"])
            elif exact:
                axes.plot(x, y, "k--", linewidth=0.9, label=curve["label"])
            else:
                dashes = ["-", "--", "-.", ":"][k % 4] if name == "velocity-history" else "-"
                axes.plot(x, y, marker="o" if options.get("marks") else None, markersize=3,
                          linestyle=dashes, label=curve["label"])
        if name == "topple-map":
            angles = [0.25 * k for k in range(201)]
            axes.plot(angles, [math.tan(math.radians(a)) for a in angles], "k-", linewidth=0.8, label="tan α = b/h")
            axes.axvline(25.0, color="k", linestyle="--", linewidth=0.8, label="α = φ")
            axes.plot([25.0, 50.0], [math.tan(math.radians(25.0))] * 2, "k:", linewidth=0.8, label="tan φ = b/h")
            axes.set_ylim(0.05, 1.25)
        if options.get("x") == "log":
            axes.set_xscale("log")
        if options.get("y") == "log":
            axes.set_yscale("log")
            low, high = axes.get_ylim()
            if low < 1e-12:
                axes.set_ylim(1e-16, high)
            elif high < 2.0 * low:  # the same to many digits: a decade, or the ticks are all alike
                axes.set_ylim(low / 3.0, 3.0 * high)
        axes.set(title=title, xlabel=x_label, ylabel=y_label)
        if name == "topple-map":  # points are everywhere
            axes.legend(loc="upper left", bbox_to_anchor=(1.01, 1.0))
        else:
            axes.legend()
        save(figure, name)
    shapes = [n for n in by_plot if n.startswith("paths-")]
    if shapes:
        draw_paths({n[len("paths-"):]: by_plot[n] for n in sorted(shapes)}, plt, save, clean)
    return made


def draw_rebound(curves, plt, save, clean):
    """Two panels, one per Δt, and the reference in both."""
    figure, panels = plt.subplots(1, 2, figsize=(7.4, 3.3), sharey=True)
    colours = {}
    for curve in curves:
        penalty = curve["label"].split("penalty ")[1]
        colour = colours.setdefault(penalty, f"C{len(colours)}")
        for axes, step in zip(panels, ("0.01", "0.005")):
            if curve["label"].startswith("reference"):
                axes.plot(clean(curve["x"]), clean(curve["y"]), ":", color=colour, label=f"reference, {penalty}")
            elif f"Δt {step} s" in curve["label"]:
                axes.plot(clean(curve["x"]), clean(curve["y"]), "o-", markersize=3, color=colour, label=penalty)
    for axes, step in zip(panels, ("0.01", "0.005")):
        axes.set(xscale="log", xlabel="Young's modulus, Pa", title=f"Paper fig. 13, Δt {step} s")
    panels[0].set_ylabel("rebound / incident speed")
    panels[1].legend(title="penalty", fontsize=6)
    save(figure, "rebound")


def draw_paths(shapes, plt, save, clean):
    """Paper fig. 16: plan of the first ten paths of each shape, with the wedge of their θ."""
    figure, panels = plt.subplots(len(shapes), 1, figsize=(6.2, 2.6 * len(shapes)), sharex=True)
    for axes, (shape, curves) in zip(panels, shapes.items()):
        run = max(max(c["x"]) - c["x"][0] for c in curves)
        sides = [y - c["y"][0] for c in curves for y in c["y"]]
        width = max(sides) - min(sides)
        for curve in curves:
            axes.plot(clean(curve["x"]), clean(curve["y"]), linewidth=0.8)
        x, y = curves[0]["x"][0], curves[0]["y"][0]
        for side in (-0.5, 0.5):
            axes.plot([x, x + run], [y, y + side * width], "k--", linewidth=0.8)
        axes.axvline(100.0, color="grey", linewidth=0.6)
        axes.set(title=f"Paper fig. 16: {shape}, 10 iterations, θ {math.degrees(math.atan2(width, 2 * run)):.1f}°",
                 ylabel="y, m", xlim=(0, 250), ylim=(0, 100))
        axes.set_aspect("equal")
    panels[-1].set_xlabel("x, m (foot of the incline at 100 m)")
    save(figure, "paths")


def write_data(lines, path):
    """Every figure, one a row."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with open(path, "w", encoding="utf-8", newline="") as file:
        rows = csv.writer(file, lineterminator="\n")
        rows.writerow(COLUMNS)
        for line in lines:
            if line["kind"] != "curve":
                rows.writerow([line["subject"], line["test"], line["quantity"], line["value"], line["unit"], line["kind"],
                               line["expected"], line["tolerance"], int(line["passed"]), line["reason"]])


def read_data(path):
    """Of such a table the lines as the programs write them."""
    def value_of(text):
        return float(text) if text else None

    with open(path, encoding="utf-8", newline="") as file:
        return [{"subject": row["case"], "test": row["test"], "quantity": row["quantity"], "value": value_of(row["value"]),
                 "unit": row["unit"], "kind": row["kind"], "expected": value_of(row["expected"]),
                 "tolerance": value_of(row["tolerance"]), "passed": row["passed"] == "1", "reason": row["reason"]}
                for row in csv.DictReader(file)]


def tests_in(lines):
    """Names of their tests, those of one suite together: `Flight.A, B`."""
    suites = collections.defaultdict(list)
    for line in lines:
        suite, _, name = line["test"].partition(".")
        suite, name = suite.rpartition("-")[2], name.partition("-")[0]  # Kinds-Suite.Test-0
        if name not in suites[suite]:
            suites[suite].append(name)
    return ", ".join(f"`{suite}.{names[0] if len(names) == 1 else '*'}`" for suite, names in suites.items())


def page_of(lines, cut_off, others, pictures):
    """The page's text. `lines` without curves; `cut_off`: tests that did not end; `others`: (test, message);
    `pictures`: their folder."""
    def is_drawn(name):
        return name and (pictures / file_of(name)).exists()

    without = []
    bars = [line for line in lines if line["kind"] != "report"]
    failed = [line for line in bars if not line["passed"]]
    page = ["# Verification", "",
            "What the engine computes beside closed forms and published figures. The page is made by "
            "`ninja -C build verification`: don't edit it.", "",
            "## How to", "",
            "- `ctest -L Verification` runs the reduced forms of all cases, in minutes.",
            "- `ninja -C build verification` runs the full ones and makes this page, its pictures and "
            "[data/verification.csv](data/verification.csv), which has every figure, its bar and the reason for the bar.",
            "- A claim may stand for many figures; the table has the one that is nearest to its bar. *METHOD* is "
            "[method.md](method.md).", "",
            f"Figures with a bar: {len(bars)}. Met: {len(bars) - len(failed)}. Missed: {len(failed)}. Tests that did not "
            f"end: {len(cut_off)}.", "",
            "## Claims", "", "| claim | worst figure | bar | of | test |", "|---|---|---|---|---|"]
    for claim, subject, pattern, picture in CLAIMS:
        shown = [line for line in bars if line["subject"] == subject and re.search(pattern, line["quantity"])]
        words = f"[{claim}](images/verification/{file_of(picture)})" if is_drawn(picture) else claim
        if not shown:
            without.append(subject)
            continue
        worst = max(shown, key=nearness)
        mark = "" if all(line["passed"] for line in shown) else " **missed**"
        page.append(f"| {words} | {figure(worst)}{mark} | {bar(worst)} | {len(shown)} | {tests_in(shown)} |")
    page += ["", "Claims with a picture are links to it."]
    if without:
        page += ["", "Cases without figures in this run: " + ", ".join(dict.fromkeys(without)) + "."]
    page += ["", "## Limits", "", "| what is not shown | figure | compare |", "|---|---|---|"]
    for subject, pattern, words in NOT_SHOWN:
        for line in lines:
            if line["subject"] == subject and re.search(pattern, line["quantity"]):
                page.append(f"| {words} ({cell(line['quantity'].split(':')[0])}) | {figure(line)} | {bar(line)} |")
    if failed:
        page += ["", "## Missed", "", "| case | quantity | measured | expected |", "|---|---|---|---|"]
        page += [f"| {line['subject']} | {cell(line['quantity'])} | {figure(line)} | {bar(line)} |" for line in failed]
    if cut_off or others:
        page += ["", "## Beside the figures", ""]
        page += [f"- `{name}` did not end: it crashed, or hung and was stopped." for name in cut_off]
        page += [f"- `{name}`: {cell(message.strip())[:300]}" for name, message in others]
    page += ["", "## Pictures", ""]
    for name, title in (("rebound", "Paper fig. 13: rebound by modulus and penalty"), ("sliding", "Paper fig. 14: sliding on 30°"),
                        ("paths", "Paper fig. 16: paths of cube and icosahedron"), ("topple-map", "Block on an incline, φ 25°"),
                        ("theta", "Dispersion angle of 10 iterations")):
        if is_drawn(name):
            page.append(f"![{title}](images/verification/{file_of(name)})")
    return "\n".join(page) + "\n"


def write_page(lines, tests, docs):
    pictures = docs / "images" / "verification"
    pictures.mkdir(parents=True, exist_ok=True)
    draw([line for line in lines if line["kind"] == "curve"], pictures)
    figures = [line for line in lines if line["kind"] != "curve"]
    write_data(figures, docs / "data" / "verification.csv")
    cut_off = [name for name, ending in tests.items() if ending is None]
    others = [(name, ending["message"]) for name, ending in tests.items() if ending and ending["message"]]
    (docs / "verification.md").write_text(page_of(figures, cut_off, others, pictures), encoding="utf-8")
    failed = [line for line in figures if line["kind"] != "report" and not line["passed"]]
    print(f"{docs / 'verification.md'}: {len(figures)} figures, {len(failed)} missed, {len(cut_off)} tests did not end")
    for line in failed:
        print(f"  FAIL {line['subject']}: {line['quantity']}: {number(line['value'])}, expected {bar(line)}")


def tests_of(program):
    """Full names of a GoogleTest program's tests."""
    listing = subprocess.run([program, "--gtest_list_tests"], capture_output=True, text=True, check=True).stdout
    names, suite = [], ""
    for line in listing.splitlines():
        entry = line.split("#")[0].rstrip()
        if entry and not line.startswith(" "):
            suite = entry.strip()
        elif entry.strip() and suite.endswith("."):
            names.append(suite + entry.strip())
    return names


def run(programs, results, form, guard):
    """One process per test: one that hangs or crashes takes nothing else with it."""
    environment = dict(os.environ, ROCKFALL_VERIFICATION=form, ROCKFALL_VERIFICATION_RESULTS=str(results))
    for program in programs:
        for name in tests_of(program):
            begin = datetime.datetime.now()
            try:
                code = subprocess.run([program, f"--gtest_filter={name}"], env=environment, timeout=guard,
                                      stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode
                state = "passed" if code == 0 else "FAILED" if code == 1 else f"ended with {code}"
            except subprocess.TimeoutExpired:
                state = f"did not end within {guard} s"
            seconds = (datetime.datetime.now() - begin).total_seconds()
            print(f"{name}: {state} ({seconds:.1f} s)", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--results", type=pathlib.Path, help="folder of the programs' results; without it the page is made "
                        "of the table in docs")
    parser.add_argument("--form", choices=("full", "reduced"), default="full")
    parser.add_argument("--docs", type=pathlib.Path, help="folder of the page; without it none is made")
    parser.add_argument("--guard", type=float, default=GUARD, help="seconds that one test may take")
    parser.add_argument("--run", nargs="*", default=[], metavar="PROGRAM", help="programs to run first")
    arguments = parser.parse_args()
    if not arguments.results:
        text = page_of(read_data(arguments.docs / "data" / "verification.csv"), [], [],
                       arguments.docs / "images" / "verification")
        (arguments.docs / "verification.md").write_text(text, encoding="utf-8")
        return
    folder = arguments.results / arguments.form
    if arguments.run:
        if folder.is_dir():
            for old in folder.glob("*.jsonl"):
                old.unlink()
        run(arguments.run, arguments.results, arguments.form, arguments.guard)
    lines, tests = read(folder)
    if not tests:
        sys.exit(f"no results in {folder}")
    if arguments.docs:
        write_page(lines, tests, arguments.docs)


if __name__ == "__main__":
    main()
