"""The folders of Core/ and Filters/ include what docs/architecture.md says, without a cycle, and none is
larger than one takes in."""

import collections
import pathlib
import re

ROOT = pathlib.Path(__file__).resolve().parents[2]
LARGEST = 35  # files
failures = []


def rooms_of(head):
    """Folder -> folders that it may include, of the table of the page with this head."""
    rooms, inside = {}, False
    for line in (ROOT / "docs/architecture.md").read_text(encoding="utf-8").splitlines():
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
        if cells == [head, "what it holds", "includes"]:
            inside = True
        elif not line.startswith("|"):
            inside = False
        elif inside and not set(line) <= set("|- "):
            rooms[cells[0].strip("`").rstrip("/")] = re.findall(r"`([\w/]+)`", cells[2])
    return rooms


def reached(rooms, room, on_the_way=()):
    """All that a folder may include, directly or through others."""
    if room in on_the_way:
        failures.append(f"a cycle of folders: {' -> '.join(on_the_way + (room,))}")
        return set()
    below = set(rooms[room])
    for other in rooms[room]:
        if other not in rooms:
            failures.append(f"{room} may include {other}, which is no folder of the table")
        else:
            below |= reached(rooms, other, on_the_way + (room,))
    return below


for top, head in (("Core", "folder"), ("Filters", "folder of Filters")):
    rooms = rooms_of(head)
    if not rooms:
        failures.append(f"docs/architecture.md has no table of the folders of {top}")
    sizes = collections.Counter()
    for path in sorted((ROOT / top).rglob("*")):
        if path.suffix not in (".h", ".cxx"):
            continue
        folder = path.parent.relative_to(ROOT / top).as_posix()
        sizes[folder] += 1
        room = "base" if folder == "base/text" else folder  # one layer
        if room not in rooms:
            failures.append(f"{top}/{folder} is not in docs/architecture.md")
            continue
        allowed = reached(rooms, room) | {room, "base", "base/text"}
        for name in re.findall(r'#include "([^"]+)"', path.read_text(encoding="utf-8")):
            included = ROOT / top / name
            if included.exists():
                other = included.parent.relative_to(ROOT / top).as_posix()
                if other not in allowed:
                    failures.append(f"{top}/{folder}/{path.name} includes {name}; the page has no such arrow")
    for folder, count in sizes.items():
        if count > LARGEST:
            failures.append(f"{top}/{folder} has {count} files, more than {LARGEST}")

for failure in failures:
    print(failure)
assert not failures, f"{len(failures)} failures"
