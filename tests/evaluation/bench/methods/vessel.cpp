// SPDX-License-Identifier: Apache-2.0
#include "vessel.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <utility>

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

}  // namespace lumen::bench
