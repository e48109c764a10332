// SPDX-License-Identifier: Apache-2.0
#include "converters/library/publish/signature.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <sstream>
#include <utility>
#include <vector>

#include "converters/base/error.h"
#include "converters/base/files.h"
#include "converters/base/run_program.h"
#include "converters/base/text.h"
#include "formats/container/printable.h"

namespace lumen::convert {

namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

constexpr unsigned kSecondsToAsk = 600;    // somebody looks for a password, or touches a token
constexpr unsigned kSecondsToVerify = 60;  // nobody is asked
constexpr std::size_t kShownWords = 300;   // bytes of a program's message
constexpr const char* kPublisher = "publisher";  // owner of a key that is given without a name

bool isOfMinisign(KeyKind kind) {
  return kind == KeyKind::MinisignSecret || kind == KeyKind::MinisignPublic;
}

/// minisign or ssh-keygen in a folder of its own, where it finds library.json and leaves nothing.
class Program {
public:
  Program(bool isMinisign, const std::string& libraryText, const Progress& progress)
      : m_name(isMinisign ? "minisign" : "ssh-keygen"), m_progress(progress) {
    const auto path = installedProgram(m_name);
    if (!path)
      throw unsupported(m_name + " is not installed, which " +
                        (isMinisign ? "minisign" : "OpenSSH") +
                        "'s keys need; Debian has it in the package " +
                        (isMinisign ? "minisign" : "openssh-client"));
    m_path = *path;
    writeNewFile(libraryText, file("library.json"));
  }

  [[nodiscard]] fs::path file(const std::string& name) const { return m_folder.path() / name; }

