# SPDX-License-Identifier: Apache-2.0
"""lumen in 3D Slicer: vessels of a volume with a few clicks, by the modules LumenVessels and LumenCaseToModel."""
import os

import ctk
import qt
import slicer
from slicer.ScriptedLoadableModule import ScriptedLoadableModule, ScriptedLoadableModuleLogic, ScriptedLoadableModuleWidget

try:
    from slicer.i18n import tr as _
except ImportError:  # before Slicer 5.6
    _ = str

COLOUR = (0.85, 0.25, 0.2)
AS_NAMED = "as its name shows"
# of lumen convert's option role
ROLES = ("vessel", "artery", "vein", "chamber", "aneurysm", "true-lumen", "false-lumen", "bone", "metal", "calcium", "organ", "region", "unknown")


class Lumen(ScriptedLoadableModule):
    def __init__(self, parent):
        super().__init__(parent)
        parent.title = "lumen"
        parent.categories = ["Vascular Modeling"]
        parent.dependencies = ["LumenVessels", "LumenCaseToModel"]
        parent.contributors = ["The lumen developers"]
        parent.helpText = _(
            "Choose an angiogram, click into vessels if you like (each point is a vessel, and so is each curve), and apply. A segmentation "
            "names vessels and states what is none: each segment has the role that its name shows, or the one that you choose. The surface, the "
            "centerline and the ends appear in the scene; the case is a file for lumen and for simulators. Not for clinical use.")
        parent.acknowledgementText = _(
            "The method is that of A. Yureidini, Robust blood vessel surface reconstruction for interactive simulations from "
            "patient data, 2014.")


class LumenLogic(ScriptedLoadableModuleLogic):
    """The work behind the buttons."""

    def outputs(self, name):
        """New nodes for the results: surface, centerline and ends."""
        add = slicer.mrmlScene.AddNewNodeByClass
        return {"surface": add("vtkMRMLModelNode", f"{name} surface"),
                "centerline": add("vtkMRMLModelNode", f"{name} centerline"),
                "ends": add("vtkMRMLMarkupsFiducialNode", f"{name} ends")}

    def labelParameters(self, segmentation, roles, onlyLabelled=False):
        """Parameters of a segmentation, which becomes a file. `roles`: by the names of segments; AS_NAMED leaves one to its name."""
        path = os.path.join(slicer.util.tempDirectory(), "segments.seg.nrrd")
        if not slicer.util.saveNode(segmentation, path): raise ValueError(_("The segmentation cannot be written."))
        stated = {name: role for name, role in roles.items() if role != AS_NAMED}
        for name in stated:
            if "," in name: raise ValueError(_("Rename the segment {name}: a comma parts roles.").format(name=name))
        return {"labelMap": path, "onlyLabelled": onlyLabelled, "roles": ",".join(f"{name}={role}" for name, role in stated.items())}

    def vesselParameters(self, volume, seeds, outputs, case, seedsOnly=False, edge="0.5r", labels=None):
        """Parameters of LumenVessels. `case`: a path, or empty for none; `labels`: those of labelParameters()."""
        if volume is None: raise ValueError(_("Choose a volume."))
        if seedsOnly and not seeds: raise ValueError(_("Tracking from seeds alone needs a markups node with points."))
        parameters = {"volume": volume, "seedsOnly": seedsOnly, "edge": edge, **outputs, **(labels or {})}
        if seeds: parameters["seeds"] = seeds
        if case: parameters["case"] = case
        return parameters

    def findVessels(self, parameters):
        """Starts LumenVessels in the background; the node reports progress, status and errors."""
        return slicer.cli.run(slicer.modules.lumenvessels, None, parameters)

    def showCase(self, case, outputs, edge="0.5r"):
        return slicer.cli.run(slicer.modules.lumencasetomodel, None, {"case": case, "edge": edge, **outputs})

    def show(self, outputs):
        """The surface shaded and seen through a little, the centerline as lines within."""
        for name, node in outputs.items():
            node.CreateDefaultDisplayNodes()
            display = node.GetDisplayNode()
            if name == "surface":
                display.SetColor(*COLOUR)
                display.SetOpacity(0.7)
                display.SetVisibility2D(True)
            elif name == "centerline":
                display.SetLineWidth(3)


