// SPDX-License-Identifier: Apache-2.0
// Jumps of value, gradient and distance at the seams between the nodes of real models.
//
//   seam_sweep CASE...
//
// Along every edge of the tree, eight lines parallel to it, at 0.5 and 0.95 of the radius, are
// walked by a cursor. Where it changes node, the place is found by bisection, and what both nodes
// answer there is compared. Then, wherever value or gradient change by more than 0.02 within a
// step, at a seam or not, the step is halved until nothing is left of it, always keeping the half
// with the greater change: what remains is a jump.
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
  bool inLumen, inBall;  ///< beyond the wall or not; within the radius of the cursor's node or not
};

struct Stop {
  double t;
  std::uint32_t cursor;
  blob_sample sample;
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

Jump difference(const blob_model* model, const double* p, const blob_sample& s,
                const blob_sample& t) {
  double square = 0, power = 0;
  const blob_node node = blob_model_node(model, s.node);
  for (int k = 0; k < 3; ++k) {
    square += (s.gradient[k] - t.gradient[k]) * (s.gradient[k] - t.gradient[k]);
    power += (p[k] - node.centre[k]) * (p[k] - node.centre[k]);
  }
  return {std::abs(s.value - t.value), std::sqrt(square), std::abs(s.distance - t.distance),
          s.distance < 0 || t.distance < 0, power < double{node.radius} * double{node.radius}};
}

Jump compare(const blob_model* model, std::uint32_t flags, const double* p, std::uint32_t a,
             std::uint32_t b) {
  blob_sample s, t;
  blob_query(model, flags | BLOB_HOLD, p, &a, &s);
  blob_query(model, flags | BLOB_HOLD, p, &b, &t);
  return difference(model, p, s, t);
}

void walkSeams(const blob_model* model, std::uint32_t flags, const Line& line, std::uint32_t cursor,
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

void walkSteps(const blob_model* model, std::uint32_t flags, const Line& line, std::uint32_t cursor,
               std::vector<Jump>& jumps) {
  constexpr int kSteps = 48, kHalvings = 36;
  constexpr double kVisible = 0.02;
  double p[3];
  const auto stopAt = [&](double t, std::uint32_t from) {
    Stop stop{t, from, {}};
    line.at(t, p);
    blob_query(model, flags, p, &stop.cursor, &stop.sample);
    return stop;
  };
  const auto change = [&](const Stop& a, const Stop& b) {
    const Jump jump = difference(model, p, a.sample, b.sample);
    return jump.value + jump.gradient;
  };
  Stop last = stopAt(0, cursor);
  for (int n = 1; n <= kSteps; ++n) {
    const Stop next = stopAt(static_cast<double>(n) / kSteps, last.cursor);
    Stop low = last, high = next;
    last = next;
    if (change(low, high) < kVisible) continue;
    for (int k = 0; k < kHalvings; ++k) {
      const Stop middle = stopAt(0.5 * (low.t + high.t), low.cursor);
      (change(low, middle) >= change(middle, high) ? high : low) = middle;
    }
    line.at(low.t, p);
    jumps.push_back(difference(model, p, low.sample, high.sample));
  }
}

using Walk = decltype(walkSeams)*;

std::vector<Jump> sweep(const blob_model* model, std::uint32_t flags, Walk walk) {
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

// Rounding of weights that change within some hundredths of a square millimetre stays below these.
void print(const char* name, const std::vector<Jump>& jumps, double Jump::*what, double rounding) {
  std::vector<double> values;
  std::size_t over = 0, lumen = 0, ball = 0;
  for (const Jump& jump : jumps) {
    values.push_back(jump.*what);
    if (!(jump.*what > rounding)) continue;
    ++over;
    if (jump.inLumen) ++lumen;
    if (jump.inBall) ++ball;
  }
  std::sort(values.begin(), values.end());
  std::printf(
      "  %-9s median %.1e  99 %% %.1e  99.9 %% %.1e  greatest %.1e  above %.0e: %zu, %zu in "
      "the lumen, %zu within the node's radius\n",
      name, values[values.size() / 2], values[values.size() * 99 / 100],
      values[values.size() * 999 / 1000], values.back(), rounding, over, lumen, ball);
}

void report(const blob_model* model, const char* file, std::uint32_t flags, Walk walk) {
  const std::vector<Jump> jumps = sweep(model, flags, walk);
  std::printf("%s, %s, %zu %s\n", file, (flags & BLOB_LOCAL) != 0 ? "LOCAL" : "BLENDED",
              jumps.size(), walk == &walkSeams ? "seams" : "steps with a visible change");
  if (jumps.empty()) return;
  print("value", jumps, &Jump::value, 1e-5);
  print("gradient", jumps, &Jump::gradient, 1e-4);
  print("distance", jumps, &Jump::distance, 1e-5);
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
    report(model, argv[i], BLOB_LOCAL, &walkSeams);
    report(model, argv[i], BLOB_BLENDED, &walkSeams);
    report(model, argv[i], BLOB_BLENDED, &walkSteps);
    blob_model_close(model);
  }
  return EXIT_SUCCESS;
}
