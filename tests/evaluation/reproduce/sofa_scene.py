# SPDX-License-Identifier: Apache-2.0
"""Scenes of SOFA in which BeamAdapter's controller pushes an instrument into a vessel, whose wall is a case (the plugin
LumenSofa) or a triangle mesh (SOFA's own collision). Both have the same instrument, solver, friction and distances.

Units: mm, kg, s; so forces are mN and Young's moduli kPa. SOFA v25.06 requires: a straight section is the first one (its
rest shape counts its start twice); the spring that holds the base takes its rest place from the first frame, not from the grid;
triangles face inwards, or LocalMinDistance finds nothing from inside; a system that is not built (build_lcp) costs the least.
"""
from dataclasses import dataclass

import numpy as np


@dataclass
class Section:
    """A part of the instrument, from handle to tip. `turn` is the diameter of its rest shape's spire, mm; 0: straight."""
    length: float
    beams: int
    young: float        # kPa
    turn: float = 0.0
    pitch: float = 0.0  # mm from spire to spire


@dataclass
class Instrument:
    radius: float    # mm
    density: float   # kg / mm^3
    sections: list


@dataclass
class SoftVessel:
    """A tube of frames in elastic tissue. Sources of the values: docs/sofa.md."""
    nodes: list             # of the case's tree, one for each frame
    centres: np.ndarray     # mm
    radii: np.ndarray       # mm, of the lumen
    record: str = "vessel"
    wall_young: float = 800.0   # kPa
    wall_share: float = 0.25    # thickness of the wall over the radius
    tissue: float = 10.0        # kPa: mN / mm for each mm of vessel
    damping: float = 0.05       # s
    density: float = 1.06e-6    # kg / mm^3


@dataclass
class Scene:
    instrument: Instrument
    start: np.ndarray      # mm: where it comes out
    direction: np.ndarray  # its direction there
    speed: float           # mm/s
    case: str = ""         # the wall: a case, or
    mesh: str = ""         # an OBJ
    domain: str = "local"
    branch: str = ""
    dt: float = 0.01
    friction: float = 0.1
    alarm: float = 0.5     # mm
    mesh_alarm: float = 0.5
    samples: int = 2
    rotation: float = 0.0
    record: str = "instrument"
    iterations: int = 1000
    initial: float = 1.0   # mm that are out at the beginning
    soft: SoftVessel = None  # the vessel gives way


PLUGINS = """BeamAdapter Sofa.Component.AnimationLoop Sofa.Component.Constraint.Lagrangian.Correction
Sofa.Component.Constraint.Lagrangian.Solver Sofa.Component.Constraint.Projective Sofa.Component.LinearSolver.Direct
Sofa.Component.ODESolver.Backward Sofa.Component.Playback Sofa.Component.SolidMechanics.Spring
Sofa.Component.StateContainer Sofa.Component.Topology.Container.Dynamic Sofa.Component.Topology.Container.Grid""".split()
OF_MESH = """Sofa.Component.Collision.Detection.Algorithm Sofa.Component.Collision.Detection.Intersection
Sofa.Component.Collision.Geometry Sofa.Component.Collision.Response.Contact Sofa.Component.IO.Mesh
Sofa.Component.Topology.Container.Constant""".split()


def quaternion(direction):
    """(x, y, z, w) that turns the x-axis to `direction`."""
    d = np.asarray(direction) / np.linalg.norm(direction)
    axis = np.array([0.0, -d[2], d[1]])
    if np.linalg.norm(axis) < 1e-9:
        return (0, 0, 0, 1) if d[0] > 0 else (0, 0, 1, 0)
    axis /= np.linalg.norm(axis)
    half = np.arccos(np.clip(d[0], -1, 1)) / 2
    return (*(axis * np.sin(half)), np.cos(half))


