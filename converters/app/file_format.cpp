// SPDX-License-Identifier: Apache-2.0
#include "converters/app/file_format.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <system_error>

#include <stdlib.h>
#include <unistd.h>

#include "converters/common/error.h"

namespace lumen::app {

namespace fs = std::filesystem;

namespace {

std::string lowerCase(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

const FileFormat* findByName(std::string_view name) {
  for (const FileFormat& format : fileFormats())
    if (format.name == name) return &format;
  return nullptr;
}

const FileFormat* findByEnding(const fs::path& path) {
  const std::string file = lowerCase(path.filename().string());
  const FileFormat* best = nullptr;
  std::size_t longest = 0;
  for (const FileFormat& format : fileFormats())
    for (const std::string_view extension : format.extensions)
      if (extension.size() > longest && file.size() > extension.size() &&
          file.ends_with(extension)) {
        best = &format;
        longest = extension.size();
      }
  return best;
}

std::string listNames(bool FileFormat::*wanted) {
  std::string names;
  for (const FileFormat& format : fileFormats())
    if (format.*wanted) names += (names.empty() ? "" : ", ") + std::string(format.name);
  return names;
}

/// `format` if it is not null and can do what is wanted.
const FileFormat& require(const FileFormat* format, const fs::path& path, std::string_view override,
                          bool FileFormat::*wanted, const std::string& verb,
                          const std::string& option) {
  if (format != nullptr && format->*wanted) return *format;
  const std::string known = "; lumen " + verb + "s " + listNames(wanted);
  if (!override.empty())
    throw unsupported(option + " " + std::string(override) + ": lumen cannot " + verb +
                      " this format" + known);
  if (format != nullptr)
    throw unsupported(path.string() + ": lumen cannot " + verb + " the format " +
                      std::string(format->name) + known);
  throw unsupported(path.string() + ": the name's ending is not that of a format that lumen " +
                    verb + "s" + known + " (" + option + " chooses one whatever the name)");
}

}  // namespace

const std::vector<FileFormat>& fileFormats() {
  static const std::vector<FileFormat> formats = {
      {"lumen", FormatKind::Case, {".lumen"}, true, true},
      {"lumen.json", FormatKind::Case, {".lumen.json", ".json"}, true, true},
      {"glb", FormatKind::Mesh, {".glb"}, false, true},
      {"gltf", FormatKind::Mesh, {".gltf"}, false, true},
      {"obj", FormatKind::Mesh, {".obj"}, false, true},
      {"stl", FormatKind::Mesh, {".stl"}, false, true},
      {"ply", FormatKind::Mesh, {".ply"}, false, true},
      {"nrrd", FormatKind::Volume, {".nrrd", ".nhdr"}, true, false},
      {"nii", FormatKind::Volume, {".nii.gz", ".nii"}, true, false},
      {"mha", FormatKind::Volume, {".mha", ".mhd"}, true, false},
      {"dicom", FormatKind::Volume, {}, true, false},
  };
  return formats;
}

const FileFormat& inputFormat(const fs::path& path, std::string_view override) {
  std::error_code ignored;
  const FileFormat* format = !override.empty()                 ? findByName(override)
                             : fs::is_directory(path, ignored) ? findByName("dicom")
                                                               : findByEnding(path);
  return require(format, path, override, &FileFormat::readable, "read", "--from");
}

const FileFormat& outputFormat(const fs::path& path, std::string_view override) {
  const FileFormat* format = override.empty() ? findByEnding(path) : findByName(override);
  return require(format, path, override, &FileFormat::writable, "write", "--to");
}

void requireInput(const fs::path& path, std::string_view what) {
  std::error_code error;
  if (fs::exists(path, error)) return;
  throw invalidInput(path.string() + ": there is no such " + std::string(what));
}

void requireWritable(const fs::path& path) {
  std::error_code ignored;
  if (path.filename().empty() || fs::is_directory(path, ignored))
    throw failed(path.string() + ": this is a folder, but the output must be a file");
  if (fs::exists(path, ignored)) {
    if (!fs::is_regular_file(path, ignored))
      throw failed(path.string() + ": this is not a regular file, but the output must be one");
    if (access(path.c_str(), W_OK) != 0)
      throw failed(path.string() + ": this file may not be overwritten: " + std::strerror(errno));
  }
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  if (!fs::is_directory(folder, ignored))
    throw failed(path.string() + ": the output's folder " + folder.string() + " does not exist");
  // permission bits do not tell (read-only mounts, privileged users), so one file is made and
  // dropped
  std::string probe = (folder / ".lumen-probe-XXXXXX").string();
  const int file = mkstemp(probe.data());
  if (file < 0)
    throw failed(path.string() + ": no file can be made in the folder " + folder.string() + ": " +
                 std::strerror(errno));
  close(file);
  unlink(probe.c_str());
}

}  // namespace lumen::app
