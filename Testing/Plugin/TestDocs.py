"""The pages of docs/ say what the plugin has: properties and defaults as in its XML, scripts that run,
the arrays and columns that come out of them, names that are in the code, links that lead somewhere."""

import glob
import os
import pathlib
import re
import sys
import tempfile
import xml.etree.ElementTree as ElementTree

import paraview.simple

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
DOCS = os.path.join(ROOT, "docs")

# page, name of its proxy in the XML, the script's variable that has the proxy
PAGES = [
    ("DEMtoCFEMesh", "DEMToCFEMesh", "slope"),
    ("RockBlocks", "RockBlocks", "rocks"),
    ("RockRelease", "RockRelease", "release"),
    ("DrawnStructure", "DrawnStructure", "net"),
    ("JointedRockMass", "JointedRockMass", "mass"),
    ("RockfallSimulation", "RockfallSimulation", "fall"),
    ("DispersionAngle", "DispersionAngle", "angle"),
    ("RockfallHazardMap", "RockfallHazardMap", "hazard"),
    ("TrajectoryCollector", "TrajectoryCollector", "collector"),
    ("design", "BarrierDesign", "design"),
    ("TrajectoryProfile", "TrajectoryProfile", "profile"),
    ("GrowingPaths", "GrowingPaths", "paths"),
    ("HazardPassages", "HazardPassageReader", "hazard"),
    ("MergeCollectors", "MergeCollectors", "merged"),
]
TYPES = {"vtkDoubleArray": "double", "vtkFloatArray": "float", "vtkIntArray": "int", "vtkIdTypeArray": "id",
         "vtkStringArray": "text", "vtkUnsignedCharArray": "byte"}

failures = []


def expect(truth, message):
    if not truth:
        failures.append(message)


def read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def rows_of(text, *header):
    """Rows of all tables whose head begins with these words, as lists of cells."""
    rows, inside = [], False
    for line in text.splitlines():
        if not line.startswith("|"):
            inside = False
            continue
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
        if cells[:len(header)] == list(header):
            inside = True
        elif inside and not set(line) <= set("|-: "):
            rows.append(cells)
    return rows


def name_in(cell):
    return cell.strip("`")


def same(default, documented):
    """Defaults as written, numbers by value."""
    numbers = r"[-+]?\d[\d.]*(?:[eE][-+]?\d+)?"
    if re.fullmatch(rf"{numbers}( {numbers})*", default):
        return re.fullmatch(rf"{numbers}( {numbers})*", documented) and \
            [float(n) for n in default.split()] == [float(n) for n in documented.split()]
    return default == documented


def properties_of(proxy):
    """{name: default as a page writes it} of a proxy's XML."""
    result = {}
    for item in proxy:
        if not item.tag.endswith("Property"):
            continue
        default = item.get("default_values")
        entries = {e.get("value"): e.get("text") for e in item.iterfind("EnumerationDomain/Entry")}
        if default is None:
            default = "–"
        elif item.find("BooleanDomain") is not None:
            default = "on" if default == "1" else "off"
        elif default in entries:
            default = entries[default]
        result[item.get("name")] = default or "empty"
    return result


def arrays_of(data):
    """{(where, name): type} of all arrays of a data object."""
    result = {}
    for where, method in (("point", "GetPointData"), ("cell", "GetCellData"),
                          ("row", "GetRowData"), ("field", "GetFieldData")):
        arrays = getattr(data, method)() if hasattr(data, method) else None
        for k in range(arrays.GetNumberOfArrays() if arrays else 0):
            array = arrays.GetAbstractArray(k)
            parts = array.GetNumberOfComponents()
            kind = TYPES.get(array.GetClassName(), array.GetClassName())
            result[where, array.GetName()] = kind + (f" ×{parts}" if parts > 1 else "")
    return result


def documented_arrays(section):
    """{(where, name): type} of a section's tables; a row may have several names and places."""
    result = {(where, name): row[2]
              for row in rows_of(section, "Array", "On", "Type", "Unit")
              for where in row[1].split(", ") for name in re.findall(r"`(\w+)`", row[0])}
    result.update({("row", name): row[1]
                   for row in rows_of(section, "Column", "Type", "Unit") for name in re.findall(r"`(\w+)`", row[0])})
    return result


def outputs_of(page):
    """What a page says of its outputs: arrays that several ports have, and [(port, its section)]."""
    path = os.path.join(DOCS, page + "Output.md")  # where there are many arrays
    text = read(path if os.path.exists(path) else os.path.join(DOCS, page + ".md"))
    shared, *sections = re.split(r"^### Port (\d+)", text.split("\n## Output")[1].split("\n## ")[0], flags=re.MULTILINE)
    return documented_arrays(shared), list(zip(map(int, sections[::2]), sections[1::2]))


