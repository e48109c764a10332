// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/phantom/phantom_scene.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "converters/base/error.h"
#include "converters/base/number_text.h"
#include "converters/base/sha256.h"
#include "converters/base/shown_text.h"
#include "converters/geometry/box.h"
#include "converters/io/centerline/centerline_readers.h"
#include "converters/stages/phantom/clutter.h"
#include "converters/stages/phantom/smooth_chain.h"
#include "formats/container/printable.h"
#include "formats/view/limits.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

constexpr double kSmallestPatient = 25;    // mm
constexpr double kMarginVoxels = 10;       // between the walls and the faces
constexpr double kMostVoxels = 536870912;  // 2^29: 3 GiB while it is drawn
constexpr double kMostDraws = 1e11;        // distances of voxels to pieces of wall: minutes
constexpr int kOrganSize = 112;
constexpr double kNamedSlice = 5;  // voxels, of the phantom with thick slices
// A stream of its own, so that the clicks do not change when the drawing does.
constexpr std::uint64_t kClicks = 0x636c69636b73ULL;

using Designer = Design (*)(const Frame&);

// In the order of the table of phantom.h; "patient" comes after them.
const std::vector<std::pair<std::string, Designer>>& designs() {
  static const std::vector<std::pair<std::string, Designer>> rows = {
      {"tube", designTube},
      {"helix", designHelix},
      {"bifurcation", designBifurcation},
      {"kissing", designKissing},
      {"aneurysm", designAneurysm},
      {"stenosis", designStenosis},
      {"dropout", designDropout},
      {"sac-lobes", designSacLobes},
      {"companion", designCompanion},
      {"hairpin", designHairpin},
      {"right-angle", designRightAngle},
      {"fading", designFading},
      {"thick-slices", designThickSlices},
      {"coil", designCoil},
      {"arc", designArc},
      {"cone", designCone},
      {"ellipse-tube", designEllipseTube},
      {"fork", designFork},
      {"sac-sphere", designSacSphere},
      {"sac-ellipsoid", designSacEllipsoid},
      {"sac-fork", designSacFork},
      {"willis", [](const Frame& frame) { return designWillis(frame, {}); }},
      {"coronary", designCoronary},
      {"hepatic", designHepatic},
      {"heart", designHeart},
      {"liver", designLiver},
      {"lungs", designLungs},
      {"dissection", designDissection},
      {"kidneys", designKidneys},
      {"legs", designLegs},
      {"retina", designRetina}};
  return rows;
}

// Voxels along each edge, as whole numbers that need not fit any integer.
Vector3d sizeOf(const Box3d& box, double voxel) {
  return (((box.high - box.low) / voxel).array().ceil() + 1 + 2 * kMarginVoxels).matrix();
}

// The least voxel of two digits, mm, that makes few enough voxels.
double workableVoxel(const Box3d& box, double voxel) {
  while (sizeOf(box, voxel).prod() > 0.98 * kMostVoxels) {
    const double digit = std::pow(10.0, std::floor(std::log10(voxel)) - 1);
    voxel = (std::floor(voxel / digit + 1e-9) + 1) * digit;
  }
  return voxel;
}

VolumeGeometry gridAround(const Box3d& box, const PhantomOptions& options) {
  const double voxel = options.voxel;
  const Vector3d size = sizeOf(box, voxel);
  if (!(size.prod() <= kMostVoxels)) {
    const double workable = workableVoxel(box, voxel);
    throw Error(
        ErrorKind::Usage,
        "phantom: a " + options.word("voxel") + " of " + shownNumber(voxel) + " mm makes " +
            joinedNumbers(size, " x ") +
            " voxels of the tree, expected at most 536870912 in all: " +
            (workable <= 10 ? options.word("voxel") + " " + shownNumber(workable) + " is enough"
                            : "lengths of the file are taken as mm"));
  }
  VolumeGeometry grid;
  grid.spacing.setConstant(voxel);
  for (int a = 0; a < 3; ++a) grid.size[static_cast<std::size_t>(a)] = static_cast<int>(size[a]);
  grid.origin = (box.low.array() - kMarginVoxels * voxel).matrix();
  return grid;
}

double chordLength(const CenterlineFile& file) {
  double length = 0;
  for (const CenterlinePoint& point : file.points)
    if (point.parent != kNoPoint)
      length +=
          (point.position - file.points[static_cast<std::size_t>(point.parent)].position).norm();
  return length;
}

std::string labelOf(std::size_t index) {
  return std::string("b").append(paddedNumber(index, 3));
}

Design makeDesign(const CenterlineFile& file, double voxel, const std::string& name,
                  const Progress& progress) {
  const std::vector<SmoothVessel> vessels = smoothVessels(file, 0.1 * voxel);
  if (vessels.size() > formats::kMaxBranches)
    throw invalidInput(name + ": has " + std::to_string(vessels.size()) +
                       " vessels; expected at most " + std::to_string(formats::kMaxBranches));
  TreeBuilder builder(Frame{voxel, 0});
  for (const SmoothVessel& vessel : vessels) {
    progress.check();
    builder.add(labelOf(builder.tree().branches.size()), vessel.parent, vessel.path);
  }
  return builder.design();
}

// The box that holds a tree in all phases of its motion.
Box3d boxOfPhases(const formats::CenterlineTree& tree, const PhantomOptions& options) {
  Box3d box = boxOf(tree);
  if (options.motion == PhantomMotion::None) return box;
  const MovingTissue tissue(options.motion, box);
  for (int phase = 1; phase < options.phases; ++phase)
    for (std::uint32_t n = 0; n < tree.nodeCount(); ++n)
      box.add(tissue.place(toEigen(tree.centre[n]), static_cast<double>(phase) / options.phases),
              static_cast<double>(tree.radius[n]));
  return box;
}

}  // namespace

