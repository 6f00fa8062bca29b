"""From a slope, its rocks and the deposits to a comparison, a search and a report in a folder.

Whoever has a slope (a proxy of DEM to CFE Mesh), rocks (a proxy of what goes into Rockfall
Simulation), the observations and the number of each rock's forecast can call `compare`; calibrate.py
takes them from layers, validation/tschamut.py from the tables of a field test.
"""
import csv
import json
import os
import time

import numpy as np
from paraview.simple import RockfallSimulation

import site_map
import site_scores as scores
from rockfall_ground import Ground
from rockfall_tables import columns_of
from site_search import Fit, Search

started = time.time()


def say(text):
    print(f"[{time.time() - started:6.1f} s] {text}", flush=True)


def refuse(text):
    raise SystemExit(text)


def set_all(proxy, part, properties):
    """A name that the proxy has not is refused, and true where a number is meant: it would be 1."""
    for name, value in properties.items():
        try:
            truth = any(isinstance(one, bool) for one in (value if isinstance(value, list) else [value]))
            if truth and not proxy.GetProperty(name).SMProperty.FindDomain("vtkSMBooleanDomain"):
                raise ValueError("a number is meant")
            setattr(proxy, name, value)
        except (AttributeError, ValueError, TypeError, RuntimeError) as error:
            refuse(f'"{part}" {name}: {json.dumps(value, default=str)} cannot be set: {error}')


def made_by(proxy, port=0):
    """What a filter made; pvbatch is its own server, so nothing is copied."""
    data = proxy.GetClientSideObject().GetOutputDataObject(port)
    if data is None or data.GetNumberOfElements(6 if data.IsA("vtkTable") else 0) == 0:
        raise SystemExit(f"{proxy.GetXMLLabel()} made nothing; the message above says why.")
    return data


def of_rocks(columns):
    """A row for each rock: of one that broke the piece that got farthest, from where the rock was released, and the
    most of all pieces."""
    if "Piece" not in columns:
        return columns
    first = np.flatnonzero(columns["Piece"] == 0)
    sizes = np.diff([*first, len(columns["Piece"])])
    begin = {name: np.repeat(columns[name][first], sizes) for name in ("StartX", "StartY", "StartZ")}
    way = np.hypot(columns["StopX"] - begin["StartX"], columns["StopY"] - begin["StartY"])
    far = np.array([k + np.argmax(way[k:k + size]) for k, size in zip(first, sizes)], int)
    most = {name: np.maximum.reduceat(columns[name], first) for name in ("MaxSpeed", "MaxKineticEnergy")}
    columns = {name: np.asarray(values)[far] for name, values in {**columns, **begin}.items()}
    return {**columns, **most, "RunOut": way[far]}


class Site:
    """The pipeline of one place: `forecast` has for each rock the number of its forecast."""

    def __init__(self, slope, rocks, observed, forecast, simulation):
        self.slope, self.observed, self.forecast = slope, observed, np.asarray(forecast)
        self.ground = Ground(made_by(slope))
        self.simulation = RockfallSimulation(Terrain=slope, Rocks=rocks)
        simulation = dict(simulation)
        # Samples under way are of no use here.
        simulation.setdefault("OutputInterval", simulation.get("EndTime", self.simulation.EndTime))
        set_all(self.simulation, "simulation", simulation)

    def run(self, values):
        """Simulates with properties {name: value} of the slope."""
        for name, value in values.items():
            setattr(self.slope, name, float(value))
        self.simulation.UpdatePipeline(0.0)
        columns = columns_of(made_by(self.simulation, 3))
        # The columns belong to the filter, which reuses their memory.
        columns = of_rocks({name: np.array(column) for name, column in columns.items()})
        return scores.Simulated(self.observed, self.forecast[columns["RockId"]], columns)


def search(site, ranges, count, folds, seed, output):
    """The fit of `count` candidates within ranges {property: (low, high)}."""
    found = Search(ranges, ranges.values(), count)
    for k, values in enumerate(found.values):
        score = site.run(dict(zip(found.names, values))).as_scored(site.observed).scores(site.observed)
        found.add(score)
        found.write(os.path.join(output, "candidates.csv"))
        say(f"  candidate {k + 1} of {count}: " + ", ".join(f"{v:g}" for v in values) +
            f": run-out {score[:, scores.MEAN].mean():.1f} m, "
            f"energy score {score[:, scores.ES].mean():.2f} m")
    fit = Fit(found, site.observed, folds, seed)
    text = "\n".join(fit.lines())
    print(text)
    with open(os.path.join(output, "calibration.txt"), "w", encoding="utf-8") as file:
        file.write(text + "\n")
    site_map.draw_search(os.path.join(output, "search.png"), fit)
    return fit


