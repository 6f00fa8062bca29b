"""The map and the run-out curves of a comparison, drawn by matplotlib."""
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import LightSource

COLOURS = ("#d95f02", "#1b4fb5", "#7a0177", "#00798c", "#a6761d", "#444444")


def draw(path, test, ground, observed, simulated, title):
    figure, (map_, curves) = plt.subplots(
        1, 2, figsize=(14, 8.2), gridspec_kw={"width_ratios": (1.55, 1)}, layout="constrained")
    figure.suptitle(title, fontsize=15, x=0.01, ha="left")
    blocks = sorted(set(observed.block))
    colour = {block: COLOURS[k % len(COLOURS)] for k, block in enumerate(blocks)}
    draw_map(map_, test, ground, observed, simulated, colour)
    draw_curves(curves, test, observed, simulated, colour)
    figure.savefig(path, dpi=110)
    plt.close(figure)


def draw_map(axes, test, ground, observed, simulated, colour):
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
    for block, tint in colour.items():
        runs = np.nonzero(observed.block == block)[0]
        own = np.isin(simulated.run, runs) & moved
        name = test.blocks[block].name
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


def draw_curves(axes, test, observed, simulated, colour):
    def curve(values, **style):
        values = np.sort(values)
        axes.step(np.append(values[0], values), np.arange(len(values) + 1) / len(values) * 100,
                  where="post", **style)

    moved = simulated.started
    for block, tint in colour.items():
        runs = np.nonzero(observed.block == block)[0]
        own = np.isin(simulated.run, runs) & moved
        if own.any():
            curve(simulated.run_out[own], color=tint, linewidth=1.2)
        curve(observed.run_out[runs], color=tint, linewidth=1.2, linestyle=(0, (4, 2)))
    if moved.any():
        curve(simulated.run_out[moved], color="black", linewidth=2.6, label="simulated, all blocks")
    curve(observed.run_out, color="black", linewidth=2.6, linestyle=(0, (4, 2)),
          label="observed, all blocks")
    axes.set(xlabel="run-out (m)", ylabel="share that stopped within it (%)", ylim=(0, 100))
    axes.set_xlim(left=0)
    axes.grid(color="#dddddd")
    axes.legend(loc="upper left", fontsize=9)
    axes.set_title("Run-out. Dashed: observed. Thin: by block, in the map's colours", fontsize=10.5,
                   loc="left")
