// SPDX-License-Identifier: Apache-2.0
// lumen library verify: whether a library is the one that its publisher signed.
#include "converters/base/option_name.h"
#include "converters/engine/about_options.h"
#include "converters/engine/answers/library_answer.h"
#include "converters/engine/operations/operations.h"
#include "converters/library/library_lock.h"
#include "converters/library/verified_revisions.h"
#include "converters/library/verify_library.h"

namespace lumen::engine {

namespace {

Json signerJson(const convert::Signer& signer) {
  if (signer.program.empty()) return nullptr;
  Json json;
  json["program"] = signer.program;
  json["key"] = signer.key.empty() ? Json(nullptr) : Json(signer.key);
  json["identity"] = signer.identity.empty() ? Json(nullptr) : Json(signer.identity);
  return json;
}

class LibraryVerifyCommand : public Command {
public:
  [[nodiscard]] std::string name() const override { return "library verify"; }
  [[nodiscard]] std::string summary() const override {
    return "Report whether a library is whole, signed by a key that you trust, and not an older "
           "one";
  }
  [[nodiscard]] std::string example() const override {
    return "  lumen library verify siphons --key publisher.pub\n"
           "  lumen library verify siphons --key allowed_signers --identity publisher@example.org";
  }

  void addRows(OptionTable& table) override {
    table.argument("LIBRARY", &m_folder, "Folder of the library");
    table
        .file(kOption.key.name, m_key,
              "The key that you trust: a public key of minisign or OpenSSH, or a list of allowed "
              "signers (ssh-keygen(1))")
        .required();
    table.add("identity", &m_identity, "NAME", "Accept only this one of the allowed signers");
    table.file(kOption.state.name, m_state,
               "Remember in FILE which revisions were verified, and refuse older ones "
               "[$XDG_STATE_HOME/lumen/libraries.json]");
    table
        .flag("no-state", m_isForgetful,
              "Remember nothing: an older revision that was signed once passes")
        .without(kOption.state.name);
    addFaultsRow(table, m_mostFaults);
  }

  Answer run(const RunContext& context) override {
    using convert::LibraryLock;
    const LibraryLock lock(m_folder, context.progress, LibraryLock::Use::Read);
    const convert::PlainFolder folder(m_folder);
    convert::VerifyOptions options;
    options.trusted = convert::readKeyFile(m_key);
    options.identity = m_identity;
    options.mostFaults = m_mostFaults;
    if (!m_isForgetful)
      options.state =
          m_state.empty() ? convert::defaultStateFile() : std::filesystem::path(m_state);
    if (!m_identity.empty() && options.trusted.kind != convert::KeyKind::AllowedSigners)
      throw Error(ErrorKind::Usage, "--identity: " + m_key + " is " +
                                        convert::keyKindText(options.trusted.kind) +
                                        "; only a list of allowed signers has names");
    const convert::LibraryVerdict verdict =
        convert::verifyLibrary(folder, options, context.progress);
    const bool isTrusted =
        verdict.isTrusted() && !(context.strict && verdict.check.faults.counts().warnings > 0);
    return report(verdict, isTrusted);
  }

private:
  [[nodiscard]] Answer report(const convert::LibraryVerdict& verdict, bool isTrusted) const {
    Json json = libraryCheckJson(m_folder, verdict.check);
    json["trusted"] = isTrusted;
    json["signed_by"] = signerJson(verdict.signer);
    json["known_revision"] =
        verdict.knownRevision == 0 ? Json(nullptr) : Json(verdict.knownRevision);
    const convert::Signer& signer = verdict.signer;
    const std::string line = isTrusted
                                 ? "trusted: " + libraryName(verdict.check) + ", signed by " +
                                       signer.program + "'s key " + signer.key +
                                       (signer.identity.empty() ? "" : " of " + signer.identity) +
                                       "; " + checkedText(verdict.check)
                                 : "not trusted: " + faultCounts(verdict.check);
    return {std::move(json),
            libraryFaultsText(m_folder, verdict.check) + Lines().add(m_folder + ": " + line).text(),
            isTrusted ? 0 : kInvalidCode, !isTrusted};
  }

  std::string m_folder, m_key, m_identity, m_state;
  bool m_isForgetful = false;
  std::size_t m_mostFaults = convert::VerifyOptions().mostFaults;
};

}  // namespace

std::unique_ptr<Command> makeLibraryVerifyCommand() {
  return std::make_unique<LibraryVerifyCommand>();
}

}  // namespace lumen::engine
