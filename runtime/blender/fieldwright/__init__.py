"""Graphs of Fieldwright as objects of Blender.

A graph file becomes an object. Its exposed parameters are properties of that object, which drive it at once; a graph that
moves follows the frame. What is wrong is told at the object, in the panel: Properties, Object, Fieldwright.
"""
import json
import os
from collections import OrderedDict

import bpy
from bpy.app.handlers import persistent
from bpy_extras.io_utils import ImportHelper

from . import server, solid

bl_info = {
    "name": "Fieldwright",
    "author": "The Fieldwright authors",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "File > Import, Properties > Object",
    "description": "Graphs of signed distance fields as objects, with live parameters",
    "category": "Import-Export",
}

MOST_CACHED_BYTES = 512 << 20  # of frames, of all objects together
graphs = {}            # server.Graph by the object's name in this session
frames = OrderedDict()  # (key, frame) to arrays, the last used last
cached_bytes = 0
quiet = False           # values are being set by the add-on, not by a hand


def program():
    addon = bpy.context.preferences.addons.get(__package__)
    return server.find_program(addon.preferences.program if addon else os.environ.get("FIELDWRIGHT", ""))


def graph_of(thing):
    """The open graph of an object; one of its own, if it is a copy of another."""
    if any(other != thing and other.fieldwright.key == thing.fieldwright.key for other in bpy.data.objects):
        thing.fieldwright.key = new_key()
    path = bpy.path.abspath(thing.fieldwright.path)
    known = graphs.get(thing.fieldwright.key)
    if known is None or known.path != os.path.abspath(path):
        known = graphs[thing.fieldwright.key] = server.Graph(path, program())
        known.values = {each.name: each.numbers() for each in thing.fieldwright.parameters}
        known.open()
    return known


def forget_frames(key):
    global cached_bytes
    for entry in [entry for entry in frames if entry[0] == key]:
        cached_bytes -= size_of(frames.pop(entry))


def size_of(made):
    return sum(made[name].nbytes for name in ("places", "triangles", "colors") if made[name] is not None)


def remember(entry, made):
    global cached_bytes
    frames[entry] = made
    cached_bytes += size_of(made)
    while cached_bytes > MOST_CACHED_BYTES and len(frames) > 1:
        cached_bytes -= size_of(frames.popitem(last=False)[1])


def seconds_of(scene):
    return (scene.frame_current_final - scene.frame_start) * scene.render.fps_base / scene.render.fps


def guarded(work):
    """Does the work for an object; what is wrong is told at it."""

    def does(thing, *arguments):
        try:
            work(thing, *arguments)
            thing.fieldwright.error = ""
        except server.ServerError as error:
            thing.fieldwright.error = str(error)
        except OSError as error:
            thing.fieldwright.error = f"{error.filename or ''}: {error.strerror}"
        return not thing.fieldwright.error

    return does


@guarded
def refresh(thing, scene):
    """The object as its parameters and the frame say."""
    own = thing.fieldwright
    moves = own.moves
    entry = (own.key, scene.frame_current_final if moves else None)
    made = frames.get(entry)
    if made is None:
        graph = graph_of(thing)
        if moves:
            graph.time(seconds_of(scene))
        made = solid.arrays(*graph.mesh(own.resolution))
        if moves:
            remember(entry, made)
    else:
        frames.move_to_end(entry)
    solid.fill(thing.data, made)
    solid.dress(thing.data, made)


@guarded
def reopen(thing, scene):
    """Reads the graph's file again; values of parameters that are still there stay."""
    global quiet
    own = thing.fieldwright
    old = {each.name: each.numbers() for each in own.parameters}
    graph = graphs[own.key] = server.Graph(bpy.path.abspath(own.path), program())
    graph.values = old
    graph.open()
    about = graph.about
    own.moves = about["moves"]
    listed = [each for each in graph.ask("parameters")[0]["parameters"] if not each["animated"]]
    quiet = True
    try:
        own.parameters.clear()
        for each in listed:
            own.parameters.add().take(each)
    finally:
        quiet = False
    forget_frames(own.key)
    if not refresh(thing, scene):
        raise server.ServerError(own.error)


def changed(parameter, context):
    """A hand has moved a parameter."""
    if quiet:
        return
    thing = parameter.id_data
    push(thing, parameter)
    forget_frames(thing.fieldwright.key)
    if not thing.fieldwright.error:
        refresh(thing, context.scene)


