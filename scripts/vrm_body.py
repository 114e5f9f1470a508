"""MakeHuman's body as a VRM 1.0: a humanoid's bones, and nothing but expressions for its face."""

import json
import struct

from PIL import Image

PARTS = {
    # What the groups of MakeHuman's base.obj are, with colour and roughness.
    "skin": (["body"], (0.6, 0.36, 0.27), 0.55),
    "teeth": (["helper-upper-teeth", "helper-lower-teeth"], (0.93, 0.91, 0.86), 0.3),
    "tongue": (["helper-tongue"], (0.72, 0.32, 0.3), 0.5),
    "lashes": (["helper-l-eyelashes-2", "helper-r-eyelashes-2"], (0.05, 0.04, 0.04), 0.9),
    "hair": (["helper-hair"], (0.03, 0.018, 0.013), 0.7),
    "suit": (["helper-tights"], (0.16, 0.32, 0.36), 0.8),
}

# Each bone of VRM, and the bones of MakeHuman that begin it; what hangs on them without a name here follows
# them.
BONES = {"hips": "root", "spine": "spine05", "chest": "spine03", "upperChest": "spine01", "neck": "neck01", "head": "head"}
SIDED = {"Eye": "eye", "Shoulder": "clavicle", "UpperArm": "upperarm01", "LowerArm": "lowerarm01", "Hand": "wrist"}
SIDED |= {"UpperLeg": "upperleg01", "LowerLeg": "lowerleg01", "Foot": "foot"}
BONES |= {f"{side}{bone}": f"{name}.{side[0].upper()}" for side in ("left", "right") for bone, name in SIDED.items()}

# Expressions of VRM by shapes of ARKit and visemes; a star stands for both sides.
EXPRESSIONS = {
    "happy": {"mouthSmile*": 0.8, "cheekSquint*": 0.6},
    "angry": {"browDown*": 1, "noseSneer*": 0.4, "eyeSquint*": 0.2},
    "sad": {"browInnerUp": 0.6, "mouthFrown*": 0.9},
    "relaxed": {"mouthSmile*": 0.3, "eyeSquint*": 0.3},
    "surprised": {"browInnerUp": 1, "browOuterUp*": 0.8, "eyeWide*": 1, "jawOpen": 0.25},
    "blink": {"eyeBlink*": 1},
    "blinkLeft": {"eyeBlinkLeft": 1},
    "blinkRight": {"eyeBlinkRight": 1},
}
EXPRESSIONS |= {vrm: {f"viseme_{name}": 1} for vrm, name in zip(("aa", "ih", "ou", "ee", "oh"), ("aa", "I", "U", "E", "O"))}

METRES = 0.1


class Buffer:
    """Bytes of a GLB, with the views and accessors into them."""

    def __init__(self):
        self.bytes, self.views, self.accessors = b"", [], []

    def view(self, content):
        self.bytes += b"\0" * (-len(self.bytes) % 4)
        self.views.append({"buffer": 0, "byteOffset": len(self.bytes), "byteLength": len(content)})
        self.bytes += content
        return len(self.views) - 1

    def add(self, rows, width, code="f", bounds=False):
        """An accessor for rows of numbers: floats, 16-bit (`H`) or 32-bit (`I`) whole numbers."""
        flat = [number for row in rows for number in row]
        kind = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4", 16: "MAT4"}[width]
        component = {"f": 5126, "H": 5123, "I": 5125}[code]
        accessor = {"bufferView": self.view(struct.pack(f"<{len(flat)}{code}", *flat)), "type": kind}
        accessor |= {"componentType": component, "count": len(rows)}
        if bounds:
            single = [struct.unpack("f", struct.pack("f", number))[0] for number in flat]
            accessor |= {"min": [min(single[i::width]) for i in range(width)]}
            accessor |= {"max": [max(single[i::width]) for i in range(width)]}
        self.accessors.append(accessor)
        return len(self.accessors) - 1


