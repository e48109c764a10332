// SPDX-License-Identifier: Apache-2.0
#include "converters/library/site/markup.h"

#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <utility>

#include "converters/base/html.h"

namespace lumen::convert {

namespace {

// From disk the pages of some browsers have no origin that 'self' could mean, so the files there
// are named by their scheme; a page that came from a server cannot ask for any of those.
constexpr const char* kPolicy =
    "default-src 'none'; script-src 'self' file:; style-src 'self' file:; img-src 'self' file: "
    "data:; "
    "base-uri 'none'; form-action 'none'";

constexpr const char* kUnreserved =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-._~/";

std::string fixedText(double value, int decimals) {
  std::array<char, 400> text{};  // the greatest double has 309 digits
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value,
                                 std::chars_format::fixed, decimals);
  return {text.data(), end.ptr};
}

}  // namespace

std::string pageOf(const PageFrame& frame, std::string_view content) {
  std::string page = "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n";
  page += "<meta http-equiv=\"Content-Security-Policy\" content=\"";
  page += kPolicy;
  page +=
      "\">\n<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta name=\"color-scheme\" content=\"light dark\">\n"
      "<meta name=\"referrer\" content=\"no-referrer\">\n<title>";
  page += htmlText(frame.title);
  page += "</title>\n<link rel=\"icon\" href=\"data:,\">\n<link rel=\"stylesheet\" href=\"";
  page += frame.root;
  page += "site/site.css\">\n";
  for (const char* const script : frame.scripts) {
    page += "<script src=\"";
    page += frame.root;
    page += "site/";
    page += script;
    page += "\" defer></script>\n";
  }
  page += "</head>\n<body data-root=\"";
  page += frame.root;
  page += "\"";
  page += frame.data;
  page += ">\n";
  page += content;
  page += "</body>\n</html>\n";
  return page;
}

std::string addressOf(std::string_view path) {
  constexpr const char* kDigits = "0123456789ABCDEF";
  const std::string_view unreserved = kUnreserved;
  std::string address;
  for (const char c : path) {
    if (unreserved.find(c) != std::string_view::npos) {
      address += c;
      continue;
    }
    const auto byte = static_cast<unsigned char>(c);
    address += '%';
    address += kDigits[byte >> 4U];
    address += kDigits[byte & 15U];
  }
  return address;
}

std::string doiLink(std::string_view doi) {
  if (doi.empty()) return {};
  std::string link = "<a rel=\"external noreferrer\" href=\"https://doi.org/";
  link += addressOf(doi);
  link += "\">";
  link += htmlName(doi);
  link += "</a>";
  return link;
}

std::string shownFigure(double value) {
  if (!std::isfinite(value)) return "?";
  const double size = std::abs(value);
  return fixedText(value, size >= 99.95 ? 0 : size >= 9.995 ? 1 : 2);
}

std::string shownBytes(std::uint64_t bytes) {
  if (bytes < 1000) return bytes == 1 ? "1 byte" : std::to_string(bytes) + " bytes";
  double value = static_cast<double>(bytes) / 1000;
  std::size_t unit = 0;
  constexpr std::array<const char*, 4> kUnits = {" kB", " MB", " GB", " TB"};
  for (; value >= 999.5 && unit + 1 < kUnits.size(); ++unit) value /= 1000;
  return fixedText(value, value >= 9.95 ? 0 : 1) + kUnits[unit];
}

std::string jsonInScript(const nlohmann::ordered_json& value) {
  const std::string json =
      value.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  std::string text;
  text.reserve(json.size());
  for (std::size_t at = 0; at < json.size(); ++at) {
    const std::string_view rest = std::string_view(json).substr(at, 3);
    if (rest == "\xE2\x80\xA8" || rest == "\xE2\x80\xA9") {  // U+2028 and U+2029
      text += rest.back() == '\xA8' ? "\\u2028" : "\\u2029";
      at += 2;
    } else if (json[at] == '<') {
      text += "\\u003c";
    } else if (json[at] == '>') {
      text += "\\u003e";
    } else if (json[at] == '&') {
      text += "\\u0026";
    } else {
      text += json[at];
    }
  }
  return text;
}

}  // namespace lumen::convert
