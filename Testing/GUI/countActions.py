"""Counts what a user does in recorded events: every click, choice and entry, but no checks, pauses or pictures.

    countActions.py events.xml most"""
import sys
import xml.etree.ElementTree as ElementTree

events, most = sys.argv[1], int(sys.argv[2])
done = [event for event in ElementTree.parse(events).getroot().iter("pqevent")
        if event.get("command") != "pause" and event.get("arguments") != "actionPicture"]
print(f"{len(done)} actions, at most {most} are wanted")
if len(done) > most:
    raise SystemExit(1)
