// SPDX-License-Identifier: Apache-2.0
// Files and folders that appear whole under their name, or not at all: a writer fills a hidden
// sibling, flushes it to disk, and renames it.
//
// A writer that ends or throws removes what it began. One that is killed cannot. So the new file or
// folder lies in a hidden folder, whose name begins with kTemporaryPrefix, and which a file in it
// proves to be a writer's: a user's own folder of such a name is never touched. The writer holds a
// lock (flock) on it for as long as it lives. The next write into that folder removes hidden siblings
// without a lock; an interrupted process, which still holds its own locks, removes those that it made.
// The process id in a name is
// for people alone: a folder may be shared by machines and containers that do not see each other's
// processes, and have the same ids. Files without a name
// (O_TMPFILE) would leave nothing either, but neither libraries that write by name nor folders can
// use them, and some file systems refuse to name them (linkat).
//
// A file system needs only to create, write and rename. Without locks, leftovers of a killed writer
// stay; without flushing (fsync: EINVAL, ENOSYS, ENOTSUP), the system decides when to write;
// without permissions to set, a file that replaces another takes those that it is given, unless
// they would let more people at it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <sys/types.h>

#include "formats/case/file_descriptor.h"
#include "formats/container/expected.h"

namespace lumen::formats {

/// Prefix of hidden names. The process id, a hyphen and random digits follow.
inline constexpr std::string_view kTemporaryPrefix = ".lumen-";

/// The system calls that make a file appear, as their manual pages have them. Tests pass others, to
/// see their order or to let them fail.
struct FileCalls {
  std::function<int(int descriptor)> flush;                     ///< fsync
  std::function<int(int descriptor, mode_t mode)> permit;       ///< fchmod
  std::function<int(const char* from, const char* to)> rename;  ///< rename
  std::function<int(const char* a, const char* b)> exchange;    ///< renameat2, RENAME_EXCHANGE
  /// syncfs of the file system of an open folder; nothing where there is no such call.
  std::function<int(int descriptor)> flushSystem = nullptr;
};
const FileCalls& systemCalls();

/// Writes `bytes` to a new file beside `file`, flushes it to disk and renames it over `file`. The
/// old file is untouched unless every step succeeds; its permissions are kept, and a new file gets
/// those of any newly created one. A symbolic link is followed, so the file that it leads to is
/// replaced. A directory, a device and an open file of a process (/dev/stdout) are refused: IO_NOT_A_FILE; anything else that fails: IO_WRITE.
Status writeFileAtomically(std::span<const std::byte> bytes, const std::filesystem::path& file,
                           const FileCalls& calls = systemCalls());

/// A hidden folder that this process holds a lock on and removes at its end.
class HiddenSibling {
public:
  /// For a new file or folder that becomes `target`, whose name ends in `ending` meanwhile.
  HiddenSibling(std::filesystem::path folder, const std::string& ending,
                const std::filesystem::path& target, FileDescriptor descriptor);
  HiddenSibling(HiddenSibling&& other) noexcept;
  HiddenSibling& operator=(HiddenSibling&&) = delete;
  ~HiddenSibling();
  /// Place in it for the new file or folder, which is not there yet.
  [[nodiscard]] const std::filesystem::path& path() const { return m_path; }
  /// Takes the lock and writes the proof; false with errno set if that fails.
  bool lock();
  /// Removes the folder with all in it.
  void remove();

private:
  std::filesystem::path m_folder, m_path;
  FileDescriptor m_descriptor;
};

/// A file for a library that writes by name. It replaces its target as writeFileAtomically() does.
class PendingFile {
public:
  /// Refuses the same targets as writeFileAtomically().
  static Expected<PendingFile> beside(const std::filesystem::path& file,
                                      const FileCalls& calls = systemCalls());
  /// Path to write to: an empty file, whose name ends like that of its target (".nii.gz").
  [[nodiscard]] const std::filesystem::path& path() const { return m_sibling.path(); }
  /// Descriptor of the empty file, for writing.
  [[nodiscard]] int descriptor() const { return m_file.get(); }
  /// Flushes the complete file and puts it in its place. Called once only.
  Status commit();

private:
  PendingFile(HiddenSibling sibling, FileDescriptor file, std::filesystem::path target,
              std::optional<mode_t> mode, const FileCalls& calls)
      : m_sibling(std::move(sibling)),
        m_file(std::move(file)),
        m_target(std::move(target)),
        m_mode(mode),
        m_calls(calls) {}

  HiddenSibling m_sibling;
  FileDescriptor m_file;
  std::filesystem::path m_target;
  std::optional<mode_t> m_mode;
  std::reference_wrapper<const FileCalls> m_calls;
};

/// A folder of files that belong together.
class PendingFolder {
public:
  /// Treatment of a target folder that is not empty.
  enum class Existing : std::uint8_t { Refuse, Replace };

  /// Refuses a target that is no folder, and with Existing::Refuse one that is not empty.
  static Expected<PendingFolder> beside(const std::filesystem::path& folder, Existing existing,
                                        const FileCalls& calls = systemCalls());
  /// Path to write to: an empty folder.
  [[nodiscard]] const std::filesystem::path& path() const { return m_sibling.path(); }
  /// Method of flushing a folder to disk: each file and folder by itself, or one call for its whole
  /// file system, which also waits for other programs' data, but not longer for a hundred thousand
  /// files than for one.
  enum class Flush : std::uint8_t { Each, System };
  /// Flushes the complete folder and puts it in its place. Called once only. A folder that it
  /// replaces changes places with it in one step and is removed then; where the kernel or the
  /// file system cannot do that (RENAME_EXCHANGE), the old folder first becomes NAME.lumen-old, so
  /// for an instant, or after a power cut in it, NAME does not exist. A NAME.lumen-old that is
  /// there already may be the only copy of something: it is refused.
  Status commit(Flush how = Flush::Each);

private:
  PendingFolder(HiddenSibling sibling, std::filesystem::path target, Existing existing,
                const FileCalls& calls)
      : m_sibling(std::move(sibling)),
        m_target(std::move(target)),
        m_existing(existing),
        m_calls(calls) {}
  Status replace();

  HiddenSibling m_sibling;
  std::filesystem::path m_target;
  Existing m_existing;
  std::reference_wrapper<const FileCalls> m_calls;
};

/// Whether this is the hidden folder of a writer, by its name and by the proof in it.
bool isTemporary(const std::filesystem::path& path);

/// The place to which an unfinished file of this process will come: the one that a message names;
/// other paths as they are. Thread-safe.
std::filesystem::path placeOf(const std::filesystem::path& file);

/// Removes the unfinished files and folders of this process, at its end. Thread-safe.
void removeOwnTemporaries();

}  // namespace lumen::formats
