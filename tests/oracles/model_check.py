"""Loads models with trimesh: STL closed, consistently oriented, with a volume and one body a yarn; OBJ and GLB the same."""

import json
import struct
import sys

import numpy
import trimesh

bad = 0


def wrong(name, *what):
    global bad
    bad += 1
    print(name, *what)


def bodies(mesh):
    """Connected bodies, by the triangles that share an edge."""
    pairs = mesh.face_adjacency
    label = numpy.arange(len(mesh.faces))
    while True:
        least = label.copy()
        numpy.minimum.at(least, pairs[:, 0], label[pairs[:, 1]])
        numpy.minimum.at(least, pairs[:, 1], label[pairs[:, 0]])
        least = least[least]
        if (least == label).all():
            return len(numpy.unique(label))
        label = least


def document(name):
    """The JSON of a binary glTF file."""
    with open(name, "rb") as file:
        data = file.read()
    size = struct.unpack_from("<I", data, 12)[0]
    return json.loads(data[20 : 20 + size])


for name in sys.argv[1:]:
    stem = name.removesuffix(".stl")
    mesh = trimesh.load(name)
    if not (mesh.is_watertight and mesh.is_winding_consistent and mesh.volume > 0):
        wrong(name, "closed", mesh.is_watertight, "consistent", mesh.is_winding_consistent, "volume", mesh.volume)
    gltf = document(stem + ".glb")
    if stem.endswith("realistic") and bodies(mesh) != len(gltf["meshes"]):
        wrong(name, bodies(mesh), "bodies for", len(gltf["meshes"]), "yarns")
    extras = next(node["extras"]["picot"] for node in gltf["nodes"] if node["name"] == "object")
    if not (extras["schema"] == "picot.model/1" and extras["stitches"] > 0 and extras["parts"]):
        wrong(stem + ".glb", "extras", extras)
    # GLB is in meters with y up.
    size = mesh.extents
    glb = trimesh.load(stem + ".glb").extents * 1000
    if not numpy.allclose([size[0], size[2], size[1]], glb, rtol=1e-4, atol=1e-2):
        wrong(stem + ".glb", "extents", glb, "for", size)
    obj = trimesh.load(stem + ".obj", force="mesh", process=False)
    if len(obj.faces) != len(mesh.faces) or not numpy.allclose(obj.extents, size, rtol=1e-4, atol=1e-2):
        wrong(stem + ".obj", len(obj.faces), "faces for", len(mesh.faces), obj.extents, size)
sys.exit(1 if bad else 0)