  /// Asks the user, if it must.
  [[nodiscard]] ProgramResult ask(const Words& arguments) const {
    return runProgram({m_path, arguments, m_folder.path(), kSecondsToAsk, {}, true, {}},
                      m_progress);
  }
  /// library.json is its standard input.
  [[nodiscard]] ProgramResult run(const Words& arguments) const {
    const ProgramResult result = runProgram(
        {m_path, arguments, m_folder.path(), kSecondsToVerify, file("library.json"), false, {}},
        m_progress);
    if (result.end == ProgramEnd::Crashed || result.end == ProgramEnd::TookTooLong)
      throw failed(m_name + " did not end as it should; nothing was verified");
    return result;
  }
  /// The last line of the program's message.
  [[nodiscard]] std::string words(const ProgramResult& result) const {
    if (result.end == ProgramEnd::TookTooLong)
      return m_name + " was not done in " + std::to_string(kSecondsToAsk / 60) + " minutes";
    std::string last;
    std::istringstream stream(result.errors);
    for (std::string line; std::getline(stream, line);) {
      for (const std::string asked : {"Password: ", "Enter passphrase: "})
        if (line.starts_with(asked)) line.erase(0, asked.size());
      if (!trimmed(line).empty()) last += (last.empty() ? "" : "; ") + trimmed(line);
    }
    if (last.empty()) return m_name + " refused without a word";
    return m_name + " reports: " + formats::printable(last.substr(0, kShownWords));
  }

private:
  std::string m_name;
  const Progress& m_progress;
  fs::path m_path;
  PrivateFolder m_folder;
};

/// The signature that a program made, or nothing where it made none.
std::string signatureIn(const fs::path& file) {
  std::error_code error;
  return fs::exists(file, error) ? readWholeFile(file, "signature", kMostText) : "";
}

/// "Good "lumen-library" signature with ED25519 key SHA256:...": the last word.
std::string fingerprint(const ProgramResult& result) {
  const std::string text = trimmed(result.output);
  const std::size_t at = text.rfind("SHA256:");
  return at == std::string::npos ? "" : formats::printable(trimmed(text.substr(at)));
}

/// The public key that lies beside a secret one: siphons.pub or siphons.key.pub for siphons.key.
std::optional<KeyFile> publicKeyBeside(const KeyFile& secret, const std::string& id) {
  for (const fs::path& file :
       {fs::path(secret.file).replace_extension(".pub"), fs::path(secret.file.string() + ".pub")})
    try {
      KeyFile key = readKeyFile(file);
      if (key.kind == KeyKind::MinisignPublic && key.id == id) return key;
    } catch (const Error&) {
      continue;  // it is only looked for
    }
  return {};
}

Signature signWithMinisign(const std::string& text, const LibraryFile& library, const KeyFile& key,
                           const Progress& progress) {
  const Program program(true, text, progress);
  const std::string about = "lumen library " + library.id;
  const ProgramResult result = program.ask(
      {"-S", "-s", fs::absolute(key.file).string(), "-m", "library.json", "-x", "signature", "-c",
       about, "-t", about + " revision " + std::to_string(library.revision)});
  Signature signature{kMinisignSignatureFile, signatureIn(program.file("signature")), {}, false};
  const auto signer = minisignSigner(signature.bytes);
  if (result.end != ProgramEnd::Done || !signer)
    throw failed(key.file.string() + ": not signed: " + program.words(result));
  signature.signer = {"minisign", *signer, ""};
  if (const auto known = publicKeyBeside(key, *signer)) {
    const TrustAnswer answer = verifySignature(text, signature.bytes, *known, "", progress);
    if (answer.trust != Trust::Trusted)
      throw failed(key.file.string() + ": minisign made a signature that " + known->file.string() +
                   " does not verify: " + answer.found);
    signature.isVerified = true;
  }
  return signature;
}

Signature signWithOpenSsh(const std::string& text, const KeyFile& key, const Progress& progress) {
  const Program program(false, text, progress);
  const ProgramResult result =
      program.ask({"-q", "-Y", "sign", "-f", fs::absolute(key.file).string(), "-n",
                   kSignatureNamespace, "library.json"});
  Signature signature{
      kOpenSshSignatureFile, signatureIn(program.file("library.json.sig")), {}, false};
  if (result.end != ProgramEnd::Done || signature.bytes.empty())
    throw failed(key.file.string() + ": not signed: " + program.words(result));
  const ProgramResult again =
      program.run({"-Y", "check-novalidate", "-n", kSignatureNamespace, "-s", "library.json.sig"});
  if (again.end != ProgramEnd::Done)
    throw failed(key.file.string() +
                 ": ssh-keygen made a signature that it does not verify: " + program.words(again));
  signature.signer = {"OpenSSH", fingerprint(again), ""};
  signature.isVerified = true;
  return signature;
}

TrustAnswer verifyWithMinisign(const std::string& text, const std::string& signature,
                               const KeyFile& trusted, const Progress& progress) {
  const auto signer = minisignSigner(signature);
  if (!signer) return {Trust::Broken, {"minisign", "", ""}, "no signature of minisign", "one"};
  if (*signer != trusted.id)
    return {Trust::Untrusted,
            {"minisign", *signer, ""},
            "a signature by minisign's key " + *signer,
            "one by " + trusted.id + ", which is in " + trusted.file.string()};
  const Program program(true, text, progress);
  writeNewFile(signature, program.file("signature"));
  const ProgramResult result = program.run({"-V", "-q", "-p", fs::absolute(trusted.file).string(),
                                            "-m", "library.json", "-x", "signature"});
  if (result.end == ProgramEnd::Done) return {Trust::Trusted, {"minisign", *signer, ""}, "", ""};
  return {Trust::Broken,
          {"minisign", *signer, ""},
          "a signature of something else (" + program.words(result) + ")",
          "one of this library.json"};
}

/// Identity of the allowed signer who made the signature, by ssh-keygen; nothing if none did.
std::string findIdentity(const Program& program) {
  const ProgramResult result = program.run(
      {"-Y", "find-principals", "-f", "allowed", "-s", "signature", "-n", kSignatureNamespace});
  if (result.end != ProgramEnd::Done) return "";
  return trimmed(result.output.substr(0, result.output.find('\n')));
}

/// A list of allowed signers of the key that is trusted.
std::string allowedSigners(const KeyFile& trusted) {
  if (trusted.kind == KeyKind::AllowedSigners)
    return readWholeFile(trusted.file, "list of allowed signers", kMostText);
  std::string text;
  for (const std::string& key : trusted.keys) text += std::string(kPublisher) + " " + key + "\n";
  return text;
}

TrustAnswer verifyWithOpenSsh(const std::string& text, const std::string& signature,
                              const KeyFile& trusted, const std::string& identity,
                              const Progress& progress) {
  const Program program(false, text, progress);
  writeNewFile(signature, program.file("signature"));
  writeNewFile(allowedSigners(trusted), program.file("allowed"));
  const ProgramResult any =
      program.run({"-Y", "check-novalidate", "-n", kSignatureNamespace, "-s", "signature"});
  if (any.end != ProgramEnd::Done)
    return {Trust::Broken,
            {"OpenSSH", "", ""},
            "a signature of something else, or none (" + program.words(any) + ")",
            "one of this library.json, in the namespace " + std::string(kSignatureNamespace)};
  const bool isList = trusted.kind == KeyKind::AllowedSigners;
  const std::string who = !isList            ? kPublisher
                          : identity.empty() ? findIdentity(program)
                                             : identity;
  const Signer signer{"OpenSSH", fingerprint(any), isList ? formats::printable(who) : ""};
  const Words arguments = {"-Y", "verify",   "-f", "allowed", "-I", who, "-n", kSignatureNamespace,
                           "-s", "signature"};
  if (!who.empty() && program.run(arguments).end == ProgramEnd::Done)
    return {Trust::Trusted, signer, "", ""};
  return {Trust::Untrusted,
          {signer.program, signer.key, ""},
          "a signature by OpenSSH's key " + signer.key,
          "one by " +
              (isList && !identity.empty() ? formats::printable(identity) + ", as in "
                                           : std::string("a key in ")) +
              trusted.file.string()};
}

}  // namespace

