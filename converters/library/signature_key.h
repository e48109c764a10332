// SPDX-License-Identifier: Apache-2.0
// Files of keys of minisign and OpenSSH, known by their content. The content of a key is the
// programs' business.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace lumen::convert {

enum class KeyKind : std::uint8_t {
  MinisignSecret,
  MinisignPublic,
  OpenSshPrivate,
  OpenSshPublic,   ///< lines as in NAME.pub
  AllowedSigners,  ///< lines as ssh-keygen(1) has them: a signer, and a key
};

struct KeyFile {
  std::filesystem::path file;  ///< as it was named
  KeyKind kind = KeyKind::MinisignPublic;
  std::string id;  ///< id of a public key of minisign: 16 hexadecimal digits, as it prints them
  std::vector<std::string> keys;  ///< keys of OpenSshPublic: "ssh-ed25519 AAAA..."
};

/// Throws Error(InvalidInput) for a file of another kind.
KeyFile readKeyFile(const std::filesystem::path& file);

/// "a secret key of minisign"
std::string keyKindText(KeyKind kind);

/// The id of the key that made a signature of minisign; nothing for another text.
std::optional<std::string> minisignSigner(const std::string& signature);

}  // namespace lumen::convert
