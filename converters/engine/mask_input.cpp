// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/mask_input.h"

#include <algorithm>
#include <charconv>
#include <string_view>
#include <utility>

#include "converters/base/error.h"
#include "converters/base/options/edit_steps.h"
#include "converters/base/options/option_name.h"
#include "converters/base/shown_text.h"
#include "converters/base/vectors.h"
#include "converters/engine/file_access.h"
#include "converters/engine/file_format.h"
#include "converters/engine/stage_options.h"
#include "converters/engine/tracking_input.h"
#include "converters/io/volume/write_volume.h"
#include "converters/stages/trees_from_surfaces/case_of_mesh.h"
#include "converters/stages/trees_from_surfaces/label_mesh.h"
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

/// Gives the labels of a mask the names of a table, where it has them.
void useTable(const convert::LabelNames& table, convert::LabelMask& mask) {
  for (std::size_t i = 0; i < mask.values.size(); ++i)
    if (const auto found = table.find(mask.values[i]); found != table.end())
      mask.names[i] = found->second;
}

/// The middle of a volume, mm, LPS, and the lengths of its edges.
std::string extentText(const convert::VolumeGeometry& geometry) {
  const Eigen::Vector3d size = geometry.cells().size.cast<double>();
  return convert::vectorText(geometry.worldFromIndex(0.5 * (size.array() - 1).matrix())) +
         " with edges of " + convert::vectorText(size.cwiseProduct(geometry.spacing)) + " mm";
}

/// Gives the remarks on ends the names of the branches on whose nodes they lie.
void renameEnds(const formats::CenterlineTree& tree, std::vector<convert::TrackEnd>& ends) {
  for (convert::TrackEnd& end : ends) {
    const auto nearest = std::min_element(tree.centre.begin(), tree.centre.end(),
                                          [&](const formats::Vec3f& a, const formats::Vec3f& b) {
                                            return (toEigen(a) - end.position).squaredNorm() <
                                                   (toEigen(b) - end.position).squaredNorm();
                                          });
    if (nearest == tree.centre.end()) return;
    end.label =
        tree.branches[tree.branch[static_cast<std::size_t>(nearest - tree.centre.begin())]].label;
  }
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

convert::LabelNames MaskArguments::table(const std::filesystem::path& file) const {
  if (labelTable.empty()) return convert::segmentNames(file);
  const std::vector<std::string>& known = convert::builtInLabelTables();
  if (std::find(known.begin(), known.end(), labelTable) == known.end())
    requireInput(labelTable, "table of labels");
  return convert::readLabelTable(labelTable);
}

formats::Case caseOfMask(const convert::Volume& volume, const std::filesystem::path& file,
                         const MaskArguments& arguments, Progress& progress) {
  const std::string name = formats::printable(file.string());
  const convert::LabelNames names = arguments.names();
  const convert::LabelNames table =
      arguments.labels.empty() ? arguments.table(file) : convert::LabelNames{};
  convert::LabelMask mask = convert::makeLabelMask(volume, names, name);
  useTable(table, mask);
  if (mask.isGrey)
    progress.warn(name +
                  ": its voxels differ from their neighbours as grey values do, and are taken as "
                  "labels; expected a segmentation: an image is tracked from " +
                  kOption.seeds.shown());
  progress.begin("surface", 0);
  convert::LabelSurface surface = convert::makeLabelSurface(mask, progress);
  progress.end();
  if (surface.cavities > 0)
    progress.warn(name + ": " + std::to_string(surface.cavities) +
                  (surface.cavities == 1 ? " hole" : " holes") + " within the labels filled");
  convert::MeshCase made = convert::caseOfLumen(
      convert::closeMesh(std::move(surface.mesh)), mask.geometry.voxelSize(), name, {},
      {{"labels", static_cast<std::int64_t>(mask.names.size())}}, progress);
  for (const std::string& note : made.notes) progress.warn(note);
  recordAssumptions(made.result.metadata.steps.back(), volume.assumptions);
  // no wall is known better than to a voxel of the labels
  std::optional<double>& voxel = made.result.metadata.voxelSize;
  voxel = std::max(voxel.value_or(0), mask.geometry.voxelSize());
  if (mask.names.size() > 1 || !arguments.labels.empty() || !table.empty())
    convert::nameBranches(mask, made.result);
  return std::move(made.result);
}

void nameByLabelMap(const convert::Volume& volume, const std::string& file,
                    const MaskArguments& arguments, formats::Case& target,
                    std::vector<convert::TrackEnd>& ends, Progress& progress) {
  const std::string& map = arguments.labelMap;
  const std::string name = formats::printable(map);
  requireInput(map, "label map");
  const FileFormat& format = inputFormat(map, "");
  if (format.kind != FormatKind::Volume)
    throw invalidInput(name + ": is no volume; expected a volume of labels");
  const convert::LabelNames table = arguments.table(map);
  const convert::Volume labels = readVolumeFile(map, format, {}, progress);
  if (!convert::holdsLabels(labels))
    throw invalidInput(name +
                       ": its voxels are no labels; expected whole numbers that are equal to "
                       "their neighbours but at borders, and 0 around vessels");
  convert::LabelMask mask = convert::makeLabelMask(labels, {}, name);
  if (convert::labelledWithin(mask, volume.geometry) == 0)
    throw invalidInput(name + ": none of its labels lies within " + formats::printable(file) +
                       "; the labels' volume is around " + extentText(mask.geometry) +
                       ", expected labels of the volume around " + extentText(volume.geometry));
  useTable(table, mask);
  const convert::Naming done = convert::nameBranches(mask, target);
  if (done.named == 0) progress.warn(name + ": no branch lies on its labels; names stay");
  progress.detail(name + ": names " + std::to_string(done.named) + " branches, " +
                  std::to_string(done.bare) + " lie on no label, " + std::to_string(done.divided) +
                  " were divided between labels");
  renameEnds(target.tree, ends);
  target.metadata.steps.push_back({"label-map",
                                   "lumen " LUMEN_VERSION,
                                   {{"label-map-sha256", convert::describeSource(labels).sha256}}});
}

}  // namespace lumen::engine
