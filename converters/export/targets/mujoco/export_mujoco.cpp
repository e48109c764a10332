// SPDX-License-Identifier: Apache-2.0
#include "converters/export/targets/mujoco/export_mujoco.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "converters/base/error.h"
#include "converters/base/number_text.h"
#include "converters/export/shared/insertion.h"
#include "converters/export/shared/surface.h"
#include "converters/export/shared/tree_losses.h"
#include "converters/export/targets/mujoco/mujoco_text.h"
#include "converters/export/targets/mujoco/wall_pieces.h"
#include "converters/export/targets/mujoco/wire.h"
#include "converters/export/targets/mujoco/wire_reach.h"
#include "formats/container/printable.h"

namespace lumen::convert {

namespace {

// MuJoCo samples a mesh's distance in an octree of six levels: 64 cells along its longest side. With cells of 0.4
// radii the distance between samples is off by h^2 / 8 R, 0.02 radii.
constexpr std::size_t kCells = 64;
constexpr double kCellRadii = 0.4;

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

/// All that is not lumen: the lumen's surface without its flat ends, turned over. It always exists, also where vessels
/// touch, and a wire that is pressed into it is pushed back the right way however deep it is; in a wall, no farther
/// than its middle.
Solid carvedOut(const ExportInput& input) {
  Solid solid{lumenSurface(input), false};
  openEnds(solid.surface.mesh);
  solid.surface.mesh = turnedOver(std::move(solid.surface.mesh));
  return solid;
}

Solid solidOf(const ExportInput& input) {
  const auto& thickness = input.options.surface.thickness;
  return thickness ? Solid{wallSurface(input, *thickness), true} : carvedOut(input);
}

constexpr double kLeast = 0.03, kMost = 0.08;  // m, of a wire

/// As long as its way, up to where a chain gets slow: its cost grows with the square of its links.
Wire wireFor(const Insertion& insertion) {
  constexpr double kMetres = 1e-3;
  Wire wire;
  const double length = std::clamp(insertion.way * kMetres, kLeast, kMost);
  wire.links = static_cast<int>(std::lround(length / wire.link));
  return wire;
}

/// The wire lies straight behind its tip before it is pushed: as much of it as no wall is in the way of. Throws
/// Error(InvalidInput) where that is less than a wire has.
void shorten(Wire& wire, const std::vector<SurfaceMesh>& pieces, const ExportInput& input,
             const Insertion& insertion) {
  const double free =
      freeBehind(pieces, input.frame.position(insertion.position),
                 input.frame.direction(insertion.direction), wire.length(), wire.radius);
  if (free >= wire.length()) return;
  if (free < kLeast)
    throw invalidInput("branch " +
                       formats::printable(input.source.tree.branches[insertion.branch].label) +
                       ": " + fixedText(1e3 * free, 1) +
                       " mm straight behind its beginning are free of other vessels, and a "
                       "guidewire that is pushed in there needs " +
                       fixedText(1e3 * kLeast, 0) + "; --insert takes another branch");
  wire.links = static_cast<int>(free / wire.link);
}

struct Scene {
  const ExportInput& input;
  const Solid& solid;
  std::size_t pieces = 0;
  Insertion insertion;
  Wire wire;
};

std::string head(const Scene& scene, WireSprings springs) {
  std::string text =
      "<!-- Vessels of a case and a guidewire; metres, kg, s; LPS. Made by lumen " LUMEN_VERSION
      ". -->\n"
      "<mujoco model=\"vessels\">\n"
      "  <compiler autolimits=\"true\" boundinertia=\"1e-14\" meshdir=\"meshes\"/>\n";
  // Damping within the contact solver, not behind it: it would make contacts as soft as it is great.
  text += "  <option timestep=\"" + mujocoNumbers({kMujocoStep}) +
          "\" gravity=\"0 0 0\" integrator=\"Euler\" sdf_iterations=\"5\" sdf_initpoints=\"4\">\n"
          "    <flag eulerdamp=\"disable\"/>\n  </option>\n  <size memory=\"200M\"/>\n";
  if (springs == WireSprings::Plugin)
    text += "  <extension>\n    <plugin plugin=\"mujoco.elasticity.cable\"/>\n  </extension>\n";
  // MuJoCo finds contacts of distance fields by a search that misses shallow ones. So they are soft, twenty steps:
  // a wire that is pressed to the wall rests some hundredths of a millimetre in it. Harder, it flickers, and snaps through the wall.
  text +=
      "  <default>\n    <default class=\"wall\">\n"
      "      <geom contype=\"2\" conaffinity=\"1\" priority=\"1\" friction=\"0.1 0 0\" solref=\"" +
      mujocoNumbers({20 * kMujocoStep, 1}) +
      "\" solimp=\"0.9 0.99 5e-05\"/>\n    </default>\n  </default>\n";
  text += "  <asset>\n";
  for (std::size_t k = 0; k < scene.pieces; ++k) {
    const std::string name = "wall_" + std::to_string(k);
    text += "    <mesh name=\"" + name + "\" file=\"" + name + ".stl\" inertia=\"shell\"/>\n";
  }
  return text + "  </asset>\n";
}

std::string sceneText(const Scene& scene, WireSprings springs) {
  std::string text = head(scene, springs) + "  <worldbody>\n";
  text += "    <light pos=\"0 0 1\" dir=\"0 0 -1\" directional=\"true\"/>\n";
  for (std::size_t k = 0; k < scene.pieces; ++k) {
    const std::string name = "wall_" + std::to_string(k);
    text += "    <geom name=\"" + name + "\" class=\"wall\" type=\"sdf\" mesh=\"" + name +
            "\" rgba=\"0.8 0.3 0.3 0.3\"/>\n";
  }
  const ExportFrame& frame = scene.input.frame;
  for (const NamedEnd& end : scene.solid.surface.ends) text += "    " + endSite(frame, end);
  text += wireBodies(scene.wire, frame.position(scene.insertion.position),
                     frame.direction(scene.insertion.direction), springs);
  return text + "  </worldbody>\n" + wireControls(scene.wire) + "</mujoco>\n";
}

std::string startOf(const Scene& scene) {
  std::string text =
      "In Python (`pip install mujoco`, 3.3.5 or later):\n\n"
      "    import mujoco\n"
      "    model = mujoco.MjModel.from_xml_path(\"scene.xml\")\n"
      "    data = mujoco.MjData(model)\n"
      "    mujoco.mj_resetDataKeyframe(model, data, 0)   # insertion\n"
      "    data.ctrl[0] = 0.01                            # m/s, forward\n"
      "    while data.time < 5: mujoco.mj_step(model, data)\n\n"
      "`python -m mujoco.viewer --mjcf=scene.xml` shows it. `scene-joints.xml` is the same wire "
      "with springs in its\n"
      "joints instead of the plugin mujoco.elasticity.cable, for engines without plugins (such as "
      "the npm package\n"
      "`@mujoco/mujoco`): as stiff in bending, a third stiffer in torsion.\n\n";
  text += scene.solid.isShell ? "The wall is a solid of the thickness that was asked for"
                              : "All that is not lumen is solid: the lumen's surface, open at its "
                                "ends, with normals into the lumen";
  text += ", in " + std::to_string(scene.pieces) +
          (scene.pieces == 1 ? " piece"
                             : " pieces, as MuJoCo samples each in at most 64 cells along a side") +
          ".\nIt ends where the guidewire of " + mujocoNumbers({scene.wire.length() * 1e3}) +
          " mm does not reach. Its geoms are of type `sdf`: as type `mesh` each would be its "
          "convex hull, and the lumen solid.\n";
  return text;
}

}  // namespace

ExportResult exportMujoco(const ExportInput& input) {
  const Wire thickness;
  const Insertion insertion =
      insertionOf(input.source.tree, input.options.sofa.insert, thickness.radius * 1e3);
  Solid solid = solidOf(input);
  solid.surface.ends = plainlyNamed(std::move(solid.surface.ends));
  Wire wire = wireFor(insertion);
  // what the wire cannot touch costs memory and time, most of them in a large tree
  solid.surface.mesh = wallsInReach(std::move(solid.surface.mesh), input.source.tree,
                                    insertion.node, wire.length() * 1e3);
  const std::vector<SurfaceMesh> pieces = piecesOf(solid.surface.mesh, kCells, kCellRadii);
  shorten(wire, pieces, input, insertion);
  const Scene scene{input, solid, pieces.size(), insertion, wire};

  ExportResult result;
  result.files = {
      {"scene.xml", sceneText(scene, WireSprings::Plugin),
       "vessels, guidewire, actuator `advance`, keyframe `insertion`, a site at each end", ""},
      {"scene-joints.xml", sceneText(scene, WireSprings::Joints), "the same without a plugin", ""}};
  for (std::size_t k = 0; k < pieces.size(); ++k)
    result.files.push_back(
        {"meshes/wall_" + std::to_string(k) + ".stl", stlInMetres(pieces[k]), "", ""});
  result.others.push_back({"meshes/wall_*.stl", "the wall, in metres"});
  result.start = startOf(scene);
  result.losses = treeLosses(input.source.tree);
  result.ends = std::move(solid.surface.ends);
  result.surface = std::move(solid.surface.report);
  return result;
}

}  // namespace lumen::convert
