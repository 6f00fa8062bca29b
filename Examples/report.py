"""A report of a finished study: one HTML file with all its pictures, which prints on A4.

    bash Examples/run.sh report.py FOLDER [--output report.html] [--title "Site"] [--author "Office"]
        [--beside OTHER]

FOLDER is that of a study of study.py. The report has a map sheet, the inputs with their hashes, the ground, rocks
and structures, maps of the hazard, what passes the lines, how sure it is with so many rocks, what was lost, and
the values in force. It is made of the study's files alone; inputs that changed since are refused.
docs/report.md says what is where.
"""
import argparse
import os
import sys

here = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [here, os.path.join(here, "study_parts"), os.path.join(here, "report_parts")]

import page
import schema
from finished import Study
from wholefile import write_text


def arguments():
    parser = argparse.ArgumentParser(description="A report of a finished study, as one HTML file.")
    parser.add_argument("folder", help="folder of a study that study.py finished")
    parser.add_argument("--output", help="the file (report.html in the folder)")
    parser.add_argument("--title", help="what stands above it (the name of the study's file)")
    parser.add_argument("--author", default="", help="who is responsible for it")
    parser.add_argument("--beside", metavar="OTHER", help="folder of a variant, whose lines stand beside these")
    return parser.parse_args()


def main():
    chosen = arguments()
    path = chosen.output or os.path.join(chosen.folder, "report.html")
    try:
        study = Study(chosen.folder)
        other = Study(chosen.beside) if chosen.beside else None
        write_text(path, page.make(study, chosen.title, chosen.author, other))
    except schema.Bad as bad:
        raise SystemExit(str(bad)) from None
    except OSError as error:
        raise SystemExit(f"{error.filename}: {error.strerror}") from None
    print(f"Report: {path}")


main()
