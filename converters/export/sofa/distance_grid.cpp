// SPDX-License-Identifier: Apache-2.0
#include "converters/export/sofa/distance_grid.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <memory>

#include <tbb/parallel_for.h>

#include "blob.h"
#include "converters/common/error.h"
#include "converters/export/sofa/scene_tree.h"

namespace lumen::convert {

namespace {

constexpr double kUsualSamples = 8e6;
constexpr double kMargin = 1;  // mm

static_assert(std::endian::native == std::endian::little, "SOFA reads the machine's numbers");

using Model = std::unique_ptr<blob_model, void (*)(blob_model*)>;

Model open(std::span<const std::byte> file) {
  blob_model* model = nullptr;
  const blob_status status = blob_model_open_bytes(file.data(), file.size(), nullptr, &model);
  if (status != BLOB_OK)
    throw failed(std::string("the case's models: ") + blob_status_text(status));
  return {model, &blob_model_close};
}

double usualSpacing(const std::array<double, 3>& low, const std::array<double, 3>& high,
                    double thinnest) {
  double volume = 1;
  for (std::size_t a = 0; a < 3; ++a) volume *= high[a] - low[a] + 2 * kMargin;
  return std::max(thinnest / 4, std::cbrt(volume / kUsualSamples));
}

void setSize(DistanceGrid& grid, const std::array<double, 3>& low,
             const std::array<double, 3>& high) {
  double samples = 1;
  for (std::size_t a = 0; a < 3; ++a) {
    const double margin = kMargin + 3 * grid.spacing;
    const double cells = std::ceil((high[a] - low[a] + 2 * margin) / grid.spacing);
    samples *= cells + 1;
    if (samples > static_cast<double>(kMostGridSamples))
      throw Error(ErrorKind::Usage,
                  "--grid " + sceneNumber(grid.spacing) + ": this makes more samples than " +
                      std::to_string(kMostGridSamples) + "; a wider spacing, please");
    grid.size[a] = static_cast<int>(cells) + 1;
    grid.first[a] = low[a] - margin;
  }
  grid.distance.resize(static_cast<std::size_t>(samples));
}

/// One row along x.
void fillRow(DistanceGrid& grid, const blob_model* model, std::size_t row) {
  const auto nx = static_cast<std::size_t>(grid.size[0]),
             ny = static_cast<std::size_t>(grid.size[1]);
  std::vector<std::array<double, 3>> points(nx);
  for (std::size_t i = 0; i < nx; ++i)
    points[i] = {grid.first[0] + static_cast<double>(i) * grid.spacing,
                 grid.first[1] + static_cast<double>(row % ny) * grid.spacing,
                 grid.first[2] + static_cast<double>(row / ny) * grid.spacing};
  std::vector<blob_sample> samples(nx);
  blob_query_many(model, BLOB_BLENDED, nx, reinterpret_cast<const double(*)[3]>(points.data()),
                  nullptr, samples.data());
  for (std::size_t i = 0; i < nx; ++i) grid.distance[row * nx + i] = -samples[i].distance;
}

template <class T>
std::string encoded(const std::vector<double>& values) {
  std::string bytes(values.size() * sizeof(T), '\0');
  for (std::size_t i = 0; i < values.size(); ++i) {
    const T value = static_cast<T>(values[i]);
    std::memcpy(bytes.data() + i * sizeof(T), &value, sizeof(T));
  }
  return bytes;
}

}  // namespace

std::array<double, 3> DistanceGrid::last() const {
  std::array<double, 3> corner = first;
  for (std::size_t a = 0; a < 3; ++a) corner[a] += spacing * (size[a] - 1);
  return corner;
}

DistanceGrid distanceGrid(std::span<const std::byte> file, const std::array<double, 3>& low,
                          const std::array<double, 3>& high, double spacing, double thinnest,
                          Progress& progress) {
  DistanceGrid grid;
  grid.spacing = spacing > 0 ? spacing : usualSpacing(low, high, thinnest);
  setSize(grid, low, high);
  const Model model = open(file);
  const std::size_t rows =
      static_cast<std::size_t>(grid.size[1]) * static_cast<std::size_t>(grid.size[2]);
  progress.begin("distances", rows);
  tbb::parallel_for(std::size_t{0}, rows, [&](std::size_t row) {
    progress.check();
    fillRow(grid, model.get(), row);
    progress.advance();
  });
  progress.end();
  return grid;
}

std::string encodeGridDoubles(const DistanceGrid& grid) {
  return encoded<double>(grid.distance);
}

std::string encodeGridFloats(const DistanceGrid& grid) {
  return encoded<float>(grid.distance);
}

std::string gridHeader(const DistanceGrid& grid, const std::string& raw) {
  const std::string spacing = sceneNumber(grid.spacing);
  return "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n"
         "CompressedData = False\nTransformMatrix = 1 0 0 0 1 0 0 0 1\nOffset = " +
         sceneNumbers({grid.first[0], grid.first[1], grid.first[2]}) +
         "\nCenterOfRotation = 0 0 0\nElementSpacing = " + spacing + " " + spacing + " " + spacing +
         "\nDimSize = " + std::to_string(grid.size[0]) + " " + std::to_string(grid.size[1]) + " " +
         std::to_string(grid.size[2]) + "\nElementType = MET_FLOAT\nElementDataFile = " + raw +
         "\n";
}

}  // namespace lumen::convert
