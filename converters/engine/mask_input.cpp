// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/mask_input.h"

#include <algorithm>
#include <charconv>
#include <string_view>
#include <utility>

#include "converters/base/error.h"
#include "converters/base/option_name.h"
#include "converters/engine/stage_options.h"
#include "converters/engine/tracking_input.h"
#include "converters/stages/trees_from_surfaces/case_of_mesh.h"
#include "formats/container/printable.h"

namespace lumen::engine {

namespace {

/// "N=NAME" of --labels. Throws Error(Usage).
std::pair<std::int64_t, std::string> namedLabel(std::string_view word) {
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  const std::string_view rest = word.substr(static_cast<std::size_t>(end - word.data()));
  if (error == std::errc() && rest.starts_with('=') && rest.find('=', 1) != std::string_view::npos)
    throw Error(ErrorKind::Usage, "--labels: " + formats::printable(std::string(word)) +
                                      " names two labels; expected a comma between them, such as "
                                      "1=ica,2=mca");
  if (error != std::errc() || value == 0 || rest.size() < 2 || rest.front() != '=')
    throw Error(ErrorKind::Usage, "--labels: " + formats::printable(std::string(word)) +
                                      "; expected labels with names, such as 1=ica,2=mca; 0 is "
                                      "what is around the vessels");
  return {value, std::string(rest.substr(1))};
}

}  // namespace

convert::LabelNames MaskArguments::names() const {
  convert::LabelNames names;
  if (label) names[*label] = "label-" + std::to_string(*label);
  for (std::size_t at = 0; at < labels.size();) {
    const std::size_t end = std::min(labels.find(',', at), labels.size());
    auto [value, text] = namedLabel(std::string_view(labels).substr(at, end - at));
    if (!names.emplace(value, std::move(text)).second)
      throw Error(ErrorKind::Usage, "--labels: names the label " + std::to_string(value) +
                                        " twice; expected each once");
    at = end + 1;
  }
  return names;
}

formats::Case caseOfMaskFile(const std::filesystem::path& file, const FileFormat& format,
                             const VolumeArguments& volume, const MaskArguments& arguments,
                             Progress& progress) {
  return caseOfMask(readVolumeFile(file, format, volume, progress), file, arguments, progress);
}

formats::Case caseOfMask(const convert::Volume& volume, const std::filesystem::path& file,
                         const MaskArguments& arguments, Progress& progress) {
  const std::string name = formats::printable(file.string());
  const convert::LabelNames names = arguments.names();
  const convert::LabelMask mask = convert::maskOf(volume, names, name);
  if (mask.isGrey)
    progress.warn(name +
                  ": its voxels differ from their neighbours as grey values do, and are taken as "
                  "labels; expected a segmentation: an image is tracked from " +
                  kOption.seeds.shown());
  progress.begin("surface", 0);
  convert::LabelSurface surface = convert::surfaceOf(mask, progress);
  progress.end();
  if (surface.cavities > 0)
    progress.warn(name + ": " + std::to_string(surface.cavities) +
                  (surface.cavities == 1 ? " hole" : " holes") + " within the labels filled");
  convert::MeshCase made = convert::caseOfLumen(
      convert::closeMesh(std::move(surface.mesh)), mask.geometry.voxelSize(), name, {},
      {{"labels", static_cast<std::int64_t>(mask.names.size())}}, progress);
  for (const std::string& note : made.notes) progress.warn(note);
  // no wall is known better than to a voxel of the labels
  std::optional<double>& voxel = made.result.metadata.voxelSize;
  voxel = std::max(voxel.value_or(0), mask.geometry.voxelSize());
  if (mask.names.size() > 1 || !arguments.labels.empty()) nameBranches(mask, made.result);
  return std::move(made.result);
}

}  // namespace lumen::engine
