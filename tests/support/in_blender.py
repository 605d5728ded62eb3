# Opens a glTF or OBJ file, or a point cache beside one, in Blender and prints as JSON, in the file's axes, what it has become there: what is seen at
# each of the frames asked for, and the meshes, materials and pictures that there are.
#     blender --background --factory-startup --python in_blender.py -- FILE FPS FRAME...
import builtins
import json
import sys
import warnings

import numpy

# The importer of Blender 3.4 goes by names that newer numpys have dropped.
warnings.simplefilter("ignore")
for name in ("bool", "int", "float", "object"):
    if not hasattr(numpy, name):
        setattr(numpy, name, getattr(builtins, name))

import bmesh
import bpy


def seen(frame):
    """Names, volume and bounds of what is shown at a frame."""
    bpy.context.scene.frame_set(frame)
    evaluated = bpy.context.evaluated_depsgraph_get()
    names, volume, places = [], 0.0, []
    for each in bpy.context.scene.objects:
        if each.type != "MESH" or abs(each.matrix_world.determinant()) < 1e-18:
            continue
        mesh = bmesh.new()
        mesh.from_mesh(each.evaluated_get(evaluated).to_mesh())
        mesh.transform(each.matrix_world)
        names.append(each.name)
        volume += mesh.calc_volume(signed=True) * numpy.sign(each.matrix_world.determinant())  # a mirror image turns faces
        places += [(v.co.x, v.co.z, -v.co.y) for v in mesh.verts]
        mesh.free()
    return {"names": sorted(names), "volume": volume,
            "min": numpy.min(places, axis=0).tolist() if places else [],
            "max": numpy.max(places, axis=0).tolist() if places else []}


def linear(color):
    return numpy.where(color <= 0.04045, color / 12.92, ((color + 0.055) / 1.055) ** 2.4)


def base_color(image, flat):
    """What a picture of colours has at places of it, linear."""
    width, height = image.size
    pixels = numpy.array(image.pixels[:]).reshape(height, width, image.channels)[:, :, :3]
    texels = numpy.minimum((flat * (width, height)).astype(int), (width - 1, height - 1))
    return linear(pixels[texels[:, 1], texels[:, 0]])


def mesh(data):
    faces = len(data.polygons)
    of_material = numpy.array([polygon.material_index for polygon in data.polygons])
    found, colors = {"triangles": faces, "materials": {}}, None
    if data.color_attributes:
        attribute = data.color_attributes[0]
        colors = numpy.array([c.color[:3] for c in attribute.data])
        if attribute.domain == "POINT":
            colors = colors[[loop.vertex_index for loop in data.loops]]
        colors = colors.reshape(faces, 3, 3).mean(axis=1)
    if data.uv_layers:
        flat = numpy.array([c.uv[:] for c in data.uv_layers[0].data]).reshape(faces, 3, 2)
        found["uv"] = [float(flat.min()), float(flat.max())]
        images = [i for i in bpy.data.images if "base_color" in i.name]
        colors = base_color(images[0], flat.mean(axis=1)) if images else None
    for index, material in enumerate(data.materials):
        own = of_material == index
        found["materials"][material.name] = {"triangles": int(own.sum()),
            "color": colors[own].mean(axis=0).tolist() if colors is not None and own.any() else None}
    return found


def material(tree):
    shader = tree.nodes["Principled BSDF"]
    return {"from": {link.to_socket.name: link.from_node.type for link in tree.links if link.to_node == shader},
            "values": {socket.name: socket.default_value for socket in shader.inputs if socket.type == "VALUE"}}


path, fps, *frames = sys.argv[sys.argv.index("--") + 1:]
bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.context.scene.render.fps = int(fps)
if path.endswith(".obj"):
    bpy.ops.wm.obj_import(filepath=path)
elif path.endswith((".pc2", ".mdd")):
    bpy.ops.wm.obj_import(filepath=path[:-3] + "obj")
    for each in bpy.context.scene.objects:
        cache = each.modifiers.new("moves", "MESH_CACHE")
        cache.cache_format, cache.filepath, cache.frame_start = path[-3:].upper(), path, 0
else:
    bpy.ops.import_scene.gltf(filepath=path)
objects = bpy.context.scene.objects
print("\nIn Blender: " + json.dumps({
    "frames": {frame: seen(int(frame)) for frame in frames},
    "parents": {each.name: each.parent.name for each in objects if each.parent},
    "meshes": {each.name: mesh(each.data) for each in objects if each.type == "MESH"},
    "materials": {each.name: material(each.node_tree) for each in bpy.data.materials if each.users and each.node_tree},
    "images": {each.name: {"size": list(each.size), "space": each.colorspace_settings.name}
               for each in bpy.data.images if each.size[0]}}))