def read_obj(path):
    """Positions, coordinates of textures, and the faces of each group: for each corner its place
    in both."""
    positions, coordinates, faces = [], [], []
    groups = {"": faces}
    for line in open(path):
        word, *rest = line.split() or [""]
        if word == "v":
            positions.append([float(number) for number in rest[:3]])
        elif word == "vt":
            coordinates.append([float(rest[0]), 1 - float(rest[1])])
        elif word == "g":
            faces = groups.setdefault(rest[0], [])
        elif word == "f":
            faces.append([tuple(int(place) - 1 for place in corner.split("/")[:2]) for corner in rest])
    return positions, coordinates, groups


def triangles(faces):
    return [(corners[0], corners[i], corners[i + 1]) for corners in faces for i in range(1, len(corners) - 1)]


def read_target(path):
    lines = (line.split() for line in open(path) if line.strip() and not line.startswith("#"))
    return {int(vertex): [float(number) for number in offset] for vertex, *offset in lines}


def cross(a, b, c):
    u, v = ([q - p for p, q in zip(a, other)] for other in (b, c))
    return [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]


def expression(targets, parts):
    """How far each vertex is moved, by its number."""
    moved = {}
    for name, weight in parts.items():
        for side in ("Left", "Right") if "*" in name else ("",):
            for vertex, offset in read_target(targets / f"{name.replace('*', side)}.target").items():
                before = moved.get(vertex, [0, 0, 0])
                moved[vertex] = [a + weight * b for a, b in zip(before, offset)]
    return moved


def skeleton(rig, positions):
    """The bones of VRM in order, parents first: name, parent's place, position; and the place for each of MakeHuman's."""
    place_of = {name: place for place, name in enumerate(BONES.values())}

    def follow(name):
        while name is not None and name not in place_of:
            name = rig["bones"][name]["parent"]
        return place_of.get(name, 0)

    bones = []
    for vrm, name in BONES.items():
        corners = [positions[vertex] for vertex in rig["joints"][rig["bones"][name]["head"]]]
        head = [sum(axis) / len(corners) for axis in zip(*corners)]
        parent = rig["bones"][name]["parent"]
        bones.append((vrm, None if parent is None else follow(parent), head))
    return bones, {name: follow(name) for name in rig["bones"]}


def influences(weights, places, count):
    """For each vertex the four bones that move it most, and their weights."""
    sums = [{} for _ in range(count)]
    for name, pairs in weights.items():
        for vertex, weight in pairs:
            sums[vertex][places[name]] = sums[vertex].get(places[name], 0) + weight
    rows = []
    for of in sums:
        most = sorted(of.items(), key=lambda pair: -pair[1])[:4] or [(0, 1.0)]
        whole = sum(weight for _, weight in most)
        most += [(0, 0.0)] * (4 - len(most))
        rows.append(([bone for bone, _ in most], [weight / whole for _, weight in most]))
    return rows


def primitive(buffer, corners, positions, normals, coordinates, bones, moves, material):
    """Triangles of one material, with all expressions."""
    order = {corner: place for place, corner in enumerate(dict.fromkeys(corners))}
    attributes = {"POSITION": buffer.add([positions[v] for v, _ in order], 3, bounds=True)}
    attributes |= {"NORMAL": buffer.add([normals[v] for v, _ in order], 3)}
    attributes |= {"JOINTS_0": buffer.add([bones[v][0] for v, _ in order], 4, "H")}
    attributes |= {"WEIGHTS_0": buffer.add([bones[v][1] for v, _ in order], 4)}
    if coordinates:
        attributes |= {"TEXCOORD_0": buffer.add([coordinates[t] for _, t in order], 2)}
    still = [0.0, 0.0, 0.0]
    targets = [{"POSITION": buffer.add([move.get(v, still) for v, _ in order], 3, bounds=True)} for move in moves]
    indices = buffer.add([[order[corner]] for corner in corners], 1, "I")
    return {"attributes": attributes, "indices": indices, "material": material, "targets": targets}