void checkEffort(const CenterlineFile& file, double voxel, const std::string& name,
                 const std::string& remedy) {
  double widest = 0;
  for (const CenterlinePoint& point : file.points) widest = std::max(widest, point.radius);
  const double nodes =
      chordLength(file) / (0.5 * voxel) + 2 * static_cast<double>(file.points.size());
  const double draws = nodes * std::pow(2 * widest / voxel + 3, 3);
  if (nodes <= static_cast<double>(formats::kMaxNodes) / 4 && draws <= kMostDraws) return;
  throw invalidInput(name + ": its vessels are " + shownNumber(chordLength(file)) +
                     " mm long and up to " + shownNumber(widest) +
                     " mm in radius, too much to draw in voxels of " + shownNumber(voxel) +
                     " mm; expected a tree in mm, or " + remedy);
}

std::vector<SeedBranch> clickTree(const formats::CenterlineTree& tree,
                                  const PhantomOptions& options, double voxel) {
  Random random(options.seed, kClicks + options.clickDrawing);
  return options.isCareless ? clickCarelessly(tree, voxel, random)
                            : clickLargeVessels(tree, voxel, random);
}

const std::vector<std::string>& phantomNames() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const auto& [name, design] : designs()) all.push_back(name);
    all.emplace_back("patient");
    return all;
  }();
  return names;
}

bool isOrgan(const std::string& name) {
  static const std::set<std::string> names = {"heart",   "liver", "lungs", "dissection",
                                              "kidneys", "legs",  "retina"};
  return names.contains(name);
}

std::set<std::string> missingParts(const PhantomOptions& options) {
  const std::string field = options.word("without");
  if (!options.without.empty() && options.name != "willis")
    throw Error(ErrorKind::Usage, field + ": found with the phantom " +
                                      formats::printable(options.name) +
                                      ", expected the phantom willis");
  std::set<std::string> missing;
  for (const std::size_t part :
       chosenWords(options.without, willisParts(), field, "parts of a circle of Willis"))
    missing.insert(willisParts()[part]);
  return missing;
}

Box3d boxOf(const formats::CenterlineTree& tree) {
  Box3d box;
  for (std::uint32_t n = 0; n < tree.nodeCount(); ++n)
    box.add(toEigen(tree.centre[n]), static_cast<double>(tree.radius[n]));
  return box;
}

PhantomScene sceneOfName(const PhantomOptions& options, Progress& progress) {
  const auto found = std::find_if(designs().begin(), designs().end(),
                                  [&](const auto& row) { return row.first == options.name; });
  const bool patient = found == designs().end();
  const bool isLarge = patient || options.name == "willis";
  const int usual = isLarge ? 256 : isOrgan(options.name) ? kOrganSize : 128;
  const int size = options.size != 0 ? options.size : usual;
  const Frame frame{options.voxel, options.voxel * (size - 1)};
  if (patient && frame.extent < kSmallestPatient)
    throw Error(ErrorKind::Usage, "phantom: the volume is " + fixedText(frame.extent, 6) +
                                      " mm wide, expected at least 25 mm for 'patient'");
  PhantomScene scene;
  const std::set<std::string> missing = missingParts(options);
  if (patient)
    scene.design = designPatient(frame, options.seed, progress);
  else
    scene.design = missing.empty() ? found->second(frame) : designWillis(frame, missing);
  fadeContrast(scene.design, options.fade);
  loseFlow(parseClutter(options.clutter), options.seed, scene.design);
  scene.grid = {{size, size, size}, Vector3d::Constant(options.voxel)};
  if (options.name == "thick-slices") scene.slice = kNamedSlice;
  if (options.sliceThickness != 0) scene.slice = options.sliceThickness / options.voxel;
  if (size < kFewestSlices * scene.slice)
    throw Error(ErrorKind::Usage,
                "phantom: " + options.word("slice-thickness") + " is " +
                    shownNumber(scene.slice * options.voxel) + " mm, expected at most " +
                    shownNumber(options.voxel * size / kFewestSlices) + " mm in a volume of " +
                    shownNumber(options.voxel * size) + " mm");
  Random random(options.seed, kClicks + options.clickDrawing);
  scene.design.seeds = options.isCareless
                           ? clickCarelessly(scene.design.tree, options.voxel, random)
                           : clickSeeds(scene.design.tree, random);
  return scene;
}

PhantomScene sceneOfTree(const PhantomOptions& options, Progress& progress) {
  const std::string name = formats::printable(options.tree.string());
  const CenterlineFile file = readSwc(options.tree);
  Box3d around;
  for (const CenterlinePoint& point : file.points) around.add(point.position, point.radius);
  gridAround(around, options);
  checkEffort(file, options.voxel, name, "a larger " + options.word("voxel"));
  PhantomScene scene;
  scene.treeSha256 = digestOfFile(options.tree).sha256;
  scene.design = makeDesign(file, options.voxel, name, progress);
  fadeContrast(scene.design, options.fade);
  loseFlow(parseClutter(options.clutter), options.seed, scene.design);
  const formats::CenterlineTree& tree = scene.design.tree;
  const Box3d box = boxOfPhases(tree, options);
  if (options.sliceThickness != 0) scene.slice = options.sliceThickness / options.voxel;
  scene.grid = gridAround(box, options);
  // whole slices
  const double slices =
      std::max<double>(kFewestSlices, std::ceil(scene.grid.size[2] / scene.slice));
  scene.grid.size[2] = static_cast<int>(std::ceil(slices * scene.slice));
  scene.design.seeds = clickTree(tree, options, options.voxel);
  return scene;
}

}  // namespace lumen::convert
