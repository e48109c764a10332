// SPDX-License-Identifier: Apache-2.0
// Runs lumen as a user would, and looks at what it leaves.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/cli/run_here.h"

namespace lumen::test {

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// A folder of its own for each test, gone afterwards, and `lumen` run inside of it.
class CliTest : public ::testing::Test {
protected:
  /// A run in this process.
  Outcome lumen(const std::vector<std::string>& arguments) const;
  /// A run of the built executable.
  Outcome lumenProgram(const std::vector<std::string>& arguments) const;
  /// Sends `signalNumber` `times` times as soon as the executable has printed to standard error, for
  /// which the run must be --verbose. After 60 s the program is killed.
  Outcome lumenWithSignal(const std::vector<std::string>& arguments, int signalNumber,
                          int times = 1) const;
  /// Runs lumen; a failure of it is one of the test.
  void make(const std::vector<std::string>& arguments) const;
  /// Fills the folder by `fill`, which is called once in this process for each name; the folders of
  /// other tests get copies of the files.
  void fillOnce(const std::string& name, const std::function<void()>& fill) const;

  [[nodiscard]] std::filesystem::path path(const std::string& name) const {
    return m_folder.path / name;
  }
  [[nodiscard]] std::string read(const std::string& name) const;
  void write(const std::string& name, const std::string& text) const;
  [[nodiscard]] bool exists(const std::string& name) const {
    return std::filesystem::exists(path(name));
  }
  /// Sorted names of the folder's entries, hidden ones too.
  [[nodiscard]] std::vector<std::string> entries() const;

private:
  TemporaryFolder m_folder;
  TemporaryFolder m_streams;  ///< standard output and error of processes
};

/// A CliTest with a 64^3 tube phantom: tube.nrrd, truth.lumen, seeds.json.
class TubeTest : public CliTest {
protected:
  void SetUp() override;
};

/// A TubeTest with its case, tube.lumen.
class FittedTubeTest : public TubeTest {
protected:
  void SetUp() override;
};

}  // namespace lumen::test