@guarded
def push(thing, parameter):
    numbers = parameter.clamped()
    graph_of(thing).set({parameter.name: numbers if len(numbers) > 1 else numbers[0]})


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

    def numbers(self):
        value = getattr(self, self.shown())
        return [value] if self.count == 1 else list(value)

    def clamped(self):
        # As single precision has it, a limit may lie beyond itself.
        return [min(max(number, self.least), self.most) for number in self.numbers()]

    def take(self, about):
        value = about["value"] if isinstance(about["value"], list) else [about["value"]]
        self.name, self.count, self.is_color = about["name"], len(value), about["unit"] == "color" and len(value) == 3
        self.least, self.most = about.get("min", -1e30), about.get("max", 1e30)
        setattr(self, self.shown(), value[0] if len(value) == 1 else value)


def renamed(own, context):
    if own.key:
        reopen(own.id_data, context.scene)


def coarsened(own, context):
    forget_frames(own.key)
    refresh(own.id_data, context.scene)


class OfObject(bpy.types.PropertyGroup):
    """What makes an object a graph's."""

    path: bpy.props.StringProperty(name="Graph", subtype="FILE_PATH",
                                   update=renamed)
    key: bpy.props.StringProperty()
    resolution: bpy.props.IntProperty(
        name="Resolution", min=0, max=1024, description="Cells along the longest side; 0: as the graph says",
        update=coarsened)
    moves: bpy.props.BoolProperty()
    error: bpy.props.StringProperty()
    parameters: bpy.props.CollectionProperty(type=Parameter)


class Preferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    program: bpy.props.StringProperty(name="Program", subtype="FILE_PATH",
                                      description="The command fieldwright; empty: the one on the path",
                                      default=os.environ.get("FIELDWRIGHT", ""))

    def draw(self, context):
        self.layout.prop(self, "program")


def new_key():
    return os.urandom(8).hex()


def add_graph(context, path):
    """An object of the graph file, in the scene; its error says what is wrong, if something is."""
    name = os.path.basename(path).removesuffix(".json").removesuffix(".field")
    thing = bpy.data.objects.new(name, bpy.data.meshes.new(name))
    context.collection.objects.link(thing)
    thing.fieldwright["path"], thing.fieldwright.key = path, new_key()
    reopen(thing, context.scene)
    for other in context.selected_objects:
        other.select_set(False)
    thing.select_set(True)
    context.view_layer.objects.active = thing
    return thing


class ImportGraph(bpy.types.Operator, ImportHelper):
    """Add a graph of Fieldwright as an object"""

    bl_idname = "import_mesh.fieldwright"
    bl_label = "Fieldwright graph (.field.json)"
    bl_options = {"REGISTER", "UNDO"}
    filename_ext = ".json"
    filter_glob: bpy.props.StringProperty(default="*.field.json", options={"HIDDEN"})

    def execute(self, context):
        thing = add_graph(context, self.filepath)
        if thing.fieldwright.error:
            self.report({"WARNING"}, thing.fieldwright.error)
        return {"FINISHED"}


class Reload(bpy.types.Operator):
    """Read the graph's file again"""

    bl_idname = "object.fieldwright_reload"
    bl_label = "Reload"

    @classmethod
    def poll(cls, context):
        return bool(context.object and context.object.fieldwright.key)

    def execute(self, context):
        if not reopen(context.object, context.scene):
            self.report({"WARNING"}, context.object.fieldwright.error)
        return {"FINISHED"}


class FromMesh(bpy.types.Operator):
    """Make a graph of the active mesh: it is a field then, which nodes can carve and blend"""

    bl_idname = "object.fieldwright_from_mesh"
    bl_label = "Mesh to Fieldwright graph"
    bl_options = {"REGISTER", "UNDO"}
    filepath: bpy.props.StringProperty(subtype="FILE_PATH", description="The graph file that is written")

    @classmethod
    def poll(cls, context):
        return bool(context.object and context.object.type == "MESH")

    def invoke(self, context, event):
        self.filepath = context.object.name + ".field.json"
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def execute(self, context):
        thing = context.object.evaluated_get(context.evaluated_depsgraph_get())
        stem = self.filepath.removesuffix(".json").removesuffix(".field")
        graph = {"fieldwright": 1, "nodes": [
            {"id": "mesh", "type": "mesh_file", "inputs": {"path": os.path.basename(stem) + ".obj"}},
            {"id": "field", "type": "mesh_to_field", "inputs": {"mesh": {"from": "mesh"}}},
            {"id": "out", "type": "output", "inputs": {"surface": {"from": "field"}}}]}
        try:
            solid.to_obj(thing.to_mesh(), thing.matrix_world, stem + ".obj")
            with open(stem + ".field.json", "w", encoding="utf-8") as file:
                json.dump(graph, file, indent=1)
        except OSError as error:
            self.report({"ERROR"}, f"{error.filename}: {error.strerror}")
            return {"CANCELLED"}
        thing.to_mesh_clear()
        add_graph(context, stem + ".field.json")
        return {"FINISHED"}


