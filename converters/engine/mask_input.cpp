// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/mask_input.h"

#include <algorithm>
#include <charconv>
#include <string_view>
#include <utility>
#include <vector>

#include "converters/base/error.h"
#include "converters/base/text.h"
#include "converters/base/warning.h"
#include "converters/engine/file_access.h"
#include "converters/engine/file_format.h"
#include "converters/engine/named_files.h"
#include "converters/engine/tracking_input.h"
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

/// The labels of a text such as "1=ica,2=mca". Throws Error(Usage).
convert::LabelNames namedLabels(const std::string& labels) {
  convert::LabelNames names;
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

/// The first table beside a map that can be read.
convert::LabelTable besideTable(const InputFile& map, Progress& progress) {
  for (const InputFile& file : convert::tablesBeside(map)) {
    try {
      convert::LabelTable table = convert::readLabelTable(file);
      progress.detail(map.name() + ": names of its labels come from " + file.name());
      return table;
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::InvalidInput) throw;
      progress.detail(std::string(error.what()) + "; this file beside " + map.name() +
                      " is passed over");
    }
  }
  return {};
}

operations::LabelPart loadLabelMap(const InputFile& map, const MaskArguments& arguments,
                                   const convert::VolumeGeometry* grid, Progress& progress) {
  requireInput(map, "label map");
  if (convert::isLabelFolder(map)) {
    convert::FolderMap read = loadLabelFolder(map, {}, progress);
    return labelPart(std::move(read.voxels), map.name(), read.table);
  }
  const FileFormat& format = volumeFormat(map, "label map", "volume of labels");
  const convert::LabelTable table = arguments.table(map, progress);
  VolumeArguments reading;
  if (grid != nullptr) reading.grid = *grid;
  convert::Volume voxels = readVolumeFile(map, format, reading, progress);
  if (auto settled = convert::settleLabels(voxels, {}))
    voxels = takeSettled(*std::move(settled), map.name(), progress);
  return labelPart(std::move(voxels), map.name(), table);
}

}  // namespace

std::set<std::int64_t> MaskArguments::chosen() const {
  std::set<std::int64_t> values;
  if (label) values.insert(*label);
  for (const auto& [value, name] : namedLabels(labels)) values.insert(value);
  return values;
}

convert::LabelTable MaskArguments::table(const InputFile& file, Progress& progress,
                                         std::int64_t layer) const {
  if (!labels.empty()) return {namedLabels(labels), {}, "the option", {}};
  if (!labelTable.empty()) {
    const std::vector<std::string>& known = convert::builtInLabelTables();
    if (std::find(known.begin(), known.end(), labelTable.name()) == known.end())
      requireInput(labelTable, "table of labels");
    return convert::readLabelTable(labelTable);
  }
  convert::LabelTable own = convert::ownNames(file, layer);
  return own.names.empty() ? besideTable(file, progress) : own;
}

convert::Volume takeSettled(convert::SettledLabels settled, const std::string& name,
                            Progress& progress) {
  for (const std::string& remark : settled.remarks)
    warn(progress, about(formats::printable(name), {WarningCode::LabelsSettled, remark}));
  return std::move(settled.voxels);
}

std::string roleFault(const std::string& text) {
  const std::size_t equals = text.rfind('=');
  if (equals != text.npos && equals > 0 && convert::roleOfWord(text.substr(equals + 1))) return {};
  return "found " + (text.empty() ? "nothing" : text) +
         ", expected a label by its name or number, = and its role: " +
         alternatives(convert::roleWords());
}

operations::LabelPart labelPart(convert::Volume voxels, const std::string& name,
                                const convert::LabelTable& table) {
  std::vector<convert::LabelMeaning> meanings = convert::meaningsOf(table);
  convert::addUnnamed(convert::countLabels(voxels), meanings);
  return {std::move(voxels), name, std::move(meanings)};
}

void stateRoles(const std::vector<std::string>& statements,
                std::vector<operations::LabelPart>& maps) {
  for (const std::string& text : statements) {
    const std::size_t equals = text.rfind('=');
    const convert::RoleStatement statement{text.substr(0, equals),
                                           *convert::roleOfWord(text.substr(equals + 1))};
    bool isFound = false;
    std::vector<std::string> names;
    for (operations::LabelPart& map : maps) {
      isFound = convert::stateRole(statement, "the option", map.meanings) || isFound;
      for (const auto& [value, name] : convert::namesOf(map.meanings)) names.push_back(name);
    }
    if (!isFound)
      throw Error(ErrorKind::Usage, "--role: no label map has the label " +
                                        formats::printable(statement.label) +
                                        didYouMean(statement.label, names));
  }
}

convert::FolderMap loadLabelFolder(const InputFile& folder,
                                   const convert::ReadVolumeOptions& options, Progress& progress) {
  progress.begin("reading", 0);
  convert::FolderMap read = convert::readLabelFolder(folder, options, progress);
  progress.end();
  for (const std::string& remark : read.remarks)
    warn(progress, {WarningCode::LabelsSettled, remark});
  return read;
}

void refuseTableOfFolder() {
  throw Error(ErrorKind::Usage,
              "--label-table does nothing for a folder, whose files name its labels");
}

std::vector<operations::LabelPart> loadLabelMaps(const MaskArguments& arguments,
                                                 const convert::VolumeGeometry* grid,
                                                 Progress& progress) {
  std::vector<operations::LabelPart> maps;
  const std::vector<InputFile>& files = arguments.labelMaps;
  if (!arguments.labelTable.empty() && !files.empty() &&
      std::all_of(files.begin(), files.end(), convert::isLabelFolder))
    refuseTableOfFolder();
  for (const InputFile& map : files) maps.push_back(loadLabelMap(map, arguments, grid, progress));
  stateRoles(arguments.roles, maps);
  return maps;
}

}  // namespace lumen::engine
