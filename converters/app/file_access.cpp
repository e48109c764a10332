// SPDX-License-Identifier: Apache-2.0
#include "converters/app/file_access.h"

#include <array>
#include <fstream>
#include <span>
#include <system_error>

#include <stdlib.h>

#include "converters/common/sha256.h"
#include "converters/seeds/seeds.h"
#include "formats/case/case_file.h"

namespace lumen::app {

namespace fs = std::filesystem;

namespace {

bool startsGzip(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::array<char, 2> magic{};
  stream.read(magic.data(), magic.size());
  return stream && magic[0] == '\x1f' && magic[1] == '\x8b';
}

/// A second name for a file, with the ending that the readers of its format go by.
class Alias {
public:
  Alias(const fs::path& file, const std::string& extension) {
    std::string pattern = (fs::temp_directory_path() / "lumen-XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr)
      throw failed(fs::temp_directory_path().string() + ": no temporary folder can be made in it");
    m_folder = pattern;
    m_path = m_folder / ("volume" + extension);
    std::error_code error;
    fs::create_symlink(fs::absolute(file), m_path, error);
    if (error) throw failed(m_path.string() + ": " + error.message());
  }
  ~Alias() {
    std::error_code ignored;
    fs::remove_all(m_folder, ignored);
  }
  Alias(const Alias&) = delete;
  Alias& operator=(const Alias&) = delete;
  [[nodiscard]] const fs::path& path() const { return m_path; }

private:
  fs::path m_folder, m_path;
};

convert::Volume readThroughAlias(const fs::path& file, const FileFormat& format,
                                 const convert::ReadVolumeOptions& options,
                                 const Progress& progress) {
  const bool zipped = format.name == "nii" && startsGzip(file);
  const Alias alias(file, "." + std::string(format.name) + (zipped ? ".gz" : ""));
  try {
    return convert::readVolume(alias.path(), options, progress);
  } catch (const Error& error) {
    // the user knows the file, not its alias
    std::string text = error.what();
    const std::string inside = alias.path().string();
    if (const auto at = text.find(inside); at != std::string::npos)
      text.replace(at, inside.size(), file.string());
    throw Error(error.kind(), text);
  }
}

/// The file's name first and once, whether or not the message begins with it.
std::string errorText(const fs::path& file, formats::Issue error) {
  const std::string prefix = file.string() + ": ";
  if (error.message.starts_with(prefix)) error.message.erase(0, prefix.size());
  return prefix + error.text();
}

std::vector<std::byte> readCaseBytes(const fs::path& file) {
  requireInput(file, "case file");
  auto bytes = formats::readFileBytes(file);
  if (!bytes) throw invalidInput(errorText(file, bytes.error()));
  return *std::move(bytes);
}

formats::Case decodeFile(const fs::path& file, std::span<const std::byte> bytes) {
  auto value = formats::decodeCase(bytes);
  if (!value) throw invalidInput(errorText(file, value.error()));
  return *std::move(value);
}

bool nameMatches(const fs::path& file, const FileFormat& format) {
  try {
    return &inputFormat(file, "") == &format;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace

formats::Case readCase(const fs::path& file) {
  return decodeFile(file, readCaseBytes(file));
}

formats::Case readParentCase(const fs::path& file) {
  const auto bytes = readCaseBytes(file);
  formats::Case value = decodeFile(file, bytes);
  value.metadata.parentSha256 = sha256(bytes);
  formats::dropDependentChunks(value);
  return value;
}

convert::Volume readVolumeAs(const fs::path& file, const FileFormat& format,
                             const VolumeArguments& volume, Progress& progress) {
  requireInput(file, "volume");
  std::error_code ignored;
  if (format.name == "dicom" && !fs::is_directory(file, ignored))
    throw invalidInput(file.string() +
                       ": this is a file; a DICOM series is read from the folder that holds it");
  progress.begin("reading", 0);
  convert::Volume result = nameMatches(file, format)
                               ? convert::readVolume(file, volume.options(), progress)
                               : readThroughAlias(file, format, volume.options(), progress);
  progress.end();
  return result;
}

void writeCase(const formats::Case& value, const fs::path& file, const FileFormat& format,
               const formats::EncodeOptions& encoding) {
  const bool json = format.name == "lumen.json";
  const auto written = formats::writeCaseFile(
      value, file, json ? formats::CaseEncoding::Json : formats::CaseEncoding::Binary, encoding);
  if (!written) throw failed(errorText(file, written.error()));
}

void writeCaseMesh(const formats::Case& value, const fs::path& file, const FileFormat& format,
                   const MeshArguments& mesh, Progress& progress) {
  const auto meshes = convert::polygonise(value, mesh.polygonise, progress);
  progress.check();
  convert::writeMesh(meshes, file, std::string(format.name), mesh.write);
}

convert::TrackResult trackSeeds(const convert::Volume& volume, const TrackArguments& track,
                                Progress& progress) {
  const auto seeds = convert::readSeeds(track.seeds);
  convert::checkSeedsInside(seeds, volume.geometry, track.seeds);
  convert::TrackResult result = convert::track(volume, seeds, track.options, progress);
  for (const auto& failure : result.failures)
    progress.warn("seed " + failure.label + " started no track: " + failure.reason);
  for (const auto& missed : result.missedPoints)
    progress.warn("seed " + missed.label + " does not pass through its " + missed.reason);
  if (result.result.tree.nodeCount() == 0)
    throw failed(track.seeds + ": none of its " + std::to_string(seeds.size()) +
                 " seeds started a track; nothing is written");
  return result;
}

void requireSeeds(const TrackArguments& track) {
  if (track.seeds.empty())
    throw Error(ErrorKind::Usage,
                "a volume needs --seeds FILE, which says where its vessels begin");
  requireInput(track.seeds, "seeds file");
  (void)convert::readSeeds(track.seeds);
}

}  // namespace lumen::app
