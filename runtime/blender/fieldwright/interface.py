"""What a person sees: menus, operators, the panel, the preferences."""
import json
import os
import textwrap

import bpy
from bpy_extras.io_utils import ImportHelper

from . import driven, solid


class Preferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    program: bpy.props.StringProperty(name="Program", subtype="FILE_PATH",
                                      description="The command fieldwright; empty: the one on the path",
                                      default=os.environ.get("FIELDWRIGHT", ""))

    def draw(self, context):
        self.layout.prop(self, "program")


class ImportGraph(bpy.types.Operator, ImportHelper):
    """Add a graph of Fieldwright as an object"""

    bl_idname = "import_mesh.fieldwright"
    bl_label = "Fieldwright graph (.field.json)"
    bl_options = {"REGISTER", "UNDO"}
    filename_ext = ".json"
    filter_glob: bpy.props.StringProperty(default="*.field.json", options={"HIDDEN"})

    def execute(self, context):
        thing = driven.add(context, self.filepath)
        if thing.fieldwright.error:
            self.report({"WARNING"}, thing.fieldwright.error)
        return {"FINISHED"}


class OfGraph:
    """What can be done with an object of a graph."""

    @classmethod
    def poll(cls, context):
        return bool(context.object and context.object.type == "MESH" and context.object.fieldwright.used())


class Reload(OfGraph, bpy.types.Operator):
    """Read the graph's file again"""

    bl_idname = "object.fieldwright_reload"
    bl_label = "Reload"
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context):
        if not driven.reopen(context.object, context.scene):
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
        stem = bpy.path.abspath(self.filepath).removesuffix(".json").removesuffix(".field")
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
        finally:
            thing.to_mesh_clear()
        driven.add(context, stem + ".field.json")
        return {"FINISHED"}


class Bake(OfGraph, bpy.types.Operator):
    """Make a mesh object of every frame, shown at its frame alone: the scene then needs no Fieldwright"""

    bl_idname = "object.fieldwright_bake"
    bl_label = "Bake frames"
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context):
        thing, scene, before = context.object, context.scene, context.scene.frame_current
        parent = bpy.data.objects.new(thing.name + " frames", None)
        context.collection.objects.link(parent)
        error = ""
        for frame in range(scene.frame_start, scene.frame_end + 1):
            scene.frame_set(frame)
            error = thing.fieldwright.error
            if error:
                break
            baked = bpy.data.objects.new(f"{thing.name} {frame:04}", thing.data.copy())
            del baked.data[solid.MARK]
            context.collection.objects.link(baked)
            baked.parent = parent
            baked.matrix_world = thing.matrix_world
            for at, hidden in ((frame - 1, True), (frame, False), (frame + 1, True)):
                baked.hide_render = baked.hide_viewport = hidden
                for path in ("hide_render", "hide_viewport"):
                    baked.keyframe_insert(path, frame=at)
        scene.frame_set(before)
        if error:
            self.report({"WARNING"}, error)
            return {"FINISHED"}
        thing.hide_render = thing.hide_viewport = True
        return {"FINISHED"}


class Panel(OfGraph, bpy.types.Panel):
    bl_idname = "OBJECT_PT_fieldwright"
    bl_label = "Fieldwright"
    bl_space_type, bl_region_type, bl_context = "PROPERTIES", "WINDOW", "object"

    def draw(self, context):
        own, layout = context.object.fieldwright, self.layout
        layout.use_property_split = True
        if own.error:
            box = layout.box()
            box.alert = True
            letters = int(context.region.width / (7 * context.preferences.system.ui_scale)) - 6  # a label has one line
            for index, line in enumerate(textwrap.wrap(own.error, max(letters, 16))):
                box.label(text=line, icon="BLANK1" if index else "ERROR")
        layout.prop(own, "path")
        layout.prop(own, "resolution")
        for parameter in own.parameters:
            layout.prop(parameter, parameter.shown(), text=parameter.name)
        row = layout.row()
        row.operator(Reload.bl_idname)
        row.operator(Bake.bl_idname)


def import_menu(self, context):
    self.layout.operator(ImportGraph.bl_idname)


def object_menu(self, context):
    self.layout.operator(FromMesh.bl_idname)


classes = (Preferences, ImportGraph, Reload, FromMesh, Bake, Panel)
