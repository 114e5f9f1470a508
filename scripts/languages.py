#!/usr/bin/env python3
"""Draws the film of docs/speech.md in which three avatars say a German sentence and an
English one.

    scripts/languages.py VIEWER MAKEHUMAN OUT.mp4 OUT.webp

MAKEHUMAN is a folder with MakeHuman's base.obj and a folder `targets` of ARKit's shapes for it. On the left is the
built-in face, in the middle the other head, which has shapes alone, and on the right a third one that has nothing
but expressions of VRM: `convert --shapes vrm` makes it. Needs espeak-ng, ffmpeg and Pillow."""

import subprocess
import sys
import tempfile
from pathlib import Path

from PIL import Image

WIDTH, HEIGHT = 240, 280
RATE = 25
SENTENCES = [
    ("de", "Guten Tag! Wir bewegen alle die Lippen, jeder nach seiner Art, und meinen dieselben Laute."),
    ("en", "And now the same in English: all of us move our lips, each in our own way."),
]


def run(*command):
    subprocess.run([str(word) for word in command], check=True)


def main():
    viewer, makehuman, film, moving = sys.argv[1:]
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        expressions = folder / "expressions.glb"
        run(viewer, "convert", "--identity", "seed:11", "--shapes", "vrm", "--out", expressions)
        avatars = [
            ["--hair", "bob"],
            [f"{makehuman}/base.obj", "--with", f"{makehuman}/targets", "--frame", "face"],
            [expressions, "--frame", "face"],
        ]
        pictures = []
        parts = []
        for voice, text in SENTENCES:
            films = []
            for place, avatar in enumerate(avatars):
                frames = folder / f"{voice}{place}"
                command = [viewer, "speak", *avatar, "--say", text, "--voice", voice, "--life", "lively", "--seed", "3"]
                command += ["--quality", "low", "--fps", RATE, "--size", f"{WIDTH}x{HEIGHT}", "--out", f"{frames}/"]
                run(*command)
                films.append(sorted(frames.glob("*.png")))
            beside = folder / voice
            beside.mkdir()
            for number, frames in enumerate(zip(*films)):
                picture = Image.new("RGB", (len(frames) * WIDTH, HEIGHT))
                for place, frame in enumerate(frames):
                    picture.paste(Image.open(frame).convert("RGB"), (place * WIDTH, 0))
                picture.save(beside / f"{number:04}.png")
                pictures.append(picture)
            part = folder / f"{voice}.mp4"
            sound = next((folder / f"{voice}0").glob("*.wav"))
            encode = ["ffmpeg", "-y", "-loglevel", "error", "-framerate", RATE, "-i", beside / "%04d.png", "-i", sound]
            encode += ["-af", "apad", "-shortest", "-c:v", "libx264", "-crf", 26, "-pix_fmt", "yuv420p"]
            run(*encode, "-c:a", "aac", "-b:a", "64k", part)
            parts.append(f"file '{part}'\n")
        listed = folder / "parts.txt"
        listed.write_text("".join(parts))
        join = ["ffmpeg", "-y", "-loglevel", "error", "-f", "concat", "-safe", 0, "-i", listed, "-c", "copy"]
        run(*join, "-movflags", "+faststart", film)
        # Without sound, in a third of the pictures: what shows itself in a document.
        first, *others = pictures[::3]
        options = {"duration": round(3000 / RATE), "loop": 0, "quality": 55, "method": 2}
        first.save(moving, save_all=True, append_images=others, **options)


main()
