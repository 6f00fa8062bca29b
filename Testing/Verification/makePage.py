#!/usr/bin/python3
"""Runs the verification programs and makes docs/verification.md and its pictures of their results.

    makePage.py --results FOLDER --form full|reduced [--docs FOLDER] [--run PROGRAM ...]

Every number on the page comes from the lines of JSON that the programs write; the words beside them
are here and in the programs. A program that fails or hangs does not keep the page from being made:
it is on the page.
"""

import argparse
import collections
import datetime
import json
import math
import os
import pathlib
import subprocess
import sys

GUARD = 4 * 3600  # s, of one program in the full form

# Subject (as the programs name it), what it is about, pictures of it. In the order of the page.
CHAPTERS = [
    ("Projectile with spin",
     "A spinning block released at 28 m/s flies for 10 s. Its centroid has to be on the parabola whatever Δt: flight "
     "is not "
     "stepped.", []),
    ("Torque-free rotation",
     "Angular momentum, kinetic energy and volume are invariants of free rotation (METHOD 10.3, 10.4). A plate with "
     "two equal "
     "moments has its attitude in closed form, a box of three different moments turns over about its intermediate "
     "axis with a "
     "period that is an elliptic integral.", ["flips"]),
    ("Elastic rebound",
     "A cube of 1 m³ falls face down on a horizontal slope, elastic (METHOD 9.1, 10.1; paper figs 12 and 13). The "
     "ratio of rebound "
     "to incident speed is taken from samples in free flight, brought to the floor along the parabola. The reference "
     "curves are "
     "the same block on the same springs, its four variables of a face-down fall integrated by velocity Verlet until "
     "it has left "
     "for good, nothing dissipated.", ["velocity-history", "rebound"]),
    ("Slope as blocks",
     "What a step costs if the slope is a system of fixed blocks, as before CFEs. For comparison only.", ["block-cost"]),
    ("Elastic drop in any attitude",
     "Six shapes in random attitudes, turning, fall 3 m without friction and with Rv 1 on planes, a ridge and a "
     "peak. What they "
     "have of mechanical energy when they fly again is compared with what they had; on a plane, angular momentum "
     "about its normal "
     "and momentum along it must stay.", []),
    ("Restitution",
     "The paper's adjustment, (Vx, Vy, Vz) ← Rv (Vx, Vy, Vz) once per impact (METHOD 4): a bounce keeps Rv² of the "
     "height, and the "
     "bounces end with the geometric series. Sliding and rolling are no impacts.", ["restitution"]),
    ("Sliding",
     "A cube on a plane of 30° (METHOD 9.2; paper fig. 14), in 16 azimuths, over one pair of CFEs and over 10⁴ of "
     "them; and at rest "
     "below the friction angle.", ["sliding"]),
    ("Slide or topple",
     "A block b long and h high on an incline is stable, slides, topples or does both. The boundaries are found by "
     "bisection: "
     "sliding counts from 5 mm, toppling from 3° on.", ["topple-map"]),
    ("Rocking block",
     "A block of half-sizes 0.25 × 1 m, tilted about an edge and let go: the time until it stands upright is a "
     "quarter of Housner's "
     "(1963) period.", ["rocking"]),
    ("Rolling",
     "A ball of flat faces, an icosahedron cut up and blown up to a sphere. Limits of the closed form: beyond √(g "
     "r), 2.5 m/s, a "
     "polyhedron hops from vertex to vertex; each vertex that sets down without rebound takes δ²/1.4 of the energy "
     "of rolling, δ "
     "the angle between vertices (8° for 1280 faces, 4° for 5120); and a ball that lies on a face has to be tipped "
     "over its edge "
     "first. Hence short runs from rest, 5120 faces beside 1280, and bars only where the ball is round enough.",
     ["rolling", "slip-to-roll", "ball"]),
    ("Oblique impact of a ball",
     "The ball lands on a vertex straight below its centroid, without spin, restitution on the normal component "
     "only. Below "
     "v_t/v_n = 3.5 μ (1+e) the contact sticks, above it slides all the way.", ["oblique"]),
    ("Convergence",
     "Δt halved and contact stiffness multiplied by ten, in four problems with a known answer.", ["convergence-Δt",
                                                                                              "convergence-penalty"]),
    ("Tunnelling",
     "Shots at jagged ground: noise, ridges, pits and spikes, terraces with steep walls, cells of 0.1 to 5 m. A shot "
     "counts as "
     "through if the centroid gets under the surface. The target `verification-tunnelling` fires a million.", []),
    ("Internal edges",
     "A plane whose heights are exact in binary, cut into two CFEs and into 32,768 (METHOD 10.5).", []),
    ("CFE search",
     "Patch, candidates and contacts of a cube on rough ground, from 100 to 10⁶ cells (METHOD 5); brute force "
     "beside it.",
     ["search"]),
    ("Shape test",
     "The paper's bi-planar slope (METHOD 9.3; figs 15, 16): cube and icosahedron of 1 m³, roughness 0.1 ± 0.1 m, Rv "
     "0.8, φ 15°, Δt "
     "0.005 s. θ = arctan(W/2L), with W the range of the lateral places and L the longest run of the group. Ten "
     "iterations as in the "
     "paper, drawn a thousand times from all that were run, give the mean and the 95 % interval.",
     ["paths", "theta"]),
    ("Shape test, variants",
     "The same with what the paper leaves open (height and attitude of the release) and with other friction "
     "angles.", []),
    ("Energy audit",
     "Released = kinetic + strain + friction + restitution + vibration + damping + numerical, over every trajectory "
     "of the shape "
     "test.", []),
    ("Piles that stand",
     "A column of ten cubes, a wall of 10 × 5 bricks and a dry-stone arch, every contact awake: nothing may creep, "
     "and the floor carries the weight.", []),
    ("Heaps",
     "Cubes of 0.6 m³, turned at random, fall onto a floor and on each other: no overlap, rest, and a heap that is "
     "the steeper the more friction there is.", ["heap-repose"]),
    ("Crowds",
     "The same rocks fall twice: with every impact resolved in time, as in groups of up to 64 rocks, and all stepped as "
     "in a large crowd. They go as far, and lose their energy to the same.", []),
    ("Robustness",
     "Unreasonable input. Every case is a test of its own under a guard of 120 s of wall time, so that a hang "
     "is a failure.", []),
]

