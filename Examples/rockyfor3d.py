"""Folders of Rockyfor3D: in, as a study of study.py; and a finished study out, as rasters of its names.

    bash Examples/run.sh rockyfor3d.py in FOLDER STUDY [--iterations N --trees-per hectare|cell]
    bash Examples/run.sh study.py RESULTS STUDY/study.json
    bash Examples/run.sh rockyfor3d.py out RESULTS FOLDER

FOLDER has ESRI ASCII rasters of one grid. STUDY gets sources, classes of ground, stems and nets as files, study.json
and notes.txt, which says what was taken how, and what of it is from memory. docs/rockyfor3d.md has the names.
"""
import argparse
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "rockyfor3d_parts"))

import folder_in
import folder_out
from grids import Bad


def arguments():
    parser = argparse.ArgumentParser(description="Folders of Rockyfor3D in and out.")
    ways = parser.add_subparsers(dest="way", required=True)
    way = ways.add_parser("in", help="a study of a folder of Rockyfor3D")
    way.add_argument("source", help="folder with dem.asc, rockdensity.asc, soiltype.asc …")
    way.add_argument("target", help="folder for the study")
    way.add_argument("--iterations", type=int, default=100, help="rocks of each source cell (100)")
    way.add_argument("--trees-per", choices=("hectare", "cell"), default="hectare", help="what nrtrees counts by (hectare)")
    way.add_argument("--seed", type=int, default=1, help="of the stems that are drawn (1)")
    way = ways.add_parser("out", help="rasters of a finished study")
    way.add_argument("source", help="folder of the study's results")
    way.add_argument("target", help="folder for the rasters")
    return parser.parse_args()


def main():
    chosen = arguments()
    try:
        os.makedirs(chosen.target, exist_ok=True)
        made = folder_in.convert(chosen.source, chosen.target, chosen.iterations, chosen.trees_per, chosen.seed) \
            if chosen.way == "in" else folder_out.convert(chosen.source, chosen.target)
    except Bad as bad:
        raise SystemExit(str(bad)) from None
    except OSError as error:
        raise SystemExit(f"{error.filename}: {error.strerror}") from None
    print(made)


main()
