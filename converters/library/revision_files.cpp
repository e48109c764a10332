// SPDX-License-Identifier: Apache-2.0
#include "converters/library/revision_files.h"

#include <system_error>
#include <utility>

#include <unistd.h>

#include "converters/base/error.h"
#include "formats/container/printable.h"

namespace lumen::convert {

namespace {

namespace fs = std::filesystem;
using formats::PendingFolder;

std::string printablePath(const fs::path& path) {
  return formats::printable(path.string());
}

TextSink sinkOf(NewFile& file) {
  return [&file](std::string_view text) { file.add(text); };
}

}  // namespace

PendingFolder pendingFolder(const fs::path& folder, PendingFolder::Existing existing) {
  auto pending = PendingFolder::beside(folder, existing);
  if (!pending) throw failed(formats::printable(pending.error().message));
  return *std::move(pending);
}

void commitFolder(PendingFolder& pending) {
  const auto done = pending.commit(PendingFolder::Flush::System);
  if (!done) throw failed(formats::printable(done.error().message));
}

void linkFile(const fs::path& from, const fs::path& to) {
  if (::link(from.c_str(), to.c_str()) == 0) return;
  std::error_code error;
  fs::copy_file(from, to, error);
  if (error) throw failed(printablePath(from) + ": cannot be copied: " + error.message());
}

void makeFolderLike(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::create_directory(to, error);
  fs::permissions(to, fs::status(from).permissions() | fs::perms::owner_all, error);
}

void linkAll(const fs::path& from, const fs::path& to,
             const std::function<bool(const std::string& name)>& skips) {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(from, error)) {
    const std::string name = entry.path().filename().string();
    const fs::path target = to / name;
    if (formats::isTemporaryName(name) || (skips && skips(name))) continue;
    const fs::file_status status = entry.symlink_status();
    if (fs::is_directory(status)) {
      makeFolderLike(entry.path(), target);
      linkAll(entry.path(), target);
    } else if (fs::is_regular_file(status)) {
      linkFile(entry.path(), target);
    } else if (fs::is_symlink(status)) {
      fs::copy_symlink(entry.path(), target);
    } else {
      throw invalidInput(printablePath(entry.path()) +
                         ": found a device or a pipe, expected files");
    }
  }
  if (error) throw failed(printablePath(from) + ": cannot be read: " + error.message());
}

void keepCase(const fs::path& from, const fs::path& to, const std::string& crate) {
  makeFolderLike(from, to);
  const fs::path old = from / kCrateFile;
  std::error_code error;
  const bool isSame = fs::is_regular_file(fs::symlink_status(old, error)) &&
                      readWholeFile(old, "RO-Crate") == crate;
  linkAll(from, to, [isSame](const std::string& name) { return !isSame && name == kCrateFile; });
  if (!isSame) writeNewFile(crate, to / kCrateFile);
}

RevisionWriter::RevisionWriter(const fs::path& folder, const LibraryFile& library)
    : m_folder(folder),
      m_library(library),
      m_manifest(folder / kManifestFile),
      m_crate(folder / kPayload / kCrateFile),
      m_texts(library, sinkOf(m_manifest), sinkOf(m_crate)) {}

void RevisionWriter::finish() {
  const TagTexts tags = m_texts.finish();
  m_manifest.close();
  m_crate.close();
  writeNewFile(tags.bag, m_folder / kBagFile);
  writeNewFile(tags.bagInfo, m_folder / kBagInfoFile);
  writeNewFile(tags.tagManifest, m_folder / kTagManifestFile);
  writeNewFile(libraryText(m_library), m_folder / kLibraryFile);
}

}  // namespace lumen::convert
