"""The pages behind ? in ParaView's window: docs/*.md as HTML, under the names that ParaView looks for.

    makePages.py docs Plugin/xml folder

Writes <group>.<proxy>.html for each source, filter and reader, <page>.html for the other pages, the pictures,
the tables and RockfallDDA.qhp, of which Qt's qhelpgenerator makes the file that the window opens. Formulas, $`...`$ in
a line and $$...$$ by themselves, are pictures that matplotlib makes: that window knows no MathML. Without matplotlib
they stay TeX."""

import glob
import hashlib
import html
import importlib.util
import os
import re
import shutil
import sys
import xml.etree.ElementTree as ElementTree

# Pages that do not bear the name of their proxy.
PAGES = {"BarrierDesign": "design", "DEMToCFEMesh": "DEMtoCFEMesh", "HazardPassageReader": "HazardPassages",
         "HazardPassageWriter": "HazardPassages", "HazardMapWriter": "Exports", "TrajectoryLayerWriter": "Exports"}

formulas = {}  # by file: TeX and size, pt
INLINE, DISPLAYED = 11, 13  # pt


def picture_of(tex, size):
    name = f"formulas/{hashlib.sha1(f'{size} {tex}'.encode()).hexdigest()[:12]}.png"
    formulas[name] = (tex, size)
    return f'<img src="{name}" alt="{html.escape(tex)}" style="vertical-align: middle"/>'


def draw_formulas(folder):
    """Writes the pictures of all formulas so far."""
    from matplotlib import rcParams
    from matplotlib.figure import Figure
    rcParams["mathtext.fontset"] = "stix"
    os.makedirs(os.path.join(folder, "formulas"), exist_ok=True)
    for name, (tex, size) in formulas.items():
        figure = Figure()
        figure.text(0, 0, f"${tex}$", size=size)
        try:
            figure.savefig(os.path.join(folder, name), dpi=110, bbox_inches="tight", pad_inches=0.02)
        except ValueError as error:
            raise SystemExit(f"makePages: {tex} is no formula to matplotlib: {error}")


DRAWS = importlib.util.find_spec("matplotlib") is not None


def spans(text, links):
    """Marks within a line; what stands in `code` is left alone."""
    parts = re.split(r"(\$?`[^`]+`\$?)", text)
    for k, part in enumerate(parts):
        if part.startswith("$`") and DRAWS:
            parts[k] = picture_of(part[2:-2], INLINE)
            continue
        if part.startswith("`") and len(part) > 1:
            parts[k] = f"<code>{html.escape(part[1:-1], quote=False)}</code>"
            continue
        part = html.escape(part, quote=False)
        part = re.sub(r"!\[([^\]]*)\]\(([^)]+)\)", r'<img src="\2" alt="\1" width="640"/>', part)
        part = re.sub(r"\*\*(.+?)\*\*", r"<b>\1</b>", part)
        part = re.sub(r"(?<![\w*])\*([^*\s][^*]*)\*(?![\w*])", r"<i>\1</i>", part)
        parts[k] = part

    def link(match):
        page, hash_mark, anchor = match.group(2).partition("#")
        return f'<a href="{links.get(page, page)}{hash_mark}{anchor}">{match.group(1)}</a>'
    return re.sub(r"(?<!!)\[([^\]]+)\]\(([^)]+)\)", link, "".join(parts))


def anchor_of(title):
    return re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-")


