// SPDX-License-Identifier: Apache-2.0
// Centerlines of other programs: points with radii and parents.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace lumen::convert {

constexpr std::int32_t kNoPoint = -1;
constexpr std::int32_t kNoVessel = -1;

/// Comment that marks files of lumen.
constexpr const char* kOwnCenterline = "lumen: centerline, millimetres, LPS";

struct CenterlinePoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< in the file's unit and axes, finite
  double radius = 0;                                   ///< in the same unit; 0: the file has none
  std::int32_t parent = kNoPoint;                      ///< index of a point before this one
  std::int32_t type = 0;                               ///< type as stated by the file
  std::int32_t vessel = kNoVessel;  ///< index of `vessels`, or kNoVessel where the file names none
};

enum class CenterlineAxes : std::uint8_t { Unknown, Lps, Ras };

/// One or several trees. Parents come before their children.
struct CenterlineFile {
  std::vector<CenterlinePoint> points;
  std::vector<std::string> vessels;                ///< names, maybe empty or equal
  std::vector<std::array<std::int32_t, 2>> links;  ///< points at which vessels close a loop
  double unit = 0;                                 ///< mm; 0: the file states none
  CenterlineAxes axes = CenterlineAxes::Unknown;   ///< axes as stated by the file
  bool isOfLumen = false;                          ///< points are the nodes of a case
  bool isOfSimVascular = false;                    ///< lengths are cm, if that is plausible
  std::vector<std::string> remarks;                ///< assumptions and omissions, sentences
  std::vector<std::string> assumptions;            ///< those of them that a case records

  [[nodiscard]] std::size_t radiiMissing() const;
};

/// A path without forks: the centerline of one vessel.
struct CenterlineChain {
  /// Indices of points. A chain that is attached to another one does not repeat the point of
  /// attachment.
  std::vector<std::int32_t> points;
  std::int32_t parent = -1;      ///< index of a chain before this one, or -1
  std::size_t parentSample = 0;  ///< index of the point of attachment among the parent's points
};

/// The trees of a file as chains, parents first. Points at the place of their parent are merged
/// with it. At a fork the child of the same vessel continues the chain; where the file names no
/// vessels the widest child does, and the one that turns least wins a tie; the others begin new
/// chains. Points at the place of a root without other children are a chain of one point.
std::vector<CenterlineChain> centerlineChains(const CenterlineFile& file);

}  // namespace lumen::convert
