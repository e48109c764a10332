// SPDX-License-Identifier: Apache-2.0
// Facts of a case for `lumen info`.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "converters/base/progress.h"
#include "converters/base/radius_range.h"
#include "converters/io/seeds/case_seeds.h"
#include "converters/judge/facts/reachable.h"
#include "converters/stages/fitting/error_of_fit.h"
#include "formats/case/case.h"
#include "formats/case/motion.h"

namespace lumen::convert {

struct BranchInfo {
  std::string label;
  std::string kind;  ///< vessel or aneurysm
  std::size_t nodes = 0;
  double length = 0;  ///< mm
  RadiusRange radius;
  std::string stopReason;  ///< such as no-valid-cylinder
  std::string end;         ///< as of describeEnds()
  std::optional<float> inlierRate;
  std::string system;  ///< such as artery; empty if the case states none
  std::string parent;  ///< label of the branch that it leaves; empty for a root
};

struct MotionInfo {
  std::size_t times = 0, nodes = 0;    ///< nodes: those that move
  double firstTime = 0, lastTime = 0;  ///< s
  double period = 0;                   ///< s; 0: not periodic
  formats::MotionFigures figures;
};

struct CaseInfo {
  std::size_t nodes = 0;
  std::size_t points = 0;
  std::optional<std::size_t> blobs;
  std::size_t links = 0;
  std::size_t trees = 0;
  std::size_t networks = 0;             ///< parts that neither trees nor links join
  std::vector<std::string> nodeArrays;  ///< names
  std::optional<MotionInfo> motion;
  std::optional<SeedCounts> seeds;              ///< absent if they cannot be read
  double length = 0;                            ///< mm
  std::optional<RadiusRange> radius;            ///< absent without nodes
  std::optional<double> leastShown;             ///< mm, as of leastShownRadius()
  std::optional<ErrorOfFitSummary> errorOfFit;  ///< over the nodes
  std::optional<Reach> reach;                   ///< absent without models
  std::vector<BranchInfo> branches;
  formats::Metadata metadata;
};

/// Warns if the case holds seeds that cannot be read.
CaseInfo describeCase(const formats::Case& value, Progress& progress);

}  // namespace lumen::convert
