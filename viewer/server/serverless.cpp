// SPDX-License-Identifier: Apache-2.0
#include "viewer/server/serverless.h"

#include <array>
#include <system_error>

#include "converters/base/error.h"
#include "formats/case/atomic_file.h"
#include "viewer/routes/html_page.h"

namespace lumen::viewer {

namespace {

namespace fs = std::filesystem;

struct Copied {
  const char *from, *to;
};

constexpr std::array<Copied, 7> kCopied = {{{"serverless.html", "index.html"},
                                            {"page.js", "page.js"},
                                            {"page.css", "page.css"},
                                            {"worker.js", "worker.js"},
                                            {"offline.js", "offline.js"},
                                            {"blob.wasm", "blob.wasm"},
                                            {"lumen-view.wasm", "lumen-view.wasm"}}};

}  // namespace

std::uint64_t writeServerless(const fs::path& folder) {
  const fs::path page = findPageFolder();
  std::error_code error;
  for (const Copied& file : kCopied)
    if (page.empty() || !fs::exists(page / file.from, error))
      throw failed(std::string(file.from) +
                   " of the page was not built; packages/wasm/build.sh builds the engine for "
                   "browsers, and ./bootstrap.sh demo "
                   "the page");
  auto pending = formats::PendingFolder::beside(folder, formats::PendingFolder::Existing::Refuse);
  if (!pending) throw failed(pending.error().message);
  std::uint64_t bytes = 0;
  for (const Copied& file : kCopied) {
    const fs::path to = pending->path() / file.to;
    if (!fs::copy_file(page / file.from, to, error))
      throw failed(folder.string() + ": " + file.to + " cannot be written: " + error.message());
    fs::permissions(to,
                    fs::perms::owner_read | fs::perms::owner_write | fs::perms::group_read |
                        fs::perms::others_read,
                    error);
    bytes += fs::file_size(to);
  }
  if (const auto done = pending->commit(); !done) throw failed(done.error().message);
  return bytes;
}

}  // namespace lumen::viewer