class LumenWidget(ScriptedLoadableModuleWidget):
    def setup(self):
        super().setup()
        self.logic, self.run, self.outputs = LumenLogic(), None, {}
        form = self.form(_("Vessels from a volume"))
        self.volume = self.selector(["vtkMRMLScalarVolumeNode"], "inputVolume")
        form.addRow(_("Volume:"), self.volume)
        self.seeds = slicer.qMRMLCheckableNodeComboBox()
        self.seeds.nodeTypes = ["vtkMRMLMarkupsFiducialNode", "vtkMRMLMarkupsCurveNode"]
        self.seeds.setMRMLScene(slicer.mrmlScene)
        self.seeds.toolTip = _("Point lists and curves within vessels. Without any all vessels are found.")
        form.addRow(_("Seeds:"), self.seeds)
        self.segmentation = self.selector(["vtkMRMLSegmentationNode"], "inputSegmentation")
        self.segmentation.toolTip = _("Segments that name vessels and state what is a vessel or none")
        self.segmentation.connect("currentNodeChanged(vtkMRMLNode*)", self.onSegmentation)
        form.addRow(_("Segmentation:"), self.segmentation)
        self.roles = qt.QTableWidget(0, 2)
        self.roles.setHorizontalHeaderLabels([_("Segment"), _("Role")])
        self.roles.horizontalHeader().setSectionResizeMode(0, qt.QHeaderView.Stretch)
        self.roles.visible = False
        form.addRow(self.roles)
        self.onlyLabelled = qt.QCheckBox()
        form.addRow(_("Labelled only:"), self.onlyLabelled)
        self.seedsOnly = qt.QCheckBox()
        form.addRow(_("Seeds only:"), self.seedsOnly)
        self.case = ctk.ctkPathLineEdit()
        self.case.filters = ctk.ctkPathLineEdit.Files | ctk.ctkPathLineEdit.Writable
        self.case.nameFilters = ["lumen case (*.lumen *.lumen.json)"]
        form.addRow(_("Case:"), self.case)
        self.edge = qt.QLineEdit("0.5r")
        self.edge.toolTip = _("Length of the triangles' edges in mm, or as a share of the radius, such as 0.5r")
        form.addRow(_("Edge length:"), self.edge)
        self.apply = self.button(form, _("Apply"), self.onApply)
        self.load = self.button(form, _("Show the case"), self.onShowCase)
        self.bar = slicer.qSlicerCLIProgressBar()
        form.addRow(self.bar)
        self.layout.addStretch(1)

    def form(self, title):
        box = ctk.ctkCollapsibleButton()
        box.text = title
        self.layout.addWidget(box)
        return qt.QFormLayout(box)

    def selector(self, types, name):
        selector = slicer.qMRMLNodeComboBox()
        selector.nodeTypes = types
        selector.objectName = name
        selector.addEnabled = selector.removeEnabled = False
        selector.noneEnabled = True
        selector.setMRMLScene(slicer.mrmlScene)
        return selector

    def button(self, form, text, call):
        button = qt.QPushButton(text)
        button.connect("clicked(bool)", call)
        form.addRow(button)
        return button

    def onSegmentation(self, node):
        """A row with a menu of roles for each segment."""
        segments = node.GetSegmentation() if node else None
        names = [segments.GetNthSegment(i).GetName() for i in range(segments.GetNumberOfSegments())] if segments else []
        self.roles.visible = bool(names)
        self.roles.setRowCount(len(names))
        for row, name in enumerate(names):
            item, menu = qt.QTableWidgetItem(name), qt.QComboBox()
            item.setFlags(qt.Qt.ItemIsEnabled)
            menu.addItems([AS_NAMED, *ROLES])
            self.roles.setItem(row, 0, item)
            self.roles.setCellWidget(row, 1, menu)

    def labels(self):
        """Parameters of the chosen segmentation; none without one."""
        node = self.segmentation.currentNode()
        if node is None: return None
        roles = {self.roles.item(row, 0).text(): self.roles.cellWidget(row, 1).currentText for row in range(self.roles.rowCount)}
        return self.logic.labelParameters(node, roles, self.onlyLabelled.checked)

    def onApply(self):
        with slicer.util.tryWithErrorDisplay(_("The vessels cannot be found."), waitCursor=False):
            volume = self.volume.currentNode()
            outputs = self.logic.outputs(volume.GetName() if volume else "")
            parameters = self.logic.vesselParameters(volume, list(self.seeds.checkedNodes()), outputs, self.case.currentPath,
                                                     self.seedsOnly.checked, self.edge.text, self.labels())
            self.start(self.logic.findVessels(parameters), outputs)

    def onShowCase(self):
        with slicer.util.tryWithErrorDisplay(_("The case cannot be shown."), waitCursor=False):
            outputs = self.logic.outputs("case")
            self.start(self.logic.showCase(self.case.currentPath, outputs, self.edge.text), outputs)

    def start(self, run, outputs):
        self.run, self.outputs = run, outputs
        self.bar.setCommandLineModuleNode(run)
        self.apply.enabled = self.load.enabled = False
        run.AddObserver(slicer.vtkMRMLCommandLineModuleNode.StatusModifiedEvent, self.onStatus)

    def onStatus(self, run, event):
        if run.IsBusy(): return
        self.apply.enabled = self.load.enabled = True
        if run.GetStatus() & slicer.vtkMRMLCommandLineModuleNode.ErrorsMask:
            slicer.util.errorDisplay(run.GetErrorText())
        else:
            self.logic.show(self.outputs)
