// SPDX-License-Identifier: Apache-2.0
// Jumps of value, gradient and distance at the seams between the nodes of real models.
//
//   seam_sweep CASE...
//
// Along every edge of the tree, eight lines parallel to it, at 0.5 and 0.95 of the radius, are
// walked by a cursor. Where it changes node, the place is found by bisection, and what both nodes
// answer there is compared.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "blob.h"

namespace {

struct Line {
  double from[3], to[3];
  void at(double t, double* p) const {
    for (int k = 0; k < 3; ++k) p[k] = from[k] + t * (to[k] - from[k]);
  }
};

struct Jump {
  double value, gradient, distance;
  double outside;  ///< of the wall, in radii; negative in the lumen
};

Line lineAlong(const blob_node& a, const blob_node& b, double share, double angle) {
  double d[3], e[3] = {0.36, 0.48, 0.8}, length = 0, along = 0, size = 0;
  for (int k = 0; k < 3; ++k) {
    d[k] = b.centre[k] - a.centre[k];
    length += d[k] * d[k];
  }
  for (double& x : d) x /= std::sqrt(length);
  for (int k = 0; k < 3; ++k) along += d[k] * e[k];
  for (int k = 0; k < 3; ++k) {
    e[k] -= along * d[k];
    size += e[k] * e[k];
  }
  for (double& x : e) x /= std::sqrt(size);
  const double f[3] = {d[1] * e[2] - d[2] * e[1], d[2] * e[0] - d[0] * e[2],
                       d[0] * e[1] - d[1] * e[0]};
  Line line;
  for (int k = 0; k < 3; ++k) {
    const double off = share * (std::cos(angle) * e[k] + std::sin(angle) * f[k]);
    const double beyond = 0.3 * (b.centre[k] - a.centre[k]);
    line.from[k] = a.centre[k] - beyond + off * a.radius;
    line.to[k] = b.centre[k] + beyond + off * b.radius;
  }
  return line;
}

Jump compare(const blob_model* model, std::uint32_t flags, const double* p, std::uint32_t a,
             std::uint32_t b) {
  blob_sample s, t;
  blob_query(model, flags | BLOB_HOLD, p, &a, &s);
  blob_query(model, flags | BLOB_HOLD, p, &b, &t);
  double square = 0;
  for (int k = 0; k < 3; ++k)
    square += (s.gradient[k] - t.gradient[k]) * (s.gradient[k] - t.gradient[k]);
  return {std::abs(s.value - t.value), std::sqrt(square), std::abs(s.distance - t.distance),
          s.distance / blob_model_node(model, a).radius};
}

void walk(const blob_model* model, std::uint32_t flags, const Line& line, std::uint32_t cursor,
          std::vector<Jump>& jumps) {
  constexpr int kSteps = 24;
  double p[3];
  line.at(0, p);
  cursor = blob_cursor_follow(model, p, cursor);
  for (int n = 1; n <= kSteps; ++n) {
    double low = static_cast<double>(n - 1) / kSteps, high = static_cast<double>(n) / kSteps;
    line.at(high, p);
    const std::uint32_t after = blob_cursor_follow(model, p, cursor);
    if (after == cursor) continue;
    while (high - low > 1e-13) {
      const double middle = 0.5 * (low + high);
      line.at(middle, p);
      (blob_cursor_follow(model, p, cursor) != cursor ? high : low) = middle;
    }
    line.at(high, p);
    jumps.push_back(compare(model, flags, p, cursor, blob_cursor_follow(model, p, cursor)));
    cursor = after;
  }
}

std::vector<Jump> sweep(const blob_model* model, std::uint32_t flags) {
  std::vector<Jump> jumps;
  const std::size_t count = blob_model_describe(model).node_count;
  for (std::uint32_t i = 0; i < count; ++i) {
    const blob_node b = blob_model_node(model, i);
    if (b.parent < 0) continue;
    const auto parent = static_cast<std::uint32_t>(b.parent);
    const blob_node a = blob_model_node(model, parent);
    for (int quarter = 0; quarter < 4; ++quarter)
      for (const double share : {0.5, 0.95})
        walk(model, flags, lineAlong(a, b, share, 0.3 + 1.5707963 * quarter), parent, jumps);
  }
  return jumps;
}

void print(const char* name, const std::vector<Jump>& jumps, double Jump::*what) {
  constexpr double kRounding = 1e-5;
  std::vector<double> values;
  std::size_t lumen = 0;
  for (const Jump& jump : jumps) {
    values.push_back(jump.*what);
    if (jump.*what > kRounding && jump.outside < 0) ++lumen;
  }
  std::sort(values.begin(), values.end());
  const auto over = values.end() - std::upper_bound(values.begin(), values.end(), kRounding);
  std::printf(
      "  %-9s median %.1e  99 %% %.1e  99.9 %% %.1e  greatest %.1e  above 1e-5: %td, %zu of them "
      "in the lumen\n",
      name, values[values.size() / 2], values[values.size() * 99 / 100],
      values[values.size() * 999 / 1000], values.back(), over, lumen);
}

}  // namespace

int main(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    blob_model* model = nullptr;
    const blob_status status = blob_model_open(argv[i], nullptr, &model);
    if (status != BLOB_OK) {
      std::fprintf(stderr, "seam_sweep: %s: %s\n", argv[i], blob_status_text(status));
      return EXIT_FAILURE;
    }
    for (const bool local : {true, false}) {
      const std::vector<Jump> jumps = sweep(model, local ? BLOB_LOCAL : BLOB_BLENDED);
      std::printf("%s, %s, %zu seams\n", argv[i], local ? "LOCAL" : "BLENDED", jumps.size());
      if (jumps.empty()) continue;
      print("value", jumps, &Jump::value);
      print("gradient", jumps, &Jump::gradient);
      print("distance", jumps, &Jump::distance);
    }
    blob_model_close(model);
  }
  return EXIT_SUCCESS;
}
