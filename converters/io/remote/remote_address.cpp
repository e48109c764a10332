// SPDX-License-Identifier: Apache-2.0
#include "converters/io/remote/remote_address.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

#include "converters/base/error.h"
#include "converters/base/text.h"
#include "formats/container/printable.h"

namespace lumen::convert {

namespace {

constexpr std::size_t kLongestAddress = 4096;
constexpr std::size_t kLongestName = 200;
constexpr std::array<std::pair<std::string_view, RemoteScheme>, 3> kSchemes = {
    {{"http://", RemoteScheme::Http},
     {"https://", RemoteScheme::Https},
     {"s3://", RemoteScheme::S3}}};

const std::pair<std::string_view, RemoteScheme>* schemeOf(std::string_view text) {
  const auto* const found = std::find_if(kSchemes.begin(), kSchemes.end(), [&](const auto& scheme) {
    return lowerCase(std::string(text.substr(0, scheme.first.size()))) == scheme.first;
  });
  return found == kSchemes.end() ? nullptr : found;
}

Error refusal(const std::string& shown, const std::string& what) {
  return {ErrorKind::Usage, formats::printable(shown) + ": " + what};
}

/// Letters, digits and marks that a URI may have (RFC 3986); other bytes are written as %XX there.
/// Object stores take any key.
bool isAllowed(unsigned char c, RemoteScheme scheme) {
  if (c <= ' ' || c == 0x7f) return scheme == RemoteScheme::S3 && c == ' ';
  return scheme == RemoteScheme::S3 || c > 0x7f ||
         std::string_view("\"<>\\^`{|}").find(static_cast<char>(c)) == std::string_view::npos;
}

/// Text with %XX as bytes.
std::string unescaped(std::string_view text) {
  std::string plain;
  for (std::size_t i = 0; i < text.size(); ++i) {
    unsigned value = 0;
    const char* const digits = text.data() + i + 1;
    const bool isEscape = text[i] == '%' && i + 2 < text.size() &&
                          std::from_chars(digits, digits + 2, value, 16).ptr == digits + 2;
    plain += isEscape ? static_cast<char>(value) : text[i];
    if (isEscape) i += 2;
  }
  return plain;
}

}  // namespace

bool isRemote(std::string_view text) {
  return schemeOf(text) != nullptr;
}

std::string RemoteAddress::shown() const {
  // a key of an object store may have a question mark
  const std::size_t end = scheme == RemoteScheme::S3 ? std::string::npos : text.find('?');
  return text.substr(0, end);
}

std::string RemoteAddress::fileName() const {
  std::string path = shown();
  path.erase(0, path.find("://") + 3);
  while (path.ends_with('/')) path.pop_back();
  const std::size_t slash = path.rfind('/');
  std::string name = slash == std::string::npos ? "" : path.substr(slash + 1);
  if (scheme != RemoteScheme::S3) name = unescaped(name);
  for (char& c : name)
    if (c == '/' || c == '\\' || static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '_';
  if (name.size() > kLongestName) name.erase(0, name.size() - kLongestName);
  while (name.starts_with('.') || name.starts_with('-')) name.erase(0, 1);
  return name.empty() ? "file" : name;
}

RemoteAddress RemoteAddress::below(std::string_view path) const {
  std::string folder = shown();
  const std::string query = text.substr(folder.size());
  while (folder.ends_with('/')) folder.pop_back();
  return {scheme, folder.append("/").append(path).append(query)};
}

RemoteAddress parseRemote(std::string_view text) {
  const auto* const scheme = schemeOf(text);
  if (scheme == nullptr)
    throw refusal(std::string(text),
                  "expected an address that begins with http://, https:// or s3://");
  const bool isStore = scheme->second == RemoteScheme::S3;
  if (!isStore) text = text.substr(0, text.find('#'));
  RemoteAddress address{scheme->second,
                        std::string(scheme->first).append(text.substr(scheme->first.size()))};
  const std::string shown = address.shown();
  if (text.size() > kLongestAddress)
    throw refusal(shown.substr(0, 100),
                  "an address has at most " + std::to_string(kLongestAddress) + " bytes");
  const std::string_view rest = std::string_view(address.text).substr(scheme->first.size());
  const std::string_view host = rest.substr(0, rest.find_first_of("/?"));
  if (host.find('@') != std::string_view::npos)
    throw Error(
        ErrorKind::Usage,
        std::string(scheme->first) + "...@" +
            formats::printable(std::string(host.substr(host.rfind('@') + 1))) +
            ": an address with a user or a password is refused, since every program of this "
            "machine can see it");
  if (!std::all_of(rest.begin(), rest.end(), [&](char c) {
        return isAllowed(static_cast<unsigned char>(c), address.scheme);
      }))
    throw refusal(shown,
                  "an address has no spaces, control characters, quotation marks or "
                  "brackets; write them as %XX");
  if (host.empty() || rest.size() <= host.size() + 1 || rest[host.size()] != '/')
    throw refusal(shown, std::string("expected ") + std::string(scheme->first) +
                             (isStore ? "BUCKET/KEY" : "HOST/PATH"));
  return address;
}

}  // namespace lumen::convert
