// SPDX-License-Identifier: Apache-2.0
#include "converters/draw/picture/trace.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

#include <tbb/parallel_for.h>

#include "blob.h"
#include "converters/base/vectors.h"

namespace lumen::convert {

namespace {

constexpr double kBall = 2;  // radii: a model's wall in its own cell does not reach beyond
// Inset in radii: rays stay off the sides of cells, where a cursor would step across.
constexpr double kInset = 1e-4;
constexpr int kMostSteps = 64;             // steps of a ray in one cell
constexpr double kShare = 0.9;             // share of the distance: it is right to first order only
constexpr double kOnSurfaceRadii = 0.002;  // a point as near is on the surface
constexpr int kRowsOfTile = 16;

/// Half-space in which the power of a node is at most that of a neighbour: across . X <= level, X
/// from the node's centre in the camera's axes, mm.
struct Side {
  Eigen::Vector3d across;
  double level;
};

/// A node's ball as the camera sees it, and the sides of its power cell.
struct SeenBall {
  std::uint32_t node;
  double x, y, depth;  ///< pixels, pixels, mm towards the viewer
  double radius;       ///< mm
  std::size_t firstSide, sides;
};

/// The balls that hold the lumen, from the front to the back.
struct Balls {
  std::vector<SeenBall> all;
  std::vector<Side> sides;
};

/// The rays of a camera.
class Rays {
public:
  Rays(const formats::CenterlineTree& tree, const blob_model* model, const Camera& camera,
       const Balls& balls, TracedSurface& surface)
      : m_tree(tree),
        m_model(model),
        m_camera(camera),
        m_towards(camera.axes.row(2)),
        m_balls(balls),
        m_surface(surface) {}

  /// Sends the rays of rows `first` to `last` - 1 that may meet a ball.
  void meet(const SeenBall& ball, int first, int last) const {
    const double reach = m_camera.scale * ball.radius;
    const int y0 = std::max(first, static_cast<int>(std::ceil(ball.y - reach - 0.5)));
    const int y1 = std::min(last, static_cast<int>(std::floor(ball.y + reach - 0.5)) + 1);
    for (int y = y0; y < y1; ++y) {
      const double dy = y + 0.5 - ball.y;
      const double half = std::sqrt(std::max(0.0, reach * reach - dy * dy));
      const int x0 = std::max(0, static_cast<int>(std::ceil(ball.x - half - 0.5)));
      const int x1 =
          std::min(m_surface.width, static_cast<int>(std::floor(ball.x + half - 0.5)) + 1);
      for (int x = x0; x < x1; ++x) ray(ball, x, y);
    }
  }

private:
  void ray(const SeenBall& ball, int x, int y) const {
    const std::size_t pixel = m_surface.at(x, y);
    const double met = double{m_surface.depth[pixel]};
    if (ball.depth + ball.radius <= met) return;
    const double u = (x + 0.5 - ball.x) / m_camera.scale, v = (ball.y - y - 0.5) / m_camera.scale;
    double near = std::sqrt(std::max(0.0, ball.radius * ball.radius - u * u - v * v)),
           far = std::max(-near, met - ball.depth);
    for (std::size_t s = ball.firstSide; s < ball.firstSide + ball.sides; ++s) {
      const Side& side = m_balls.sides[s];
      const double rest = side.level - side.across.x() * u - side.across.y() * v;
      const double c = side.across.z();
      if (c > 0)
        near = std::min(near, rest / c);
      else if (c < 0)
        far = std::max(far, rest / c);
      else if (rest < 0)
        return;
      if (near <= far) return;
    }
    march(ball.node, pixel, m_camera.place(x + 0.5, y + 0.5, ball.depth), near, far);
  }

  /// Along a ray, from `near` to `far` mm towards the viewer from `origin`, with the cursor at a
  /// node.
  void march(std::uint32_t node, std::size_t pixel, const Eigen::Vector3d& origin, double near,
             double far) const {
    std::uint32_t cursor = node;
    blob_sample sample{};
    double along = near;
    bool isOutwards = false, isAtEnd = false;
    for (int step = 0; step < kMostSteps; ++step) {
      const Eigen::Vector3d p = origin + along * m_towards;
      blob_query(m_model, BLOB_BLENDED, p.data(), &cursor, &sample);
      if (!std::isfinite(sample.distance)) return;
      if (std::abs(sample.distance) < kOnSurfaceRadii * double{m_tree.radius[cursor]})
        return keep(pixel, p, sample);
      // in the lumen already: its wall lies towards the viewer
      if (step == 0) isOutwards = sample.distance < 0;
      if (isAtEnd && sample.distance > 0) return;
      along -= kShare * sample.distance;
      isAtEnd = !isOutwards && along < far;
      if (isAtEnd) along = far;
    }
  }