def smooth(positions, faces):
    normals = [[0.0, 0.0, 1e-12] for _ in positions]
    for corners in faces:
        normal = cross(*(positions[v] for v, _ in corners))
        for vertex, _ in corners:
            normals[vertex] = [a + b for a, b in zip(normals[vertex], normal)]
    lengths = [sum(x * x for x in normal) ** 0.5 for normal in normals]
    return [[x / length for x in normal] for normal, length in zip(normals, lengths)]


def vertices(faces):
    return {vertex for corners in faces for vertex, _ in corners}


def fitted(point, eyes, ball):
    """A point of one of the two eyes, where the ball is that stands for it in base.obj."""
    eye = [other for other in eyes if (other[0] > 0) == (point[0] > 0)]
    where = []
    for axis in range(3):
        (a, b), (c, d) = ((min(p[axis] for p in of), max(p[axis] for p in of)) for of in (eye, ball))
        where.append(c + (point[axis] - a) * (d - c) / (b - a))
    return where


def is_opaque(picture, coordinates, corners):
    """Whether a face is of the ball of the eye: the cornea before it is transparent, and left out here."""
    where = [sum(coordinates[t][axis] for _, t in corners) / len(corners) * picture.size[axis] for axis in range(2)]
    return picture.getpixel(tuple(min(int(x), size - 1) for x, size in zip(where, picture.size)))[3] > 127


def is_under_hair(x, y, z):
    """Whether hair grows at a place, in metres: brows, and what is above a plane from forehead to nape,
    but for the ears."""
    is_brow = z > 0.1 and 0.013 < abs(x) < 0.05 and 1.566 < y < 1.5725
    return is_brow or (y > 1.535 + 0.6 * (z - 0.02) and not (abs(x) > 0.072 and y < 1.575))


def vrm(makehuman, targets):
    """The bytes of the VRM. `makehuman` has base.obj and the folders rigs and eyes; `targets` has ARKit's shapes."""
    raw, _, groups = read_obj(makehuman / "base.obj")
    rig = json.loads((makehuman / "rigs/default.mhskel").read_text())
    weights = json.loads((makehuman / "rigs/default_weights.mhw").read_text())["weights"]
    ground = min(raw[v][1] for corners in groups["body"] for v, _ in corners)
    metres = lambda point: [METRES * point[0], METRES * (point[1] - ground), METRES * point[2]]
    positions = [metres(point) for point in raw]
    bones, places = skeleton(rig, positions)
    moves = [expression(targets, parts) for parts in EXPRESSIONS.values()]
    moves = [{v: [METRES * x for x in offset] for v, offset in move.items()} for move in moves]
    rows = influences(weights, places, len(positions))

    buffer, materials, primitives = Buffer(), [], []
    middle = lambda corners: [sum(axis) / len(corners) for axis in zip(*(positions[v] for v, _ in corners))]
    is_scalp = lambda corners: is_under_hair(*middle(corners))
    scalp = [corners for corners in groups["body"] if is_scalp(corners)]
    groups["body"] = [corners for corners in groups["body"] if not is_scalp(corners)]
    # Of the strips of hair, those that hang over the face are left out.
    groups["helper-hair"] = scalp + [c for c in groups["helper-hair"] if middle(c)[2] < 0.04]
    for name, (names, colour, roughness) in PARTS.items():
        faces = triangles(corners for group in names for corners in groups.get(group, []))
        normals = smooth(positions, faces)
        corners = [(v, 0) for face in faces for v, _ in face]
        primitives.append(primitive(buffer, corners, positions, normals, None, rows, moves, len(materials)))
        surface = {"baseColorFactor": [*colour, 1], "metallicFactor": 0, "roughnessFactor": roughness}
        materials.append({"name": name, "pbrMetallicRoughness": surface, "doubleSided": name in ("hair", "lashes")})
    ball = {is_left: vertices(groups[f"helper-{side}-eye"]) for is_left, side in ((True, "l"), (False, "r"))}
    eyes, coordinates, balls = read_obj(makehuman / "eyes/high-poly.obj")
    eyes = [fitted(point, eyes, [positions[v] for v in ball[point[0] > 0]]) for point in eyes]
    picture = Image.open(makehuman / "eyes/brown_eye.png")
    faces = triangles(corners for of in balls.values() for corners in of if is_opaque(picture, coordinates, corners))
    sides = [list(BONES).index("leftEye" if point[0] > 0 else "rightEye") for point in eyes]
    turned = [([side, 0, 0, 0], [1.0, 0.0, 0.0, 0.0]) for side in sides]
    corners = [corner for face in faces for corner in face]
    primitives.append(
        primitive(buffer, corners, eyes, smooth(eyes, faces), coordinates, turned, [{}] * len(moves), len(materials))
    )
    picture = buffer.view((makehuman / "eyes/brown_eye.png").read_bytes())
    surface = {"baseColorTexture": {"index": 0}, "metallicFactor": 0, "roughnessFactor": 0.15}
    materials.append({"name": "eyes", "pbrMetallicRoughness": surface})
    return glb(buffer, bones, materials, primitives, picture)


