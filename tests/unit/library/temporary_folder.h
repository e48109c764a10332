// SPDX-License-Identifier: Apache-2.0
// A folder for a test's files, gone with it.
#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "converters/base/run_program.h"

namespace lumen::convert {

class TemporaryFolder {
public:
  [[nodiscard]] std::filesystem::path path(const std::string& name = "") const {
    return m_folder.path() / name;
  }
  void write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories(path(name).parent_path());
    std::ofstream(path(name), std::ios::binary) << text;
  }
  [[nodiscard]] std::string read(const std::string& name) const {
    std::ifstream stream(path(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }

private:
  PrivateFolder m_folder;
};

}  // namespace lumen::convert