const char* signatureFile(KeyKind kind) {
  return isOfMinisign(kind) ? kMinisignSignatureFile : kOpenSshSignatureFile;
}

void requireSigningKey(const KeyFile& key) {
  // an agent may have the private key of a public one of OpenSSH
  if (key.kind == KeyKind::MinisignPublic || key.kind == KeyKind::AllowedSigners)
    throw invalidInput(key.file.string() + ": found " + keyKindText(key.kind) +
                       ", expected a secret key, which signs");
}

Signature sign(const std::string& libraryText, const LibraryFile& library, const KeyFile& key,
               const Progress& progress) {
  requireSigningKey(key);
  return isOfMinisign(key.kind) ? signWithMinisign(libraryText, library, key, progress)
                                : signWithOpenSsh(libraryText, key, progress);
}

TrustAnswer verifySignature(const std::string& libraryText,
                            const std::optional<std::string>& signature, const KeyFile& trusted,
                            const std::string& identity, const Progress& progress) {
  if (trusted.kind == KeyKind::MinisignSecret || trusted.kind == KeyKind::OpenSshPrivate)
    throw invalidInput(trusted.file.string() + ": found " + keyKindText(trusted.kind) +
                       ", expected a public one, which verifies; a secret key is for nobody else");
  const bool isMinisign = isOfMinisign(trusted.kind);
  if (!signature)
    return {Trust::Unsigned,
            {},
            "nothing",
            std::string("a signature by ") + (isMinisign ? "minisign" : "OpenSSH") +
                ", of which the key is"};
  return isMinisign ? verifyWithMinisign(libraryText, *signature, trusted, progress)
                    : verifyWithOpenSsh(libraryText, *signature, trusted, identity, progress);
}

}  // namespace lumen::convert
