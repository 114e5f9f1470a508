"""Three avatars with three lists of names, side by side: what the films of docs/live.md and docs/speech.md show."""

import shutil
import subprocess

import vrm_body
from PIL import Image

WIDTH, HEIGHT = 240, 280


def run(*command):
    subprocess.run([str(word) for word in command], check=True)


def three(makehuman, targets, folder):
    """The viewer's arguments for each: the built-in face (joints and shapes); MakeHuman's head with ARKit's shapes, which
    lie in the folder `targets` beside visemes; and MakeHuman's body as a VRM, which has nothing but expressions for its face."""
    arkit = folder / "arkit"
    arkit.mkdir()
    for target in targets.glob("*.target"):
        if not target.name.startswith("viseme_"):
            shutil.copy(target, arkit)
    vrm = folder / "body.vrm"
    vrm.write_bytes(vrm_body.vrm(makehuman, targets))
    return [
        ["--hair", "bob"],
        [makehuman / "base.obj", "--with", arkit, "--frame", "face"],
        [vrm, "--frame", "face"],
    ]


def beside(frames):
    """One picture of several that lie next to each other."""
    picture = Image.new("RGB", (len(frames) * WIDTH, HEIGHT))
    for place, frame in enumerate(frames):
        picture.paste(Image.open(frame).convert("RGB"), (place * WIDTH, 0))
    return picture


def save(pictures, out, milliseconds, quality):
    """Moving pictures that show themselves in a document."""
    first, *others = pictures
    options = {"duration": milliseconds, "loop": 0, "quality": quality, "method": 2}
    first.save(out, save_all=True, append_images=others, **options)
