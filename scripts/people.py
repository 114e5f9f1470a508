#!/usr/bin/env python3
"""Draws the two dozen people of docs/marsienne.md, the seeds 1 to 24, into one picture:

    scripts/people.py VIEWER OUT.webp

Faces, skins and irises are what the seeds draw; style and colour of hair are chosen here. Needs Pillow."""

import subprocess
import sys
import tempfile
from pathlib import Path

from PIL import Image

EDGE = 224
COLUMNS = 6
# One for each seed, in their order.
HAIR = (
    "bob dark-brown, short black, long brown, curly dark-brown, short brown, bob red, "
    "long black, short gray, curly black, bob blond, mohawk dark-brown, long light-brown, "
    "short dark-brown, bob black, curly red, long dark-brown, short white, bob brown, "
    "short light-brown, long blond, curly brown, bob gray, short black, long red"
)


def main():
    viewer, out = sys.argv[1:]
    people = [person.split() for person in HAIR.split(", ")]
    rows = -(-len(people) // COLUMNS)
    sheet = Image.new("RGB", (COLUMNS * EDGE, rows * EDGE))
    with tempfile.TemporaryDirectory() as folder:
        picture = Path(folder) / "person.png"
        for place, (style, color) in enumerate(people):
            command = [viewer, "render", "--identity", f"seed:{place + 1}", "--hair", style, "--hair-color", color]
            command += ["--frame", "face", "--quality", "high", "--size", f"{EDGE}x{EDGE}", "--out", picture]
            subprocess.run(command, check=True)
            at = (place % COLUMNS * EDGE, place // COLUMNS * EDGE)
            sheet.paste(Image.open(picture).convert("RGB"), at)
    sheet.save(out, quality=82, method=6)


main()
