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

#include "converters/app/report.h"

namespace lumen::viewer {

using app::Json;

/// The cases (.lumen, .lumen.json) directly in a folder or one level below, sorted by name. Hidden
/// ones and those that were not saved (NAME.unsaved.lumen) are none of it.
std::vector<std::filesystem::path> casesIn(const std::filesystem::path& folder);

/// What a library holds; each case is read in the background, for its figures. All calls are
/// thread-safe.
class Library {
public:
  /// `told` is called, without any lock, when more figures are there.
  Library(std::filesystem::path folder, std::vector<std::filesystem::path> cases,
          std::function<void()> told);
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
  [[nodiscard]] std::size_t size() const { return m_cases.size(); }
  [[nodiscard]] const std::filesystem::path& at(std::size_t index) const { return m_cases[index]; }
  /// The case's path below the folder, for people.
  [[nodiscard]] std::string nameOf(std::size_t index) const;
  /// How many cases have been read.
  [[nodiscard]] std::size_t readCount() const { return m_read; }

private:
  struct Figures {
    std::size_t branches = 0;
    double length = 0;  ///< mm
    std::string error;
  };
  void read();

  const std::filesystem::path m_folder;
  const std::vector<std::filesystem::path> m_cases;
  const std::function<void()> m_told;
  mutable std::mutex m_mutex;  ///< guards the figures
  std::vector<std::optional<Figures>> m_figures;
  std::atomic<std::size_t> m_read{0};
  std::atomic<bool> m_ended{false};
  std::thread m_thread;
};

}  // namespace lumen::viewer
