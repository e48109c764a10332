// SPDX-License-Identifier: Apache-2.0
// Commands that judge a library as a whole: check, sign, verify.
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "converters/base/options/option_name.h"
#include "converters/engine/about_options.h"
#include "converters/engine/answers/library_answer.h"
#include "converters/engine/operations/operations.h"
#include "converters/library/index/library_lock.h"
#include "converters/library/publish/signature.h"
#include "converters/library/publish/verify_library.h"
#include "formats/case/atomic_file.h"

namespace lumen::engine {

namespace {

struct CheckedLibrary {
  std::optional<std::string> text;  ///< of library.json; none if it cannot be read
  convert::LibraryCheck check;
};

/// Checks a library while nobody changes it.
CheckedLibrary checkAll(const std::string& library, const convert::LibraryCheckOptions& options,
                        const RunContext& context) {
  const convert::LibraryLock lock(library, context.progress, convert::LibraryLock::Use::Read);
  const convert::PlainFolder folder(library);
  convert::LibraryCheck check{convert::FaultList(options.mostFaults), {}, 0, 0, 0, 0};
  auto text = convert::readLibraryText(folder, check.faults, context.progress);
  if (text) check = convert::checkLibrary(folder, *text, options, context.progress);
  return {std::move(text), std::move(check)};
}

/// No error, and with --strict no warning.
bool isPassed(const convert::LibraryCheck& check, const RunContext& context) {
  const formats::FaultCounts& counts = check.faults.counts();
  return counts.errors == 0 && !(context.strict && counts.warnings > 0);
}

/// The faults, and a line with the verdict.
Answer answerOf(const std::string& folder, const convert::LibraryCheck& check, Json json,
                const std::string& verdict, bool isGood) {
  return {std::move(json),
          libraryFaultsText(folder, check) + Lines().add(folder + ": " + verdict).text(),
          isGood ? 0 : kInvalidCode, !isGood};
}

Json signerJson(const convert::Signer& signer) {
  if (signer.program.empty()) return nullptr;
  Json json;
  json["program"] = signer.program;
  json["key"] = signer.key.empty() ? Json(nullptr) : Json(signer.key);
  json["identity"] = signer.identity.empty() ? Json(nullptr) : Json(signer.identity);
  return json;
}

class LibraryCheckCommand : public Command {
public:
  [[nodiscard]] std::string name() const override { return "library check"; }
  [[nodiscard]] std::string summary() const override {
    return "Report all faults of a library; exit with 3 if there are any";
  }
  [[nodiscard]] std::string example() const override {
    return "  lumen library check siphons\n"
           "  lumen library check siphons --resume siphons.checked   # goes on where it was "
           "interrupted";
  }

  void addRows(OptionTable& table) override {
    table.argument("LIBRARY", &m_folder, "Folder of the library");
    table.file(
        kOption.resume.name, m_journal,
        "Keep in FILE which cases are whole, and pass over those that nothing has touched since: "
        "same devices, inodes, sizes and times of change of all their files. Damage by the disk "
        "itself is not seen then");
    addFaultsRow(table, m_options.mostFaults);
  }

  Answer run(const RunContext& context) override {
    m_options.journal = m_journal;
    const convert::LibraryCheck check = checkAll(m_folder, m_options, context).check;
    const bool isWhole = isPassed(check, context);
    Json json = libraryCheckJson(m_folder, check);
    json["whole"] = isWhole;
    const std::string verdict =
        isWhole
            ? "whole" + (check.faults.counts().warnings > 0 ? ", with " + faultCounts(check) : "")
            : "not whole: " + faultCounts(check) +
                  (check.faults.counts().errors == 0 ? ", which --strict makes errors" : "");
    return answerOf(m_folder, check, std::move(json), verdict + "; " + checkedText(check), isWhole);
  }

private:
  std::string m_folder, m_journal;
  convert::LibraryCheckOptions m_options;
};

class LibrarySignCommand : public Command {
public:
  [[nodiscard]] std::string name() const override { return "library sign"; }
  [[nodiscard]] std::string summary() const override {
    return "Sign a library by minisign or OpenSSH, after a check of all of it";
  }
  [[nodiscard]] std::string example() const override {
    return "  minisign -G -p publisher.pub -s publisher.key     # once\n"
           "  lumen library sign siphons --key publisher.key\n"
           "  lumen library sign siphons --key ~/.ssh/id_ed25519";
  }

