// SPDX-License-Identifier: Apache-2.0
// ownNames() of label_table.h: the names in the header of a map.
#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <string_view>

#include "converters/base/error.h"
#include "converters/base/text.h"
#include "converters/io/labels/label_lines.h"
#include "converters/io/labels/label_table.h"
#include "converters/io/volume/dicom/dicom_tree.h"
#include "converters/io/volume/nifti_header.h"
#include "converters/io/volume/text_header.h"
#include "formats/container/printable.h"

namespace lumen::convert {
namespace {

namespace fs = std::filesystem;

struct Segment {
  std::string value, name, layer = "0", tags;
};

/// "CATEGORY~TYPE~MODIFIER~..." of the Terminology tag, each "SCHEME^CODE^MEANING": the meaning of
/// the type.
std::string typeOf(const std::string& terminology) {
  const std::vector<std::string> parts = splitWords(terminology, "~");
  if (parts.size() < 3) return {};
  const std::vector<std::string> type = splitWords(parts[2], "^");
  return type.size() < 3 ? "" : type[2];
}

std::map<std::string, Segment> segmentsOf(HeaderLines& lines) {
  std::map<std::string, Segment> segments;
  std::string line;
  while (lines.next(line) && !trimmed(line).empty()) {
    const std::size_t equals = line.find(":="), underscore = line.find('_');
    if (equals == line.npos || underscore > equals || !line.starts_with("Segment")) continue;
    const std::string number = line.substr(7, underscore - 7);
    const std::string key = line.substr(underscore + 1, equals - underscore - 1);
    if (!parseInteger(number)) continue;
    const std::string value = trimmed(line.substr(equals + 2));
    if (key == "LabelValue") segments[number].value = value;
    if (key == "Name") segments[number].name = value;
    if (key == "Layer") segments[number].layer = value;
    if (key == "Tags") segments[number].tags = value;
  }
  return segments;
}

/// The terminology among the tags of a segment, "Key:value|Key:value|".
std::string terminologyIn(const std::string& tags) {
  constexpr std::string_view kKey = "TerminologyEntry:";
  const std::size_t at = tags.find(kKey);
  if (at == tags.npos) return {};
  const std::size_t from = at + kKey.size();
  return tags.substr(from, tags.find('|', from) - from);
}

LabelTable namesOfSegments(HeaderLines& lines, const InputFile& file, std::int64_t layer) {
  LabelTable table;
  for (const auto& [number, segment] : segmentsOf(lines)) {
    if (segment.value.empty() || segment.layer != std::to_string(layer)) continue;
    addLabelName(formats::printable(file.path().string()) + ": Segment" + number + ": ",
                 segment.value, segment.name, table.names);
    const LabelRole role = roleOfName(typeOf(terminologyIn(segment.tags)));
    const auto value = parseInteger(segment.value);
    if (value && *value != 0 && role != LabelRole::Unknown) table.roles[*value] = role;
  }
  table.rolesFrom = "terminology";
  return table;
}

/// The text between two marks from `at` on, and moves `at` behind it; empty, and `at` at the end,
/// if there is none.
std::string_view between(std::string_view text, std::string_view open, std::string_view close,
                         std::size_t& at) {
  const std::size_t from = text.find(open, at);
  const std::size_t to = from == text.npos ? from : text.find(close, from + open.size());
  at = std::min(to, text.size());
  return to == text.npos ? std::string_view()
                         : text.substr(from + open.size(), to - from - open.size());
}

/// The names of a table of Connectome Workbench. The map is readable without it: labels and names
/// that cannot be used are passed over.
LabelNames namesOfWorkbench(std::string_view xml) {
  LabelNames names;
  for (std::size_t at = xml.find("<LabelTable"); at < xml.size();) {
    const std::string label(between(xml, "<Label ", "</Label>", at));
    std::size_t inside = 0;
    const std::string value(between(label, "Key=\"", "\"", inside));
    std::string name(label.substr(std::min(label.find('>'), label.size())));
    name.erase(0, 1);
    std::size_t data = 0;
    if (name.starts_with("<![CDATA[")) name = std::string(between(name, "<![CDATA[", "]]>", data));
    try {
      if (!value.empty()) addLabelName("", value, name, names);
    } catch (const Error&) {
    }
  }
  return names;
}

}  // namespace

namespace {

/// The names of segments and structures of DICOM. Those that no branch can have are passed over.
LabelTable namesOfDicom(const InputFile& file) {
  LabelTable table;
  for (const DicomSegment& segment : dicomSegments(file)) {
    try {
      addLabelName("", std::to_string(segment.number), segment.name, table.names);
    } catch (const Error&) {
      continue;
    }
    const LabelRole role = roleOfName(segment.type);
    if (segment.number > 0 && role != LabelRole::Unknown)
      table.roles[static_cast<std::int64_t>(segment.number)] = role;
  }
  table.from = "its header";
  table.rolesFrom = "terminology";
  return table;
}

/// The file of a folder of one, as archives have one for a segmentation.
std::optional<InputFile> onlyFileOf(const InputFile& folder) {
  if (folder.files() != nullptr)
    return folder.files()->size() == 1 ? std::optional(folder.files()->front()) : std::nullopt;
  if (!folder.isFolder()) return std::nullopt;
  std::optional<InputFile> only;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder.path(), error)) {
    if (only || !entry.is_regular_file(error)) return std::nullopt;
    only = InputFile(entry.path());
  }
  return only;
}

}  // namespace

LabelTable ownNames(const InputFile& file, std::int64_t layer) {
  if (const std::optional<InputFile> only = onlyFileOf(file)) return ownNames(*only, layer);
  if (file.isFolder() || (!file.isInMemory() && !fs::is_regular_file(file.path()))) return {};
  if (LabelTable dicom = namesOfDicom(file); !dicom.names.empty()) return dicom;
  HeaderLines lines(file);
  std::string line;
  LabelTable table;
  if (lines.next(line) && line.starts_with("NRRD")) {
    table = namesOfSegments(lines, file, layer);
  } else {
    table.names = namesOfWorkbench(niftiExtensions(file));
  }
  table.from = "its header";
  return table;
}

}  // namespace lumen::convert