# What a reader has to know about the figures of a case, whatever they are.
COMMENTS = {
    "Heaps":
        "The full form, 1000 cubes at four friction angles, takes some two minutes of two cores; the reduced one (45 "
        "cubes at two) runs with the other tests.",
    "Elastic rebound":
        "Where the block is softer than its contact (E L < p) the outcome depends on what becomes of the block's "
        "vibration between the touches that follow one another within milliseconds. Where it is far stiffer, its strain "
        "follows the contact without inertia and the ratio is 1 to rounding; the reference keeps a little vibration there.",
    "Rolling":
        "The figures approach those of a sphere as the faces become smaller; at 1280 faces the deviation is the "
        "polyhedron's.",
    "Shape test":
        "θ is an extreme-value statistic (a range over a longest run): it grows with the number of iterations, and ten of "
        "them leave an interval as wide as the difference that the paper reports. The paper gives neither the height nor "
        "the attitude of the release; see the variants for what they do.",
}

# What it means that a bar of a case is missed.
WHEN_MISSED = {
    "Oblique impact of a ball":
        "Sticking is a shear spring with damping of its own. When the normal contact opens it has not quite come to rest, "
        "and the slip velocity left over depends on where in its swing that is: it scatters about zero by a few per cent "
        "of v_t, and v_t' by 2/7 of that.",
    "Elastic drop in any attitude":
        "Where energy is left in springs in flight, a contact was dropped while it was still compressed: near a peak it came "
        "to the end of its feature and no neighbour took it over. Damped steps are taken where a step of lasting contact "
        "falls between two touches of one impact.",
    "Shape test":
        "The order of the two shapes is not the paper's. At φ 15° on 30° a cube that lies on a face slides, and as "
        "tan φ < b/h it cannot trip: friction takes more of its energy than impacts do and keeps it in the fall line. An "
        "icosahedron goes on rolling and bouncing, and is turned aside at each touch. The variants show that the cube "
        "spreads wider than the icosahedron where it tumbles, that is with more friction and a higher release.",
}

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
        return f"{value:.{digits + 1}f}".rstrip("0").rstrip(".") if size < 1e4 else f"{value:.0f}"
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


def verdict(line):
    if line["kind"] == "report":
        return "–"
    return "pass" if line["passed"] else "**FAIL**"


def cell(text):
    return text.replace("|", "\\|").replace("\n", " ")


