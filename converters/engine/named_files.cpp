// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/named_files.h"

#include <map>
#include <string_view>
#include <variant>
#include <vector>

#include "converters/base/error.h"
#include "converters/engine/file_access.h"
#include "converters/engine/mask_input.h"
#include "converters/engine/mesh_input.h"
#include "converters/engine/tracking_input.h"
#include "converters/io/centerline/centerline_readers.h"
#include "formats/container/printable.h"

namespace lumen::engine {

namespace {

using Look = void (*)(const InputFile&);

/// Throws if the header of a volume cannot be read, which needs no option. Contours are not filled.
void lookAtVolume(const InputFile& file, const std::string& role, const std::string& expected) {
  const FileFormat& format = volumeFormat(file, role, expected);
  VolumeArguments arguments;
  arguments.grid = convert::VolumeGeometry{};
  arguments.grid->size = {1, 1, 1};
  Progress silent;
  loadVolumeHeader(file, format, arguments, silent);
}

void lookAtLabelMap(const InputFile& file) {
  requireInput(file, "label map");
  if (!convert::isLabelFolder(file)) lookAtVolume(file, "label map", "volume of labels");
}

void lookAtLabelTable(const InputFile& file) {
  MaskArguments arguments;
  arguments.labelTable = file;
  Progress silent;
  (void)arguments.table(file, silent);
}

void lookAtCenterline(const InputFile& file) {
  MeshArguments arguments;
  arguments.centerline = file;
  Progress silent;
  loadGivenCenterline(arguments, silent);
}

/// By the name of the row. A file of another option must be there.
const std::map<std::string_view, Look> kLooks = {
    {"label-map", lookAtLabelMap},
    {"label-table", lookAtLabelTable},
    {"native",
     [](const InputFile& file) {
       lookAtVolume(file, "scan without contrast", "scan without contrast");
     }},
    {"centerline", lookAtCenterline},
    {"tree", [](const InputFile& file) { convert::readSwc(file); }},
    {"veins", [](const InputFile& file) { convert::readSwc(file); }},
    {"against", [](const InputFile& file) { readCase(file); }}};

/// The inputs that the row names.
std::vector<InputFile> inputsOf(const OptionRow& row) {
  if (const auto one = std::get_if<InputFile*>(&row.target)) return {**one};
  if (const auto several = std::get_if<std::vector<InputFile>*>(&row.target)) return **several;
  const auto name = std::get_if<std::string*>(&row.target);
  if (name != nullptr && kLooks.contains(row.name)) return {**name};
  return {};
}

}  // namespace

const FileFormat& volumeFormat(const InputFile& file, const std::string& role,
                               const std::string& expected) {
  requireInput(file, role);
  const FileFormat& format = inputFormat(file, "");
  if (format.kind != FormatKind::Volume)
    throw invalidInput(formats::printable(file.name()) + ": is no volume; expected a " + expected);
  return format;
}

void lookAtFiles(const OptionRow& row) {
  const auto look = kLooks.find(row.name);
  for (const InputFile& file : inputsOf(row))
    if (look != kLooks.end())
      look->second(file);
    else if (!row.isArgument)
      requireInput(file, "file");
}

}  // namespace lumen::engine
