// SPDX-License-Identifier: Apache-2.0
// A folder of cases, of which one is looked at at a time.
#pragma once

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "converters/engine/report.h"

namespace lumen::viewer {

using app::Json;

/// A case of a folder.
struct ListedCase {
  std::filesystem::path file;
  std::string name;  ///< for people
  std::filesystem::path
      keptAt;  ///< of a published one: where changes are kept until they are downloaded
};

/// What a folder has to show.
struct CaseList {
  std::string name;  ///< for people
  std::vector<ListedCase> cases;
  bool isPublished = false;  ///< it is a library of spec/library.md, whose cases stay as they are
};

/// The cases that a library's library.json lists, in its order. In a folder without one: all cases (.lumen, .lumen.json)
/// directly in it or one level below, sorted by name; hidden ones and those that were not saved
/// (NAME.unsaved.lumen) are none of it. Throws Error(InvalidInput) for a library.json that breaks its format.
CaseList casesIn(const std::filesystem::path& folder);

/// What a library holds; each case is read in the background, for its figures. All calls are
/// thread-safe.
class Library {
public:
  /// `told` is called, without any lock, when more figures are there.
  Library(CaseList list, std::function<void()> told);
  ~Library();
  /// Begins to read the cases.
  void start();
  /// Ends that for good; `told` is not called any more.
  void end();
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;

  /// {"name", "cases": [{"name", "branches", "length", "error"}]}; figures are null until the case
  /// has been read, and stay so if it cannot be, which "error" tells.
  [[nodiscard]] Json json() const;
  [[nodiscard]] std::size_t size() const { return m_list.cases.size(); }
  [[nodiscard]] const ListedCase& at(std::size_t index) const { return m_list.cases[index]; }
  [[nodiscard]] bool isPublished() const { return m_list.isPublished; }
  /// How many cases have been read.
  [[nodiscard]] std::size_t readCount() const { return m_read; }

private:
  struct Figures {
    std::size_t branches = 0;
    double length = 0;  ///< mm
    std::string error;
  };
  void read();

  const CaseList m_list;
  const std::function<void()> m_told;
  mutable std::mutex m_mutex;  ///< guards the figures
  std::vector<std::optional<Figures>> m_figures;
  std::atomic<std::size_t> m_read{0};
  std::atomic<bool> m_ended{false};
  std::thread m_thread;
};

}  // namespace lumen::viewer
