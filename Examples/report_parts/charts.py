"""Exceedance curves at the lines, and how quantities settle as rocks are added."""
import numpy as np
from matplotlib.ticker import MaxNLocator

from enough import lost_before, quantile_ranks, share_interval
from figures import GREY, PAGE, STYLES, new, picture, place

POINTS = 24  # of a curve of convergence
CURVES = 4  # of them in a figure
LONGEST = 30  # letters of a line's name in a chart
CONFIDENCE = 0.95
ROCK = ("Iteration", "BlockId")  # tell the rocks of a study from each other


def short(name):
    return name if len(name) <= LONGEST else name[:LONGEST - 1] + "…"


def exceedance(study, names):
    """Energy and height of what passes these lines."""
    rows = -(-len(names) // 3)
    figure = new(PAGE, 70.0 + 4.0 * rows)
    table = study.exceedance
    for k, (column, label) in enumerate((("EnergyInKilojoules", "kinetic energy, kJ"),
                                         ("HeightOverGround", "height of the lowest point over ground, m"))):
        axes = place(figure, 14.0 + 88.0 * k, 12.0, 70.0, 52.0)
        for number, name in names:
            own = (table["Line"] == number) if len(table) else np.zeros(0, bool)
            values, share = table[column][own], 100.0 * table["ShareOfPassing"][own]
            known = ~np.isnan(values)
            colour, dash = STYLES[number % len(STYLES)]
            axes.step(values[known], share[known], where="pre", color=colour, ls=dash, lw=1.2, label=short(name))
        for share in (50.0, 10.0, 5.0, 1.0):
            axes.axhline(share, color=GREY, lw=0.4, ls=(0, (4, 3)))
        axes.set(yscale="log", xlabel=label, ylabel="passing rocks with at least as much, %" if k == 0 else "", ylim=(0.5, 105.0))
        axes.set_xlim(left=0.0)
        axes.xaxis.set_major_locator(MaxNLocator(5))
        axes.set_yticks([1, 2, 5, 10, 20, 50, 100], ["1", "2", "5", "10", "20", "50", "100"])
        axes.minorticks_off()
        axes.grid(lw=0.2, alpha=0.6)
        if k == 0:
            figure.legend(*axes.get_legend_handles_labels(), loc="upper center", ncol=min(len(names), 3), frameon=False,
                          borderaxespad=0.2)
    return picture(figure, "Exceedance at the lines, of the rocks that pass. Dashed: 50, 10, 5 and 1 %, which are the 50, 90, "
                   "95 and 99 % values.", "Exceedance curves")


def best_place(study, name, rows):
    """What a barrier on a line and on its parallels has to hold, and what gets past it, over the distance."""
    table, offset = study.places, study.places["Offset"][rows]
    frequent = np.isfinite(table["AnnualFrequency"][rows]).all()
    figure = new(PAGE, 62.0)
    panels = [place(figure, 12.0 + 57.0 * k, 12.0, 44.0, 38.0) for k in range(3)]
    for axes, what, title in ((panels[0], "EnergyInKilojoules", "energy, kJ"), (panels[1], "TopHeight", "top of the rock, m")):
        for level, (colour, dash) in zip((95, 99), STYLES):
            middle, low, high = (table[f"{what}{level}{end}"][rows] for end in ("", "Low", "High"))
            axes.fill_between(offset, low, high, color=colour, alpha=0.15, lw=0.0)
            axes.plot(offset, middle, color=colour, ls=dash, lw=1.2, marker=".", ms=3, label=f"{level} %")
        axes.set_title(title, loc="left", fontsize=7)
    ends = ("AnnualFrequency", "UncaughtFrequency") if frequent else ("Share", "UncaughtShare")
    come, past = (table[end][rows] for end in ends)
    past = past if frequent else come * np.nan_to_num(past)  # of all released, as `come`
    for values, text, (colour, dash) in ((come, "come to it", STYLES[2]), (past, "get past the barrier", STYLES[3])):
        panels[2].plot(offset, values * (1.0 if frequent else 100.0), color=colour, ls=dash, lw=1.2, marker=".", ms=3, label=text)
    panels[2].set_title("rocks, 1/a" if frequent else "rocks, % of the released", loc="left", fontsize=7)
    for axes in panels:
        axes.set(xlabel="to the left of the line, m", ylim=(0.0, None))
        axes.grid(lw=0.2, alpha=0.6)
        axes.axvline(0.0, color=GREY, lw=0.6)
    for axes, x in ((panels[0], 0.06), (panels[2], 0.6)):
        figure.legend(*axes.get_legend_handles_labels(), loc="upper left", bbox_to_anchor=(x, 1.0), ncol=2, frameon=False,
                      borderaxespad=0.2)
    barrier = [study.lines[column][study.lines["LineName"] == name][0] for column in ("BarrierHeight", "BarrierCapacity")]
    return picture(figure, f"{short(name)} and its parallels: 95 and 99 % values, shaded their limits where enough rocks come; "
                   f"rocks that come and that get past a barrier of {barrier[0]:g} m and {barrier[1]:g} kJ. The best place has "
                   "little of all three.",
                   "Best place of a barrier")


def quantile(values, q=0.95):
    """With its interval by order statistics, or NaN where there are too few values, which may be infinite."""
    values = np.sort(values)
    ranks = quantile_ranks(len(values), q, CONFIDENCE) if len(values) else None
    low, high = (values[r - 1] for r in ranks) if ranks else (np.nan, np.nan)
    if not len(values):
        return np.nan, low, high
    beside = values[int(np.ceil((len(values) - 1) * q))]
    return (np.quantile(np.minimum(values, beside), q) if np.isfinite(beside) else beside), low, high


def share(count, total, lost):
    """In %, with its interval; of rocks that were lost before nobody knows whether they count."""
    low, high = share_interval(int(count), int(total), CONFIDENCE, int(lost))
    return 100.0 * count / total, 100.0 * low, 100.0 * high


def first_passings(study, name):
    """Rock (iteration, block) and energy (kJ) of each rock that passes a line, when it does so first; of one that broke the
    largest of its pieces."""
    table = study.crossings
    if not len(table):
        return np.empty((0, 2)), np.empty(0)
    own = (table["LineName"] == name) & (table["Passing"] == 0)
    rocks, energy = np.stack([table[key][own] for key in ROCK], axis=1), table["KineticEnergy"][own] / 1000.0
    if "Piece" in table and len(energy):
        rocks, of = np.unique(rocks, axis=0, return_inverse=True)
        largest = np.zeros(len(rocks))
        np.maximum.at(largest, of.ravel(), energy)
        energy = largest
    return rocks, energy


def lost(study, passed, last=np.inf):
    """How many rocks of the iterations up to this one were lost before a line that these rocks passed."""
    endless = np.stack([study.rocks[key] for key in ROCK], axis=1)[study.rocks["Endless"] & (study.rocks["Iteration"] <= last)]
    return lost_before(map(tuple, endless.tolist()), map(tuple, passed.tolist()))


def settling(study, names):
    """How shares and 95 % values settle: curves over the number of rocks, and what they end with."""
    iteration = study.rocks["Iteration"]
    ends = np.unique(np.linspace(1, study.iterations, POINTS).round().astype(int))
    order = np.unique(iteration)  # a study's iterations are numbered from 0
    totals = [int((iteration <= order[end - 1]).sum()) for end in ends]
    ways = np.where(study.rocks["Endless"], np.inf, study.rocks["RunOut"])
    curves = [("", "run-out, 95 %", "m", [quantile(ways[iteration <= order[end - 1]]) for end in ends])]
    for name in names:
        passed, energy = first_passings(study, name)
        when = passed[:, 0]
        curves.append((name, "share that passes", "%", [
            share((when <= order[end - 1]).sum(), total, lost(study, passed, order[end - 1])) for end, total in zip(ends, totals)]))
        curves.append((name, "energy, 95 %", "kJ", [quantile(energy[when <= order[end - 1]]) for end in ends]))
    return totals, curves


def convergence(study, names):
    """Figures of all curves, and what they end with."""
    totals, curves = settling(study, names)
    drawn = [curve for curve in curves if np.isfinite([middle for middle, *_ in curve[-1]]).any()]
    figures = [curves_of(totals, drawn[k:k + CURVES]) for k in range(0, len(drawn), CURVES)]
    ends = [{"label": f"{name}: {what}" if name else what, "unit": unit, "value": values[-1][0], "low": values[-1][1],
             "high": values[-1][2]} for name, what, unit, values in curves]
    return figures, ends


def curves_of(totals, curves):
    rows = -(-len(curves) // 2)
    figure = new(PAGE, 46.0 * rows + 4.0)
    for k, (name, what, unit, values) in enumerate(curves):
        axes = place(figure, 16.0 + 88.0 * (k % 2), 46.0 * (rows - 1 - k // 2) + 10.0, 68.0, 32.0)
        values = np.array(values)
        middle, low, high = np.where(np.isfinite(values), values, np.nan).T
        axes.fill_between(totals, low, high, color="#b9c9df", lw=0.0)
        axes.plot(totals, middle, color="#1b4f91", lw=1.2, marker=".", ms=3)
        axes.set_title(f"{short(name)}: {what}, {unit}" if name else f"{what}, {unit}", loc="left", fontsize=7)
        axes.set_xlim(0.0, totals[-1] * 1.02)
        axes.set_ylim(bottom=0.0)
        axes.grid(lw=0.2, alpha=0.6)
        if k >= len(curves) - 2:
            axes.set_xlabel("rocks")
    return picture(figure, "Value after so many rocks, and its 95 % interval: shares by Clopper & Pearson, rocks lost before the line "
                   "counted both ways, quantiles by order statistics. Where no band is, too few rocks came, or too many left the DEM, still moved or were lost in nodata.", "Convergence")
