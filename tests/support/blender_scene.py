# What tests of the add-on have in common: it is installed, two graphs are written, and solids are measured.
#     blender --background --factory-startup --python-exit-code 1 --python TEST.py -- ZIP PROGRAM FOLDER
import importlib
import os
import signal
import sys

import bmesh
import bpy

zipped, program, folder = sys.argv[sys.argv.index("--") + 1:]

BALL = """{"fieldwright": 1, "unit": "cm", "nodes": [
  {"id": "ball", "type": "sphere", "inputs": {"radius": 10}},
  {"id": "red", "type": "material", "label": "Red", "inputs": {"surface": {"from": "ball"}, "base_color": [0.8, 0.1, 0.05], "roughness": 0.3}},
  {"id": "box", "type": "box", "inputs": {"half_extents": [3, 8, 4]}},
  {"id": "right", "type": "translate", "inputs": {"surface": {"from": "box"}, "offset": [40, 0, 0]}},
  {"id": "metal", "type": "material", "inputs": {"surface": {"from": "right"}, "metallic": 1}},
  {"id": "both", "type": "union", "inputs": {"a": {"from": "red"}, "b": {"from": "metal"}}},
  {"id": "out", "type": "output", "inputs": {"surface": {"from": "both"}, "resolution": 48}}],
 "parameters": [{"name": "radius", "node": "ball", "input": "radius", "min": 5.1, "max": 15},
                {"name": "size", "node": "box", "input": "half_extents"}]}"""
BOX = 8 * 0.03 * 0.08 * 0.04  # its volume, and that of a ball, in metres
MOVING = """{"fieldwright": 1, "nodes": [
  {"id": "ball", "type": "sphere", "inputs": {"radius": 0.5}},
  {"id": "up", "type": "translate", "inputs": {"surface": {"from": "ball"}}},
  {"id": "out", "type": "output", "inputs": {"surface": {"from": "up"}, "resolution": 24}}],
 "timeline": {"length": 2, "fps": 24, "tracks": [
  {"node": "up", "input": "offset", "keys": [{"time": 0, "value": [0, 0, 0]}, {"time": 2, "value": [0, 4, 0]}]}]}}"""


def ball(radius):
    return 4 / 3 * 3.14159265 * radius**3


def path(name):
    return os.path.join(folder, name)


def write(name, text):
    with open(path(name), "w", encoding="utf-8") as file:
        file.write(text)


def near(value, wanted, part=0.03):
    assert abs(value - wanted) <= part * abs(wanted) + 1e-9, (value, wanted)


def volume(thing):
    mesh = bmesh.new()
    mesh.from_mesh(thing.data)
    size = mesh.calc_volume(signed=True)
    mesh.free()
    return size


def height(thing):
    """Of the middle of its vertices."""
    return sum(vertex.co.z for vertex in thing.data.vertices) / len(thing.data.vertices)


def add(name):
    bpy.ops.import_mesh.fieldwright(filepath=path(name))
    return bpy.context.object


def select(thing):
    bpy.ops.object.select_all(action="DESELECT")
    thing.select_set(True)
    bpy.context.view_layer.objects.active = thing


def install():
    """The add-on's module: an extension where Blender has them."""
    if bpy.app.version < (4, 2):
        name = "fieldwright"
        bpy.ops.preferences.addon_install(filepath=zipped, overwrite=True)
        bpy.ops.preferences.addon_enable(module=name)
    else:
        name = "bl_ext.user_default.fieldwright"
        bpy.ops.extensions.package_install_files(filepath=zipped, repo="user_default", enable_on_install=True)
    return importlib.import_module(name)


def preferences():
    return bpy.context.preferences.addons[addon.__name__].preferences


def kill_server(thing):
    child = addon.driven.graphs[thing.name_full].server.child
    os.kill(child.pid, signal.SIGKILL)
    child.wait()


addon = install()
preferences().program = program
write("ball.field.json", BALL)
write("moving.field.json", MOVING)