def borrowed_arrays(section, port):
    """Those of another page, where a section says so: Arrays of [Rock Blocks](RockBlocks.md), or Arrays of port 1
    of [Rockfall Simulation](RockfallSimulationOutput.md)."""
    found = re.search(r"Arrays of (?:port (\d+) of )?\[[^]]*\]\((\w+)\.md", section)
    if not found:
        return {}
    shared, sections = outputs_of(found.group(2))
    return {**shared, **documented_arrays(dict(sections)[int(found.group(1) or port)])}


proxies = {}
for path in glob.glob(os.path.join(ROOT, "Plugin", "xml", "*.xml")):
    for found in ElementTree.parse(path).getroot().iter("SourceProxy"):
        if not (found.get("base_proxyname") and found.find("Hints/ReaderFactory") is not None):  # another name only
            proxies[found.get("name")] = found
expect(set(proxies) == {proxy for _, proxy, _ in PAGES},
       f"the XML has the proxies {sorted(proxies)}, there are pages for {[p[1] for p in PAGES]}")

known = set()  # every property, array and column
for page, proxy, variable in PAGES:
    text = read(os.path.join(DOCS, page + ".md"))

    rows = rows_of(text, "Property", "Unit", "Default", "Meaning")
    documented = {name_in(row[0]): row[2] for row in rows}
    expect(len(documented) == len(rows), f"{page}.md names a property twice")
    expected = properties_of(proxies[proxy])
    known |= set(expected)
    for name in sorted(set(expected) - set(documented)):
        expect(False, f"{page}.md does not name the property {name}")
    for name in sorted(set(documented) - set(expected)):
        expect(False, f"{page}.md names the property {name}, which the XML does not have")
    for name in sorted(set(documented) & set(expected)):
        expect(same(expected[name], documented[name]),
               f"{page}.md: default of {name} is {documented[name]}, in the XML {expected[name]}")
    advanced = {item.get("name") for item in proxies[proxy]
                if item.get("panel_visibility") == "advanced"}
    told = {name_in(row[0]) for row in rows if row[3].endswith("*Advanced.*")}
    expect(told == advanced, f"{page}.md: advanced are {sorted(told)}, in the XML {sorted(advanced)}")

    scripts = re.findall(r"^```python\n(.*?)^```", text, re.MULTILINE | re.DOTALL)
    expect(scripts, f"{page}.md has no script")
    scope = {}
    for script in scripts:
        exec(compile(script, page + ".md", "exec"), scope)
    result = scope[variable].GetClientSideObject()
    shared, sections = outputs_of(page)
    used = set()
    expect([number for number, _ in sections] == list(range(result.GetNumberOfOutputPorts())),
           f"{page}.md describes the ports {[number for number, _ in sections]}")
    for number, section in sections:
        data = result.GetOutputDataObject(number)
        expect("Empty without" in section or data.GetNumberOfElements(6 if data.IsA("vtkTable") else 1) > 0,
               f"{page}.md: its script leaves port {number} empty")
        made, told = arrays_of(data), documented_arrays(section)
        known |= {name for _, name in made}
        used |= set(shared) & set(made)
        others = {**shared, **borrowed_arrays(section, number)}
        told = {**{key: kind for key, kind in others.items() if key in made}, **told}
        if "slope's field arrays" in section:  # which are on the page of slopes
            made = {key: kind for key, kind in made.items()
                    if key in told or key[0] != "field" or not re.match("Terrain|LocalOrigin", key[1])}
        for key in sorted(set(made) | set(told)):
            expect(made.get(key) == told.get(key),
                   f"{page}.md, port {number}: {' array '.join(key)} is {told.get(key)}, "
                   f"the filter makes {made.get(key)}")
    expect(used == set(shared), f"{page}.md: no port has {sorted(set(shared) - used)}")
    for source in list(paraview.simple.GetSources().values()):
        paraview.simple.Delete(source)

# Notation: its names are in the code and in ParaView.
code = set(re.findall(r"\w+", "\n".join(
    read(path) for path in glob.glob(os.path.join(ROOT, "Core", "**", "*.h"), recursive=True))))
symbols = rows_of(read(os.path.join(DOCS, "notation.md")), "Symbol", "In the code", "In ParaView")
expect(len(symbols) > 30, f"notation.md has {len(symbols)} symbols only")
for row in symbols:
    expect(len(row) == 6, f"notation.md: {row} has {len(row)} cells")
    for name in re.findall(r"`(\w+)`", row[1]):
        expect(name in code or name + "_" in code, f"notation.md: {name} is not in the Core")
    for name in re.findall(r"`(\w+)`", row[2]):
        expect(name in known, f"notation.md: {name} is no property, array or column")

# Links between the pages, and to their headings.
def anchors_of(text):
    """Anchors of a page's headings, as GitHub makes them."""
    headings = re.findall(r"^#+ (.*)$", re.sub(r"^```.*?^```", "", text, flags=re.MULTILINE | re.DOTALL), re.MULTILINE)
    return {re.sub(r"[^\w -]", "", heading.lower()).replace(" ", "-") for heading in headings}