def to_html(text, links):
    out, lines, k = [], text.split("\n"), 0
    while k < len(lines):
        line = lines[k]
        if line.startswith("```"):
            end = next(n for n in range(k + 1, len(lines)) if lines[n].startswith("```"))
            out.append(f"<pre>{html.escape(chr(10).join(lines[k + 1:end]), quote=False)}</pre>")
            k = end + 1
        elif line.startswith("$$") and DRAWS:
            out.append(f"<p>{picture_of(line.strip('$'), DISPLAYED)}</p>")
            k += 1
        elif line.startswith("    ") and (not out or not out[-1].startswith("<ul>")):
            end = k
            while end < len(lines) and (lines[end].startswith("    ") or not lines[end].strip()):
                end += 1
            out.append(f"<pre>{html.escape(chr(10).join(lines[k:end]).rstrip(), quote=False)}</pre>")
            k = end
        elif match := re.match(r"(#+) (.*)", line):
            level = len(match.group(1))
            out.append(f'<h{level}><a name="{anchor_of(match.group(2))}"></a>{spans(match.group(2), links)}</h{level}>')
            k += 1
        elif line.startswith("|"):
            rows = []
            while k < len(lines) and lines[k].startswith("|"):
                rows.append([cell.strip() for cell in re.split(r"(?<!\\)\|", lines[k].strip()[1:-1])])
                k += 1
            body = "".join(
                "<tr>" + "".join(f"<{tag}>{spans(cell, links)}</{tag}>" for cell in row) + "</tr>\n"
                for n, row in enumerate(rows) if n != 1 for tag in ["th" if n == 0 else "td"])
            out.append(f'<table border="1" cellspacing="0" cellpadding="4">\n{body}</table>')
        elif re.match(r"(- |\d+\. )", line):
            kind = "ul" if line.startswith("- ") else "ol"
            items = []
            while k < len(lines) and (re.match(r"(- |\d+\. )", lines[k]) or (lines[k].startswith("  ") and lines[k].strip())):
                if match := re.match(r"(?:- |\d+\. )(.*)", lines[k]):
                    items.append(match.group(1))
                else:
                    items[-1] += " " + lines[k].strip()
                k += 1
            out.append(f"<{kind}>" + "".join(f"<li>{spans(item, links)}</li>" for item in items) + f"</{kind}>")
        elif line.strip():
            paragraph = []
            while k < len(lines) and lines[k].strip() and not re.match(r"(#|\||```|- )", lines[k]):
                paragraph.append(lines[k])
                k += 1
            out.append(f"<p>{spans(' '.join(paragraph), links)}</p>")
        else:
            k += 1
    return "\n".join(out)


def names_of(xml_folder, docs):
    """{name of a proxy's page in ParaView: page of docs/}; readers have that of the source they are."""
    names = {}
    for path in sorted(glob.glob(os.path.join(xml_folder, "*.xml"))):
        for group in ElementTree.parse(path).getroot().iter("ProxyGroup"):
            for proxy in group:
                if not proxy.tag.endswith("Proxy"):
                    continue
                name = proxy.get("name")
                for candidate in (name, proxy.get("base_proxyname")):
                    page = PAGES.get(candidate, candidate)
                    if page and os.path.exists(os.path.join(docs, page + ".md")):
                        names[f"{group.get('name')}.{name}"] = page
                        break
                else:
                    raise SystemExit(f"makePages: {name} has no page in {docs}")
    return names


def main(docs, xml_folder, folder):
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)
    names = names_of(xml_folder, docs)
    pages = [os.path.basename(path)[:-3] for path in sorted(glob.glob(os.path.join(docs, "*.md")))]
    links = {page + ".md": page + ".html" for page in pages}
    titles = {}
    for page in pages:
        with open(os.path.join(docs, page + ".md"), encoding="utf-8") as file:
            text = file.read()
        titles[page] = re.match(r"# (.*)", text).group(1)
        # In ASCII: ParaView's help window takes pages for Latin-1.
        content = (f"<html><head><title>{html.escape(titles[page])}</title></head>\n<body>\n{to_html(text, links)}\n"
                   "</body></html>\n").encode("ascii", "xmlcharrefreplace")
        for name in [page] + [name for name, of in names.items() if of == page]:
            with open(os.path.join(folder, name + ".html"), "wb") as file:
                file.write(content)
    if formulas:
        draw_formulas(folder)
    pictures = [os.path.relpath(path, docs) for path in glob.glob(os.path.join(docs, "images", "**", "*.png"), recursive=True)]
    for picture in pictures:
        os.makedirs(os.path.dirname(os.path.join(folder, picture)), exist_ok=True)
        shutil.copy(os.path.join(docs, picture), os.path.join(folder, picture))
    tables = sorted(os.path.relpath(path, docs) for path in glob.glob(os.path.join(docs, "data", "*.csv")))
    for table in tables:
        os.makedirs(os.path.dirname(os.path.join(folder, table)), exist_ok=True)
        shutil.copy(os.path.join(docs, table), os.path.join(folder, table))
    files = [name + ".html" for name in pages + sorted(names)] + sorted(pictures) + sorted(formulas) + tables
    contents = "\n".join(f'<section title="{html.escape(titles[page])}" ref="{page}.html"/>'
                         for page in pages if page != "README")
    with open(os.path.join(folder, "RockfallDDA.qhp"), "w", encoding="utf-8") as file:
        file.write(f"""<?xml version="1.0" encoding="UTF-8"?>
<QtHelpProject version="1.0">
<namespace>RockfallDDA.pages</namespace>
<virtualFolder>RockfallDDA</virtualFolder>
<filterSection>
<toc><section title="Rockfall DDA" ref="README.html">
{contents}
</section></toc>
<files>
{chr(10).join(f"<file>{name}</file>" for name in files)}
</files>
</filterSection>
</QtHelpProject>
""")


if __name__ == "__main__":
    main(*sys.argv[1:])