class Bake(bpy.types.Operator):
    """Make a mesh object of every frame, shown at its frame alone: the scene then needs no Fieldwright"""

    bl_idname = "object.fieldwright_bake"
    bl_label = "Bake frames"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        return bool(context.object and context.object.fieldwright.key)

    def execute(self, context):
        thing, scene, before = context.object, context.scene, context.scene.frame_current
        parent = bpy.data.objects.new(thing.name + " frames", None)
        context.collection.objects.link(parent)
        parent.matrix_world = thing.matrix_world
        for frame in range(scene.frame_start, scene.frame_end + 1):
            scene.frame_set(frame)
            if thing.fieldwright.error:
                break
            baked = bpy.data.objects.new(f"{thing.name} {frame:04}", thing.data.copy())
            context.collection.objects.link(baked)
            baked.parent = parent
            for at, hidden in ((frame - 1, True), (frame, False), (frame + 1, True)):
                baked.hide_render = baked.hide_viewport = hidden
                for path in ("hide_render", "hide_viewport"):
                    baked.keyframe_insert(path, frame=at)
        scene.frame_set(before)
        if thing.fieldwright.error:
            self.report({"WARNING"}, thing.fieldwright.error)
        thing.hide_render = True
        thing.hide_set(True)
        return {"FINISHED"}


class Panel(bpy.types.Panel):
    bl_idname = "OBJECT_PT_fieldwright"
    bl_label = "Fieldwright"
    bl_space_type, bl_region_type, bl_context = "PROPERTIES", "WINDOW", "object"

    @classmethod
    def poll(cls, context):
        return bool(context.object and context.object.fieldwright.key)

    def draw(self, context):
        own, layout = context.object.fieldwright, self.layout
        layout.use_property_split = True
        if own.error:
            box = layout.box()
            box.alert = True
            words = own.error
            while words:  # a label has one line
                box.label(text=words[:60], icon="ERROR" if words is own.error else "BLANK1")
                words = words[60:]
        layout.prop(own, "path")
        layout.prop(own, "resolution")
        for parameter in own.parameters:
            layout.prop(parameter, parameter.shown(), text=parameter.name)
        row = layout.row()
        row.operator(Reload.bl_idname)
        row.operator(Bake.bl_idname)


def menu(self, context):
    self.layout.operator(ImportGraph.bl_idname)


def object_menu(self, context):
    self.layout.operator(FromMesh.bl_idname)


def of_scene(scene):
    return [thing for thing in scene.objects if thing.type == "MESH" and thing.fieldwright.key]


@persistent
def frame_changed(scene, depsgraph=None):
    for thing in of_scene(scene):
        own = thing.fieldwright
        known = graphs.get(own.key)
        if known and thing.animation_data:  # keyed parameters tell nobody
            for parameter in own.parameters:
                if known.values.get(parameter.name) not in (parameter.clamped(), parameter.numbers()[0]):
                    forget_frames(own.key)
                    push(thing, parameter)
        if own.moves or (thing.animation_data and own.parameters):
            refresh(thing, scene)


@persistent
def loaded(*_):
    """Another file was opened: what it shows was saved with it, and is made again when something changes."""
    graphs.clear()
    frames.clear()
    server.Graph.stop_all()


classes = (Parameter, OfObject, Preferences, ImportGraph, Reload, FromMesh, Bake, Panel)


def register():
    for each in classes:
        bpy.utils.register_class(each)
    bpy.types.Object.fieldwright = bpy.props.PointerProperty(type=OfObject)
    bpy.types.TOPBAR_MT_file_import.append(menu)
    bpy.types.VIEW3D_MT_object_convert.append(object_menu)
    bpy.app.handlers.frame_change_post.append(frame_changed)
    bpy.app.handlers.load_post.append(loaded)


def unregister():
    loaded()
    bpy.app.handlers.load_post.remove(loaded)
    bpy.app.handlers.frame_change_post.remove(frame_changed)
    bpy.types.VIEW3D_MT_object_convert.remove(object_menu)
    bpy.types.TOPBAR_MT_file_import.remove(menu)
    del bpy.types.Object.fieldwright
    for each in reversed(classes):
        bpy.utils.unregister_class(each)
