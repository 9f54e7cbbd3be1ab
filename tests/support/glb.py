"""An independent reader of binary glTF with forward kinematics. Shares no code with the program that writes it."""
import json
import struct

import numpy as np

from support.bvh import forward_kinematics, matrices_of

COMPONENTS = {5121: np.uint8, 5123: np.uint16, 5125: np.uint32, 5126: np.float32}
WIDTHS = {"SCALAR": 1, "VEC3": 3, "VEC4": 4, "MAT4": 16}


class Glb:
    def __init__(self, path):
        data = open(path, "rb").read()
        magic, version, length = struct.unpack_from("<4sII", data)
        assert (magic, version, length) == (b"glTF", 2, len(data)), (magic, version, length, len(data))
        size, kind = struct.unpack_from("<I4s", data, 12)
        assert kind == b"JSON" and size % 4 == 0, (kind, size)
        self.json = json.loads(data[20:20 + size])
        binary, kind = struct.unpack_from("<I4s", data, 20 + size)
        assert kind == b"BIN\0", kind
        self.binary = data[28 + size:28 + size + binary]
        assert len(self.binary) == binary == self.json["buffers"][0]["byteLength"]
        self.nodes = self.json["nodes"]
        self.names = [node["name"] for node in self.nodes]
        self.parents = [-1] * len(self.nodes)
        for i, node in enumerate(self.nodes):
            for child in node.get("children", ()):
                assert self.parents[child] == -1, "a node with two parents"
                self.parents[child] = i

    def values(self, index):
        """The values of an accessor, (count, width)."""
        accessor = self.json["accessors"][index]
        view = self.json["bufferViews"][accessor["bufferView"]]
        width, kind = WIDTHS[accessor["type"]], COMPONENTS[accessor["componentType"]]
        flat = np.frombuffer(self.binary, kind, accessor["count"] * width, view["byteOffset"])
        assert flat.nbytes == view["byteLength"]
        return flat.reshape(accessor["count"], width)

    def tracks(self):
        """The times (F,), and the translations and rotations by node."""
        animation = self.json["animations"][0]
        found, times = {"translation": {}, "rotation": {}}, None
        for channel in animation["channels"]:
            sampler = animation["samplers"][channel["sampler"]]
            assert sampler["interpolation"] == "LINEAR"
            times = self.values(sampler["input"])[:, 0]
            target = channel["target"]
            found[target["path"]][target["node"]] = self.values(sampler["output"])
        return times, found["translation"], found["rotation"]


def world(glb, frames, translations, rotations):
    """Joint positions (F, N, 3) and rotations (F, N, 3, 3); without tracks those of the nodes."""
    count = len(glb.nodes)
    offsets, local = np.zeros((frames, count, 3)), np.zeros((frames, count, 3, 3))
    for i, node in enumerate(glb.nodes):
        offsets[:, i] = translations.get(i, node.get("translation", [0, 0, 0]))
        turn = np.asarray(rotations.get(i, [node.get("rotation", [0, 0, 0, 1])]), dtype=float)
        local[:, i] = matrices_of(np.roll(turn, 1, axis=-1))  # glTF writes x y z w
    order = sorted(range(count), key=lambda i: depth(glb, i))
    return forward_kinematics(glb.parents, offsets, local, order)


def depth(glb, node):
    return 0 if glb.parents[node] < 0 else 1 + depth(glb, glb.parents[node])