def write_table(path, header, rows):
    with open(path + ".part", "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(header)
        writer.writerows(rows)
    os.replace(path + ".part", path)


def number(value):
    return "" if value is None else f"{value:.3f}"


def write_results(site, simulated, own, table, names, output):
    """`names` are those of the deposits, `own` their scores."""
    path = lambda name: os.path.join(output, name)
    write_table(path("comparison.csv"), ["What", "Unit", "Observed", "Simulated"],
                [[what, unit, number(seen), number(made)] for what, unit, seen, made in table])
    rows, observed = [], site.observed
    for k, score in enumerate(own):
        values = simulated.run_out[simulated.of(observed.forecast[k])]
        rows.append([names[k], observed.group[k], number(observed.run_out[k]), number(score[scores.MEAN])] +
                    [number(np.percentile(values, q)) for q in scores.QUANTILES] +
                    [number(score[column]) for column in (scores.CRPS, scores.ES, scores.RANK)])
    write_table(path("runs.csv"),
                ["Run", "Group", "ObservedRunOut_m", "MeanRunOut_m"] +
                [f"RunOut{q}_m" for q in scores.QUANTILES] + ["CRPS_m", "EnergyScore_m", "Rank"], rows)
    name_of = dict(zip(observed.forecast.tolist(), names))
    if len(name_of) < len(names):  # a forecast of several deposits has no deposit's name
        name_of = {forecast: forecast for forecast in name_of}
    write_table(path("stops.csv"), ["Run", "X", "Y", "RunOut_m", "Started", "FateCode"],
                [[name_of[forecast], f"{x:.3f}", f"{y:.3f}", f"{run:.3f}", int(moved), fate]
                 for forecast, (x, y), run, moved, fate in zip(
                     simulated.forecast.tolist(), simulated.stop, simulated.run_out, simulated.started,
                     simulated.fate)])


def print_table(table):
    print(f"\n{'':46}{'observed':>10}{'simulated':>11}")
    for what, unit, seen, made in table:
        print(f"{what + ', ' + unit:46}{'' if seen is None else f'{seen:.1f}':>10}{made:11.1f}")


def judged_lines(site, simulated):
    """The figures of validation.md as a table: of all that is simulated, and within the tracked ground."""
    observed = site.observed
    seen = observed.run_out.mean()
    lines = ["| | mean run-out | error | CRPS | energy score | within 5 to 95 % |", "|---|---|---|---|---|---|"]
    for what, own in scores.judgement(observed, simulated):
        mean = own[:, scores.MEAN].mean()
        lines.append(f"| {what} | {mean:.1f} m | {100 * (mean / seen - 1):+.1f} % | "
                     f"{own[:, scores.CRPS].mean():.1f} m | {own[:, scores.ES].mean():.1f} m | "
                     f"{100 * scores.covered(own):.0f} % |")
    lines += [f"| observed | {seen:.1f} m | | | | |",
              f"| without a model | | | {scores.climatology(observed):.1f} m | | |"]
    if observed.tracked:
        lines += ["", f"{100 * simulated.beyond(observed):.0f} % of the rocks go beyond the tracked ground; "
                      "within it their run-outs count as far as its edge."]
    return lines


def report(path, title, ground, table, judged, fit):
    """The whole of it as a page."""
    lines = [f"# {title}", "", *judged, "", "![Stopping points and run-outs](map.png)", "",
             "| ground | value | 90 % of the bootstrap |", "|---|---|---|"]
    spread = {name: f"{low:.4g} to {high:.4g}" for name, _, low, high, _ in fit.parameters()} \
        if fit else {}
    lines += [f"| {name} | {value:g} | {spread.get(name, 'not searched')} |"
              for name, value in ground.items()]
    if fit:
        lines += ["", "![Scores of the candidates](search.png)", "", "```text", *fit.lines(), "```"]
    lines += ["", "| | observed | simulated |", "|---|---|---|"]
    lines += [f"| {what}, {unit} | {'' if seen is None else f'{seen:.1f}'} | {made:.1f} |"
              for what, unit, seen, made in table]
    with open(path + ".part", "w", encoding="utf-8") as file:
        file.write("\n".join(lines) + "\n")
    os.replace(path + ".part", path)


def compare(site, values, names, title, output, fit=None):
    """Simulates with these values, prints, draws and writes everything into the folder."""
    simulated = site.run(values)
    say("Ground: " + ", ".join(f"{name} {value:g}" for name, value in values.items()))
    if not simulated.started.any():
        raise SystemExit(f"No rock ran farther than {scores.STARTED:g} m: nothing to compare.")
    observed = site.observed
    drop = np.array([site.ground.height(*start) - site.ground.height(*stop)
                     for start, stop in zip(observed.start, observed.stop)])
    table = scores.comparison(observed, simulated, drop)
    print_table(table)
    judged = judged_lines(site, simulated)
    print("", *judged, sep="\n")
    write_results(site, simulated, simulated.scores(observed), table, names, output)
    site_map.draw(os.path.join(output, "map.png"), site.ground, observed, simulated,
                  f"{title}: {len(names)} observed, {simulated.started.sum()} simulated")
    report(os.path.join(output, "report.md"), title, values, table, judged, fit)
    say(f"Written to {output}: report.md, map.png, comparison.csv, runs.csv, stops.csv")
