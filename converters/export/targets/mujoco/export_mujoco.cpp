// SPDX-License-Identifier: Apache-2.0
// Declared in targets.h.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "converters/base/error.h"
#include "converters/base/number_text.h"
#include "converters/export/shared/frame.h"
#include "converters/export/shared/insertion.h"
#include "converters/export/shared/mujoco_text.h"
#include "converters/export/shared/surface.h"
#include "converters/export/shared/text_files.h"
#include "converters/export/targets/mujoco/wall_pieces.h"
#include "converters/export/targets/mujoco/wire.h"
#include "converters/export/targets/targets.h"
#include "converters/io/mesh/mesh_parts.h"
#include "converters/io/mesh/vertex_streams.h"
#include "formats/container/printable.h"

namespace lumen::convert {

namespace {

// MuJoCo samples a mesh's distance in an octree of six levels: 64 cells along its longest side.
// With cells of 0.4 radii the distance between samples is off by h^2 / 8 R, 0.02 radii.
constexpr std::size_t kCells = 64;
constexpr double kCellRadii = 0.4;
// Radii: a piece of a wall that moves is cut until it rides on one rigid body as well as that.
constexpr double kRigidRadii = 0.1;
// MuJoCo takes about 9 MB for the octree of each piece.
constexpr std::size_t kMostBodies = 64;

// MuJoCo finds contacts of distance fields by a search that misses shallow ones, so contacts are
// soft, over kContactSteps steps: a wire that is pressed to the wall rests some hundredths of a
// millimetre in it. Harder, it flickers, and snaps through the wall. Damping is within the contact
// solver (eulerdamp), where it does not make contacts soft.
constexpr double kContactSteps = 20;

constexpr double kWider = 1.25;

/// Pieces that ride on bodies as well as no more than `most` of them can, which is at least their
/// number without a motion.
std::vector<SurfaceMesh> cutToRide(const SurfaceMesh& wall, double cell, const WallBodies& bodies,
                                   std::size_t most) {
  for (double rigid = kRigidRadii;; rigid *= kWider) {
    std::vector<SurfaceMesh> pieces = cutIntoPieces(
        wall, kCells, cell,
        [&](std::span<const WallFacet> piece) { return bodies.carrying(piece).misfit <= rigid; });
    if (pieces.size() <= most) return pieces;
  }
}

/// Pieces of a wall, with cells that are as wide as it takes to have no more than `most` pieces, 0
/// for any number; adds a sentence where that is wider than usual. `bodies`: of a wall that moves.
std::vector<SurfaceMesh> cutIntoFew(const SurfaceMesh& wall, std::size_t most,
                                    const std::optional<WallBodies>& bodies, const FieldWord& word,
                                    std::vector<std::string>& losses) {
  double cell = kCellRadii;
  std::vector<SurfaceMesh> pieces = cutIntoPieces(wall, kCells, cell);
  while (most > 0 && pieces.size() > most) {
    cell *= kWider;
    pieces = cutIntoPieces(wall, kCells, cell);
  }
  if (bodies)
    pieces = cutToRide(wall, cell, *bodies, std::max(pieces.size(), most > 0 ? most : kMostBodies));
  if (cell > kCellRadii)
    losses.push_back("the wall is in no more than " + std::to_string(most) +
                     " pieces, so MuJoCo samples its distance every " + fixedText(cell, 2) +
                     " radii, and is up to " + fixedText(cell * cell / 8, 2) +
                     " radii off between samples; a greater " + word("max-pieces") + " is nearer");
  return pieces;
}

struct Solid {
  ExportedSurface surface;
  bool isShell = false;  ///< a wall of some thickness; else all but the lumen
};

void openEnds(SurfaceMesh& mesh) {
  std::size_t kept = 0;
  for (std::size_t t = 0; t < mesh.triangle.size(); ++t) {
    const FaceKind kind = mesh.groups[mesh.group[t]].kind;
    if (kind == FaceKind::Inlet || kind == FaceKind::Outlet) continue;
    mesh.triangle[kept] = mesh.triangle[t];
    mesh.group[kept++] = mesh.group[t];
  }
  mesh.triangle.resize(kept);
  mesh.group.resize(kept);
}

/// All that is not lumen: the lumen's surface without its flat ends, turned over. It always exists,
/// also where vessels touch, and a wire that is pressed into it is pushed back in the right
/// direction however deep it is; in a wall, no farther than its middle. Between vessels that touch
/// the solid is as thick as the wire is wide, as the octree does not see a thinner one and the
/// soft contact would let a wire through it.
Solid carvedOut(const ExportInput& input, double wireWidth) {
  Solid solid{lumenSurface(input, wireWidth), false};
  openEnds(solid.surface.mesh);
  solid.surface.mesh = turnedOver(std::move(solid.surface.mesh));
  return solid;
}

Solid makeSolid(const ExportInput& input, double wireWidth) {
  const auto& thickness = input.options.surface.thickness;
  return thickness ? Solid{wallSurface(input, *thickness), true} : carvedOut(input, wireWidth);
}

constexpr double kShortestWire = 0.03, kLongestWire = 0.08;  // m, of a wire

/// A wire as long as its path, up to where a chain gets slow: its cost grows with the square of its
/// links.
Wire wireFor(const Insertion& insertion) {
  Wire wire;
  const double length = std::clamp(insertion.pathLength * kMetres, kShortestWire, kLongestWire);
  wire.links = static_cast<int>(std::lround(length / wire.link));
  return wire;
}

/// Shortens the wire to the length that lies straight behind its tip before the push, free of
/// walls. Throws Error(InvalidInput) where that is less than a wire has.
void shorten(Wire& wire, const std::vector<SurfaceMesh>& pieces, const ExportInput& input,
             const Insertion& insertion) {
  const double free =
      freeBehind(pieces, input.frame.position(insertion.position),
                 input.frame.direction(insertion.direction), wire.length(), wire.radius);
  if (free >= wire.length()) return;
  if (free < kShortestWire)
    throw invalidInput(
        "branch " + formats::printable(input.source.tree.branches[insertion.branch].label) + ": " +
        fixedText(1e3 * free, 1) +
        " mm straight behind its beginning are free of other vessels, and a "
        "guidewire that is pushed in there needs " +
        fixedText(1e3 * kShortestWire, 0) + "; " + input.field("insert") + " takes another branch");
  wire.links = static_cast<int>(free / wire.link);
}

struct MujocoScene {
  const ExportInput& input;
  const Solid& solid;
  const std::vector<SurfaceMesh>& pieces;
  Insertion insertion;
  Wire wire;
  /// Bodies of the pieces and of the entry in a case with a motion, and their keyframes
  std::vector<RidingBody> bodies{};
  std::string keyframes{};
};

/// An element with its children, in a body that keyframes place; `at`: its place at rest, m.
std::string onBody(const std::string& name, const Eigen::Vector3d& at, const std::string& content) {
  return "    <body name=\"" + name + "\" mocap=\"true\" pos=\"" + mujocoNumbers(at) + "\">\n" +
         content + "    </body>\n";
}

/// Red, green, blue and opacity of a piece: of the system that most of its triangles have.
std::string wallColor(const SurfaceMesh& piece) {
  constexpr double kOpacity = 0.3;
  const auto system = mainSystem(piece);
  const auto [red, green, blue] = system ? systemColor(*system) : std::array{0.8, 0.3, 0.3};
  return numberText(red, 3) + " " + numberText(green, 3) + " " + numberText(blue, 3) + " " +
         numberText(kOpacity);
}

std::string wallGeom(const MujocoScene& scene, std::size_t k) {
  const std::string name = "wall_" + std::to_string(k);
  const auto geom = [&](const std::string& place) {
    return "    <geom name=\"" + name + "\" class=\"wall\" type=\"sdf\" mesh=\"" + name + "\"" +
           place + " rgba=\"" + wallColor(scene.pieces[k]) + "\"/>\n";
  };
  if (scene.bodies.empty()) return geom("");
  const Eigen::Vector3d& at = scene.bodies[k].centre;
  return onBody(name, at, geom(" pos=\"" + mujocoNumbers(-at) + "\""));
}

std::string wireText(const MujocoScene& scene, WireSprings springs) {
  const Eigen::Vector3d tip = scene.input.frame.position(scene.insertion.position),
                        direction = scene.input.frame.direction(scene.insertion.direction);
  if (scene.bodies.empty()) return wireBodies(scene.wire, tip, direction, springs);
  const Eigen::Vector3d& at = scene.bodies.back().centre;
  return onBody("entry", at, wireBodies(scene.wire, tip - at, direction, springs));
}

std::string sceneText(const MujocoScene& scene, WireSprings springs) {
  const ExportFrame& frame = scene.input.frame;
  std::string meshes, geoms, sites;
  for (std::size_t k = 0; k < scene.pieces.size(); ++k) {
    const std::string name = "wall_" + std::to_string(k);
    meshes += "    <mesh name=\"" + name + "\" file=\"" + name + ".stl\" inertia=\"shell\"/>\n";
    geoms += wallGeom(scene, k);
  }
  for (const NamedEnd& end : scene.solid.surface.ends) sites += "    " + endSite(frame, end);
  return exportText(
      "mujoco/scene.xml",
      {{"version", LUMEN_VERSION},
       {"step", mujocoNumbers({kMujocoStep})},
       {"plugin", springs == WireSprings::Plugin ? exportText("mujoco/plugin.xml") : ""},
       {"solref", mujocoNumbers({kContactSteps * kMujocoStep, 1})},
       {"meshes", meshes},
       {"geoms", geoms},
       {"ends", sites},
       {"wire", wireText(scene, springs)},
       {"controls", wireControls(scene.wire, scene.keyframes)}});
}

std::string motionText(const formats::Motion& motion) {
  return "\n" + exportText("mujoco/motion.md",
                           {{"times", std::to_string(motion.time.size())},
                            {"first", numberText(motion.time.front())},
                            {"last", numberText(motion.time.back())},
                            {"period", motion.period > 0 ? numberText(motion.period) : "None"}});
}

/// The bodies on which pieces and the entry ride; adds a sentence on how well the pieces do.
std::vector<RidingBody> bodiesOf(const WallBodies& bodies, const std::vector<SurfaceMesh>& pieces,
                                 const Eigen::Vector3d& entry, std::vector<std::string>& losses) {
  std::vector<RidingBody> riding;
  double most = 0;
  for (const SurfaceMesh& piece : pieces) {
    riding.push_back(bodies.carrying(piece));
    most = std::max(most, riding.back().misfit);
  }
  riding.push_back(bodies.carrying(entry));
  losses.push_back("the wall rides on " + std::to_string(pieces.size()) +
                   " rigid bodies, and is up to " + fixedText(most, 2) +
                   " radii off where the motion of the case has it; sites of the ends rest");
  return riding;
}

std::string startPose(const MujocoScene& scene) {
  const std::string pieces =
      scene.pieces.size() == 1
          ? "1 piece"
          : std::to_string(scene.pieces.size()) +
                " pieces, as MuJoCo samples each in at most 64 cells along a side";
  return exportText(
      "mujoco/README.md",
      {{"wall", scene.solid.isShell ? "The wall is a solid of the thickness that was asked for"
                                    : "All that is not lumen is solid: the lumen's surface, open "
                                      "at its ends, with normals into the lumen"},
       {"pieces", pieces},
       {"motion", !scene.bodies.empty() ? motionText(*scene.input.source.motion) : ""},
       {"length", mujocoNumbers({scene.wire.length() * 1e3})}});
}

}  // namespace

ExportResult exportMujoco(const ExportInput& input) {
  const Wire thickness;
  const Insertion insertion = findInsertion(input.source.tree, input.options.insert,
                                            thickness.radius * 1e3, input.options.word);
  Solid solid = makeSolid(input, 2e3 * thickness.radius);
  solid.surface.ends = plainlyNamed(std::move(solid.surface.ends));
  Wire wire = wireFor(insertion);
  // walls out of the wire's reach cost memory and time, and are most of a large tree
  solid.surface.mesh = wallsInReach(std::move(solid.surface.mesh), input.source.tree,
                                    insertion.node, wire.length() * 1e3);
  ExportResult result;
  std::optional<WallBodies> bodies;
  if (input.source.motion) bodies.emplace(input.source);
  const std::vector<SurfaceMesh> pieces = cutIntoFew(solid.surface.mesh, input.options.maxPieces,
                                                     bodies, input.options.word, result.losses);
  shorten(wire, pieces, input, insertion);
  MujocoScene scene{input, solid, pieces, insertion, wire};
  if (bodies) {
    scene.bodies =
        bodiesOf(*bodies, pieces, input.frame.position(insertion.position), result.losses);
    scene.keyframes = bodies->keyframes(scene.bodies);
  }
  result.playsMotion = bodies.has_value();

  result.files = {
      {"scene.xml", sceneText(scene, WireSprings::Plugin),
       "vessels, guidewire, actuator `advance`, keyframe `insertion`, a site at each end", ""},
      {"scene-joints.xml", sceneText(scene, WireSprings::Joints), "the same without a plugin", ""}};
  for (std::size_t k = 0; k < pieces.size(); ++k)
    result.files.push_back(
        {"meshes/wall_" + std::to_string(k) + ".stl", stlInMetres(pieces[k]), "", ""});
  result.others.push_back({"meshes/wall_*.stl", "the wall, in metres"});
  result.start = startPose(scene);
  result.ends = std::move(solid.surface.ends);
  result.surface = std::move(solid.surface.report);
  return result;
}

TargetRow mujocoRow() {
  return {.name = "mujoco",
          .title = "MuJoCo 3",
          .files = {"scene.xml", "scene-joints.xml", "meshes/wall_0.stl"},
          .units = {LengthUnit::Metre},
          .axes = {Axes::Lps},
          .holds = "the wall as a solid; a guidewire at the root, pushed by an actuator; the ends",
          .lacks = "the tree and its radii",
          .options = {"edge", "max-error", "triangles", "thickness", "max-pieces", "insert"}};
}

}  // namespace lumen::convert
