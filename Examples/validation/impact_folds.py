"""Impacts of tracks that are held out: each is foretold by the ground that does best on the other tracks.

    chantSura FOLDER --set ScarSpinDrag=1.5 … > other.txt     # once for each ground
    python3 Examples/validation/impact_folds.py preset.txt other.txt ...

A ground's score is the pinball loss of the energy ratio at the five quantiles plus |ln| of the simulated
over the observed rotational energy, each over that of the first table.
"""
import math
import re
import sys

import numpy as np

LEVELS = np.array([0.05, 0.25, 0.5, 0.75, 0.95])


class Impacts:
    """What chantSura wrote of one ground."""

    def __init__(self, path):
        self.track, loss, self.inside, self.spin = [], [], [], []
        with open(path, encoding="utf-8") as file:
            for line in file:
                parts = line.split("|")
                if len(parts) != 4 or not re.match(r"\S+_impact_\d+ ", line):
                    continue
                name, seen = parts[0].split()
                *quantiles, rank = (float(v.strip("*")) for v in parts[1].split())
                off = float(seen) - np.array(quantiles)
                self.track.append(name.split("_impact_")[0])
                loss.append(np.maximum(LEVELS * off, (LEVELS - 1.0) * off).mean())
                self.inside.append(0.05 <= rank <= 0.95)
                factor = parts[2].split()[3]
                self.spin.append(math.nan if factor == "-" else float(factor))
        if not loss:
            raise SystemExit(f"{path}: no impacts of chantSura are in it")
        self.loss, self.spin, self.inside = np.array(loss), np.array(self.spin), np.array(self.inside)


def main(paths):
    grounds = [Impacts(path) for path in paths]
    tracks = grounds[0].track
    if any(ground.track != tracks for ground in grounds):
        raise SystemExit(f"{', '.join(paths)}: the tables have different impacts")
    tracks = np.array(tracks)
    loss = np.array([ground.loss for ground in grounds])
    spin = np.abs(np.log(np.array([ground.spin for ground in grounds])))
    foretold = np.zeros(len(tracks), int)
    for track in sorted(set(tracks)):
        own = tracks == track
        score = (loss[:, ~own].mean(axis=1) / loss[0, ~own].mean() +
                 np.nanmean(spin[:, ~own], axis=1) / np.nanmean(spin[0, ~own]))
        foretold[own] = best = int(np.argmin(score))
        print(f"{track} is foretold by {paths[best]}")
    every = np.arange(len(tracks))
    made = np.array([ground.spin for ground in grounds])[foretold, every]
    inside = np.array([ground.inside for ground in grounds])[foretold, every]
    print(f"held out: {inside.sum()} of {len(tracks)} within 5 to 95 %, rotational energy median "
          f"{np.nanmedian(made):.2f} ({np.nanmin(made):.2f} to {np.nanmax(made):.2f}) of {np.isfinite(made).sum()}, "
          f"pinball loss {loss[foretold, every].mean() / loss[0].mean():.2f} of that of {paths[0]}")
    print(f"{paths[0]}: {grounds[0].inside.sum()} within 5 to 95 %, rotational energy median "
          f"{np.nanmedian(grounds[0].spin):.2f} ({np.nanmin(grounds[0].spin):.2f} to {np.nanmax(grounds[0].spin):.2f})")


if __name__ == "__main__":
    if len(sys.argv) < 3:
        raise SystemExit("two tables at least are needed: impact_folds.py PRESET.txt OTHER.txt ...")
    main(sys.argv[1:])
