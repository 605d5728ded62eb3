# What a scene goes through besides: each is to end in a message at the object or in nothing at all. Prints "all is well" if all is
# (blender_scene.py).
import os
import sys

import bpy
import numpy

sys.path.insert(0, os.path.dirname(__file__))
from blender_scene import (BALL, BOX, add, addon, ball, height, kill_server, near, path, preferences, program, select, volume,
                           write)


def radius(thing, value):
    thing.fieldwright.parameters["radius"].number = value
    return thing.fieldwright.error


def frames(first, last, step=1):
    scene = bpy.context.scene
    scene.render.fps, scene.frame_start, scene.frame_end, scene.frame_step = 24, first, last, step
    return range(first, last + 1, step)


# More objects than a server has documents; none is left open by those that go, or that are read again.
several = [add("ball.field.json") for _ in range(18)]
for thing in several:
    assert not radius(thing, 7), thing.fieldwright.error
near(volume(several[0]), ball(0.07) + BOX)
near(volume(several[17]), ball(0.07) + BOX)
for thing in several[1:]:
    bpy.data.objects.remove(thing)
thing = several[0]
select(thing)
for _ in range(18):
    bpy.ops.object.fieldwright_reload()
    assert not thing.fieldwright.error, thing.fieldwright.error
assert len(addon.driven.graphs) == 1

# The file gets another name while it is open, and the object the new one.
write("old.field.json", BALL)
thing = add("old.field.json")
os.rename(path("old.field.json"), path("new.field.json"))
kill_server(thing)
assert "no such file" in radius(thing, 8), thing.fieldwright.error
thing.fieldwright.path = path("new.field.json")
assert not thing.fieldwright.error, thing.fieldwright.error
near(volume(thing), ball(0.08) + BOX)

# Mended so that it allows less: the value is held.
assert not radius(thing, 14)
write("new.field.json", BALL.replace('"max": 15', '"max": 10'))
bpy.ops.object.fieldwright_reload()
assert not thing.fieldwright.error and thing.fieldwright.parameters["radius"].number == 10, thing.fieldwright.error
near(volume(thing), ball(0.1) + BOX)
assert not radius(thing, 0), "a limit that single precision has below itself"
# The path is taken away, and given back.
thing.fieldwright.path = ""
assert "choose a file" in thing.fieldwright.error and bpy.ops.object.fieldwright_reload.poll()
thing.fieldwright.path = path("ball.field.json")
assert not thing.fieldwright.error, thing.fieldwright.error

# Programs that are others, or none.
for wrong in "/bin/cat", "/bin/true", "/usr/bin/yes", "/etc/passwd":
    preferences().program = wrong
    assert wrong in radius(thing, 11), (wrong, thing.fieldwright.error)
preferences().program = program
assert not radius(thing, 12), thing.fieldwright.error
near(volume(thing), ball(0.12) + BOX)

# A solid that vanishes, and comes back.
write("hole.field.json", """{"fieldwright": 1, "nodes": [
  {"id": "a", "type": "sphere", "inputs": {"radius": 1}}, {"id": "b", "type": "sphere", "inputs": {"radius": 0.5}},
  {"id": "s", "type": "subtract", "inputs": {"a": {"from": "a"}, "b": {"from": "b"}}},
  {"id": "out", "type": "output", "inputs": {"surface": {"from": "s"}, "resolution": 24}}],
 "parameters": [{"name": "hole", "node": "b", "input": "radius"}]}""")
thing = add("hole.field.json")
thing.fieldwright.parameters["hole"].number = 2
assert "empty" in thing.fieldwright.error, thing.fieldwright.error
thing.fieldwright.parameters["hole"].number = 0.6
assert not thing.fieldwright.error, thing.fieldwright.error
near(volume(thing), ball(1) - ball(0.6), 0.1)

# The server is killed while frames play.
moving = add("moving.field.json")
for frame in frames(1, 12):
    bpy.context.scene.frame_set(frame)
    if frame % 3 == 0:
        kill_server(moving)
    assert not moving.fieldwright.error, moving.fieldwright.error
    assert abs(height(moving) - (frame - 1) / 12) < 0.1, (frame, height(moving))

