// SPDX-License-Identifier: Apache-2.0
// The frame of all pages of a library's site.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace lumen::convert {

/// Frame around the content of a page.
struct PageFrame {
  std::string title;                 ///< any text
  std::string root;                  ///< path from the page to the library's folder: "" or "../../"
  std::vector<const char*> scripts;  ///< names in site/, in this order
  std::string data;                  ///< attributes of the body, ready: " data-page=\"1\""
};

/// A whole page. It asks for nothing but files of the library, and runs no script and no style that
/// is in itself.
std::string pageText(const PageFrame& frame, std::string_view content);

}  // namespace lumen::convert
