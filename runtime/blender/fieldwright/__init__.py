"""Graphs of Fieldwright as objects of Blender.

A graph file becomes an object. Its exposed parameters are properties of that object, which drive it at once; a graph that
moves follows the frame. What is wrong is told at the object, in the panel: Properties, Object, Fieldwright.
"""
import importlib.util

import bpy
from bpy.app.handlers import persistent

has_numpy = importlib.util.find_spec("numpy") is not None  # Debian's Blender comes without
if has_numpy:
    from . import driven, interface

# What Blender before 4.2 reads; newer ones read blender_manifest.toml.
bl_info = {
    "name": "Fieldwright",
    "author": "The Fieldwright authors",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "File > Import, Properties > Object",
    "description": "Graphs of signed distance fields as objects, with live parameters",
    "category": "Import-Export",
}


@persistent
def frame_changed(scene, depsgraph=None):
    driven.followed(scene, depsgraph)


@persistent
def loaded(*_):
    """Another file was opened: what it shows was saved with it, and is made again when something changes."""
    driven.forget_all()


class WithoutNumpy(bpy.types.AddonPreferences):
    """Instead of all else, where numpy is not there."""

    bl_idname = __package__

    def draw(self, context):
        self.layout.label(text="Blender's Python has no numpy: install it (Debian: python3-numpy), and start Blender again",
                          icon="ERROR")


classes = (driven.Parameter, driven.OfObject, *interface.classes) if has_numpy else (WithoutNumpy,)


def register():
    for each in classes:
        bpy.utils.register_class(each)
    if has_numpy:
        appear()


def unregister():
    if has_numpy:
        disappear()
    for each in reversed(classes):
        bpy.utils.unregister_class(each)


def appear():
    bpy.types.Object.fieldwright = bpy.props.PointerProperty(type=driven.OfObject)
    bpy.types.TOPBAR_MT_file_import.append(interface.import_menu)
    bpy.types.VIEW3D_MT_object_convert.append(interface.object_menu)
    bpy.app.handlers.frame_change_post.append(frame_changed)
    bpy.app.handlers.load_post.append(loaded)


def disappear():
    loaded()
    bpy.app.handlers.load_post.remove(loaded)
    bpy.app.handlers.frame_change_post.remove(frame_changed)
    bpy.types.VIEW3D_MT_object_convert.remove(interface.object_menu)
    bpy.types.TOPBAR_MT_file_import.remove(interface.import_menu)
    del bpy.types.Object.fieldwright
