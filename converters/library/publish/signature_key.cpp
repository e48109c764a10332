// SPDX-License-Identifier: Apache-2.0
// Declared in signature.h.
#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <span>
#include <sstream>
#include <string_view>

#include "converters/base/error.h"
#include "converters/base/files.h"
#include "converters/base/text.h"
#include "converters/library/publish/signature.h"
#include "formats/json/base64.h"

namespace lumen::convert {

namespace {

constexpr std::size_t kMostKeyBytes = 1U << 20U;  // size of a file of keys: thousands of signers

// minisign(1): sizes of the contents of its files, in bytes; each begins with two that name the
// algorithm
constexpr std::size_t kMinisignSecret = 158, kMinisignPublic = 42, kMinisignSignature = 74;
constexpr std::size_t kKeyId = 8;

std::vector<std::string> splitLines(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(trimmed(line));
  return lines;
}

/// The second line of a file of minisign, whose first is a comment.
std::optional<std::vector<std::byte>> minisignBytes(const std::vector<std::string>& lines) {
  if (lines.size() < 2 || !lines[0].starts_with("untrusted comment:")) return {};
  return formats::fromBase64(lines[1]);
}

/// Little-endian, as minisign prints it.
std::string keyId(std::span<const std::byte> bytes) {
  constexpr const char* digits = "0123456789ABCDEF";
  std::string text;
  for (std::size_t i = kKeyId; i-- > 0;) {
    const auto byte = std::to_integer<unsigned>(bytes[i]);
    text += digits[byte >> 4U];
    text += digits[byte & 0xfU];
  }
  return text;
}

/// Names of algorithms in OpenSSH's files: "ssh-ed25519", "ecdsa-sha2-nistp256",
/// "sk-ssh-ed25519@openssh.com".
bool isKeyType(std::string_view word) {
  constexpr std::array<std::string_view, 4> kBegins = {"ssh-", "ecdsa-sha2-", "sk-ssh-",
                                                       "sk-ecdsa-sha2-"};
  return std::any_of(kBegins.begin(), kBegins.end(),
                     [&](std::string_view begin) { return word.starts_with(begin); });
}

std::vector<std::string> splitWords(const std::string& line) {
  std::istringstream stream(line);
  return {std::istream_iterator<std::string>(stream), {}};
}

bool isKey(const std::vector<std::string>& words, std::size_t at) {
  return at + 1 < words.size() && isKeyType(words[at]) &&
         formats::fromBase64(words[at + 1]).has_value();
}

/// Lines that each hold a public key, some with the signers who may use it before; false for
/// anything else.
bool readOpenSsh(const std::vector<std::string>& lines, KeyFile& key) {
  bool hasSigners = false, hasAny = false;
  for (const std::string& line : lines) {
    if (line.empty() || line.starts_with('#')) continue;
    const std::vector<std::string> words = splitWords(line);
    const bool isBare = isKey(words, 0);
    bool found = isBare;
    for (std::size_t at = 1; at < words.size() && !found; ++at) found = isKey(words, at);
    if (!found) return false;
    hasAny = true;
    hasSigners = hasSigners || !isBare;
    if (isBare) key.keys.push_back(words[0] + " " + words[1]);
  }
  key.kind = hasSigners ? KeyKind::AllowedSigners : KeyKind::OpenSshPublic;
  return hasAny;
}

}  // namespace

KeyFile readKeyFile(const std::filesystem::path& file) {
  const std::string text = readWholeFile(file, "key file", kMostKeyBytes);
  KeyFile key;
  key.file = file;
  const std::vector<std::string> lines = splitLines(text);
  if (const auto bytes = minisignBytes(lines)) {
    if (bytes->size() == kMinisignSecret) {
      key.kind = KeyKind::MinisignSecret;
      return key;
    }
    if (bytes->size() == kMinisignPublic) {
      key.id = keyId(std::span(*bytes).subspan(2, kKeyId));
      return key;
    }
  }
  if (!lines.empty() && lines[0].starts_with("-----BEGIN ") &&
      lines[0].ends_with("PRIVATE KEY-----")) {
    key.kind = KeyKind::OpenSshPrivate;
    return key;
  }
  if (readOpenSsh(lines, key)) return key;
  throw invalidInput(file.string() +
                     ": found neither, expected a key of minisign (minisign -G makes one) or of "
                     "OpenSSH (ssh-keygen), or a list of allowed signers");
}

std::string keyKindText(KeyKind kind) {
  switch (kind) {
    case KeyKind::MinisignSecret:
      return "a secret key of minisign";
    case KeyKind::MinisignPublic:
      return "a public key of minisign";
    case KeyKind::OpenSshPrivate:
      return "a private key of OpenSSH";
    case KeyKind::OpenSshPublic:
      return "a public key of OpenSSH";
    case KeyKind::AllowedSigners:
      break;
  }
  return "a list of allowed signers";
}

std::optional<std::string> minisignSigner(const std::string& signature) {
  const auto bytes = minisignBytes(splitLines(signature));
  if (!bytes || bytes->size() != kMinisignSignature) return {};
  return keyId(std::span(*bytes).subspan(2, kKeyId));
}

}  // namespace lumen::convert
