// SPDX-License-Identifier: Apache-2.0
#include "converters/picture/trace.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <string>

#include <tbb/parallel_for.h>

#include "blob.h"
#include "converters/common/error.h"
#include "converters/common/vectors.h"

namespace lumen::convert {

namespace {

constexpr double kBall = 1.5;   // radii: beyond it a node's own section does not reach
constexpr int kMostSteps = 64;  // of a ray in one ball
constexpr double kShare = 0.9;  // of the distance: it is right to first order only
constexpr double kNear = 0.01;  // radii: on the surface
constexpr int kRowsOfTile = 16;

using Model = std::unique_ptr<blob_model, void (*)(blob_model*)>;

/// A node's ball as the camera sees it.
struct Ball {
  std::uint32_t node;
  double x, y, depth;  ///< pixels, pixels, mm towards the viewer
  double radius;       ///< mm
};

class Tracer {
public:
  Tracer(const formats::CenterlineTree& tree, const blob_model* model, const Camera& camera)
      : m_tree(tree), m_model(model), m_camera(camera), m_towards(camera.axes.row(2)) {
    for (std::uint32_t n = 0; n < tree.nodeCount(); ++n) {
      const Eigen::Vector3d p = camera.project(toEigen(tree.centre[n]));
      m_balls.push_back({n, p.x(), p.y(), p.z(), kBall * double{tree.radius[n]}});
    }
    std::stable_sort(m_balls.begin(), m_balls.end(), [](const Ball& a, const Ball& b) {
      return a.depth + a.radius > b.depth + b.radius;
    });
  }

  void rows(TracedSurface& surface, int first, int last) const {
    for (const Ball& ball : m_balls) {
      const double reach = m_camera.scale * ball.radius;
      const int y0 = std::max(first, static_cast<int>(std::ceil(ball.y - reach - 0.5)));
      const int y1 = std::min(last, static_cast<int>(std::floor(ball.y + reach - 0.5)) + 1);
      for (int y = y0; y < y1; ++y) {
        const double dy = y + 0.5 - ball.y;
        const double half = std::sqrt(std::max(0.0, reach * reach - dy * dy));
        const int x0 = std::max(0, static_cast<int>(std::ceil(ball.x - half - 0.5)));
        const int x1 =
            std::min(surface.width, static_cast<int>(std::floor(ball.x + half - 0.5)) + 1);
        for (int x = x0; x < x1; ++x) ray(surface, ball, x, y);
      }
    }
  }

private:
  void ray(TracedSurface& surface, const Ball& ball, int x, int y) const {
    const std::size_t pixel = surface.at(x, y);
    if (ball.depth + ball.radius <= surface.depth[pixel]) return;
    const double dx = (x + 0.5 - ball.x) / m_camera.scale, dy = (y + 0.5 - ball.y) / m_camera.scale;
    const double half = std::sqrt(std::max(0.0, ball.radius * ball.radius - dx * dx - dy * dy));
    const double last = std::max(ball.depth - half, double{surface.depth[pixel]});
    double depth = ball.depth + half;
    if (depth <= last) return;
    const Eigen::Vector3d origin = m_camera.place(x + 0.5, y + 0.5, 0);
    std::uint32_t cursor = ball.node;
    blob_sample sample{};
    const double near = kNear * double{m_tree.radius[ball.node]};
    // out of a lumen that reaches out of the ball, towards the viewer
    double forward = 1;
    for (int step = 0; step < kMostSteps; ++step) {
      const Eigen::Vector3d p = origin + depth * m_towards;
      blob_query(m_model, BLOB_BLENDED, p.data(), &cursor, &sample);
      if (!std::isfinite(sample.distance)) return;
      if (std::abs(sample.distance) < near) {
        if (depth > double{surface.depth[pixel]}) keep(surface, pixel, depth, sample);
        return;
      }
      if (step == 0 && sample.distance < 0) forward = -1;
      depth -= kShare * sample.distance;
      if (forward > 0 && depth < last) return;
    }
  }

  void keep(TracedSurface& surface, std::size_t pixel, double depth,
            const blob_sample& sample) const {
    surface.depth[pixel] = static_cast<float>(depth);
    const Eigen::Vector3d n(sample.normal[0], sample.normal[1], sample.normal[2]);
    surface.normal[pixel] = (m_camera.axes * n).cast<float>();
    surface.node[pixel] = sample.node;
  }

  const formats::CenterlineTree& m_tree;
  const blob_model* m_model;
  const Camera& m_camera;
  Eigen::Vector3d m_towards;
  std::vector<Ball> m_balls;
};

}  // namespace

TracedSurface traceSurface(const formats::CenterlineTree& tree, std::span<const std::byte> file,
                           const Camera& camera, Progress& progress) {
  blob_model* opened = nullptr;
  const blob_status status = blob_model_open_bytes(file.data(), file.size(), nullptr, &opened);
  if (status != BLOB_OK)
    throw failed(std::string("the case's models: ") + blob_status_text(status));
  const Model model(opened, &blob_model_close);
  TracedSurface surface;
  surface.width = camera.width;
  surface.height = camera.height;
  const std::size_t pixels = surface.at(0, camera.height);
  surface.depth.assign(pixels, TracedSurface::kNothing);
  surface.normal.assign(pixels, Eigen::Vector3f::Zero());
  surface.node.assign(pixels, 0);
  const Tracer tracer(tree, model.get(), camera);
  const int tiles = (camera.height + kRowsOfTile - 1) / kRowsOfTile;
  tbb::parallel_for(0, tiles, [&](int tile) {
    if (progress.cancelled()) return;
    tracer.rows(surface, tile * kRowsOfTile, std::min(camera.height, (tile + 1) * kRowsOfTile));
  });
  progress.check();
  return surface;
}

}  // namespace lumen::convert
