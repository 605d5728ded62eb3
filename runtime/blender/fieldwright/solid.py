"""What the server answers, as an object of Blender: its triangles, colours and materials.

Fieldwright has +Y up and its document's unit; Blender has +Z up and metres.
"""
import bpy
import numpy

METRES = {"m": 1.0, "dm": 0.1, "cm": 0.01, "mm": 0.001, "um": 1e-6, "µm": 1e-6, "km": 1000.0, "in": 0.0254, "ft": 0.3048}
COLOR = "Color"


def turned(places, scale):
    return numpy.stack((places[:, 0], -places[:, 2], places[:, 1]), axis=1) * numpy.float32(scale)


def arrays(result, blobs):
    """The places, triangles and colours of an answer, in Blender's axes and metres."""
    scale = METRES.get(result["unit"], 1.0)
    places = turned(numpy.frombuffer(blobs["positions"], numpy.float32).reshape(-1, 3), scale)
    colors = numpy.frombuffer(blobs["colors"], numpy.float32).reshape(-1, 3) if "colors" in blobs else None
    return {"places": places, "triangles": numpy.frombuffer(blobs["indices"], numpy.uint32), "colors": colors,
            "materials": result["materials"], "color": result["baseColor"]}


def fill(mesh, made):
    """Makes the mesh of these arrays, with a slot for each material."""
    places, triangles = made["places"], made["triangles"]
    faces = len(triangles) // 3
    if len(mesh.vertices) != len(places) or len(mesh.loops) != len(triangles):
        mesh.clear_geometry()
        mesh.vertices.add(len(places))
        mesh.loops.add(len(triangles))
        mesh.polygons.add(faces)
        mesh.polygons.foreach_set("loop_start", numpy.arange(0, 3 * faces, 3, dtype=numpy.int32))
        if bpy.app.version < (4, 1):
            mesh.polygons.foreach_set("loop_total", numpy.full(faces, 3, numpy.int32))
        mesh.polygons.foreach_set("use_smooth", numpy.ones(faces, bool))
    mesh.vertices.foreach_set("co", places.ravel())
    mesh.loops.foreach_set("vertex_index", triangles.view(numpy.int32))
    counts = [material["triangles"] for material in made["materials"]]
    if len(counts) > 1 or len(mesh.materials) > 1:  # else all are 0, and to say so takes long
        mesh.polygons.foreach_set("material_index", numpy.repeat(numpy.arange(len(counts), dtype=numpy.int32), counts))
    paint(mesh, made)
    mesh.update(calc_edges=True)


def paint(mesh, made):
    known = mesh.color_attributes.get(COLOR)
    if made["colors"] is None:
        if known:
            mesh.color_attributes.remove(known)
        return
    if known is None:
        known = mesh.color_attributes.new(COLOR, "FLOAT_COLOR", "POINT")
    with_alpha = numpy.ones((len(made["places"]), 4), numpy.float32)
    with_alpha[:, :3] = made["colors"]
    known.data.foreach_set("color", with_alpha.ravel())


def dress(mesh, made):
    """Gives the mesh its materials. One that a person put into a slot stays."""
    for index, wanted in enumerate(made["materials"]):
        if index == len(mesh.materials):
            mesh.materials.append(None)
        material = mesh.materials[index]
        if material and not material.get("fieldwright"):
            continue
        if material is None:
            material = bpy.data.materials.new(wanted.get("name") or mesh.name)
            material["fieldwright"] = True
            material.use_nodes = True
            mesh.materials[index] = material
        shade(material, wanted, made)
    while len(mesh.materials) > len(made["materials"]):
        mesh.materials.pop()


def shade(material, wanted, made):
    tree = material.node_tree
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
    with open(path, "w", encoding="utf-8") as file:
        for vertex in mesh.vertices:
            x, y, z = matrix @ vertex.co
            file.write(f"v {x:.9g} {z:.9g} {-y:.9g}\n")
        for triangle in mesh.loop_triangles:
            a, b, c = (1 + index for index in triangle.vertices)
            file.write(f"f {a} {b} {c}\n")
