// SPDX-License-Identifier: Apache-2.0
#include "disc_image.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lumen::reproduce {
namespace {

constexpr int kRim = 2;       // pixels beyond [-5, 5], for stencils at its border
constexpr int kStrips = 256;  // in a pixel: the error of its share is below 1e-4

/// Share of the pixel around (u, v) that lies in the unit disc around the origin: strips across it,
/// each cut at the disc's chord.
double share(double u, double v, double spacing) {
  double inside = 0;
  for (int k = 0; k < kStrips; ++k) {
    const double y = v + spacing * ((k + 0.5) / kStrips - 0.5);
    if (std::abs(y) >= 1) continue;
    const double half = std::sqrt(1 - y * y);
    const double low = std::max(u - 0.5 * spacing, -half), high = std::min(u + 0.5 * spacing, half);
    inside += std::max(0.0, high - low);
  }
  return inside / (kStrips * spacing);
}

/// Turns samples into B-spline coefficients by the recursive filter with the pole sqrt(3) - 2
/// (Unser, "Splines: a perfect fit for signal and image processing", 1999), mirrored at both ends.
void filterLine(std::vector<double>& line) {
  const double pole = std::sqrt(3.0) - 2;
  const std::size_t n = line.size();
  double sum = 0, power = 1;
  for (std::size_t k = 0; k < n; ++k, power *= pole) sum += power * line[k];
  line[0] = sum;  // the image is flat far from the disc, so one period of the mirror is enough
  for (std::size_t k = 1; k < n; ++k) line[k] += pole * line[k - 1];
  line[n - 1] = pole / (pole * pole - 1) * (line[n - 1] + pole * line[n - 2]);
  for (std::size_t k = n - 1; k-- > 0;) line[k] = pole * (line[k + 1] - line[k]);
  for (double& c : line) c *= 6;
}

std::array<float, 4> weights(Interpolation interpolation, double t) {
  const double s = 1 - t;
  std::array<double, 4> w{};
  switch (interpolation) {
    case Interpolation::Linear:
      w = {0, s, t, 0};
      break;
    case Interpolation::Cubic:
      w = {-0.5 * t * s * s, 1 + t * t * (1.5 * t - 2.5), 1 + s * s * (1.5 * s - 2.5),
           -0.5 * s * t * t};
      break;
    case Interpolation::Spline:
      w = {s * s * s / 6, 2.0 / 3 - t * t * (1 - 0.5 * t), 2.0 / 3 - s * s * (1 - 0.5 * s),
           t * t * t / 6};
      break;
  }
  std::array<float, 4> out{};
  for (std::size_t k = 0; k < 4; ++k) out[k] = static_cast<float>(w[k]);
  return out;
}

}  // namespace

float Image::at(int i, int j) const {
  const int x = std::clamp(i, 0, n - 1), y = std::clamp(j, 0, n - 1);
  return value[static_cast<std::size_t>(y * n + x)];
}

Image discImage(int across, double u, double v) {
  Image image{5 * across + 2 * kRim, 2.0 / across, {}};
  for (int j = 0; j < image.n; ++j)
    for (int i = 0; i < image.n; ++i) {
      const double x = (i - 0.5 * (image.n - 1)) * image.spacing;
      const double y = (j - 0.5 * (image.n - 1)) * image.spacing;
      image.value.push_back(static_cast<float>(share(x - u, y - v, image.spacing)));
    }
  return image;
}

std::array<Image, 2> maskGradient(const Image& image) {
  const float centre = std::numbers::sqrt2_v<float> - 1,
              beside = 1 - 0.5F * std::numbers::sqrt2_v<float>;
  std::array<Image, 2> out = {Image{image.n, image.spacing, {}}, Image{image.n, image.spacing, {}}};
  const auto unit = static_cast<float>(0.5 / image.spacing);
  for (int j = 0; j < image.n; ++j)
    for (int i = 0; i < image.n; ++i) {
      const auto along = [&](int k) { return image.at(i + 1, j + k) - image.at(i - 1, j + k); };
      const auto across = [&](int k) { return image.at(i + k, j + 1) - image.at(i + k, j - 1); };
      out[0].value.push_back(unit * (centre * along(0) + beside * (along(-1) + along(1))));
      out[1].value.push_back(unit * (centre * across(0) + beside * (across(-1) + across(1))));
    }
  return out;
}

Image splineCoefficients(const Image& image) {
  Image out = image;
  const auto n = static_cast<std::size_t>(image.n);
  std::vector<double> line(n);
  for (const std::size_t stride : {std::size_t{1}, n})
    for (std::size_t k = 0; k < n; ++k) {
      float* first = out.value.data() + k * (stride == 1 ? n : 1);
      for (std::size_t m = 0; m < n; ++m) line[m] = static_cast<double>(first[m * stride]);
      filterLine(line);
      for (std::size_t m = 0; m < n; ++m) first[m * stride] = static_cast<float>(line[m]);
    }
  return out;
}

Stencil stencilAt(const Image& image, Interpolation interpolation, double u, double v) {
  const double x = image.index(u), y = image.index(v);
  const double i = std::floor(x), j = std::floor(y);
  return {static_cast<int>(i) - 1, static_cast<int>(j) - 1, weights(interpolation, x - i),
          weights(interpolation, y - j)};
}

Layers interleave(const std::array<Image, 3>& images) {
  Layers layers{images[0].n, {}};
  for (std::size_t i = 0; i < images[0].value.size(); ++i)
    layers.value.emplace_back(images[0].value[i], images[1].value[i], images[2].value[i], 0.0F);
  return layers;
}

Eigen::Array4f valueAt(const Layers& layers, const Stencil& stencil) {
  Eigen::Array4f sum = Eigen::Array4f::Zero();
  const Eigen::Array4f* row = layers.value.data() + stencil.j * layers.n + stencil.i;
  for (std::size_t j = 0; j < 4; ++j, row += layers.n) {
    const Eigen::Array4f line = stencil.wi[0] * row[0] + stencil.wi[1] * row[1] +
                                stencil.wi[2] * row[2] + stencil.wi[3] * row[3];
    sum += stencil.wj[j] * line;
  }
  return sum;
}

}  // namespace lumen::reproduce
