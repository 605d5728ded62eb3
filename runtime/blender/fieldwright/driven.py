"""Objects that a graph drives: their properties, and how the mesh follows them.

A mesh is marked with the wish that it was made for (which graph, values, time, resolution): whatever Blender does with it meanwhile,
undo, copy or save, tells what it is of, and what is as it is wished for is not made again. Meshes of frames are kept by their wish.
"""
import json
import os
import threading
from collections import OrderedDict

import bpy

from . import server, solid

MOST_CACHED_BYTES = 512 << 20  # of frames, of all objects together
graphs = {}             # server.Graph by the full name of its object
frames = OrderedDict()  # arrays by wishes, the last used last
cached_bytes = 0
quiet = False           # values are being set by the add-on, not by a hand
alone = threading.RLock()  # a render follows frames on a thread of its own


def program():
    addon = bpy.context.preferences.addons.get(__package__)
    return server.find_program(addon.preferences.program if addon else os.environ.get("FIELDWRIGHT", ""))


def file_of(thing):
    """The graph file, where it is now: a path that begins at the scene's file does not follow when that is saved elsewhere."""
    own = thing.fieldwright
    if not own.path:
        return ""
    path = os.path.abspath(bpy.path.abspath(own.path, library=thing.library))
    if own.found and own.found != path and not os.path.exists(path) and os.path.exists(own.found):
        return own.found
    return path


def graph_of(thing):
    """The open graph of an object; those of objects that are no more are closed."""
    path, runs, name = file_of(thing), program(), thing.name_full
    known = graphs.get(name)
    if known is None or (known.path, known.program) != (path, runs):
        if not os.path.exists(path):
            raise server.ServerError(f"there is no file '{path}'" if path else "no graph: choose a file")
        living = {each.name_full for each in bpy.data.objects} - {name}
        for gone in [each for each in graphs if each not in living]:
            graphs.pop(gone).close()
        known = graphs[name] = server.Graph(path, runs)
    return known


def forget_file(path):
    """What was read of a file is read again when it is needed."""
    global cached_bytes
    for name in [name for name, graph in graphs.items() if graph.path == path]:
        graphs.pop(name).close()
    for wish in [wish for wish in frames if json.loads(wish)[0] == path]:
        cached_bytes -= solid.size_of(frames.pop(wish))


def forget_all():
    global cached_bytes
    graphs.clear()
    frames.clear()
    cached_bytes = 0
    server.Graph.stop_all()


def remember(wish, made):
    global cached_bytes
    frames[wish] = made
    cached_bytes += solid.size_of(made)
    while cached_bytes > MOST_CACHED_BYTES and len(frames) > 1:
        cached_bytes -= solid.size_of(frames.popitem(last=False)[1])


def seconds_of(scene):
    return (scene.frame_current_final - scene.frame_start) * scene.render.fps_base / scene.render.fps


def wish_of(thing, scene, evaluated=None):
    """What the object is to show: file, resolution, time and values, as a text."""
    own = (thing.evaluated_get(evaluated) if evaluated else thing).fieldwright  # in a render only that has what is keyed
    values = {each.name: each.value() for each in own.parameters}
    return json.dumps([file_of(thing), own.resolution, seconds_of(scene) if own.moves else 0, values])


def own_mesh(thing, wish, scene, evaluated):
    """The object's mesh, or another one in its place, if that is not this object's to change: one that the add-on did not make,
    or that others show who wish for something else."""
    mesh = thing.data
    others = [each for each in bpy.data.objects if each.data == mesh and each != thing] if mesh.users > 1 else []
    if solid.MARK in mesh and all(each.fieldwright.path and wish_of(each, scene, evaluated) == wish for each in others):
        return mesh
    thing.data = bpy.data.meshes.new(thing.name)
    thing.data[solid.MARK] = ""
    for material in mesh.materials:
        thing.data.materials.append(material)
    return thing.data


def check_free(thing):
    """That Blender lets the object's mesh be changed."""
    if thing.library or thing.override_library or thing.data.library:
        raise server.ServerError(f"'{thing.name}' belongs to another file: make it local with all of its data, and it is driven here")
    if thing.mode != "OBJECT":
        mode = thing.mode.replace("_", " ").lower()
        raise server.ServerError(f"'{thing.name}' is being edited by hand: leave {mode} mode, then reload")


def guarded(work):
    """Does the work for an object, one at a time; what is wrong is told at it."""

    def does(thing, *arguments):
        own, error = thing.fieldwright, ""
        with alone:
            try:
                work(thing, *arguments)
            except server.ServerError as wrong:
                error = str(wrong)
            except OSError as wrong:
                error = f"{wrong.filename or ''}: {wrong.strerror}"
        if own.error != error:
            own.error = error
        return not error

    return does


