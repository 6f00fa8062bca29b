"""The map and the run-out curves of a comparison, drawn by matplotlib."""
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import LightSource

from site_scores import ES, RANK

COLOURS = ("#d95f02", "#1b4fb5", "#7a0177", "#00798c", "#a6761d", "#444444")


def draw(path, ground, observed, simulated, title):
    figure, (map_, curves) = plt.subplots(
        1, 2, figsize=(14, 8.2), gridspec_kw={"width_ratios": (1.55, 1)}, layout="constrained")
    figure.suptitle(title, fontsize=15, x=0.01, ha="left")
    colour = {group: COLOURS[k % len(COLOURS)] for k, group in enumerate(observed.groups())}
    draw_map(map_, ground, observed, simulated, colour)
    draw_curves(curves, observed, simulated, colour)
    figure.savefig(path, dpi=110)
    plt.close(figure)


def draw_map(axes, ground, observed, simulated, colour):
    everything = np.concatenate([observed.start, observed.stop, simulated.stop[simulated.started]])
    low, high = everything.min(axis=0) - 12, everything.max(axis=0) + 12
    half = 0.5 * ground.cell
    extent = (ground.west - half, ground.west + (ground.columns - 0.5) * ground.cell,
              ground.south - half, ground.north + half)
    light = LightSource(azdeg=315, altdeg=40)
    heights = np.where(np.isnan(ground.heights), np.nanmin(ground.heights), ground.heights)
    relief = light.hillshade(heights, dx=ground.cell, dy=ground.cell)
    axes.imshow(relief, extent=extent, cmap="gray", vmin=-0.6, vmax=1.15, interpolation="bilinear")
    x = ground.west + ground.cell * np.arange(ground.columns)
    y = ground.north - ground.cell * np.arange(ground.rows)
    lines = axes.contour(x, y, ground.heights, colors="#6b5a3a", linewidths=0.7,
                         levels=np.arange(np.floor(heights.min() / 5) * 5, heights.max() + 5, 5))
    axes.clabel(lines, lines.levels[::2], fontsize=8, fmt="%g")
    moved = simulated.started
    for name, tint in colour.items():
        runs = np.nonzero(observed.group == name)[0]
        own = (simulated.group == name) & moved
        axes.plot(*simulated.stop[own].T, ".", color=tint, alpha=0.45, markersize=5,
                  label=f"{name}: simulated stop")
        axes.plot(*observed.stop[runs].T, "o", color=tint, markersize=9, markeredgecolor="white",
                  markeredgewidth=1.4, label=f"{name}: observed stop", zorder=5)
    axes.plot(*observed.start.T, "^", color="black", markersize=7, markeredgecolor="white",
              label="release", zorder=4)
    axes.set(xlim=(max(low[0], extent[0]), min(high[0], extent[1])),
             ylim=(max(low[1], extent[2]), min(high[1], extent[3])),
             xlabel="x (m), local", ylabel="y (m), local", aspect="equal")
    axes.legend(loc="upper right", fontsize=9, framealpha=0.9)
    axes.set_title("Stopping points; contours every 5 m", fontsize=10.5, loc="left")


def draw_curves(axes, observed, simulated, colour):
    def curve(values, **style):
        values = np.sort(values)
        axes.step(np.append(values[0], values), np.arange(len(values) + 1) / len(values) * 100,
                  where="post", **style)

    moved = simulated.started
    for name, tint in colour.items() if len(colour) > 1 else ():
        runs = np.nonzero(observed.group == name)[0]
        own = (simulated.group == name) & moved
        if own.any():
            curve(simulated.run_out[own], color=tint, linewidth=1.2)
        curve(observed.run_out[runs], color=tint, linewidth=1.2, linestyle=(0, (4, 2)))
    if moved.any():
        curve(simulated.run_out[moved], color="black", linewidth=2.6, label="simulated")
    curve(observed.run_out, color="black", linewidth=2.6, linestyle=(0, (4, 2)),
          label="observed")
    axes.set(xlabel="run-out (m)", ylabel="share that stopped within it (%)", ylim=(0, 100))
    axes.set_xlim(left=0)
    axes.grid(color="#dddddd")
    axes.legend(loc="upper left", fontsize=9)
    axes.set_title("Run-out. Dashed: observed" +
                   (". Thin: by group, in the map's colours" if len(colour) > 1 else ""),
                   fontsize=10.5, loc="left")


def draw_search(path, fit):
    """The score of every candidate over each of its parameters, and the ranks of the observed
    run-outs where they were held out."""
    names, rows = fit.search.names, 1 + len(fit.search.names) // 3
    figure, axes = plt.subplots(rows, 3, figsize=(13, 3.6 * rows), layout="constrained",
                                squeeze=False)
    every = fit.scores[:, :, ES].mean(axis=1)
    low, high = every.min(), np.percentile(every, 90)
    for k, (name, panel) in enumerate(zip(names, axes.ravel())):
        panel.plot(fit.search.values[:, k], every, "o", color="#1b4fb5", markersize=5, alpha=0.7)
        panel.plot(fit.values()[k], every.min(), "o", color="#d95f02", markersize=9)
        panel.axvspan(*np.percentile(fit.spread[:, k], (5, 95)), color="#d95f02", alpha=0.12)
        panel.set(xlabel=name, ylabel="energy score (m)",
                  ylim=(low - 0.05 * (high - low) - 0.01, high + 0.01))
        panel.grid(color="#dddddd")
    axes.ravel()[0].set_title("Orange: the best, and 90 % of the bootstrap", fontsize=10.5, loc="left")
    ranks, what = (fit.splits[0][2], "held out") if fit.splits else (fit.scores[fit.best], "not held out")
    last = axes.ravel()[len(names)]
    last.hist(ranks[:, RANK], bins=np.linspace(0, 1, 11), color="#00798c", edgecolor="white")
    last.axhline(len(ranks) / 10, color="black", linewidth=1, linestyle=(0, (4, 2)))
    last.set(xlabel="share of simulated run-outs below the observed one", ylabel="deposits")
    last.set_title(f"Ranks of the observed run-outs, {what}. Even is right", fontsize=10.5, loc="left")
    for panel in axes.ravel()[len(names) + 1:]:
        panel.set_axis_off()
    figure.savefig(path, dpi=100)
    plt.close(figure)