# Undone, Blender has another value than the server: it counts.
thing = add("ball.field.json")
name = thing.name
bpy.ops.ed.undo_push(message="before")
radius(thing, 14)
bpy.ops.ed.undo_push(message="behind")
bpy.ops.ed.undo()
thing = bpy.data.objects[name]
assert thing.fieldwright.parameters["radius"].number == 10
near(volume(thing), ball(0.1) + BOX)
thing.fieldwright.parameters["size"].triple = (6, 8, 4)
near(volume(thing), ball(0.1) + 2 * BOX)
assert not radius(thing, 14)
near(volume(thing), ball(0.14) + 2 * BOX)

# A copy goes its own way; one that shares the mesh does so from when it is changed.
thing = add("ball.field.json")
select(thing)
bpy.ops.object.duplicate()
copy = bpy.context.object
radius(copy, 6)
near(volume(thing), ball(0.1) + BOX)
radius(thing, 12)
near(volume(copy), ball(0.06) + BOX, 0.05)
near(volume(thing), ball(0.12) + BOX)
select(thing)
bpy.ops.object.duplicate(linked=True)
twin = bpy.context.object
bpy.context.scene.frame_set(3)
assert twin.data == thing.data
radius(twin, 8)
assert twin.data != thing.data and len(twin.data.materials) == 2
near(volume(twin), ball(0.08) + BOX, 0.05)
near(volume(thing), ball(0.12) + BOX)

