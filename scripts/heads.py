"""Three avatars with three lists of names, side by side: what the films of docs/live.md and docs/speech.md show."""

import json
import struct
import subprocess

from PIL import Image

WIDTH, HEIGHT = 240, 280


def run(*command):
    subprocess.run([str(word) for word in command], check=True)


def three(viewer, makehuman, folder):
    """The viewer's arguments for each: the built-in face (joints and shapes); MakeHuman's head, whose folder holds
    base.obj and a folder `targets` of ARKit's shapes for it; and a VRM, which has nothing but expressions."""
    glb, vrm = folder / "expressions.glb", folder / "expressions.vrm"
    run(viewer, "convert", "--identity", "seed:11", "--shapes", "vrm", "--out", glb)
    vrm.write_bytes(as_vrm(glb.read_bytes()))
    return [
        ["--hair", "bob"],
        [f"{makehuman}/base.obj", "--with", f"{makehuman}/targets", "--frame", "face"],
        [vrm, "--frame", "face"],
    ]


def as_vrm(glb):
    """A GLB whose shapes have the names of VRM's expressions as a VRM 1.0: bones of a humanoid by the names of its
    joints, an expression for each shape, eyes that turn. It is made for these films: lengths are centimetres, and
    the neck hangs on no spine, which stricter programs may refuse."""
    (length,) = struct.unpack_from("<I", glb, 12)
    scene = json.loads(glb[20 : 20 + length])
    nodes = {node.get("name"): number for number, node in enumerate(scene["nodes"])}
    bones = {"neck": "NeckJoint", "head": "HeadJoint", "jaw": "JawJoint", "leftEye": "LtEyeJoint", "rightEye": "RtEyeJoint"}
    humanoid = {bone: {"node": nodes[name]} for bone, name in bones.items()} | body(scene)
    binds = {}
    for number, node in enumerate(scene["nodes"]):
        mesh = scene["meshes"][node["mesh"]] if "mesh" in node else {}
        for index, name in enumerate(mesh.get("extras", {}).get("targetNames", [])):
            binds.setdefault(name, []).append({"node": number, "index": index, "weight": 1.0})
    expressions = {"preset": {name: {"morphTargetBinds": binds[name]} for name in binds}}
    about = {"name": "Expressions", "version": "1", "authors": ["Mimik"], "licenseUrl": "https://vrm.dev/licenses/1.0/"}
    turn = {"inputMaxValue": 90.0, "outputScale": 30.0}
    sides = ["HorizontalInner", "HorizontalOuter", "VerticalDown", "VerticalUp"]
    look = {"type": "bone", "offsetFromHeadBone": [0.0, 0.0, 0.0]} | {f"rangeMap{side}": turn for side in sides}
    vrm = {"specVersion": "1.0", "meta": about, "humanoid": {"humanBones": humanoid}, "expressions": expressions}
    scene.setdefault("extensionsUsed", []).append("VRMC_vrm")
    scene.setdefault("extensions", {})["VRMC_vrm"] = vrm | {"lookAt": look}
    text = json.dumps(scene).encode()
    text += b" " * (-len(text) % 4)
    rest = glb[20 + length :]
    header = struct.pack("<4sIIII", b"glTF", 2, 20 + len(text) + len(rest), len(text), 0x4E4F534A)
    return header + text + rest


def body(scene):
    """Adds the bones that every VRM has below the neck, in centimetres, and says which nodes they are."""
    lengths = [("hips", None, 0, -75, 0), ("spine", "hips", 0, 12, 0)]
    for side, sign in [("left", 1), ("right", -1)]:
        lengths += [(f"{side}UpperLeg", "hips", 9 * sign, -5, 0), (f"{side}LowerLeg", f"{side}UpperLeg", 0, -42, 0)]
        lengths += [(f"{side}Foot", f"{side}LowerLeg", 0, -42, 0), (f"{side}UpperArm", "spine", 16 * sign, 38, 0)]
        lengths += [(f"{side}LowerArm", f"{side}UpperArm", 27 * sign, 0, 0)]
        lengths += [(f"{side}Hand", f"{side}LowerArm", 25 * sign, 0, 0)]
    places = {}
    for bone, parent, *translation in lengths:
        places[bone] = len(scene["nodes"])
        scene["nodes"].append({"name": bone, "translation": translation})
        above = scene["scenes"][0]["nodes"] if parent is None else children(scene, places[parent])
        above.append(places[bone])
    return {bone: {"node": node} for bone, node in places.items()}


def children(scene, node):
    return scene["nodes"][node].setdefault("children", [])


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