  void addRows(OptionTable& table) override {
    table.argument("LIBRARY", &m_folder, "Folder of the library");
    OptionRow& key = table.file(
        "key", m_key,
        "The secret key, of minisign or OpenSSH, or a public key of OpenSSH whose secret one an "
        "agent has. The program asks for a password if the key has one");
    key.type = "FILE";
    key.required();
    table.file(kOption.resume.name, m_journal,
               "Pass over cases in the check that lumen library check " + kOption.resume.shown() +
                   " FILE found whole");
  }

  Answer run(const RunContext& context) override {
    const convert::KeyFile key = convert::readKeyFile(m_key);
    convert::requireSigningKey(key);
    m_options.journal = m_journal;
    const CheckedLibrary checked = checkAll(m_folder, m_options, context);
    if (!isPassed(checked.check, context)) return report(checked.check, {});
    const convert::Signature signature =
        convert::sign(*checked.text, *checked.check.library, key, context.progress);
    write(signature, *checked.text, context);
    return report(checked.check, signature);
  }

private:
  void write(const convert::Signature& signature, const std::string& text,
             const RunContext& context) const {
    const std::filesystem::path file = std::filesystem::path(m_folder) / signature.file;
    const auto unchanged = [&] {
      convert::FaultList ignored(0);
      const convert::PlainFolder folder(m_folder);  // it may be another by now
      return convert::readLibraryText(folder, ignored, context.progress) == text;
    };
    const convert::LibraryLock lock(m_folder, context.progress);
    if (!unchanged())
      throw failed(m_folder + ": library.json was changed while it was signed; nothing is written");
    const auto done = formats::writeFileAtomically(std::as_bytes(std::span(signature.bytes)), file);
    if (!done) throw failed(done.error().message);
  }

  [[nodiscard]] Answer report(const convert::LibraryCheck& check,
                              const std::optional<convert::Signature>& signature) const {
    const convert::Signature made = signature.value_or(convert::Signature{});
    const auto ofSignature = [&](const std::string& text) {
      return signature ? Json(text) : Json(nullptr);
    };
    Json json = libraryCheckJson(m_folder, check);
    json["signed"] = signature.has_value();
    json["signature"] = ofSignature(made.file);
    json["program"] = ofSignature(made.signer.program);
    json["key"] = ofSignature(made.signer.key);
    json["verified"] = made.isVerified;
    const std::string unverified =
        made.isVerified ? "" : "; not verified, as no public key lies beside the secret one";
    const std::string line =
        signature
            ? "signed: " + libraryName(check) + ", by " + made.signer.program + "'s key " +
                  made.signer.key + ", in " + made.file + unverified
            : "not signed: " + faultCounts(check) + ", which lumen library check reports, too";
    return answerOf(m_folder, check, std::move(json), line, signature.has_value());
  }

  std::string m_folder, m_key, m_journal;
  convert::LibraryCheckOptions m_options;
};

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
    const convert::LibraryLock lock(m_folder, context.progress, convert::LibraryLock::Use::Read);
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
    return report(verdict, isPassed(verdict.check, context));
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
    return answerOf(m_folder, verdict.check, std::move(json), line, isTrusted);
  }

  std::string m_folder, m_key, m_identity, m_state;
  bool m_isForgetful = false;
  std::size_t m_mostFaults = convert::VerifyOptions().mostFaults;
};

}  // namespace

std::unique_ptr<Command> makeLibraryCheckCommand() {
  return std::make_unique<LibraryCheckCommand>();
}

std::unique_ptr<Command> makeLibrarySignCommand() {
  return std::make_unique<LibrarySignCommand>();
}

std::unique_ptr<Command> makeLibraryVerifyCommand() {
  return std::make_unique<LibraryVerifyCommand>();
}

}  // namespace lumen::engine
