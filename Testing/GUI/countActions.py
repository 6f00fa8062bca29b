"""Counts what a user does in recorded events: every click, choice and entry, but no checks, pauses or pictures.

    countActions.py events.xml most [most ...]

Of several numbers the first is for what is done between the first picture and the second, and so on. A choice from a
menu, or a click of the mouse, is one action there."""
import sys
import xml.etree.ElementTree as ElementTree

events, mosts = sys.argv[1], list(map(int, sys.argv[2:]))
parts = [[]]
for event in ElementTree.parse(events).getroot().iter("pqevent"):
    if event.get("arguments") == "actionPicture":
        parts.append([])
    elif event.get("command") != "pause" and event.get("arguments") != "actionCheck":
        parts[-1].append(event)
if len(mosts) == 1:
    counts = [sum(map(len, parts))]
else:
    counts = [sum(event.get("command") != "mouseRelease" and not event.get("object").endswith("menubar") for event in part)
              for part in parts[1:1 + len(mosts)]]
for count, most in zip(counts, mosts, strict=True):
    print(f"{count} actions, at most {most} are wanted")
    if count > most:
        raise SystemExit(1)
