"""The page: figures and tables put into report.html by Jinja."""
import os
import time

import jinja2

import charts
import maps
import tables
from finished import name_of_crs, osr
from identity import version

HERE = os.path.dirname(os.path.abspath(__file__))


def duration(seconds):
    minutes, seconds = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours} h {minutes:02d} min" if hours else f"{minutes} min {seconds:02d} s" if minutes else f"{seconds} s"


def make(study, title=None, author="", other=None):
    """The text of the whole page; with the lines of another study beside those of this one."""
    families = study.lines_with_parallels()
    named = [(k, str(study.lines["LineName"][k])) for k in study.given_lines()] if study.lines else []
    curve, ends = charts.convergence(study, [name for _, name in named])
    lines = tables.lines(study) if study.lines else []
    sessions = study.manifest.get("sessions") or []
    settings = jinja2.Environment(loader=jinja2.FileSystemLoader(HERE), autoescape=True, trim_blocks=True,
                                  lstrip_blocks=True, undefined=jinja2.StrictUndefined)
    settings.filters["number"] = tables.number
    slope = study.slope
    date = time.strftime("%Y-%m-%d")
    crs = name_of_crs(osr.SpatialReference(slope.crs)) if slope.crs else "local coordinates"
    return settings.get_template("report.html").render(
        title=title or os.path.splitext(study.name)[0], author=author, date=date, study=study,
        version=version(), sessions=sessions, seconds=duration(sum(one["seconds"] for one in sessions)),
        crs=crs, size=(slope.heights.shape[1], slope.heights.shape[0]), cell=slope.cell,
        site=maps.site(study, f"Coordinates: {crs}, m.   {study.name}, {date}, {study.program}"),
        maps=maps.results(study) if study.map else [],
        ground=tables.ground(study), ground_source=tables.source_of(study), classed=tables.classed(study),
        rocks=tables.rocks(study), by_source=tables.sources(study), frequencies=tables.frequencies(study),
        structures=tables.structures(study), standing=tables.standing(study), often=tables.known_often(study), lines=lines,
        few=any(cell.endswith(tables.FEW) for table in lines for _, _, cells in table["rows"] for cell in cells),
        design=tables.design(study), freeboard=study.given.get("lines", {}).get("Freeboard", 0.5),
        exceedance=[charts.exceedance(study, some) for some in tables.slices(named)],
        best=[charts.best_place(study, name, rows) for name, rows in families if len(rows) > 1],
        convergence=curve, ends=ends, fates=tables.fates(study), notes=tables.notes(study),
        values=tables.values_in_force(study), preset=tables.has_preset(study), total=len(study.rocks), breaks=tables.breaks(study), beside=tables.beside(study, other) if other else None,
        sources=int((study.rocks["Iteration"] == study.rocks["Iteration"].min()).sum()))
