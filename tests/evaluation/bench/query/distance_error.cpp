// SPDX-License-Identifier: Apache-2.0
// How far the distance from one evaluation is from that to the nearest point of the wall.
//
//   distance_error CASE...
//
// Ten random points about each node, out to twice its radius. Prints, for bands of the exact
// distance, the median and the 99th percentile of the error, all in radii of the cursor's node.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <random>
#include <vector>

#include "blob.h"

namespace {

struct Band {
  double low, high;
  std::vector<double> error{};
};

struct Counts {
  int all = 0, notConverged = 0;
};

double quantile(std::vector<double>& values, double share) {
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

void measure(const blob_model* model, const double* point, std::uint32_t cursor,
             std::vector<Band>& bands, Counts& counts) {
  blob_sample exact, quick;
  blob_query(model, BLOB_DISTANCE_EXACT, point, &cursor, &exact);
  ++counts.all;
  if ((exact.state & BLOB_NOT_CONVERGED) != 0) {
    ++counts.notConverged;
    return;
  }
  blob_query(model, BLOB_BLENDED, point, &cursor, &quick);
  const double radius = blob_model_node(model, quick.node).radius;
  const double depth = exact.distance / radius;
  for (Band& band : bands)
    if (depth >= band.low && depth < band.high)
      band.error.push_back(std::abs(quick.distance - exact.distance) / radius);
}

void measure(const blob_model* model, std::vector<Band>& bands, Counts& counts) {
  constexpr int kPoints = 10;
  constexpr double kReachRadii = 2.0;  // radii
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> share(-1, 1);
  const auto count = static_cast<std::uint32_t>(blob_model_describe(model).node_count);
  for (std::uint32_t i = 0; i < count; ++i) {
    const blob_node node = blob_model_node(model, i);
    for (int n = 0; n < kPoints;) {
      double direction[3], square = 0;
      for (double& x : direction) {
        x = share(random);
        square += x * x;
      }
      if (square > 1) continue;
      ++n;
      double point[3];
      for (int k = 0; k < 3; ++k)
        point[k] = node.centre[k] + kReachRadii * node.radius * direction[k];
      measure(model, point, i, bands, counts);
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    blob_model* model = nullptr;
    if (const blob_status status = blob_model_open(argv[i], nullptr, &model); status != BLOB_OK) {
      std::fprintf(stderr, "%s: %s\n", argv[i], blob_status_text(status));
      return 1;
    }
    std::vector<Band> bands{{-2, -0.8},  {-0.8, -0.4}, {-0.4, -0.2}, {-0.2, -0.05}, {-0.05, 0.05},
                            {0.05, 0.2}, {0.2, 0.4},   {0.4, 0.7},   {0.7, 1.0}};
    Counts counts;
    measure(model, bands, counts);
    std::printf("%s: %d points, %d not converged\n", argv[i], counts.all, counts.notConverged);
    for (Band& band : bands)
      if (!band.error.empty())
        std::printf("%5.2f to %5.2f R: %6zu points, median %.4f, 99 %% %.4f\n", band.low, band.high,
                    band.error.size(), quantile(band.error, 0.5), quantile(band.error, 0.99));
    blob_model_close(model);
  }
  return 0;
}
