// SPDX-License-Identifier: Apache-2.0
// The random tree while it is being built.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "converters/stages/phantom/growth.h"

namespace lumen::convert {

struct GrownBranch {
  std::string label;
  int parent = -1;
  Path path;  ///< points PatientTree::step apart
  formats::BranchKind kind = formats::BranchKind::Vessel;
  std::vector<double> origins;  ///< arc lengths where children leave, mm
};

/// Sizes that follow the frame, in mm.
struct PatientScale {
  explicit PatientScale(const Frame& frame);
  double rootRadius;      ///< 2.2, or less in a volume under 50 mm
  double smallestRadius;  ///< 0.25, or 1.25 voxels if that is more
  double length;          ///< factor on lengths: 1 at 102.4 mm
  double margin;          ///< between walls and faces
  double gap;             ///< between the walls of two vessels
  double contact;         ///< along which two walls touch: 11, or less in a volume under 50 mm
  int branches;           ///< wanted: 40, or fewer in a volume under 45 mm
};

struct PatientTree {
  PatientTree(const Frame& frame, std::uint64_t seed, std::uint64_t attempt);

  Frame frame;
  PatientScale scale;
  double step;  ///< mm between the points of a path
  Random random;
  GrownBranches grown;
  std::vector<GrownBranch> branches;
  std::string kissing;  ///< labels of the two vessels that touch

  /// Appends the branch and makes it an obstacle.
  int add(GrownBranch branch);
  /// The point of a branch at an arc length, and the unit tangent there.
  [[nodiscard]] std::size_t indexAt(int branch, double arc) const;
  [[nodiscard]] Eigen::Vector3d tangentAt(int branch, std::size_t index) const;
  [[nodiscard]] double measureLength(int branch) const;
  /// An arc length from which a child of the branch may leave: away from its ends and from other
  /// children.
  std::optional<double> pickOrigin(int branch);
  Eigen::Vector3d randomPoint();
};

/// A sac on the outside of a bend of `parent`. False if no place was found.
bool addAneurysm(PatientTree& tree, int parent);

/// A vessel that leaves one branch, comes to another one, runs along it with their walls touching,
/// and parts. False if no place was found.
bool addKissingBranch(PatientTree& tree, const std::string& label);

}  // namespace lumen::convert
