// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/mask_input.h"

#include <algorithm>
#include <charconv>
#include <string_view>
#include <utility>
#include <vector>

#include "converters/base/error.h"
#include "converters/engine/file_access.h"
#include "converters/engine/file_format.h"
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

}  // namespace

std::set<std::int64_t> MaskArguments::chosen() const {
  std::set<std::int64_t> values;
  if (label) values.insert(*label);
  for (const auto& [value, name] : namedLabels(labels)) values.insert(value);
  return values;
}

convert::LabelNames MaskArguments::names(const InputFile& file) const {
  if (!labels.empty()) return namedLabels(labels);
  if (labelTable.empty()) return convert::segmentNames(file);
  const std::vector<std::string>& known = convert::builtInLabelTables();
  if (std::find(known.begin(), known.end(), labelTable.name()) == known.end())
    requireInput(labelTable, "table of labels");
  return convert::readLabelTable(labelTable);
}

std::optional<operations::LabelPart> loadRegions(const MaskArguments& arguments,
                                                 Progress& progress) {
  const InputFile& map = arguments.labelMap;
  if (map.empty()) return {};
  requireInput(map, "label map");
  const FileFormat& format = inputFormat(map, "");
  if (format.kind != FormatKind::Volume)
    throw invalidInput(formats::printable(map.name()) +
                       ": is no volume; expected a volume of labels");
  convert::LabelNames names = arguments.names(map);
  return operations::LabelPart{readVolumeFile(map, format, {}, progress), map.name(),
                               std::move(names)};
}

}  // namespace lumen::engine