def table(lines):
    """Rows; the common beginning of neighbouring quantities stays, so that each row can be read alone."""
    rows = ["| quantity | measured | expected | | why this bar |", "|---|---|---|---|---|"]
    for line in lines:
        unit = f" {line['unit']}" if line["unit"] else ""
        rows.append("| " + " | ".join([cell(line["quantity"]), number(line["value"]) + unit, bar(line), verdict(line),
                                       cell(line["reason"])]) + " |")
    return rows


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
        axes.set(title=title, xlabel=x_label, ylabel=y_label)
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


def write_page(lines, tests, form, docs):
    pictures = docs / "images" / "verification"
    pictures.mkdir(parents=True, exist_ok=True)
    made = draw([line for line in lines if line["kind"] == "curve"], pictures)
    figures = collections.defaultdict(list)
    for line in lines:
        if line["kind"] != "curve":
            figures[line["subject"]].append(line)
    bars = [line for group in figures.values() for line in group if line["kind"] != "report"]
    failed = [line for line in bars if not line["passed"]]
    cut_off = [name for name, ending in tests.items() if ending is None]
    others = [(name, ending["message"]) for name, ending in tests.items() if ending and ending["message"]]

    page = ["# Verification", "",
            "What the engine computes beside closed forms and published figures. Every number and picture on this "
            "page is made by "
            "`ninja verification` from the runs themselves (`Testing/Verification/`); `ctest -L Verification` runs "
            "the reduced forms of "
            "the same cases. Regenerate the page, don't edit it.", "",
            f"Form: {form}. Figures with a bar: {len(bars)}; met: {len(bars) - len(failed)}; missed: {len(failed)}. Tests that did not "
            f"end: {len(cut_off)}.", "",
            "*Measured* is this code's figure. *Expected* is the closed form or the published one, with its "
            "tolerance; in brackets it is "
            "only there to compare with. A dash instead of a verdict: reported, without a bar. METHOD is the "
            "restatement of the method "
            "that the code follows, *the paper* Zheng et al. (2014), doi:10.1080/17486025.2013.871070.", ""]
    page += ["## Summary", "", "| case | figures with a bar | met | missed |", "|---|---|---|---|"]
    known = [subject for subject, _, _ in CHAPTERS] + sorted(s for s in figures if s not in {c[0] for c in CHAPTERS})
    for subject in known:
        barred = [line for line in figures.get(subject, []) if line["kind"] != "report"]
        missed = sum(not line["passed"] for line in barred)
        link = "#" + "".join(c for c in subject.lower().replace(" ", "-") if c.isalnum() or c == "-")
        state = f"**{missed}**" if missed else "0"
        if not figures.get(subject):
            page.append(f"| [{subject}]({link}) | no results | | |")
        else:
            page.append(f"| [{subject}]({link}) | {len(barred)} | {len(barred) - missed} | {state} |")
    if cut_off or others:
        page += ["", "Beside the figures:", ""]
        page += [f"- `{name}` did not end: it crashed, or hung and was stopped." for name in cut_off]
        page += [f"- `{name}`: {cell(message.strip())[:300]}" for name, message in others]
    texts = {subject: (words, images) for subject, words, images in CHAPTERS}
    for subject in known:
        words, images = texts.get(subject, ("", []))
        page += ["", f"## {subject}", "", words, ""]
        if subject in COMMENTS:
            page += [COMMENTS[subject], ""]
        if subject in WHEN_MISSED and any(not line["passed"] for line in figures.get(subject, [])):
            page += [WHEN_MISSED[subject], ""]
        if figures.get(subject):
            page += table(figures[subject])
        else:
            page.append("No results: the test did not get there.")
        for image in images:
            if image in made:
                title = PICTURES[image][0] if image in PICTURES else "Paper fig. 16"
                page += ["", f"![{title}](images/verification/{file_of(image)})"]
    (docs / "verification.md").write_text("\n".join(page) + "\n", encoding="utf-8")
    print(f"{docs / 'verification.md'}: {len(bars)} bars, {len(failed)} missed, {len(cut_off)} tests did not end")
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
    parser.add_argument("--results", type=pathlib.Path, required=True, help="folder of the programs' results")
    parser.add_argument("--form", choices=("full", "reduced"), default="full")
    parser.add_argument("--docs", type=pathlib.Path, help="folder of the page; without it none is made")
    parser.add_argument("--guard", type=float, default=GUARD, help="seconds that one test may take")
    parser.add_argument("--run", nargs="*", default=[], metavar="PROGRAM", help="programs to run first")
    arguments = parser.parse_args()
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
        write_page(lines, tests, arguments.form, arguments.docs)


if __name__ == "__main__":
    main()
