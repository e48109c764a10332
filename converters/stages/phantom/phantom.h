// SPDX-License-Identifier: Apache-2.0
// Synthetic angiograms with a known truth. Nothing here is patient data.
//
// A phantom has a name, and fills a cube with origin 0; or it is a tree of a file (--tree), and
// the volume is the box around it, where the file has it. Directions are the identity, voxels
// cubes; slices may be thicker (--slice-thickness), and are then means over their thickness. A
// voxel's intensity is 100 outside of vessels and 1100 within them (less where contrast is lost);
// voxels that the wall crosses have the share of them that lies inside. Then come the point-spread
// function, the mean over thick slices, the bias field, and white noise.
//
// The truth defines the wall exactly: the union of the round cones between consecutive nodes of
// each branch (common/tube_tree_distance.h). Nodes are about half a voxel apart. Ends are round; a
// vessel that leaves the volume ends on the plane of the outermost voxel centres. A child's first
// node lies on its parent's axis. Where a vessel divides, the wider child goes on as the same
// branch. An aneurysm is a branch from its parent's axis to the centre of its sac, each radius that
// of the largest ball inside.
//
// | name | shows |
// |---|---|
// | tube, helix | a straight vessel, a winding one |
// | bifurcation | a fork of 70 degrees |
// | kissing | two vessels whose walls touch over a quarter of the extent |
// | aneurysm | a sac on a bend |
// | stenosis | a narrowing to 45 % |
// | dropout | contrast that falls to 35 %, twice |
// | sac-lobes | a sac with two lobes, in a fork |
// | companion | a narrow bright vessel and a wide dark one, side by side over most of the extent |
// | hairpin | half circles of 3, 2 and 1.5 radii |
// | right-angle | narrow children that leave a wide parent at a right angle |
// | fading | contrast that falls along the tree |
// | thick-slices | a fork in slices of five voxels |
// | coil, arc, cone, ellipse-tube | tubes whose measures have closed forms |
// | fork | straight vessels that part at known angles |
// | sac-sphere, sac-ellipsoid | sacs above a plane that touches a straight vessel: their neck |
// | sac-fork | a sac at the end of a trunk that parts to both sides |
// | willis | a circle of Willis: three inlets, and communicating arteries as links |
// | coronary | an artery that winds over a ventricle, with three side branches |
// | hepatic | a trunk that divides three times |
// | heart | coronary arteries and a vein on a heart with a bright ventricle |
// | liver | portal and hepatic venous trees that cross |
// | lungs | pulmonary arteries along bronchi, and veins |
// | dissection | true and false lumen of an aorta beside calcium |
// | kidneys, legs, retina | two systems beside a bright cortex, bone, each other |
// | patient | a random tree |
//
// Shapes scale with the volume's edge. Radii of the small phantoms are given for 25.4 mm (128
// voxels of 0.2 mm), where they are 0.6 to 2.6 mm, and scale by no less than 0.5 and no more
// than 1.5. `patient` keeps radii of 2.2 to 0.25 mm (at least 1.25 voxels) in volumes of 50 mm or
// more; it has 40 branches from 45 mm on, in proportion fewer in smaller volumes, and its branches
// get shorter with the volume. Its step in the metadata names the two vessels that touch
// ("kissing").
//
// `willis` keeps its radii of 2 to 0.7 mm in volumes of 51 mm, and scales by no less than 0.5 and no
// more than 1.5. Its variants lack some of its parts (--without): where the first part of an anterior
// or posterior cerebral artery is missing, the communicating artery feeds the rest. --clutter
// (clutter.h) adds to each phantom.
//
// The truth of phantoms whose measures have closed forms (measured_designs.cpp, stenosis, helix)
// states these in its step, as true.BRANCH.MEASURE. The wall of `ellipse-tube` is not that of its
// tree, whose radii are those of the balls inside.
//
// `coronary` and `hepatic` lie in the middle half of the volume, so that they can move. With --motion
// (moving.h) there is a volume for each of the phases, evenly over a cycle, the first at rest; each has
// noise of its own. The truth is the tree at rest with its motion.
//
// `heart` to `retina` are organs in computed tomography: intensities are Hounsfield units, voxels of 1
// mm and 112 along an edge are usual, and all lengths scale with the volume's edge. Noise and bias are
// shares of 220 HU. Edges breathe and slices have streaks. The truth states the system of each vessel;
// branches are SYSTEM-000 and so on. They do not move.
//
// A tree from a file is smoothed by the rule of smooth_chain.h. Its branches are b000, b001 and so
// on, its seeds those of the vessels that are longer than 5 mm and wide enough to be tracked
// (design.h), and its step states the digest of the file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "converters/base/field_word.h"
#include "converters/base/options/option_table.h"
#include "converters/base/progress.h"
#include "converters/io/seeds/seeds.h"
#include "converters/stages/phantom/moving.h"
#include "converters/voxels/volume.h"
#include "formats/case/case.h"

