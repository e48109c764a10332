// SPDX-License-Identifier: Apache-2.0
// lumen library verify: whether a library is what its publisher signed.
#include "converters/cli/command.h"
#include "converters/cli/value_checks.h"
#include "converters/engine/library_check_report.h"
#include "converters/library/library_lock.h"
#include "converters/library/verified_revisions.h"
#include "converters/library/verify_library.h"

namespace lumen::app {

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
    return "Tell whether a library is whole, signed by a key that you trust, and not an older one";
  }
  [[nodiscard]] std::string example() const override {
    return "  lumen library verify siphons --key publisher.pub\n"
           "  lumen library verify siphons --key allowed_signers --identity publisher@example.org";
  }

  void bind(CLI::App& app) override {
    addFile(app, "LIBRARY", m_folder, "Folder of the library");
    addFile(app, "--key", m_key,
            "The key that you trust: a public key of minisign or OpenSSH, or a list of allowed "
            "signers (ssh-keygen(1))")
        ->required();
    app.add_option("--identity", m_identity, "Whom of the allowed signers; by default anybody")
        ->type_name("NAME");
    auto* state = addFile(app, "--state", m_state,
                          "Remember in FILE which revisions were verified, and refuse older ones "
                          "[$XDG_STATE_HOME/lumen/libraries.json]")
                      ->required(false);
    app.add_flag("--no-state", m_isForgetful,
                 "Remember nothing: an older revision that was signed once passes")
        ->excludes(state);
    app.add_option("--max-faults", m_mostFaults, "List so many faults; all count for the verdict")
        ->type_name("N")
        ->check(wholeIn(0, 1000000))
        ->capture_default_str();
  }

  int run(Context& context) override {
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
    if (!options.state.empty()) context.interrupts.watchOutput(options.state);
    const convert::LibraryVerdict verdict =
        convert::verifyLibrary(folder, options, context.progress);
    const bool isTrusted =
        verdict.isTrusted() && !(context.common.strict && verdict.check.faults.counts().warnings > 0);
    report(verdict, isTrusted, context);
    return isTrusted ? 0 : kFaulty;
  }

private:
  void report(const convert::LibraryVerdict& verdict, bool isTrusted,
              const Context& context) const {
    if (context.common.json) {
      Json json = libraryCheckJson(m_folder, verdict.check);
      json["trusted"] = isTrusted;
      json["signed_by"] = signerJson(verdict.signer);
      json["known_revision"] =
          verdict.knownRevision == 0 ? Json(nullptr) : Json(verdict.knownRevision);
      answerJson(json);
      return;
    }
    if (context.common.quiet && isTrusted) return;
    const convert::Signer& signer = verdict.signer;
    const std::string line = isTrusted
                                 ? "trusted: " + libraryName(verdict.check) + ", signed by " +
                                       signer.program + "'s key " + signer.key +
                                       (signer.identity.empty() ? "" : " of " + signer.identity) +
                                       "; " + checkedText(verdict.check)
                                 : "not trusted: " + faultCounts(verdict.check);
    answer(libraryFaultsText(m_folder, verdict.check) + Lines().add(m_folder + ": " + line).text());
  }

  std::string m_folder, m_key, m_identity, m_state;
  bool m_isForgetful = false;
  std::size_t m_mostFaults = convert::VerifyOptions().mostFaults;
};

}  // namespace

std::unique_ptr<Command> makeLibraryVerifyCommand() {
  return std::make_unique<LibraryVerifyCommand>();
}

}  // namespace lumen::app
