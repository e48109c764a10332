// SPDX-License-Identifier: Apache-2.0
#include "converters/library/site/page_frame.h"

#include "converters/base/html.h"

namespace lumen::convert {

namespace {

// From disk the pages of some browsers have no origin that 'self' could mean, so the files there
// are named by their scheme; a page that came from a server cannot ask for any of those.
constexpr const char* kPolicy =
    "default-src 'none'; script-src 'self' file:; style-src 'self' file:; img-src 'self' file: "
    "data:; "
    "base-uri 'none'; form-action 'none'";

}  // namespace

std::string pageText(const PageFrame& frame, std::string_view content) {
  PageHead head;
  head.policy = kPolicy;
  head.viewport = "width=device-width, initial-scale=1";
  head.meta = {{"color-scheme", "light dark"}, {"referrer", "no-referrer"}};
  head.title = frame.title;
  head.links = "<link rel=\"icon\" href=\"data:,\">\n<link rel=\"stylesheet\" href=\"" +
               frame.root + "site/site.css\">\n";
  for (const char* const script : frame.scripts)
    head.links +=
        "<script src=\"" + frame.root + "site/" + std::string(script) + "\" defer></script>\n";
  head.bodyAttributes = " data-root=\"" + frame.root + "\"" + frame.data;
  return htmlPage(head, content);
}

}  // namespace lumen::convert
