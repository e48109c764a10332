// SPDX-License-Identifier: Apache-2.0
// Files and folders that appear whole under their name, or not at all: what is written lies hidden
// beside its place, is flushed to disk, and is renamed.
//
// A writer that ends or throws removes what it began. One that is killed cannot, so every hidden
// name begins with kTemporaryPrefix and the writer's process id, and the writer holds a lock
// (flock) on it for as long as it lives. The next write into that folder removes what nobody has
// locked; an interrupted process, which still holds its own locks, removes what bears its id. A
// lock rather than the id tells the dead from the living, because a folder may be shared by
// machines and containers that do not see each other's processes. Files without a name (O_TMPFILE)
// would leave nothing either, but neither libraries that write by name nor folders can use them, and
// some file systems refuse to name them (linkat).
//
// Of a file system no more is asked than to create, write and rename. Where it has no locks, what a
// killed writer left stays; where it cannot flush (fsync: EINVAL, ENOSYS, ENOTSUP), that is left to
// the system; where it has no permissions to set, a file that replaces another takes what it is
// given, unless that would let more people at it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string_view>

#include <sys/types.h>

#include "formats/case/file_descriptor.h"
#include "formats/container/expected.h"

namespace lumen::formats {

/// What follows is the process id, a hyphen, a number, and for a file the ending of its target.
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
/// old file is untouched unless all of that succeeds; its permissions are kept, and a new file gets
/// those of any newly created one. A symbolic link is followed, so the file that it leads to is
/// replaced. A directory or device is refused: IO_NOT_A_FILE; anything else that fails: IO_WRITE.
Status writeFileAtomically(std::span<const std::byte> bytes,
                                   const std::filesystem::path& file,
                                   const FileCalls& calls = systemCalls());

/// A hidden, empty file or folder that this process holds a lock on and removes at its end.
class HiddenSibling {
public:
  HiddenSibling(std::filesystem::path path, FileDescriptor descriptor)
      : m_path(std::move(path)), m_descriptor(std::move(descriptor)) {}
  HiddenSibling(HiddenSibling&& other) noexcept;
  HiddenSibling& operator=(HiddenSibling&&) = delete;
  ~HiddenSibling();
  [[nodiscard]] const std::filesystem::path& path() const { return m_path; }
  [[nodiscard]] int descriptor() const { return m_descriptor.get(); }
  /// It has another name now, under which it stays.
  void release() { m_path.clear(); }

private:
  std::filesystem::path m_path;
  FileDescriptor m_descriptor;
};

/// A file for a library that writes by name. It replaces its target as writeFileAtomically() does.
class PendingFile {
public:
  /// Refuses what writeFileAtomically() refuses.
  static Expected<PendingFile> beside(const std::filesystem::path& file,
                                      const FileCalls& calls = systemCalls());
  /// Where to write: an empty file, whose name ends like that of its target (".nii.gz").
  [[nodiscard]] const std::filesystem::path& path() const { return m_sibling.path(); }
  /// Of the empty file, for writing.
  [[nodiscard]] int descriptor() const { return m_sibling.descriptor(); }
  /// The file is complete: flushes it and puts it in its place. Once only.
  Status commit();

private:
  PendingFile(HiddenSibling sibling, std::filesystem::path target, std::optional<mode_t> mode,
              const FileCalls& calls)
      : m_sibling(std::move(sibling)), m_target(std::move(target)), m_mode(mode), m_calls(calls) {}

  HiddenSibling m_sibling;
  std::filesystem::path m_target;
  std::optional<mode_t> m_mode;
  std::reference_wrapper<const FileCalls> m_calls;
};

/// A folder of files that belong together.
class PendingFolder {
public:
  /// What to do about a folder of that name that is not empty.
  enum class Existing : std::uint8_t { Refuse, Replace };

  /// Refuses a target that exists and is no folder, and any full one with Existing::Refuse.
  static Expected<PendingFolder> beside(const std::filesystem::path& folder, Existing existing,
                                        const FileCalls& calls = systemCalls());
  /// Where to write: an empty folder.
  [[nodiscard]] const std::filesystem::path& path() const { return m_sibling.path(); }
  /// How a folder gets to the disk: each file and folder by itself, or by one call for its whole file system, which also
  /// waits for what others write, but not longer for a hundred thousand files than for one.
  enum class Flush : std::uint8_t { Each, System };
  /// The folder is complete: flushes all in it and puts it in its place. Once only. A folder that
  /// it replaces changes places with it in one step and is removed then; where the kernel or the
  /// file system cannot do that (RENAME_EXCHANGE), the old folder first becomes NAME.lumen-old, so
  /// for an instant, or after a power cut in it, NAME does not exist.
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

/// Whether a file or folder of this name is one that a writer has not put in its place.
bool isTemporaryName(std::string_view name);

enum class Temporaries : std::uint8_t { Abandoned, AbandonedAndOwn };

/// Removes from `folder` what killed writers left there; with AbandonedAndOwn also what this
/// process is writing. Failures are ignored: the next write tries again.
void removeTemporaries(const std::filesystem::path& folder, Temporaries which);

}  // namespace lumen::formats
