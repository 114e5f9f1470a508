#!/usr/bin/env python3
"""Draws the film of docs/live.md: three avatars with three lists of names, driven by one recording of a phone.

    scripts/driven.py VIEWER TAKE.csv MAKEHUMAN OUT.webp

MAKEHUMAN is a folder with MakeHuman's base.obj and a folder `targets` of ARKit's shapes for it. On the left is the
built-in face (joints and shapes), in the middle the other head (shapes alone), and on the right a third one that has
nothing but expressions of VRM: `convert --shapes vrm` makes it. Needs Pillow."""

import subprocess
import sys
import tempfile
from pathlib import Path

from PIL import Image

WIDTH, HEIGHT = 240, 280
RATE = 15
LOOK = ["--quality", "low"]


def run(*command):
    subprocess.run([str(word) for word in command], check=True)


def main():
    viewer, take, makehuman, out = sys.argv[1:]
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        expressions = folder / "expressions.glb"
        run(viewer, "convert", "--identity", "seed:11", "--shapes", "vrm", "--out", expressions)
        avatars = [
            ["--hair", "bob"],
            [f"{makehuman}/base.obj", "--with", f"{makehuman}/targets", "--frame", "face"],
            [expressions, "--frame", "face"],
        ]
        films = []
        for place, avatar in enumerate(avatars):
            frames = folder / str(place)
            command = [viewer, "record", *avatar, "--clip", take, *LOOK]
            run(*command, "--fps", RATE, "--size", f"{WIDTH}x{HEIGHT}", "--out", f"{frames}/")
            films.append(sorted(frames.glob("*.png")))
        pictures = []
        for frames in zip(*films):
            picture = Image.new("RGB", (len(frames) * WIDTH, HEIGHT))
            for place, frame in enumerate(frames):
                picture.paste(Image.open(frame).convert("RGB"), (place * WIDTH, 0))
            pictures.append(picture)
        first, *others = pictures
        options = {"duration": round(1000 / RATE), "loop": 0, "quality": 70, "method": 2}
        first.save(out, save_all=True, append_images=others, **options)


main()
