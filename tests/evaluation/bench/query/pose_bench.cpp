// SPDX-License-Identifier: Apache-2.0
// Time to move the nodes of a model, and of queries on it: pose_bench [MODEL.lumen]. Without a file: a
// helix of 10,000 nodes with five blobs each. Processor time; medians.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <vector>

#include <time.h>

#include "blob_pose.h"
#include "tree.h"

namespace {

using lumen::blob::test::Model;

struct PoseCloser {
  void operator()(blob_pose* pose) const { blob_pose_close(pose); }
};

double now() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

// Transforms of a wave along y, with the turns that go with it.
std::vector<blob_transform> wave(const blob_model* model, double height) {
  std::vector<blob_transform> result;
  for (std::uint32_t i = 0; i < blob_model_describe(model).node_count; ++i) {
    const blob_node node = blob_model_node(model, i);
    const double x = node.centre[0], angle = 0.5 * std::atan(0.05 * height * std::cos(0.05 * x));
    result.push_back({{x, node.centre[1] + height * std::sin(0.05 * x), node.centre[2]},
                      {0, 0, std::sin(angle), std::cos(angle)},
                      1});
  }
  return result;
}

template <class Set>
double timeOf(Set set) {
  std::vector<double> times;
  for (int round = 0; round < 101; ++round) {
    const double start = now();
    set(round);
    times.push_back(now() - start);
  }
  return median(times);
}

// Nanoseconds of a query at points along the vessels, at 0.7 radii from the axis.
double queryTime(const blob_model* model) {
  std::vector<std::array<double, 3>> points;
  std::vector<std::uint32_t> cursors;
  for (std::uint32_t i = 0; i < blob_model_describe(model).node_count; ++i) {
    const blob_node at = blob_model_node(model, i);
    if (at.parent < 0) continue;
    const blob_node from = blob_model_node(model, static_cast<std::uint32_t>(at.parent));
    for (int step = 0; step < 20; ++step) {
      const double share = step / 20.0;
      std::array<double, 3> p{};
      for (std::size_t k = 0; k < 3; ++k)
        p[k] = from.centre[k] + share * (at.centre[k] - from.centre[k]);
      p[1] += 0.7 * at.radius;
      points.push_back(p);
      cursors.push_back(static_cast<std::uint32_t>(at.parent));
    }
  }
  std::vector<double> distances(points.size());
  blob_columns columns = blob_columns_default();
  columns.count = points.size();
  for (std::size_t k = 0; k < 3; ++k) columns.point[k] = &points[0][k];
  columns.point_stride = sizeof points[0];
  columns.cursor = cursors.data();
  columns.distance = distances.data();
  std::vector<double> times;
  for (int round = 0; round < 7; ++round) {
    const double start = now();
    blob_query_columns(model, BLOB_BLENDED, &columns);
    times.push_back(1e9 * (now() - start) / static_cast<double>(points.size()));
  }
  return *std::min_element(times.begin(), times.end());
}

}  // namespace

int main(int argc, char** argv) {
  Model rest;
  if (argc > 1) {
    blob_model* model = nullptr;
    if (blob_model_open(argv[1], nullptr, &model) != BLOB_OK) return 1;
    rest.reset(model);
  } else {
    rest = lumen::blob::test::helix(10000, 0.02).build();
  }
  blob_pose_def def = blob_pose_def_default();
  def.renew = 0;
  blob_pose* made = nullptr;
  if (blob_pose_create(rest.get(), &def, &made) != BLOB_OK) return 1;
  const std::unique_ptr<blob_pose, PoseCloser> pose(made);
  const std::size_t count = blob_model_describe(rest.get()).node_count;
  const std::vector<blob_transform> waves[2] = {wave(rest.get(), 0.3), wave(rest.get(), 0.6)};
  std::vector<std::array<double, 3>> centres[2];
  for (int w = 0; w < 2; ++w)
    for (const blob_transform& t : waves[w])
      centres[w].push_back({t.centre[0], t.centre[1], t.centre[2]});
  const std::size_t some = std::min<std::size_t>(100, count);
  const double all = timeOf([&](int round) {
    blob_pose_set(pose.get(), count, nullptr, waves[round % 2].data(), nullptr);
  });
  const double few = timeOf([&](int round) {
    blob_pose_set(pose.get(), some, nullptr, waves[round % 2].data(), nullptr);
  });
  const double byCentres = timeOf([&](int round) {
    blob_pose_set_centres(pose.get(), count, nullptr,
                          reinterpret_cast<const double(*)[3]>(centres[round % 2].data()), nullptr);
  });
  std::printf("%zu nodes: set %.3f ms, from centres %.3f ms, %zu of them %.4f ms\n", count,
              1e3 * all, 1e3 * byCentres, some, 1e3 * few);
  const double atRest = queryTime(rest.get()), posed = queryTime(blob_pose_model(pose.get()));
  std::printf("blended query: %.1f ns at rest, %.1f ns posed, %.3f times\n", atRest, posed,
              posed / atRest);
}
