// SPDX-License-Identifier: Apache-2.0
// The parts of the specification that are made from the code, the schemas and the tests.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace lumen::formats::test {

std::string readText(const std::filesystem::path& file);

/// spec/errors.md: every code, its number, severity, arguments and meaning.
std::string errorsPage();

/// The tables of properties, one for each schema in `folder`, in the order of the specification.
std::string propertyTables(const std::filesystem::path& folder);

/// spec/lumen.md with its tables of properties made anew.
std::string specificationWithTables(const std::string& text, const std::string& tables);

/// A requirement of the specification: its number and the sentence that it stands in.
struct Requirement {
  std::string number;  ///< "M12"
  std::string sentence;
};
std::vector<Requirement> requirements(const std::string& specification);

/// A test that names requirements in a comment "// spec: M12, M13" above it.
struct TestReference {
  std::string test;    ///< Suite.Name
  std::string number;  ///< of the requirement
};
std::vector<TestReference> testReferences(const std::filesystem::path& testFolder);

/// spec/coverage.md: from requirement to tests, and from error code to the test files that name it.
std::string coveragePage(const std::string& specification, const std::filesystem::path& testFolder);

}  // namespace lumen::formats::test
