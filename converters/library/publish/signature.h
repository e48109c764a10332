// SPDX-License-Identifier: Apache-2.0
// Signatures of library.json by minisign or OpenSSH, which are programs of their own:
// spec/library.md, Trust. There is no cryptography here.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "converters/base/progress.h"
#include "converters/library/index/library_file.h"

namespace lumen::convert {

// Files of keys of minisign and OpenSSH, known by their content. The content of a key is the
// programs' business.

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

inline constexpr const char* kSignatureNamespace = "lumen-library";

/// Maker of a signature.
struct Signer {
  std::string program;   ///< "minisign" or "OpenSSH"
  std::string key;       ///< minisign's id of the key, or OpenSSH's "SHA256:..."
  std::string identity;  ///< name in a list of allowed signers; may be empty
};

struct Signature {
  std::string file;  ///< its name in the folder
  std::string bytes;
  Signer signer;
  /// Checked with the public key beside the secret one, or by the key that it holds.
  bool isVerified = false;
};

/// Throws Error(InvalidInput) for a key that cannot sign.
void requireSigningKey(const KeyFile& key);

/// Signs with the secret key; the program may ask for its password on the terminal. Nothing is
/// written. Throws Error(Unsupported) if the program is not installed, Error(InvalidInput) for
/// another key, Error(Failed) with the program's words if it refuses.
Signature sign(const std::string& libraryText, const LibraryFile& library, const KeyFile& key,
               const Progress& progress);

enum class Trust : std::uint8_t {
  Trusted,
  Unsigned,   ///< there is no signature of the key's kind
  Untrusted,  ///< the key is not trusted
  Broken,     ///< no signature, or one of other bytes
};

struct TrustAnswer {
  Trust trust = Trust::Broken;
  Signer signer;      ///< as far as it is known
  std::string found;  ///< reason why it is not trusted; `expected`: the trusted state
  std::string expected;
};

/// Whether the signature that `signature` holds, nothing if there is none, is of `libraryText` and
/// by a trusted key; `identity` names one of a list of allowed signers, by default any of them.
/// Throws as sign().
TrustAnswer verifySignature(const std::string& libraryText,
                            const std::optional<std::string>& signature, const KeyFile& trusted,
                            const std::string& identity, const Progress& progress);

/// The signature's file for keys of this kind.
const char* signatureFile(KeyKind kind);

}  // namespace lumen::convert
