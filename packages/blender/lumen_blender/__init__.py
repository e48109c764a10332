# SPDX-License-Identifier: Apache-2.0
"""Cases of lumen in Blender: curves with radii, the surface, the ends as empties; and back."""
bl_info = {
    "name": "lumen cases",
    "author": "The lumen developers",
    "version": (0, 2, 0),
    "blender": (3, 3, 0),
    "location": "File > Import, File > Export",
    "description": "Vessels with their centerlines, surface and ends; needs the program lumen",
    "category": "Import-Export",
}

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, StringProperty
from bpy_extras.io_utils import ExportHelper, ImportHelper

from . import exporting, importing
from .program import Failure

SCALE = FloatProperty(name="Scale", description="Blender units of a millimetre: 0.001 where a unit is a metre", default=0.001,
                      min=1e-6, max=1000, precision=4)


class LumenPreferences(bpy.types.AddonPreferences):
    bl_idname = __name__
    program: StringProperty(name="Program lumen", subtype="FILE_PATH", default="", description="Empty: the one on the path")

    def draw(self, context):
        self.layout.prop(self, "program")


class LumenOperator:
    """An operator whose failures are a message, not a traceback."""

    def execute(self, context):
        addon = context.preferences.addons.get(__name__)
        try:
            text = self.work(context, addon.preferences.program if addon else "")
        except Failure as failure:
            self.report({"ERROR"}, str(failure))
            return {"CANCELLED"}
        self.report({"INFO"}, text)
        return {"FINISHED"}


class ImportLumenCase(LumenOperator, bpy.types.Operator, ImportHelper):
    """Import a case of lumen: centerlines, surface and ends"""
    bl_idname = "import_scene.lumen"
    bl_label = "Import lumen case"
    bl_options = {"REGISTER", "UNDO"}
    filename_ext = ".lumen"
    filter_glob: StringProperty(default="*.lumen;*.lumen.json", options={"HIDDEN"})
    scale: SCALE
    curves: BoolProperty(name="Centerlines", description="A curve for each vessel, with its radii", default=True)
    surface: BoolProperty(name="Surface and ends", description="The closed surface, and an empty at each end", default=True)
    edge: StringProperty(name="Edge length", description="Edge of the surface in mm, or as a share of the radius, such as 0.5r", default="0.5r")

    def work(self, context, program):
        made = importing.import_case(context, self.filepath, program, self.scale, self.curves, self.surface, self.edge)
        return f"{made.name}: {len(made.all_objects)} objects"


class ExportLumenCase(LumenOperator, bpy.types.Operator, ExportHelper):
    """Export curves with radii, or a surface, as a case of lumen"""
    bl_idname = "export_scene.lumen"
    bl_label = "Export lumen case"
    filename_ext = ".lumen"
    filter_glob: StringProperty(default="*.lumen;*.lumen.json", options={"HIDDEN"})
    scale: SCALE
    source: EnumProperty(name="From", items=[
        ("CURVES", "Curves", "Each curve is a vessel, round as its radii state"),
        ("SURFACE", "Surface", "Walls are those of the mesh; its centerline is that of the curves, or found")])
    selected: BoolProperty(name="Selected only", default=False)

    def work(self, context, program):
        return exporting.export_case(context, self.filepath, program, self.scale, self.source, self.selected)


def import_entry(menu, context):
    menu.layout.operator(ImportLumenCase.bl_idname, text="lumen case (.lumen)")


def export_entry(menu, context):
    menu.layout.operator(ExportLumenCase.bl_idname, text="lumen case (.lumen)")


CLASSES = (LumenPreferences, ImportLumenCase, ExportLumenCase)


def register():
    for each in CLASSES: bpy.utils.register_class(each)
    bpy.types.TOPBAR_MT_file_import.append(import_entry)
    bpy.types.TOPBAR_MT_file_export.append(export_entry)


def unregister():
    bpy.types.TOPBAR_MT_file_export.remove(export_entry)
    bpy.types.TOPBAR_MT_file_import.remove(import_entry)
    for each in reversed(CLASSES): bpy.utils.unregister_class(each)