  void keep(std::size_t pixel, const Eigen::Vector3d& p, const blob_sample& sample) const {
    const auto depth = static_cast<float>(m_towards.dot(p - m_camera.centre));
    if (depth <= m_surface.depth[pixel]) return;
    m_surface.depth[pixel] = depth;
    const Eigen::Vector3d n(sample.normal[0], sample.normal[1], sample.normal[2]);
    m_surface.normal[pixel] = (m_camera.axes * n).cast<float>();
    m_surface.node[pixel] = sample.node;
  }

  const formats::CenterlineTree& m_tree;
  const blob_model* m_model;
  const Camera& m_camera;
  Eigen::Vector3d m_towards;
  const Balls& m_balls;
  TracedSurface& m_surface;
};

void addSides(Balls& balls, const formats::CenterlineTree& tree, const blob_model* model,
              const Camera& camera) {
  SeenBall& ball = balls.all.back();
  const Eigen::Vector3d centre = toEigen(tree.centre[ball.node]);
  const double radius = double{tree.radius[ball.node]};
  std::vector<std::uint32_t> neighbours(blob_model_neighbours(model, ball.node, nullptr, 0));
  blob_model_neighbours(model, ball.node, neighbours.data(), neighbours.size());
  ball.firstSide = balls.sides.size();
  for (const std::uint32_t other : neighbours) {
    const Eigen::Vector3d across = toEigen(tree.centre[other]) - centre;
    const double r = double{tree.radius[other]};
    const double level = 0.5 * (across.squaredNorm() - r * r + radius * radius);
    balls.sides.push_back({camera.axes * across, level - kInset * radius * across.norm()});
  }
  ball.sides = neighbours.size();
}

}  // namespace

SurfaceTracer::SurfaceTracer(const formats::Case& source)
    : m_tree(source.tree), m_model(openModels(source)) {}

TracedSurface SurfaceTracer::trace(const Camera& camera, Progress& progress) const {
  TracedSurface surface;
  surface.width = camera.width;
  surface.height = camera.height;
  const std::size_t pixels = surface.at(0, camera.height);
  surface.depth.assign(pixels, TracedSurface::kNothing);
  surface.normal.assign(pixels, Eigen::Vector3f::Zero());
  surface.node.assign(pixels, 0);
  Balls balls;
  for (std::uint32_t n = 0; n < m_tree.nodeCount(); ++n) {
    const Eigen::Vector3d p = camera.project(toEigen(m_tree.centre[n]));
    balls.all.push_back({n, p.x(), p.y(), p.z(), kBall * double{m_tree.radius[n]}, 0, 0});
    addSides(balls, m_tree, m_model.get(), camera);
  }
  std::stable_sort(balls.all.begin(), balls.all.end(), [](const SeenBall& a, const SeenBall& b) {
    return a.depth + a.radius > b.depth + b.radius;
  });
  const Rays rays(m_tree, m_model.get(), camera, balls, surface);
  const int tiles = (camera.height + kRowsOfTile - 1) / kRowsOfTile;
  tbb::parallel_for(0, tiles, [&](int tile) {
    const int first = tile * kRowsOfTile, last = std::min(camera.height, first + kRowsOfTile);
    for (const SeenBall& ball : balls.all) {
      if (progress.cancelled()) return;
      rays.meet(ball, first, last);
    }
  });
  progress.check();
  return surface;
}

namespace {

constexpr int kDirections = 8, kSteps = 4;  // numbers for occlusion
constexpr float kAmbient = 0.55F, kDiffuse = 0.6F, kSpecular = 0.12F, kShininess = 32;

/// sRGB, IEC 61966-2-1.
float decodeSrgb(std::uint8_t value) {
  const float v = static_cast<float>(value) / 255;
  return v <= 0.04045F ? v / 12.92F : std::pow((v + 0.055F) / 1.055F, 2.4F);
}

/// The greatest sine above the surface's plane of the surfaces in one direction.
float findHorizon(const TracedSurface& surface, double pixelsPerMm, int x, int y, double angle,
                  double reach) {
  const std::size_t pixel = surface.at(x, y);
  const Eigen::Vector3f& normal = surface.normal[pixel];
  float highest = 0;
  for (int step = 1; step <= kSteps; ++step) {
    const double length = reach * step / kSteps;
    const int u = x + static_cast<int>(std::lround(length * std::cos(angle)));
    const int v = y + static_cast<int>(std::lround(length * std::sin(angle)));
    if (u < 0 || v < 0 || u >= surface.width || v >= surface.height) break;
    const std::size_t other = surface.at(u, v);
    if (!surface.isHit(other)) continue;
    const Eigen::Vector3f to(static_cast<float>((u - x) / pixelsPerMm),
                             static_cast<float>((y - v) / pixelsPerMm),
                             surface.depth[other] - surface.depth[pixel]);
    const float distance = to.norm();
    if (distance <= 0) continue;
    // points far in front shade little
    const auto range = static_cast<float>(2 * reach / pixelsPerMm);
    const float weight = std::max(0.0F, 1 - distance / (2 * range));
    highest = std::max(highest, weight * (normal.dot(to) / distance - 0.1F));
  }
  return highest;
}

Light litAt(const TracedSurface& surface, std::size_t pixel, const Light& colour, float sky) {
  static const Eigen::Vector3f kLight = Eigen::Vector3f(-0.45F, 0.6F, 0.66F).normalized();
  static const Eigen::Vector3f kHalf = (kLight + Eigen::Vector3f::UnitZ()).normalized();
  const Eigen::Vector3f& n = surface.normal[pixel];
  const float diffuse = std::max(0.0F, n.dot(kLight));
  const float shine = std::pow(std::max(0.0F, n.dot(kHalf)), kShininess);
  const Light lit = colour * (kAmbient * sky * (0.75F + 0.25F * n.y()) +
                              kDiffuse * diffuse * (0.4F + 0.6F * sky));
  return lit + Light::Constant(kSpecular * shine * sky);
}

}  // namespace

std::uint8_t encodeSrgb(float light) {
  const float v = std::clamp(light, 0.0F, 1.0F);
  const float s = v <= 0.0031308F ? 12.92F * v : 1.055F * std::pow(v, 1 / 2.4F) - 0.055F;
  return static_cast<std::uint8_t>(std::lround(255 * s));
}

std::vector<float> computeOcclusion(const TracedSurface& surface, const Camera& camera,
                                    double reach) {
  std::vector<float> sky(surface.depth.size(), 1);
  tbb::parallel_for(0, surface.height, [&](int y) {
    for (int x = 0; x < surface.width; ++x) {
      const std::size_t pixel = surface.at(x, y);
      if (!surface.isHit(pixel)) continue;
      // other directions at the neighbours, which the samples of a pixel average
      const double turn = ((x & 1) + 2 * (y & 1)) / 4.0;
      float sum = 0;
      for (int k = 0; k < kDirections; ++k)
        sum += findHorizon(surface, camera.scale, x, y,
                           2 * std::numbers::pi * (k + turn) / kDirections, reach);
      sky[pixel] = std::clamp(1 - 1.2F * sum / kDirections, 0.0F, 1.0F);
    }
  });
  return sky;
}

Picture shade(const TracedSurface& surface, const Camera& camera, const std::vector<Light>& colours,
              const Picture& background, int samples) {
  const std::vector<float> sky = computeOcclusion(surface, camera, 0.02 * surface.width);
  std::array<float, 256> linear{};
  for (std::size_t i = 0; i < linear.size(); ++i)
    linear[i] = decodeSrgb(static_cast<std::uint8_t>(i));
  Picture picture = background;
  tbb::parallel_for(0, picture.height, [&](int y) {
    for (int x = 0; x < picture.width; ++x) {
      Light sum = Light::Zero();
      int hits = 0;
      for (int j = 0; j < samples; ++j)
        for (int i = 0; i < samples; ++i) {
          const std::size_t pixel = surface.at(samples * x + i, samples * y + j);
          if (!surface.isHit(pixel)) continue;
          sum += litAt(surface, pixel, colours[surface.node[pixel]], sky[pixel]);
          ++hits;
        }
      if (hits == 0) continue;
      Rgb& out =
          picture.pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) +
                         static_cast<std::size_t>(x)];
      const auto all = static_cast<float>(samples * samples);
      for (std::size_t c = 0; c < 3; ++c)
        out[c] = encodeSrgb((sum[static_cast<Eigen::Index>(c)] +
                             (all - static_cast<float>(hits)) * linear[out[c]]) /
                            all);
    }
  });
  return picture;
}

}  // namespace lumen::convert
