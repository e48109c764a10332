// SPDX-License-Identifier: Apache-2.0
#include "converters/export/targets/sofa/scene_parts.h"

#include <algorithm>

namespace lumen::convert {

namespace {

constexpr double kFriction = 0.1;  // friction of hydrophilic coatings on vessels: docs/sofa.md
constexpr double kFixation = 1e8;  // mN / mm and mN mm / rad: a hand that holds the instrument
constexpr int kViewEdgesPerMm = 1;

std::string restNode(const Instrument& instrument) {
  return "rest_" + instrument.name;
}

void setSection(SceneItem& item, const RodSection& section, double poissonRatio) {
  item.set("length", section.length)
      .set("youngModulus", section.youngModulus)
      .set("poissonRatio", poissonRatio)
      .set("radius", section.radius);
  if (section.innerRadius > 0) item.set("innerRadius", section.innerRadius);
  item.set("massDensity", section.density)
      .set("nbBeams", section.beams())
      .set("nbEdgesCollis", section.beams())
      .set("nbEdgesVisu", std::max(1, static_cast<int>(section.length * kViewEdgesPerMm)));
  if (section.curlDiameter > 0)
    item.set("spireDiameter", section.curlDiameter).set("spireHeight", section.curlHeight);
}

void addTriangles(SceneItem& vessel) {
  vessel.add("MeshTopology")
      .set("name", "triangles")
      .set("position", "@loader.position")
      .set("triangles", "@loader.triangles");
  vessel.add("MechanicalObject").set("name", "points").set("template", "Vec3d");
  for (const char* const model :
       {"TriangleCollisionModel", "LineCollisionModel", "PointCollisionModel"})
    vessel.add(model).set("moving", 0).set("simulated", 0).set("group", 1);
}

void addGrid(SceneItem& vessel, const SceneGrid& grid) {
  // without a frame of its own a contact of the grid brings SOFA v25.06 down
  vessel.add("MechanicalObject").set("name", "frame").set("template", "Rigid3d");
  vessel
      .add("RigidDistanceGridCollisionModel",
           "Distances in mm, positive in the lumen; box: where the first and the last sample are, "
           "mm")
      .set("name", "wall")
      .setFile("filename", "wall.raw")
      .set("nx", grid.size[0])
      .set("ny", grid.size[1])
      .set("nz", grid.size[2])
      .set("box", sceneNumbers({grid.first[0], grid.first[1], grid.first[2], grid.last[0],
                                grid.last[1], grid.last[2]}))
      .set("usePoints", 0)
      .set("moving", 0)
      .set("simulated", 0)
      .set("group", 1);
  vessel
      .add("DiscreteGridField", "Field for components that ask a ScalarField, which here none does")
      .set("name", "field")
      .setFile("file", "distance.mhd");
}

/// The motion in the case, which takes the wall along, the surface to be looked at, and the place
/// where the instruments enter.
void addMotion(SceneItem& vessel, const Insertion& insertion) {
  vessel.add("MechanicalObject", "The points of the surface, which go along")
      .set("name", "points")
      .set("template", "Vec3d")
      .set("position", "@loader.position");
  vessel
      .add("BlobMotion",
           "Moves the wall as the motion in case.lumen does; offset: its time, s, at which the "
           "scene begins; place: where the instruments enter, at rest")
      .set("name", "motion")
      .set("field", "@wall")
      .set("points", "@points")
      .set("place", entryPlace(insertion))
      .set("offset", 0);
}

}  // namespace

std::string entryPlace(const Insertion& insertion) {
  const Eigen::Quaterniond turn = turnTo(insertion.direction);
  const Eigen::Vector3d& at = insertion.position;
  return sceneNumbers({at.x(), at.y(), at.z(), turn.x(), turn.y(), turn.z(), turn.w()});
}

void addLoop(SceneItem& root, WallKind wall, double radius, double alarm) {
  root.add("FreeMotionAnimationLoop").set("name", "loop");
  root.add("DefaultVisualManagerLoop").set("name", "visuals");
  root.add("LCPConstraintSolver", "mu: Coulomb's coefficient of friction")
      .set("name", "contacts")
      .set("mu", kFriction)
      .set("tolerance", 1e-6)
      .set("maxIt", 1000)
      .set("build_lcp", 0);
  if (isOfCase(wall)) return;
  root.add("CollisionPipeline").set("name", "pipeline");
  root.add("BruteForceBroadPhase").set("name", "broad");
  root.add("BVHNarrowPhase").set("name", "narrow");
  if (wall == WallKind::Grid) {
    root.add("DiscreteIntersection").set("name", "distances");
    root.add("CollisionResponse")
        .set("name", "response")
        .set("response", "FrictionContactConstraint");
    return;
  }
  root.add(
          "LocalMinDistance",
          "mm: contactDistance is the radius of the widest instrument; nearer than alarmDistance a "
          "contact is looked after")
      .set("name", "distances")
      .set("contactDistance", radius)
      .set("alarmDistance", radius + alarm)
      .set("angleCone", 0.2);
  root.add("CollisionResponse")
      .set("name", "response")
      .set("response", "FrictionContactConstraint");
}

void addView(SceneItem& root, const Box3d& box) {
  root.add("VisualStyle")
      .set("name", "style")
      .set("displayFlags",
           "showVisualModels hideBehaviorModels hideCollisionModels hideForceFields");
  const Eigen::Vector3d middle = box.middle();
  const double extent = std::max(1.0, box.size().maxCoeff());
  root.add("InteractiveCamera", "From the front: y is posterior, z superior")
      .set("name", "camera")
      .set("position", sceneNumbers({middle[0], middle[1] - 1.8 * extent, middle[2]}))
      .set("lookAt", sceneNumbers({middle[0], middle[1], middle[2]}));
  root.add("LightManager").set("name", "lights");
  root.add("DirectionalLight").set("name", "front").set("direction", "0.3 -1 0.5");
  root.add("DirectionalLight").set("name", "back").set("direction", "-0.3 1 0.2");
}

namespace {

/// A surface in a node of its own, `view_NAME`, which moves with the points of the wall if it `moves`.
void addSurfaceView(SceneItem& vessel, const std::string& name, const std::string& loader,
                    const std::array<double, 3>& color, bool moves) {
  constexpr double kOpacity = 0.25;  // instruments show through
  SceneItem& view = vessel.addNode("view_" + name);
  view.add("OglModel")
      .set("name", "surface")
      .set("src", "@../" + loader)
      .set("color", sceneNumbers({color[0], color[1], color[2], kOpacity}));
  if (moves)
    view.add("IdentityMapping")
        .set("name", "mapping")
        .set("input", "@../points")
        .set("output", "@surface");
}

}  // namespace

void addVessel(SceneItem& root, WallKind wall, const SceneInput& input) {
  SceneItem& vessel = root.addNode("vessel", "The wall");
  if (isOfCase(wall))
    vessel.add("BlobField", "The models of the case: negative in the wall, positive in the lumen")
        .set("name", "wall")
        .setFile("filename", "case.lumen")
        // the small jumps of local fields throw an instrument that a moving wall presses on
        .set("domain", input.moves ? "blended" : "local")
        .set("branch", input.branch);
  if (wall == WallKind::Soft) addTube(vessel, input.frames);
  vessel
      .add("MeshOBJLoader", wall == WallKind::Mesh ? "The surface in mm; its normals point out of "
                                                     "the lumen, and are turned to where the "
                                                     "instruments are"
                                                   : "The surface in mm, to be looked at only")
      .set("name", "loader")
      .setFile("filename", "vessel.obj")
      .set("flipNormals", wall == WallKind::Mesh ? 1 : 0);
  if (wall == WallKind::Mesh) addTriangles(vessel);
  if (wall == WallKind::Grid) addGrid(vessel, input.grid);
  if (input.moves) addMotion(vessel, input.insertion);
  if (input.systems.empty())
    addSurfaceView(vessel, "vessel", "loader", {0.8, 0.2, 0.2}, input.moves);
  for (const SceneSystem& system : input.systems) {
    vessel.add("MeshOBJLoader", "The surface of this system of vessels, with the points of all")
        .set("name", "loader_" + system.name)
        .setFile("filename", system.file)
        .set("flipNormals", wall == WallKind::Mesh ? 1 : 0);
    addSurfaceView(vessel, system.name, "loader_" + system.name, system.color, input.moves);
  }
}

void addRestShape(SceneItem& root, const Instrument& instrument) {
  SceneItem& node = root.addNode(restNode(instrument),
                                 "Sections of the " + instrument.name + ", from handle to tip");
  std::string materials;
  for (const RodSection& section : instrument.sections) {
    const bool isStraight = section.curlDiameter == 0;
    const std::string name = isStraight ? "shaft" : "tip";
    setSection(node.add(isStraight ? "RodStraightSection" : "RodSpireSection",
                        "length and radii in mm, youngModulus in kPa, massDensity in kg / mm^3")
                   .set("name", name),
               section, instrument.poissonRatio);
    if (!materials.empty()) materials += ' ';
    materials += "@" + name;
  }
  node.add("WireRestShape")
      .set("name", "shape")
      .set("template", "Rigid3d")
      .set("wireMaterials", materials);
  node.add("EdgeSetTopologyContainer").set("name", "lines");
  node.add("EdgeSetTopologyModifier").set("name", "modifier");
  node.add("EdgeSetGeometryAlgorithms").set("name", "geometry").set("template", "Rigid3d");
  node.add("MechanicalObject").set("name", "frames").set("template", "Rigid3d");
}

void addBeamSolver(SceneItem& node, int frames) {
  node.add("EulerImplicitSolver")
      .set("name", "time")
      .set("rayleighStiffness", 0.2)
      .set("rayleighMass", 0.1);
  node.add("BTDLinearSolver").set("name", "solver");
  node.add("RegularGridTopology", "As many frames as all instruments have when they are wholly in")
      .set("name", "lines")
      .set("nx", frames)
      .set("ny", 1)
      .set("nz", 1)
      .set("xmin", 0)
      .set("xmax", 1)
      .set("ymin", 0)
      .set("ymax", 0)
      .set("zmin", 0)
      .set("zmax", 0);
  node.add("MechanicalObject").set("name", "frames").set("template", "Rigid3d");
}

void addBeams(SceneItem& node, const Instrument& instrument) {
  node.add("WireBeamInterpolation")
      .set("name", "interpolation_" + instrument.name)
      .set("WireRestShape", "@../" + restNode(instrument) + "/shape");
  // a node has one mass only, and SOFA passes over all but the last
  node.addNode("forces_" + instrument.name)
      .add("AdaptiveBeamForceFieldAndMass")
      .set("name", "forces")
      .set("interpolation", "@../interpolation_" + instrument.name);
}

void addEntry(SceneItem& node) {
  node.add("LinearSolverConstraintCorrection")
      .set("name", "correction")
      .set("wire_optimization", 1);
  node.add("FixedProjectiveConstraint").set("name", "unused").set("indices", 0);
  node.add("RestShapeSpringsForceField", "Holds the instruments where they enter: at startingPos")
      .set("name", "entry")
      .set("points", "@controller.indexFirstNode")
      .set("external_rest_shape", "@frames")
      .set("external_points", 0)
      .set("stiffness", kFixation)
      .set("angularStiffness", kFixation);
}

void addBlobContact(SceneItem& node, const Instrument& instrument, double alarm) {
  node.add("BeamBlobContact", "radius and alarmDistance in mm; samples on each beam")
      .set("name", "contact_" + instrument.name)
      .set("field", "@/vessel/wall")
      .set("interpolation", "@interpolation_" + instrument.name)
      .set("radius", instrument.radius())
      .set("friction", kFriction)
      .set("samples", 3)
      .set("alarmDistance", alarm);
}

void addContactPoints(SceneItem& node, WallKind wall, double proximity) {
  SceneItem& points = node.addNode("points", "Points along the instruments, a beam's length apart");
  points.add("EdgeSetTopologyContainer").set("name", "lines");
  points.add("EdgeSetTopologyModifier").set("name", "modifier");
  points.add("MechanicalObject").set("name", "positions").set("template", "Vec3d");
  points.add("MultiAdaptiveBeamMapping")
      .set("name", "mapping")
      .set("controller", "../controller")
      .set("useCurvAbs", 1);
  if (wall == WallKind::Mesh)
    for (const char* const model : {"LineCollisionModel", "PointCollisionModel"})
      points.add(model).set("group", 2);
  if (wall == WallKind::Grid)
    points
        .add("PointCollisionModel", "proximity: the radius of the widest instrument and a step, mm")
        .set("group", 2)
        .set("proximity", proximity);
  points.add("WriteState", "Their positions, mm: a line T=, seconds, and a line X= for each record")
      .set("name", "recorder")
      .setFile("filename", "positions.txt")
      .set("writeX", 1)
      .set("time", 0)
      .set("period", 10 * kPushTime);
}

void addInstrumentView(SceneItem& node, const Instrument& instrument) {
  SceneItem& view = node.addNode("view_" + instrument.name);
  view.add("OglModel")
      .set("name", "surface")
      .set("color", sceneNumbers({instrument.color[0], instrument.color[1], instrument.color[2]}))
      .set("quads", "@quads.quads");
  view.add("QuadSetTopologyContainer").set("name", "quads");
  view.add("QuadSetTopologyModifier").set("name", "modifier");
  view.add("QuadSetGeometryAlgorithms").set("name", "geometry").set("template", "Vec3d");
  view.add("Edge2QuadTopologicalMapping")
      .set("name", "tube")
      .set("nbPointsOnEachCircle", 10)
      .set("radius", instrument.radius())
      .set("input", "@../../" + restNode(instrument) + "/lines")
      .set("output", "@quads")
      .set("flipNormals", 1);
  view.add("AdaptiveBeamMapping")
      .set("name", "mapping")
      .set("useCurvAbs", 1)
      .set("interpolation", "@../interpolation_" + instrument.name)
      .set("input", "@../frames")
      .set("output", "@surface");
}

}  // namespace lumen::convert
