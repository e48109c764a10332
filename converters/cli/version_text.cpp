// SPDX-License-Identifier: Apache-2.0
// Declared in help_text.h.
#include <nlohmann/json.hpp>

#include "converters/cli/help_text.h"
#include "converters/export/shared/text_files.h"
#include "converters/io/seeds/seeds_parse.h"
#include "converters/library/index/json_values.h"
#include "formats/container/container.h"
#include "libblob/include/blob.h"

namespace lumen::cli {

namespace {

using Json = nlohmann::ordered_json;

#if defined(__clang__)
constexpr const char* kCompiler = "clang " __clang_version__;
#elif defined(__GNUC__)
constexpr const char* kCompiler = "gcc " __VERSION__;
#else
constexpr const char* kCompiler = "unknown";
#endif

#if defined(__x86_64__)
constexpr const char* kArchitecture = "x86_64";
#elif defined(__aarch64__)
constexpr const char* kArchitecture = "aarch64";
#else
constexpr const char* kArchitecture = "unknown";
#endif

#ifdef LUMEN_WITH_VIEWER
constexpr bool kHasViewer = true;
#else
constexpr bool kHasViewer = false;
#endif

#ifdef LUMEN_WITH_LIBRARY
constexpr bool kHasLibrary = true;
#else
constexpr bool kHasLibrary = false;
#endif

#ifdef LUMEN_WITH_DICOM
constexpr bool kHasDicom = true;
#else
constexpr bool kHasDicom = false;
#endif

#ifdef LUMEN_WRITES_VDB
constexpr bool kHasOpenVdb = true;
#else
constexpr bool kHasOpenVdb = false;
#endif

std::string blobVersion() {
  return std::to_string(BLOB_VERSION_MAJOR) + "." + std::to_string(BLOB_VERSION_MINOR) + "." +
         std::to_string(BLOB_VERSION_PATCH);
}

Json formatVersions() {
  return {{"case", formats::versionText(formats::kFormatVersion)},
          {"case_reader", formats::versionText(formats::kMinimumReader)},
          {"seeds", convert::kSeedsVersion},
          {"export", convert::kManifestVersion},
          {"library", convert::kLibraryFormat}};
}

}  // namespace

std::string versionLine() {
  return "lumen " LUMEN_VERSION "\n";
}

std::string versionJson() {
  const Json answer = {
      {"program", "lumen"},
      {"version", LUMEN_VERSION},
      {"libblob", blobVersion()},
      {"formats", formatVersions()},
      {"build",
       {{"type", LUMEN_BUILD_TYPE}, {"compiler", kCompiler}, {"architecture", kArchitecture}}},
      {"parts",
       {{"viewer", kHasViewer},
        {"dicom", kHasDicom},
        {"library", kHasLibrary},
        {"openvdb", kHasOpenVdb}}}};
  return answer.dump(2) + "\n";
}

}  // namespace lumen::cli