def sections_text(instrument):
    lines, names = [], []
    for i, s in enumerate(instrument.sections):
        kind = "RodSpireSection" if s.turn else "RodStraightSection"
        spire = f' spireDiameter="{s.turn}" spireHeight="{s.pitch}"' if s.turn else ""
        lines.append(f'    <{kind} name="section{i}" length="{s.length}" nbBeams="{s.beams}" nbEdgesCollis="{s.beams}" '
                     f'nbEdgesVisu="{s.beams}" youngModulus="{s.young}" poissonRatio="0.3" '
                     f'radius="{instrument.radius}" massDensity="{instrument.density}"{spire}/>')
        names.append(f"@section{i}")
    return "\n".join(lines), " ".join(names)


def numbers(values):
    return " ".join(f"{v:.6g}" for v in values)


def tube_text(vessel, dt):
    """The components that make frames of a vessel a tube in tissue; they stand for half of the edges at each."""
    c = np.asarray(vessel.centres)
    along = np.gradient(c, axis=0)
    place = [(*p, *quaternion(d)) for p, d in zip(c, along)]
    edge = np.linalg.norm(np.diff(c, axis=0), axis=1)
    half = 0.5 * (np.append(edge, 0) + np.insert(edge, 0, 0))
    hold = vessel.tissue * half
    radius = 0.5 * (vessel.radii[1:] + vessel.radii[:-1])
    # lists of one value each, or all but the radii would be taken from the first
    every = np.ones(len(edge))
    edges = " ".join(f"{i} {i + 1}" for i in range(len(c) - 1))
    return f"""    <EulerImplicitSolver rayleighStiffness="{vessel.damping}" rayleighMass="0"/>
    <BTDLinearSolver/>
    <MeshTopology name="lines" position="{numbers(c.ravel())}" edges="{edges}"/>
    <MechanicalObject name="frames" template="Rigid3d" position="{numbers(np.ravel(place))}"/>
    <BeamInterpolation name="interpolation" crossSectionShape="circular" straight="0"
        radius="{numbers(radius * (1 + vessel.wall_share))}" innerRadius="{numbers(radius)}"
        lengthY="{numbers(every)}" lengthZ="{numbers(every)}"
        defaultYoungModulus="{numbers(every * vessel.wall_young)}" defaultPoissonRatio="{numbers(every * 0.49)}"/>
    <AdaptiveBeamForceFieldAndMass interpolation="@interpolation" massDensity="{vessel.density}" computeMass="1"/>
    <RestShapeSpringsForceField name="tissue" stiffness="{numbers(hold)}" angularStiffness="{numbers(hold * vessel.radii ** 2)}"/>
    <LinearSolverConstraintCorrection wire_optimization="1"/>
    <BlobPose name="pose" field="@wall" nodes="{' '.join(str(n) for n in vessel.nodes)}"/>
    <WriteState filename="{vessel.record}" writeX="1" time="0" period="{dt}"/>
"""


def wall_text(scene):
    """The vessel's node."""
    if scene.case:
        branch = f' branch="{scene.branch}"' if scene.branch else ""
        return f"""  <Node name="vessel">
    <BlobField name="wall" filename="{scene.case}" domain="{scene.domain}"{branch}/>
{tube_text(scene.soft, scene.dt) if scene.soft else ""}  </Node>"""
    return f"""  <Node name="vessel">
    <MeshOBJLoader name="loader" filename="{scene.mesh}" flipNormals="1"/>
    <MeshTopology src="@loader"/>
    <MechanicalObject name="dofs"/>
    <TriangleCollisionModel moving="0" simulated="0" group="2"/>
    <LineCollisionModel moving="0" simulated="0" group="2"/>
    <PointCollisionModel moving="0" simulated="0" group="2"/>
  </Node>"""


