// SPDX-License-Identifier: Apache-2.0
#include "viewer/server/page_files.h"

#include <array>
#include <filesystem>
#include <system_error>

#include "formats/case/case_file.h"

namespace lumen::viewer {

namespace {

namespace fs = std::filesystem;

struct Known {
  const char *name, *file, *type;
};

constexpr std::array<Known, 4> kKnown = {{
    {"", "index.html", "text/html; charset=utf-8"},
    {"page.js", "page.js", "text/javascript; charset=utf-8"},
    {"page.css", "page.css", "text/css; charset=utf-8"},
    {"blob.wasm", "blob.wasm", "application/wasm"},
}};

PageFiles readFrom(const fs::path& folder) {
  PageFiles files;
  for (const Known& known : kKnown) {
    const auto bytes = formats::readFileBytes(folder / known.file);
    if (!bytes) continue;
    files[known.name] = {known.type, {reinterpret_cast<const char*>(bytes->data()), bytes->size()}};
  }
  // one without the others is a build that was interrupted
  return files.contains("") && files.contains("page.js") ? files : PageFiles();
}

}  // namespace

const char* const kNoPage =
    "<!doctype html>\n<html lang=\"en\"><meta charset=\"utf-8\"><title>lumen</title>\n"
    "<h1>The page of the viewer was not built</h1>\n"
    "<p>Building it needs npm: <code>apt install npm</code>, then <code>./bootstrap.sh demo</code> "
    "in lumen's folder.</p>\n</html>\n";

PageFiles findPageFiles() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (error) return {};
  const fs::path folder = program.parent_path();
  for (const char* const place : {"../share/lumen/viewer", "../../viewer/page"})
    if (PageFiles files = readFrom(folder / place); !files.empty()) return files;
  return {};
}

}  // namespace lumen::viewer
