// SPDX-License-Identifier: Apache-2.0
// Runs the built executable as a user would, and looks at what it leaves.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace lumen::test {

struct Outcome {
  int code = -1;  ///< exit code; 1000 + n if signal n ended the process
  std::string out;
  std::string err;
};

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// A folder of its own for each test, gone afterwards, and `lumen` run inside of it.
class CliTest : public ::testing::Test {
protected:
  CliTest();
  ~CliTest() override;

  Outcome lumen(const std::vector<std::string>& arguments) const;
  /// Sends `signalNumber` `times` times as soon as the program has printed to standard error, for
  /// which the run must be --verbose. After 60 s the program is killed.
  Outcome lumenWithSignal(const std::vector<std::string>& arguments, int signalNumber,
                          int times = 1) const;

  [[nodiscard]] std::filesystem::path path(const std::string& name) const {
    return m_folder / name;
  }
  [[nodiscard]] std::string read(const std::string& name) const;
  void write(const std::string& name, const std::string& text) const;
  [[nodiscard]] bool exists(const std::string& name) const {
    return std::filesystem::exists(path(name));
  }
  /// Sorted names of the folder's entries, hidden ones too.
  [[nodiscard]] std::vector<std::string> entries() const;

private:
  std::filesystem::path m_folder;
  std::filesystem::path m_streams;  ///< the runs' standard output and error, beside the folder
};

/// A CliTest with a 64^3 tube phantom: tube.nrrd, truth.lumen, seeds.json.
class TubeTest : public CliTest {
protected:
  void SetUp() override;
};

}  // namespace lumen::test
