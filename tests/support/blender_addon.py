# Drives the add-on in a Blender without its window, as a person would, and prints "all is well" if all is (blender_scene.py).
import os
import sys
import time

import bpy

sys.path.insert(0, os.path.dirname(__file__))
from blender_scene import BALL, BOX, add, addon, ball, height, kill_server, near, path, preferences, program, volume, write

# Import: the solid, in metres and with Blender's up; its colours and materials.
thing = add("ball.field.json")
own = thing.fieldwright
assert not own.error, own.error
near(volume(thing), ball(0.1) + BOX)
near(thing.dimensions.z, 0.2)
assert [slot.name for slot in thing.data.materials][0].startswith("Red"), list(thing.data.materials)
shader = thing.data.materials[0].node_tree.nodes["Principled BSDF"]
near(shader.inputs["Roughness"].default_value, 0.3)
near(thing.data.materials[1].node_tree.nodes["Principled BSDF"].inputs["Metallic"].default_value, 1)
assert thing.data.color_attributes["Color"].domain == "POINT"
assert not thing.data.validate(), "the mesh needed mending"

# Parameters drive it; one beyond its range is held there.
assert [each.name for each in own.parameters] == ["radius", "size"]
own.parameters["radius"].number = 12
assert not own.error, own.error
near(volume(thing), ball(0.12) + BOX)
own.parameters["radius"].number = 99
near(volume(thing), ball(0.15) + BOX)
assert own.parameters["radius"].number == 15
own.parameters["size"].triple = (6, 8, 4)
near(volume(thing), ball(0.15) + 2 * BOX)
before = len(thing.data.polygons)
own.resolution = 64
near(volume(thing), ball(0.15) + 2 * BOX)
assert len(thing.data.polygons) > 1.5 * before
own.resolution = 0
assert len(thing.data.polygons) == before
own.resolution = 64

# How long a change takes, for whoever reads the log.
times = []
for step in range(10):
    start = time.perf_counter()
    own.parameters["radius"].number = 10 + 0.1 * step
    times.append(1000 * (time.perf_counter() - start))
print(f"a parameter to the object: {sorted(times)[5]:.1f} ms, {len(thing.data.polygons)} triangles")

# The server is killed: the next change starts another, with the values that were set.
kill_server(thing)
own.parameters["radius"].number = 10
assert not own.error, own.error
near(volume(thing), ball(0.1) + 2 * BOX)

# A graph that is broken, and mended; a program that is not there.
write("ball.field.json", BALL.replace("sphere", "spere"))
bpy.ops.object.fieldwright_reload()
assert "did you mean 'sphere'" in own.error and "ball.field.json:2" in own.error, own.error
near(volume(thing), ball(0.1) + 2 * BOX)
write("ball.field.json", BALL)
bpy.ops.object.fieldwright_reload()
assert not own.error and own.parameters["radius"].number == 10, own.error
preferences().program = "/nothing/fieldwright"
lost = add("ball.field.json")
assert "there is no program" in lost.fieldwright.error, lost.fieldwright.error
bpy.data.objects.remove(lost)
preferences().program = program

# The timeline follows the frame, from the cache the second time.
moving = add("moving.field.json")
scene = bpy.context.scene
scene.render.fps, scene.frame_start, scene.frame_end = 24, 1, 13
heights = {}
for again in range(2):
    for frame in (1, 13, 25):
        scene.frame_set(frame)
        assert not moving.fieldwright.error, moving.fieldwright.error
        heights[frame, again] = height(moving)
assert abs(heights[1, 0]) < 0.02 and abs(heights[13, 0] - 1) < 0.05 and abs(heights[25, 0] - 2) < 0.05, heights
assert all(heights[frame, 0] == heights[frame, 1] for frame in (1, 13, 25))
bpy.context.view_layer.objects.active = moving
scene.frame_end = 3
bpy.ops.object.fieldwright_bake()
baked = [each for each in bpy.data.objects if each.name.startswith("moving 0")]
assert len(baked) == 3, [each.name for each in bpy.data.objects]
scene.frame_set(2)
assert [each.hide_render for each in baked] == [True, False, True]

# A keyed parameter is followed too.
bpy.context.view_layer.objects.active = thing
own.parameters["radius"].number = 6
own.parameters["radius"].keyframe_insert("number", frame=1)
own.parameters["radius"].number = 12
own.parameters["radius"].keyframe_insert("number", frame=11)
scene.frame_set(1)
near(volume(thing), ball(0.06) + 2 * BOX, 0.06)
scene.frame_set(11)
near(volume(thing), ball(0.12) + 2 * BOX)

# A mesh of Blender as a field.
bpy.ops.mesh.primitive_cube_add(size=2)
bpy.ops.object.fieldwright_from_mesh(filepath=path("cube.field.json"))
assert not bpy.context.object.fieldwright.error, bpy.context.object.fieldwright.error
near(volume(bpy.context.object), 8, 0.05)

# Saved and opened again: it is there as it was, and goes on.
bpy.ops.wm.save_as_mainfile(filepath=path("scene.blend"))
bpy.ops.wm.open_mainfile(filepath=path("scene.blend"))
thing = bpy.data.objects["ball"]
near(volume(thing), ball(0.12) + 2 * BOX)
thing.animation_data_clear()
thing.fieldwright.parameters["radius"].number = 8
assert not thing.fieldwright.error, thing.fieldwright.error
near(volume(thing), ball(0.08) + 2 * BOX, 0.05)

# Removed: no child is left, and Blender knows nothing of it.
children = [each.child.pid for each in addon.driven.server.Graph.servers.values() if each.child]
assert children
bpy.ops.preferences.addon_disable(module=addon.__name__)
assert not hasattr(bpy.types.Object, "fieldwright")
for pid in children:
    assert not os.path.exists(f"/proc/{pid}"), "a child is left"
# (Blender's own operator that deletes its folder needs a window.)
print("all is well")