def glb(buffer, bones, materials, primitives, picture):
    nodes = []
    for name, parent, head in bones:
        above = [0, 0, 0] if parent is None else bones[parent][2]
        nodes.append({"name": name, "translation": [a - b for a, b in zip(head, above)]})
        if parent is not None:
            nodes[parent].setdefault("children", []).append(len(nodes) - 1)
    binds = [[1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, *(-x for x in head), 1] for *_, head in bones]
    skin = {"joints": list(range(len(bones))), "inverseBindMatrices": buffer.add(binds, 16)}
    body = len(nodes)
    nodes.append({"name": "body", "mesh": 0, "skin": 0})
    about = {"name": "MakeHuman's body", "version": "1", "authors": ["MakeHuman"], "licenseUrl": "https://vrm.dev/licenses/1.0/"}
    turn = {"inputMaxValue": 90.0, "outputScale": 30.0}
    sides = ["HorizontalInner", "HorizontalOuter", "VerticalDown", "VerticalUp"]
    expressions = {
        name: {"morphTargetBinds": [{"node": body, "index": index, "weight": 1.0}]} for index, name in enumerate(EXPRESSIONS)
    }
    names = [f"Face_{name}" for name in EXPRESSIONS]
    vrm = {
        "specVersion": "1.0",
        "meta": about,
        "humanoid": {"humanBones": {name: {"node": place} for place, (name, *_) in enumerate(bones)}},
        "expressions": {"preset": expressions},
        "lookAt": {"type": "bone", "offsetFromHeadBone": [0, 0.06, 0]} | {f"rangeMap{side}": turn for side in sides},
    }
    scene = {
        "asset": {"version": "2.0"},
        "extensionsUsed": ["VRMC_vrm"],
        "extensions": {"VRMC_vrm": vrm},
        "scene": 0,
        "scenes": [{"nodes": [0, body]}],
        "nodes": nodes,
        "skins": [skin],
        "meshes": [{"name": "body", "primitives": primitives, "extras": {"targetNames": names}}],
        "materials": materials,
        "textures": [{"source": 0}],
        "images": [{"bufferView": picture, "mimeType": "image/png"}],
        "buffers": [{"byteLength": len(buffer.bytes)}],
        "bufferViews": buffer.views,
        "accessors": buffer.accessors,
    }
    text = json.dumps(scene).encode()
    text += b" " * (-len(text) % 4)
    content = buffer.bytes + b"\0" * (-len(buffer.bytes) % 4)
    header = struct.pack("<4sIIII", b"glTF", 2, 28 + len(text) + len(content), len(text), 0x4E4F534A)
    return header + text + struct.pack("<II", len(content), 0x004E4942) + content