namespace lumen::convert {

struct PhantomOptions {
  std::string name;            ///< one of phantomNames(); empty with a tree
  std::filesystem::path tree;  ///< an SWC file in mm; empty with a name
  int size =
      0;  ///< voxels along an edge; 0: the phantom's own (128; patient and willis 256; organs
          ///< 112); a tree's box follows from it
  double voxel = 0;     ///< mm; 0: the phantom's own (0.2; organs 1)
  double noise = 0.05;  ///< standard deviation, as a share of the vessels' contrast
  double bias = 0.1;    ///< amplitude of the slow bias field, as a share of the contrast
  double psf = 0.6;     ///< standard deviation of the Gaussian point-spread function, in voxels
  double sliceThickness = 0;  ///< mm along z; 0: a voxel, or the phantom's own
  double fade = 0;      ///< share of the contrast that is lost at the end farthest from the root
  std::string clutter;  ///< empty, or kinds of clutter.h with commas between them
  std::string without;  ///< of willis: empty, or names of willisParts() with commas between them
  std::uint64_t seed = 1;
  bool isCareless = false;         ///< clicks as of a person in a hurry
  std::uint64_t clickDrawing = 0;  ///< another number: other clicks on the same volume
  PhantomMotion motion = PhantomMotion::None;
  int phases = 10;   ///< of a motion
  FieldWord word{};  ///< names fields in messages and in the help of rows

  /// Adds a row for each value above except name and tree, stored in this object.
  void addRows(OptionTable& table);
  /// The values that are set, as a case states them.
  [[nodiscard]] std::map<std::string, formats::ParameterValue> parameters() const;
};

struct Phantom {
  Volume volume;                  ///< int16; of the rest
  formats::Case truth;            ///< the true tree, densely sampled; no points, no models
  std::vector<SeedBranch> seeds;  ///< clicks as a user would set them
};

constexpr int kFewestSlices = 4;

/// Ways to click, by their names.
const std::map<std::string, bool>& carelessByName();

/// Whether a phantom is an organ with tissue around its vessels.
bool isOrgan(const std::string& name);

/// Names of the phantoms, in the order of the table above.
const std::vector<std::string>& phantomNames();

/// Makes a phantom of options within the ranges of their rows. Throws Error(Usage) for an unknown
/// name, and for a size or thickness that is too small, Error(InvalidInput) for the file of the
/// tree, and Error(Cancelled).
Phantom makePhantom(const PhantomOptions& options, Progress& progress);

/// Receives the volume of a phase, from 1 on: those after the rest.
using PhaseReceiver = std::function<void(int phase, const Volume& volume)>;
/// Makes a phantom that may move, and hands over the volume of each phase but the first as soon as it
/// is drawn. Throws as above, and Error(Usage) for a motion of a phantom whose wall is no tree's.
Phantom makePhantom(const PhantomOptions& options, const PhaseReceiver& receive,
                    Progress& progress);

}  // namespace lumen::convert