@guarded
def refresh(thing, scene, evaluated=None):
    """The object as its parameters and the frame say: as the evaluated dependency graph has them, if that is given."""
    wish = wish_of(thing, scene, evaluated)
    if thing.data.get(solid.MARK) == wish:
        return
    check_free(thing)
    made = frames.get(wish)
    if made is None:
        _, resolution, seconds, values = json.loads(wish)
        made = solid.arrays(*graph_of(thing).mesh(values, seconds, resolution))
        if thing.fieldwright.moves or thing.animation_data:
            remember(wish, solid.kept(made))
    else:
        frames.move_to_end(wish)
    mesh = own_mesh(thing, wish, scene, evaluated)
    solid.fill(mesh, made)
    solid.dress(mesh, made)
    mesh[solid.MARK] = wish


@guarded
def reopen(thing, scene):
    """Reads the graph's file again; values of parameters that are still there stay."""
    global quiet
    own = thing.fieldwright
    check_free(thing)
    if solid.MARK in thing.data:
        thing.data[solid.MARK] = ""
    forget_file(file_of(thing))
    graph = graph_of(thing)
    own["found"] = graph.path
    graph.open()
    own.moves = graph.about["moves"]
    old = server.fitting({each.name: each.value() for each in own.parameters}, graph.about["parameters"])
    quiet = True
    try:
        own.parameters.clear()
        for each in graph.about["parameters"]:
            if not each["animated"]:
                own.parameters.add().take({**each, "value": old.get(each["name"], each["value"])})
    finally:
        quiet = False
    if not refresh(thing, scene):
        raise server.ServerError(own.error)


def changed(parameter, context):
    """A hand has moved a parameter: beyond its limits it is held there."""
    global quiet
    if quiet:
        return
    quiet = True
    try:
        parameter.hold()
    finally:
        quiet = False
    refresh(parameter.id_data, context.scene)


class Parameter(bpy.types.PropertyGroup):
    """A parameter that the graph exposes."""

    count: bpy.props.IntProperty(default=1)
    least: bpy.props.FloatProperty(default=-1e30)
    most: bpy.props.FloatProperty(default=1e30)
    number: bpy.props.FloatProperty(name="Value", update=changed, precision=4)
    pair: bpy.props.FloatVectorProperty(name="Value", size=2, update=changed, precision=4)
    triple: bpy.props.FloatVectorProperty(name="Value", size=3, update=changed, precision=4)
    color: bpy.props.FloatVectorProperty(name="Value", size=3, subtype="COLOR", min=0, soft_max=1, update=changed)
    is_color: bpy.props.BoolProperty()

    def shown(self):
        """The name of the property that has the value."""
        return "color" if self.is_color else ("number", "pair", "triple")[self.count - 1]

    def value(self):
        value = getattr(self, self.shown())
        return value if self.count == 1 else list(value)

    def hold(self):
        value = self.value()
        held = [min(max(each, self.least), self.most) for each in (value if self.count > 1 else [value])]
        if held != (value if self.count > 1 else [value]):
            setattr(self, self.shown(), held if self.count > 1 else held[0])

    def take(self, about):
        value = about["value"] if isinstance(about["value"], list) else [about["value"]]
        self.name, self.count, self.is_color = about["name"], len(value), about["unit"] == "color" and len(value) == 3
        self.least, self.most = about.get("min", -1e30), about.get("max", 1e30)
        setattr(self, self.shown(), value[0] if len(value) == 1 else value)


def renamed(own, context):
    reopen(own.id_data, context.scene)


def coarsened(own, context):
    refresh(own.id_data, context.scene)


class OfObject(bpy.types.PropertyGroup):
    """What makes an object a graph's."""

    path: bpy.props.StringProperty(name="Graph", subtype="FILE_PATH", update=renamed)
    found: bpy.props.StringProperty(description="Where the graph was read the last time")
    resolution: bpy.props.IntProperty(name="Resolution", min=0, max=1024, update=coarsened,
                                      description="Cells along the longest side; 0: as the graph says")
    moves: bpy.props.BoolProperty()
    error: bpy.props.StringProperty()
    parameters: bpy.props.CollectionProperty(type=Parameter)

    def used(self):
        return bool(self.path or self.error)


def add(context, path):
    """An object of the graph file, in the scene; its error says what is wrong, if something is."""
    if context.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")
    path = os.path.abspath(bpy.path.abspath(path))
    name = os.path.basename(path).removesuffix(".json").removesuffix(".field")
    thing = bpy.data.objects.new(name, bpy.data.meshes.new(name))
    thing.data[solid.MARK] = ""
    collection = context.collection
    if collection.library:  # another file's
        collection = context.scene.collection
    collection.objects.link(thing)
    relative = bpy.data.filepath and context.preferences.filepaths.use_relative_paths
    thing.fieldwright["path"] = bpy.path.relpath(path) if relative else path
    reopen(thing, context.scene)
    if not context.view_layer.active_layer_collection.exclude:
        for other in context.selected_objects:
            other.select_set(False)
        thing.select_set(True)
        context.view_layer.objects.active = thing
    return thing


def followed(scene, evaluated):
    """Called at each frame, with what Blender made of it. Parameters that are keyed or driven tell nobody."""
    for thing in scene.objects:
        own = thing.fieldwright
        shown = not (thing.hide_viewport and thing.hide_render)
        if thing.type == "MESH" and own.path and shown and not thing.library and (own.moves or thing.animation_data):
            refresh(thing, scene, evaluated)
