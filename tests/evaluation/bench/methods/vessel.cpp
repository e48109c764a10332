// SPDX-License-Identifier: Apache-2.0
#include "vessel.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "formats/case/blobby.h"
#include "formats/case/case_file.h"

namespace lumen::bench {
namespace {

std::shared_ptr<blob_model> openModel(const formats::Case& source, blob_simd simd) {
  const std::vector<std::byte> bytes = formats::encodeBinary(source);
  blob_open_def def = blob_open_def_default();
  def.simd = simd;
  blob_model* model = nullptr;
  const blob_status status = blob_model_open_bytes(bytes.data(), bytes.size(), &def, &model);
  if (status != BLOB_OK) throw std::runtime_error(blob_status_text(status));
  return {model, blob_model_close};
}

}  // namespace

OwnedVessel openVessel(formats::Case source, std::string name) {
  OwnedVessel result;
  result.model = openModel(source, BLOB_SIMD_BEST);
  result.vessel.name = std::move(name);
  result.vessel.model = result.model.get();
  result.vessel.voxel = source.metadata.voxelSize.value_or(result.vessel.voxel);
  result.source = std::move(source);
  return result;
}

formats::Case readCase(const std::string& file) {
  auto read = formats::readCaseFile(file);
  if (!read) throw std::runtime_error(read.error().text());
  return *std::move(read);
}

std::shared_ptr<blob_model> scalarModel(const formats::Case& source) {
  return openModel(source, BLOB_SIMD_SCALAR);
}

double gridCell(const blob_model* model, double wanted, double most) {
  const blob_model_info info = blob_model_describe(model);
  double volume = 1;
  for (std::size_t i = 0; i < 3; ++i) volume *= info.high[i] - info.low[i] + 2;
  return std::max(wanted, std::cbrt(volume / most));
}

std::string inMm(double length) {
  std::ostringstream out;
  out.precision(2);
  out << length << " mm";
  return out.str();
}

using formats::Case;
using formats::Vec3f;

Case tubeAlong(const std::vector<Vec3f>& line, double spacing, double radius) {
  Case result;
  formats::BlobbyModels models;
  const auto wall = [&](double width) {
    formats::BlobbyModels probe;
    for (int j = -3; j <= 3; ++j) {
      probe.centre.push_back({static_cast<float>(j * spacing), 0, 0});
      probe.width.push_back(static_cast<float>(width));
    }
    probe.offset = {0, 7};
    return formats::evaluateField(probe, 0, {0, radius, 0}).f;
  };
  double low = 0.01 * radius, high = 2 * radius;
  for (int i = 0; i < 40; ++i) (wall(0.5 * (low + high)) < 0.1 ? low : high) = 0.5 * (low + high);
  const int last = static_cast<int>(line.size()) - 1;
  models.offset.push_back(0);
  for (int i = 0; i <= last; ++i) {
    for (int j = i - 3; j <= i + 3; ++j) {
      models.centre.push_back(line[static_cast<std::size_t>(std::clamp(j, 0, last))]);
      models.width.push_back(static_cast<float>(low));
    }
    models.offset.push_back(static_cast<std::uint32_t>(models.width.size()));
    result.tree.centre.push_back(line[static_cast<std::size_t>(i)]);
    const Vec3f& a = line[static_cast<std::size_t>(std::max(i - 1, 0))];
    const Vec3f& b = line[static_cast<std::size_t>(std::min(i + 1, last))];
    const double x = b.x - a.x, y = b.y - a.y, length = std::hypot(x, y);
    result.tree.direction.push_back(
        {static_cast<float>(x / length), static_cast<float>(y / length), 0});
    result.tree.parent.push_back(i - 1);
  }
  result.tree.radius.assign(line.size(), static_cast<float>(radius));
  result.tree.height.assign(line.size(), static_cast<float>(spacing));
  result.tree.branch.assign(line.size(), 0);
  formats::Branch branch;
  branch.label = "tube";
  branch.nodeCount = static_cast<std::uint32_t>(line.size());
  result.tree.branches.push_back(branch);
  result.models = models;
  return result;
}

}  // namespace lumen::bench