# A mesh that a person put in its place is theirs.
theirs = bpy.data.meshes.new("theirs")
theirs.from_pydata([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [], [(0, 1, 2)])
twin.data = theirs
assert not radius(twin, 9)
assert len(theirs.vertices) == 3 and twin.data != theirs

# So is what they did to materials.
thing = add("ball.field.json")
red = thing.data.materials[0]
red.node_tree.nodes["Principled BSDF"].inputs["Roughness"].default_value = 0.9
thing.data.materials[1] = bpy.data.materials.new("mine")
thing.data.materials.append(bpy.data.materials.new("another"))
radius(thing, 8)
near(red.node_tree.nodes["Principled BSDF"].inputs["Roughness"].default_value, 0.9)
assert [each.name for each in thing.data.materials][1:] == ["mine", "another"]
red.use_nodes = False
assert not radius(thing, 9)
bpy.data.materials.remove(red)
assert not radius(thing, 10) and thing.data.materials[0]

# A hand is at the mesh itself.
for mode in "EDIT", "SCULPT":
    select(thing)
    bpy.ops.object.mode_set(mode=mode)
    assert f"leave {mode.lower()} mode" in radius(thing, 12), thing.fieldwright.error
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.ops.object.fieldwright_reload()
    assert not thing.fieldwright.error, thing.fieldwright.error
    near(volume(thing), ball(0.12) + BOX)
    radius(thing, 10)
bpy.ops.object.mode_set(mode="EDIT")
assert not add("ball.field.json").fieldwright.error

# Names of all kinds.
write("Grüße \"場所\".field.json", BALL)
thing = add("Grüße \"場所\".field.json")
assert not thing.fieldwright.error, thing.fieldwright.error
assert not thing.data.validate(), "the mesh needed mending"

# Saved, then saved elsewhere: a path that begins at the scene's file is found again.
bpy.ops.wm.save_as_mainfile(filepath=path("one.blend"))
write("wrong.field.json", BALL.replace("sphere", "spere"))
wrong, thing = add("wrong.field.json").name, add("ball.field.json")
assert thing.fieldwright.path == "//ball.field.json", thing.fieldwright.path
os.makedirs(path("else/where"))
bpy.ops.wm.save_as_mainfile(filepath=path("else/where/two.blend"))
assert not radius(thing, 8), thing.fieldwright.error
name = thing.name
bpy.ops.wm.open_mainfile(filepath=path("else/where/two.blend"))
thing = bpy.data.objects[name]
assert not radius(thing, 9), thing.fieldwright.error
write("wrong.field.json", BALL)  # mended meanwhile
select(bpy.data.objects[wrong])
bpy.ops.object.fieldwright_reload()
near(volume(bpy.data.objects[wrong]), ball(0.1) + BOX)

# Linked from another file it stays as it was saved, whatever is tried; made local, it is driven.
bpy.ops.wm.read_homefile(use_empty=True)
preferences().program = program
moving, thing = add("moving.field.json"), add("ball.field.json")
moving.name, thing.name = "moving", "still"
bpy.ops.wm.save_as_mainfile(filepath=path("library.blend"))
bpy.ops.wm.read_homefile(use_empty=True)
preferences().program = program
with bpy.data.libraries.load(path("library.blend"), link=True) as (_, linked):
    linked.objects = ["moving", "still"]
moving, thing = linked.objects
for each in linked.objects:
    bpy.context.collection.objects.link(each)
frames(1, 25)
bpy.context.scene.frame_set(13)
near(volume(moving), ball(0.5), 0.15)
instead = thing.override_create()
bpy.context.collection.objects.link(instead)
for each in thing, instead:
    radius(each, 8)
    near(volume(each), ball(0.1) + BOX)
assert "make it local" in instead.fieldwright.error, instead.fieldwright.error
select(thing)
bpy.ops.object.fieldwright_reload()
bpy.ops.object.make_local(type="ALL")
assert not radius(bpy.context.object, 8), bpy.context.object.fieldwright.error
near(volume(bpy.context.object), ball(0.08) + BOX)

# Several frames are rendered, as a farm would: opened and told to.
bpy.ops.wm.read_homefile(use_empty=True)
preferences().program = program
moving, scene = add("moving.field.json"), bpy.context.scene
scene.camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
scene.collection.objects.link(scene.camera)
scene.camera.location, scene.camera.rotation_euler = (0, -12, 2), (1.5708, 0, 0)
scene.render.engine = "CYCLES"
scene.cycles.samples, scene.cycles.use_denoising, scene.render.film_transparent = 1, False, True
scene.render.resolution_x = scene.render.resolution_y = 32
scene.render.image_settings.file_format, scene.render.filepath = "PNG", path("frame")
frames(1, 25, 12)
keyed = add("ball.field.json")
keyed.location, keyed.scale = (-3, 0, 0), (10, 10, 10)
for frame, value in (1, 6), (25, 14):
    radius(keyed, value)
    keyed.fieldwright.parameters["radius"].keyframe_insert("number", frame=frame)
bpy.ops.wm.save_as_mainfile(filepath=path("farm.blend"))
bpy.ops.wm.open_mainfile(filepath=path("farm.blend"))
bpy.ops.render.render(animation=True)
rows, sizes = [], []
for frame in frames(1, 25, 12):
    pixels = numpy.array(bpy.data.images.load(path(f"frame{frame:04}.png")).pixels).reshape(32, 32, 4)[:, :, 3]
    rows.append(numpy.nonzero(pixels[:, 13:19].sum(axis=1) > 0.5)[0].mean())
    sizes.append(pixels[:, :13].sum())
assert rows[0] + 3 < rows[1] < rows[2] - 3, rows
assert sizes[0] * 1.4 < sizes[1] < sizes[2] / 1.4, sizes

# A Blender without numpy, as Debian's may be: the add-on is switched on, says so in its preferences, and does nothing else.
name = addon.__name__
bpy.ops.preferences.addon_disable(module=name)
for each in [each for each in sys.modules if each == name or each.startswith(name + ".")]:
    del sys.modules[each]
sys.modules["numpy"] = None
bpy.ops.preferences.addon_enable(module=name)
assert name in bpy.context.preferences.addons and not hasattr(bpy.types.Object, "fieldwright")
bpy.ops.preferences.addon_disable(module=name)
print("all is well")
