"""What the server answers, as an object of Blender: its triangles, colours and materials.

Fieldwright has +Y up and its document's unit; Blender has +Z up and metres.
"""
import json

import bpy
import numpy

from . import records

METRES = {"m": 1.0, "dm": 0.1, "cm": 0.01, "mm": 0.001, "um": 1e-6, "µm": 1e-6, "km": 1000.0, "in": 0.0254, "ft": 0.3048}
COLOR = "Color"
MARK = "fieldwright"  # the property of what the add-on made


def arrays(result, blobs):
    """What an answer has of a mesh, in Blender's axes and metres: arrays, each in one piece, of types that Blender copies; as long
    as the answer is there."""
    places = numpy.frombuffer(blobs["positions"], numpy.float32).reshape(-1, 3)
    turned = numpy.empty_like(places)
    scale = numpy.float32(METRES.get(result["unit"], 1.0))
    numpy.multiply(places[:, 0], scale, out=turned[:, 0])
    numpy.multiply(places[:, 2], -scale, out=turned[:, 1])
    numpy.multiply(places[:, 1], scale, out=turned[:, 2])
    colors = None
    if "colors" in blobs:
        colors = numpy.ones((len(places), 4), numpy.float32)
        colors[:, :3] = numpy.frombuffer(blobs["colors"], numpy.float32).reshape(-1, 3)
    whole = {name: numpy.frombuffer(blobs.get(name, b""), numpy.uint32) for name in ("indices", "edges", "triangle_edges")}
    return {"places": turned, "colors": colors, **whole, "materials": result["materials"], "color": result["baseColor"]}


def kept(made):
    """The same, to keep."""
    return {name: value.copy() if isinstance(value, numpy.ndarray) else value for name, value in made.items()}


def size_of(made):
    return sum(array.nbytes for array in made.values() if isinstance(array, numpy.ndarray))


def fill(mesh, made):
    """Makes the mesh of these arrays, smooth, with the material of each triangle. Blender copies an array as a whole if it is of
    the very type that it keeps; otherwise it would take a hundred times as long."""
    places, corners, edges, sides = made["places"].ravel(), made["indices"], made["edges"], made["triangle_edges"]
    faces = len(corners) // 3
    mesh.clear_geometry()
    mesh.vertices.add(len(places) // 3)
    mesh.edges.add(len(edges) // 2)
    mesh.loops.add(len(corners))
    mesh.polygons.add(faces)
    if bpy.app.version < (3, 6):
        mesh.vertices.foreach_set("co", places)
        mesh.edges.foreach_set("vertices", edges)
        records.write(mesh, corners, sides)
    else:
        mesh.attributes["position"].data.foreach_set("vector", places)
        mesh.polygons.foreach_set("loop_start", numpy.arange(0, 3 * faces, 3, dtype=numpy.uint32))
        for attribute, values in ((".edge_verts", edges), (".corner_vert", corners), (".corner_edge", sides)):
            mesh.attributes[attribute].data.foreach_set("value", values.view(numpy.int32))
        if faces and not mesh.polygons[0].use_smooth:
            mesh.polygons.foreach_set("use_smooth", numpy.ones(faces, bool))
    counts = [material["triangles"] for material in made["materials"]]
    if len(counts) > 1:
        of_faces = numpy.repeat(numpy.arange(len(counts), dtype=numpy.int32), counts)
        mesh.attributes.new("material_index", "INT", "FACE").data.foreach_set("value", of_faces)
    if made["colors"] is not None:
        mesh.color_attributes.new(COLOR, "FLOAT_COLOR", "POINT").data.foreach_set("color", made["colors"].ravel())
    mesh.update()


def dress(mesh, made):
    """Gives the mesh its materials. What a person put into a slot stays; so does what they changed of a material, until the graph
    says something else of it."""
    for index, wanted in enumerate(made["materials"]):
        if index == len(mesh.materials):
            mesh.materials.append(None)
        words = json.dumps([wanted["roughness"], wanted["metallic"], wanted["ior"], wanted["transmission"], wanted["emission"],
                            made["color"], made["colors"] is not None])
        material = mesh.materials[index]
        if material and material.get(MARK) in (None, words):
            continue
        if material is None or material.users > 1:  # that of a copy, which is to look otherwise
            material = mesh.materials[index] = bpy.data.materials.new(wanted.get("name") or mesh.name)
            material.use_nodes = True
        material[MARK] = words
        if material.node_tree:
            shade(material.node_tree, wanted, made)
    while len(mesh.materials) > len(made["materials"]) and mesh.materials[-1] and mesh.materials[-1].get(MARK):
        mesh.materials.pop()


def shade(tree, wanted, made):
    shader = next((node for node in tree.nodes if node.type == "BSDF_PRINCIPLED"), None)
    if shader is None:
        return

    def put(names, value):
        for name in names:  # as versions of Blender call it
            if name in shader.inputs:
                shader.inputs[name].default_value = value
                return

    put(["Roughness"], wanted["roughness"])
    put(["Metallic"], wanted["metallic"])
    put(["IOR"], wanted["ior"])
    put(["Transmission Weight", "Transmission"], wanted["transmission"])
    put(["Emission Color", "Emission"], (*wanted["emission"], 1.0))
    put(["Emission Strength"], 1.0 if any(wanted["emission"]) else 0.0)
    put(["Base Color"], (*made["color"], 1.0))
    source = tree.nodes.get("fieldwright")
    if made["colors"] is not None and source is None:
        source = tree.nodes.new("ShaderNodeAttribute")
        source.name, source.attribute_name = "fieldwright", COLOR
        source.location = (shader.location.x - 250, shader.location.y)
        tree.links.new(source.outputs["Color"], shader.inputs["Base Color"])
    elif made["colors"] is None and source is not None:
        tree.nodes.remove(source)


def to_obj(mesh, matrix, path):
    """Writes a mesh of Blender as an OBJ that a graph's mesh_file reads: +Y up, metres."""
    mesh.calc_loop_triangles()
    places = numpy.empty(3 * len(mesh.vertices), numpy.float32)
    mesh.vertices.foreach_get("co", places)
    matrix = numpy.array(matrix)
    places = places.reshape(-1, 3) @ matrix[:3, :3].T + matrix[:3, 3]
    triangles = numpy.empty(3 * len(mesh.loop_triangles), numpy.int32)
    mesh.loop_triangles.foreach_get("vertices", triangles)
    triangles = 1 + triangles.reshape(-1, 3)
    if numpy.linalg.det(matrix[:3, :3]) < 0:  # mirrored
        triangles = triangles[:, ::-1]
    with open(path, "w", encoding="utf-8") as file:
        file.writelines(f"v {x:.9g} {z:.9g} {-y:.9g}\n" for x, y, z in places.tolist())
        file.writelines(f"f {a} {b} {c}\n" for a, b, c in triangles.tolist())