def contact_text(scene):
    """Components of the instrument's node for its contact."""
    if scene.case:
        r = scene.instrument.radius
        return (f'    <BeamBlobContact name="contact" field="@/vessel/wall" interpolation="@interpolation" radius="{r}" '
                f'friction="{scene.friction}" samples="{scene.samples}" alarmDistance="{scene.alarm}"/>')
    return f"""    <Node name="collision">
      <EdgeSetTopologyContainer name="edges"/>
      <EdgeSetTopologyModifier name="modifier"/>
      <MechanicalObject name="points"/>
      <MultiAdaptiveBeamMapping name="mapping" controller="../controller" useCurvAbs="1"/>
      <LineCollisionModel group="1"/>
      <PointCollisionModel group="1"/>
    </Node>"""


def pipeline_text(scene):
    if scene.case:
        return ""
    # with a narrower cone the tip of the guidewire leaves by the first bend, as contacts of its last point are left out
    r = scene.instrument.radius
    return f"""  <CollisionPipeline/>
  <BruteForceBroadPhase/>
  <BVHNarrowPhase/>
  <LocalMinDistance name="distances" contactDistance="{r}" alarmDistance="{r + scene.mesh_alarm}" angleCone="0.9"/>
  <CollisionResponse name="response" response="FrictionContactConstraint"/>
"""


def scene_text(scene):
    plugins = PLUGINS + (["LumenSofa"] if scene.case else OF_MESH)
    if scene.soft:
        plugins = plugins + ["Sofa.Component.Topology.Container.Constant"]
    required = "\n".join(f'  <RequiredPlugin name="{p}"/>' for p in plugins)
    sections, names = sections_text(scene.instrument)
    nodes = sum(s.beams for s in scene.instrument.sections) + 1
    place = " ".join(f"{v:.6g}" for v in (*scene.start, *quaternion(scene.direction)))
    return f"""<?xml version="1.0"?>
<Node name="root" dt="{scene.dt}" gravity="0 0 0">
{required}
  <FreeMotionAnimationLoop/>
  <LCPConstraintSolver mu="{scene.friction}" tolerance="1e-6" maxIt="{scene.iterations}" build_lcp="0"/>
{pipeline_text(scene)}{wall_text(scene)}
  <Node name="rest">
{sections}
    <WireRestShape template="Rigid3d" name="shape" wireMaterials="{names}"/>
    <EdgeSetTopologyContainer name="lines"/>
    <EdgeSetTopologyModifier name="modifier"/>
    <EdgeSetGeometryAlgorithms name="algorithms" template="Rigid3d"/>
    <MechanicalObject name="dofs" template="Rigid3d"/>
  </Node>
  <Node name="instrument">
    <EulerImplicitSolver rayleighStiffness="0.2" rayleighMass="0.1"/>
    <BTDLinearSolver/>
    <RegularGridTopology name="grid" nx="{nodes}" ny="1" nz="1" xmin="0" xmax="0" ymin="0" ymax="0" zmin="0" zmax="0"/>
    <MechanicalObject name="dofs" template="Rigid3d"/>
    <WireBeamInterpolation name="interpolation" WireRestShape="@../rest/shape"/>
    <AdaptiveBeamForceFieldAndMass name="forces" interpolation="@interpolation"/>
    <InterventionalRadiologyController name="controller" template="Rigid3d" instruments="interpolation" topology="@grid"
        startingPos="{place}" xtip="{scene.initial}" step="0.1" speed="{scene.speed}" rotationInstrument="{scene.rotation}"
        controlledInstrument="0" threshold="0.001"/>
    <LinearSolverConstraintCorrection wire_optimization="1"/>
    <FixedProjectiveConstraint indices="0"/>
    <RestShapeSpringsForceField points="@controller.indexFirstNode" external_rest_shape="@dofs" external_points="0"
        stiffness="1e8" angularStiffness="1e8"/>
    <WriteState filename="{scene.record}" writeX="1" writeV="1" time="0" period="{scene.dt}"/>
{contact_text(scene)}
  </Node>
</Node>
"""
