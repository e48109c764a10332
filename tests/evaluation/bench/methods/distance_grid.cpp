// SPDX-License-Identifier: Apache-2.0
#include "distance_grid.h"

#include <algorithm>
#include <cmath>

#include <tbb/parallel_for.h>

#include "method.h"

namespace lumen::bench {

DistanceGrid::DistanceGrid(const Vessel& vessel) : cell(vessel.gridCell) {
  const blob_model_info info = blob_model_describe(vessel.model);
  for (std::size_t i = 0; i < 3; ++i) {
    low[i] = info.low[i] - 1;
    size[i] = static_cast<std::size_t>((info.high[i] - info.low[i] + 2) / cell) + 2;
  }
  value.resize(size[0] * size[1] * size[2]);
  tbb::parallel_for(std::size_t{0}, size[2], [&](std::size_t z) {
    std::size_t at = z * size[0] * size[1];
    for (std::size_t y = 0; y < size[1]; ++y)
      for (std::size_t x = 0; x < size[0]; ++x) {
        const double p[3] = {low[0] + cell * static_cast<double>(x),
                             low[1] + cell * static_cast<double>(y),
                             low[2] + cell * static_cast<double>(z)};
        std::uint32_t cursor = BLOB_NOWHERE;
        blob_sample s;
        blob_query(vessel.model, 0, p, &cursor, &s);
        value[at++] = static_cast<float>(s.distance);
      }
  });
}

namespace {

// A dense grid of distances, sampled trilinearly with its gradient.
class Grid : public Method {
public:
  [[nodiscard]] std::string name() const override { return "dense grid, " + inMm(m_grid.cell); }

  void prepare(const Vessel& vessel) override { m_grid = DistanceGrid(vessel); }

  void query(std::size_t, const double* points, std::size_t count,
             const Answers& answers) override {
    for (std::size_t i = 0; i < count; ++i) {
      double gradient[3];
      answers.distance[i] = sample(points + 3 * i, gradient);
      if (answers.normal[0] == nullptr) continue;
      const double length = std::hypot(gradient[0], gradient[1], gradient[2]);
      for (std::size_t k = 0; k < 3; ++k)
        answers.normal[k][i] = length > 0 ? gradient[k] / length : 0;
    }
  }

  [[nodiscard]] double megabytes() const override {
    return static_cast<double>(m_grid.value.size() * sizeof(float)) * 1e-6;
  }

private:
  [[nodiscard]] double sample(const double* p, double* gradient) const {
    std::size_t cell[3];
    double t[3];
    for (std::size_t i = 0; i < 3; ++i) {
      const double x = (p[i] - m_grid.low[i]) / m_grid.cell;
      cell[i] = std::min(static_cast<std::size_t>(std::max(x, 0.0)), m_grid.size[i] - 2);
      t[i] = x - static_cast<double>(cell[i]);
    }
    const std::size_t dy = m_grid.size[0], dz = dy * m_grid.size[1];
    const float* v = &m_grid.value[cell[0] + dy * cell[1] + dz * cell[2]];
    const auto mix = [](double a, double b, double s) { return a + s * (b - a); };
    const double x00 = v[1] - v[0], x10 = v[dy + 1] - v[dy], x01 = v[dz + 1] - v[dz],
                 x11 = v[dy + dz + 1] - v[dy + dz];
    const double c00 = v[0] + t[0] * x00, c10 = v[dy] + t[0] * x10, c01 = v[dz] + t[0] * x01,
                 c11 = v[dy + dz] + t[0] * x11;
    gradient[0] = mix(mix(x00, x10, t[1]), mix(x01, x11, t[1]), t[2]) / m_grid.cell;
    gradient[1] = mix(c10 - c00, c11 - c01, t[2]) / m_grid.cell;
    const double c0 = mix(c00, c10, t[1]), c1 = mix(c01, c11, t[1]);
    gradient[2] = (c1 - c0) / m_grid.cell;
    return mix(c0, c1, t[2]);
  }

  DistanceGrid m_grid;
};

}  // namespace

void addGrid(Methods& methods) {
  methods.push_back(std::make_unique<Grid>());
}

}  // namespace lumen::bench
