// SPDX-License-Identifier: Apache-2.0
// The branches of a case as lines of points, each from where it begins on its parent.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "formats/case/case.h"

namespace lumen::convert {

/// A branch: its first point lies on its parent's axis, since other programs find branchings there.
struct BranchPath {
  std::uint32_t branch = 0;  ///< index in the tree
  std::string name;          ///< a file's name: small letters, digits, "_", "." and "-", unique
  std::vector<Eigen::Vector3d> points;  ///< mm, LPS, two or more
  std::vector<double> radii;            ///< mm; the first is that of the branch's own first node

  /// Unit vector along the path.
  [[nodiscard]] Eigen::Vector3d tangent(std::size_t k) const;
};

/// The paths of all branches with a length. Throws Error(InvalidInput) if there is none.
std::vector<BranchPath> branchPaths(const formats::CenterlineTree& tree);

/// A label as the stem of a file's name: small letters, digits, "_", "." and "-".
std::string fileWord(const std::string& label);

/// A path as a file of SimVascular (.pth), in cm; `id` from 1.
std::string encodePth(const BranchPath& path, std::size_t id);

/// <NAME x=".." y=".." z=".." />, as SimVascular's files have points, with a line break.
std::string pointElement(const std::string& name, const Eigen::Vector3d& v);

}  // namespace lumen::convert

namespace lumen {

// Sentences on the parts of a tree that a file of lines of points cannot hold.

/// Sentences without a full stop about links that close loops and about aneurysms; empty for a
/// tree that has neither. `lines`: what holds the lines, in the singular, as "the file". `isNetwork`:
/// it holds links.
std::vector<std::string> treeLosses(const formats::CenterlineTree& tree, const std::string& lines,
                                    bool isNetwork = false);

}  // namespace lumen