pages = {os.path.basename(path): read(path) for path in sorted(glob.glob(os.path.join(DOCS, "*.md")))}
for page, text in pages.items():
    for target, anchor in re.findall(r"\]\(([^)#:\s]*)(?:#([^)]*))?\)", text):
        expect(os.path.exists(os.path.join(DOCS, target)), f"{page} links to {target}, which is not there")
        if anchor and (target or page) in pages:
            expect(anchor in anchors_of(pages[target or page]),
                   f"{page} links to {target}#{anchor}, which is no heading there")


# People read pages that are short. Signs of tables are no words.
def words_in(text):
    return sum(any(c.isalnum() for c in word) for word in text.split())


LONG = {"DEMtoCFEMesh.md": 1600, "architecture.md": 2500, "bad_input.md": 1600, "formats.md": 1950, "materials.md": 1600, "method.md": 1900, "notation.md": 1550, "performance.md": 950,
        "validation.md": 1700}
for page, text in pages.items():
    most = LONG.get(page, 1500)
    expect(words_in(text) <= most, f"{page} has {words_in(text)} words, at most {most} are read")
    for paragraph in re.split(r"\n\s*\n|\n(?=[-*|] |\d+\. )", text):
        if not paragraph.startswith(("|", "    ", "```")):
            expect(words_in(paragraph) <= 120, f"{page} has a paragraph of {words_in(paragraph)} words: {paragraph[:60]}")
total = sum(len(text.split()) for text in pages.values())
expect(total <= 51200, f"docs/ has {total} words, at most 51,200 are read")

# Messages on the page of bad input are in the code. … stands for what is put in.
sources = [path for folder in ("Core", "Filters", "Examples")
           for path in glob.glob(os.path.join(ROOT, folder, "**", "*.*"), recursive=True)
           if path.endswith((".cxx", ".h", ".py"))]
spoken = "\n".join(map(read, sources)) + read(os.path.join(DOCS, "data", "bad_input.csv"))
spoken = re.sub(r'"\s*\n\s*f?"', "", spoken).replace('\\"', '"').replace('""', '"').lower()
for line in pages["bad_input.md"].splitlines():
    for phrase in re.findall(r"\*([^*]+)\*", line.split(" | ")[0]) if line.startswith("| *") else []:
        for piece in phrase.split("…"):
            expect(piece.strip().lower() in spoken, f"bad_input.md: nothing says {piece.strip()}")

# The page of verification is what its maker makes of the table beside it.
sys.path.insert(0, os.path.join(ROOT, "Testing", "Verification"))
import makePage  # noqa: E402

figures = makePage.read_data(os.path.join(DOCS, "data", "verification.csv"))
page = makePage.page_of(figures, [], [], pathlib.Path(DOCS, "images", "verification"))
expect("## Beside the figures" in pages["verification.md"] or page == pages["verification.md"],
       "verification.md is not of its table: python3 Testing/Verification/makePage.py --docs docs")

# What the code cites as METHOD n or n.m is a section of the page, or a numbered line of it.
sections = dict(re.findall(r"^## (\d+)\. [^\n]*\n(.*?)(?=^## |\Z)", read(os.path.join(DOCS, "method.md")),
                           re.MULTILINE | re.DOTALL))
for path in glob.glob(os.path.join(ROOT, "Core", "*", "*.[hc]*")):
    for section, line in re.findall(r"METHOD (\d+)(?:\.(\d+))?", read(path)):
        expect(section in sections and (not line or re.search(rf"^(\| )?{line}[.]? ", sections[section], re.MULTILINE)),
               f"{path} cites METHOD {section}{'.' + line if line else ''}, which docs/method.md does not have")

# The panel says of each preset what supports it, as the page does.
presets = [f"{row[0]} ({row[1]})" for row in rows_of(read(os.path.join(DOCS, "materials.md")), "Preset", "Support")]
labels = [entry.get("text") for entry in
          proxies["DEMToCFEMesh"].iterfind("IntVectorProperty[@name='Preset']/EnumerationDomain/Entry")][1:]
expect(presets == labels, f"materials.md has the presets {presets}, the panel {labels}")

# Behind ? every formula of a page is a picture.
sys.path.insert(0, os.path.join(ROOT, "Plugin", "help"))
import makePages  # noqa: E402

with tempfile.TemporaryDirectory() as folder:
    makePages.main(DOCS, os.path.join(ROOT, "Plugin", "xml"), folder)
    for page, text in pages.items():
        made = read(os.path.join(folder, page[:-3] + ".html"))
        pictures = re.findall(r'<img src="(formulas/\w+\.png)"', made)
        told = len(re.findall(r"^\$\$", text, re.MULTILINE)) + text.count("$`")
        expect(len(pictures) == told, f"{page} has {told} formulas, {len(pictures)} of them are pictures behind ?")
        for picture in pictures:
            expect(os.path.getsize(os.path.join(folder, picture)) > 200, f"{page}: {picture} is empty")
    expect("formulas/" in read(os.path.join(folder, "method.html")), "method.md has no typeset formulas")

if failures:
    raise SystemExit("\n".join(failures))
print("the pages say what there is")
