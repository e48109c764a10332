# SPDX-License-Identifier: Apache-2.0
"""lumen in 3D Slicer: vessels of a volume with a few clicks, by the modules LumenVessels and LumenCaseToModel."""
import ctk
import qt
import slicer
from slicer.ScriptedLoadableModule import ScriptedLoadableModule, ScriptedLoadableModuleLogic, ScriptedLoadableModuleWidget

try:
    from slicer.i18n import tr as _
except ImportError:  # before Slicer 5.6
    _ = str

COLOUR = (0.85, 0.25, 0.2)


class Lumen(ScriptedLoadableModule):
    def __init__(self, parent):
        super().__init__(parent)
        parent.title = "lumen"
        parent.categories = ["Vascular Modeling"]
        parent.dependencies = ["LumenVessels", "LumenCaseToModel"]
        parent.contributors = ["The lumen developers"]
        parent.helpText = _(
            "Choose an angiogram, click into vessels if you like (each point is a vessel, and so is each curve), and apply. The surface, the "
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

    def vesselParameters(self, volume, seeds, outputs, case, seedsOnly=False, edge="0.5r"):
        """Parameters of LumenVessels. `case`: a path, or empty for none."""
        if volume is None: raise ValueError(_("Choose a volume."))
        if seedsOnly and not seeds: raise ValueError(_("Tracking from seeds alone needs a markups node with points."))
        parameters = {"volume": volume, "seedsOnly": seedsOnly, "edge": edge, **outputs}
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

    def onApply(self):
        with slicer.util.tryWithErrorDisplay(_("The vessels cannot be found."), waitCursor=False):
            volume = self.volume.currentNode()
            outputs = self.logic.outputs(volume.GetName() if volume else "")
            parameters = self.logic.vesselParameters(volume, list(self.seeds.checkedNodes()), outputs, self.case.currentPath,
                                                     self.seedsOnly.checked, self.edge.text)
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
