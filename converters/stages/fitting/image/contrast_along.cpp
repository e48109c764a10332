// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/fitting/image/contrast_along.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "converters/base/statistics.h"
#include "converters/base/vectors.h"

namespace lumen::convert::fitting {
namespace {

/// Standard deviation of the change of the contrast over kWalk voxels, and from a vessel to its
/// branch, as shares of the contrast.
constexpr double kChange = 0.1, kWalk = 10, kAtFork = 0.03;
/// Standard deviation of the contrasts of a tree, as a share of their median.
constexpr double kAmongVessels = 0.3;

/// A Gaussian as its precision and precision times mean.
struct Message {
  double precision = 0, weighted = 0;
  Message& operator+=(const Message& other) {
    precision += other.precision;
    weighted += other.weighted;
    return *this;
  }
  friend Message operator-(Message a, const Message& b) {
    return {a.precision - b.precision, a.weighted - b.weighted};
  }
  /// After a step of this variance.
  [[nodiscard]] Message over(double variance) const {
    if (!(precision > 0)) return {};
    const double p = 1 / (1 / precision + variance);
    return {p, p * weighted / precision};
  }
};

}  // namespace

std::vector<Estimate> contrastAlong(const formats::CenterlineTree& tree,
                                    const std::vector<Estimate>& measured, double voxel) {
  std::vector<double> values;
  for (const Estimate& e : measured)
    if (e.deviation > 0) values.push_back(e.value);
  if (values.empty()) return {};
  const double usual = upperMedian(values);
  const std::size_t count = tree.nodeCount();
  std::vector<Message> own(count), below(count), toParent(count), fromParent(count);
  std::vector<double> step(count, 0.0);
  for (std::size_t i = 0; i < count; ++i) {
    if (const Estimate& e = measured[i]; e.deviation > 0) {
      const double p = 1 / (e.deviation * e.deviation);
      own[i] = {p, p * e.value};
    }
    if (tree.parent[i] == formats::kNoParent) continue;
    const auto parent = static_cast<std::size_t>(tree.parent[i]);
    const double length = (toEigen(tree.centre[i]) - toEigen(tree.centre[parent])).norm();
    step[i] = usual * usual *
              (kChange * kChange * length / (kWalk * voxel) +
               (tree.branch[i] != tree.branch[parent] ? kAtFork * kAtFork : 0.0));
  }
  const double p = 1 / (kAmongVessels * kAmongVessels * usual * usual);
  for (std::size_t i = count; i-- > 0;) {
    Message sum = below[i];
    sum += own[i];
    if (tree.parent[i] == formats::kNoParent) {
      fromParent[i] = {p, p * usual};
      continue;
    }
    toParent[i] = sum.over(step[i]);
    below[static_cast<std::size_t>(tree.parent[i])] += toParent[i];
  }
  std::vector<Estimate> expected(count);
  for (std::size_t i = 0; i < count; ++i) {
    if (tree.parent[i] != formats::kNoParent) {
      const auto parent = static_cast<std::size_t>(tree.parent[i]);
      Message sum = own[parent];
      sum += below[parent];
      sum += fromParent[parent];
      fromParent[i] = (sum - toParent[i]).over(step[i]);
    }
    Message rest = below[i];
    rest += fromParent[i];
    expected[i] = {rest.weighted / rest.precision, 1 / std::sqrt(rest.precision)};
  }
  return expected;
}

}  // namespace lumen::convert::fitting
