// SPDX-License-Identifier: Apache-2.0
#include "converters/base/html.h"

#include <cstddef>
#include <span>

#include "formats/container/printable.h"
#include "formats/container/utf8.h"
#include "formats/json/base64.h"

namespace lumen {

namespace {

constexpr const char* kUnreserved =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-._~/";

/// The replacement of a character that could be markup; empty for all others.
std::string_view reference(char c) {
  switch (c) {
    case '&':
      return "&amp;";
    case '<':
      return "&lt;";
    case '>':
      return "&gt;";
    case '"':
      return "&quot;";
    case '\'':
      return "&#39;";
    default:
      return {};
  }
}

}  // namespace

std::string htmlText(std::string_view text) {
  std::string safe;
  for (const char c : formats::printable(text)) {
    const std::string_view instead = reference(c);
    if (instead.empty())
      safe += c;
    else
      safe += instead;
  }
  return safe;
}

std::string htmlName(std::string_view text) {
  std::string element = "<bdi>";
  element += htmlText(text);
  element += "</bdi>";
  return element;
}

std::string dataAddress(std::string_view type, std::string_view bytes) {
  std::string address = "data:";
  address += type;
  address += ";base64,";
  address += formats::base64(std::as_bytes(std::span(bytes)));
  return address;
}

std::string urlAddress(std::string_view path) {
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

std::string jsonInScript(std::string_view json) {
  std::string text;
  text.reserve(json.size());
  for (std::size_t at = 0; at < json.size(); ++at) {
    const std::string_view rest = json.substr(at, 3);
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

Markup text(std::string_view text) {
  return {htmlText(text)};
}

Markup name(std::string_view text) {
  return {htmlName(text)};
}

Markup shortened(std::string_view text, std::size_t bytes) {
  if (text.size() <= bytes) return name(text);
  std::size_t end = 0;
  for (std::size_t at = 0; at < bytes;) {
    end = at;
    if (formats::nextCodePoint(text, at) == formats::kIllFormed) at = end + 1;
  }
  Markup result = name(text.substr(0, end));
  result.html += " … (" + std::to_string(text.size()) + " bytes)";
  return result;
}

Markup element(std::string_view tag, const Markup& content, std::string_view attributes) {
  Markup result{"<"};
  result.html += tag;
  if (!attributes.empty()) result.html += ' ';
  result.html += attributes;
  result.html += '>';
  result.html += content.html;
  result.html += "</";
  result.html += tag;
  result.html += '>';
  return result;
}

Markup paragraph(std::string_view ours) {
  return {element("p", text(ours)).html + "\n"};
}

Markup pngFigure(std::string_view png, const Markup& caption, std::string_view alt,
                 std::string_view attributes) {
  Markup image{"<img alt=\"" + htmlText(alt) + "\" src=\"" + dataAddress("image/png", png) + "\">"};
  image += element("figcaption", caption);
  return {element("figure", image, attributes).html + "\n"};
}

Markup section(std::string_view id, std::string_view title, const Markup& content) {
  Markup inside = element("h2", text(title));
  inside.html += '\n';
  inside += content;
  return {element("section", inside, "id=\"" + htmlText(id) + "\"").html + "\n"};
}

Markup factRow(std::string_view what, const Markup& value) {
  Markup pair = element("dt", text(what));
  pair += element("dd", value);
  return {element("div", pair).html + "\n"};
}

Markup factList(const Facts& facts) {
  Markup pairs;
  for (const auto& [what, value] : facts) pairs += factRow(what, value);
  return {element("dl", pairs).html + "\n"};
}

std::string htmlPage(const PageHead& head, std::string_view content) {
  std::string page = "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n";
  page += "<meta http-equiv=\"Content-Security-Policy\" content=\"";
  page += head.policy;
  page += "\">\n<meta name=\"viewport\" content=\"";
  page += head.viewport;
  page += "\">\n";
  for (const auto& [what, value] : head.meta) {
    page += "<meta name=\"";
    page += what;
    page += "\" content=\"";
    page += value;
    page += "\">\n";
  }
  page += "<title>";
  page += htmlText(head.title);
  page += "</title>\n";
  page += head.links;
  page += "</head>\n<body";
  page += head.bodyAttributes;
  page += ">\n";
  page += content;
  page += "</body>\n</html>\n";
  return page;
}

}  // namespace lumen
