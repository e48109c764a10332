// SPDX-License-Identifier: Apache-2.0
// Writes the generated parts of the specification: write_spec SPEC_FOLDER TESTS_FOLDER.
#include <cstdio>
#include <fstream>

#include "unit/formats/spec_tables.h"

int main(int argc, char** argv) {
  using namespace lumen::formats::test;
  if (argc != 3) {
    std::fputs("usage: write_spec SPEC_FOLDER TESTS_FOLDER\n", stderr);
    return 2;
  }
  const std::filesystem::path spec = argv[1], tests = argv[2];
  const std::string text =
      specificationWithTables(readText(spec / "lumen.md"), propertyTables(spec / "schema"));
  if (text.empty()) return 1;
  std::ofstream(spec / "lumen.md", std::ios::binary) << text;
  std::ofstream(spec / "errors.md", std::ios::binary) << errorsPage();
  std::ofstream(spec / "coverage.md", std::ios::binary) << coveragePage(text, tests);
  return 0;
}
