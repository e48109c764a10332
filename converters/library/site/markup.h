// SPDX-License-Identifier: Apache-2.0
// Parts of all pages of a library's site: frame, addresses, numbers.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

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
std::string pageOf(const PageFrame& frame, std::string_view content);

/// A path as a relative address: all but letters, digits, "-", ".", "_", "~" and "/"
/// percent-encoded (RFC 3986). Fit for an attribute.
std::string addressOf(std::string_view path);

/// A link to the page of a digital object identifier; empty without one.
std::string doiLink(std::string_view doi);

/// `value` with three significant digits, as a person reads it: "3614", "61.2", "0.52".
std::string shownFigure(double value);

/// "1.2 MB"; decimal units, as files are sold.
std::string shownBytes(std::uint64_t bytes);

/// JSON as a value in a script, inside of an HTML page or not: no "<", ">", "&" and no line
/// separator in it. Bytes that are not UTF-8 become U+FFFD.
std::string jsonInScript(const nlohmann::ordered_json& value);

}  // namespace lumen::convert
