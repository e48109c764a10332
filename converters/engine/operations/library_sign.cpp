// SPDX-License-Identifier: Apache-2.0
// lumen library sign: a signature of library.json, and so of all that a library has.
#include <optional>
#include <span>
#include <string>

#include "converters/base/option_name.h"
#include "converters/engine/answers/library_answer.h"
#include "converters/engine/operations/operations.h"
#include "converters/library/change.h"
#include "converters/library/signature.h"
#include "formats/case/atomic_file.h"

namespace lumen::engine {

namespace {

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
    convert::LibraryCheckOptions options;
    options.journal = m_journal;
    convert::LibraryCheck check{convert::FaultList(options.mostFaults), {}, 0, 0, 0, 0};
    const std::optional<std::string> text = checkAll(options, check, context);
    const bool isFaulty =
        check.faults.counts().errors > 0 || (context.strict && check.faults.counts().warnings > 0);
    if (isFaulty) {
      return report(check, nullptr);
    }
    const convert::Signature signature =
        convert::sign(*text, *check.library, key, context.progress);
    write(signature, *text, context);
    return report(check, &signature);
  }

private:
  /// The text of library.json that is to be signed; nothing if it cannot be read.
  std::optional<std::string> checkAll(const convert::LibraryCheckOptions& options,
                                      convert::LibraryCheck& check,
                                      const RunContext& context) const {
    using convert::LibraryLock;
    const LibraryLock lock(m_folder, context.progress, LibraryLock::Use::Read);
    const convert::PlainFolder folder(m_folder);
    auto text = convert::readLibraryText(folder, check.faults, context.progress);
    if (text) check = convert::checkLibrary(folder, *text, options, context.progress);
    return text;
  }

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
                              const convert::Signature* signature) const {
    Json json = libraryCheckJson(m_folder, check);
    json["signed"] = signature != nullptr;
    json["signature"] = signature != nullptr ? Json(signature->file) : Json(nullptr);
    json["program"] = signature != nullptr ? Json(signature->signer.program) : Json(nullptr);
    json["key"] = signature != nullptr ? Json(signature->signer.key) : Json(nullptr);
    json["verified"] = signature != nullptr && signature->isVerified;
    const std::string line =
        signature != nullptr
            ? "signed: " + libraryName(check) + ", by " + signature->signer.program + "'s key " +
                  signature->signer.key + ", in " + signature->file +
                  (signature->isVerified
                       ? ""
                       : "; not verified, as no public key lies beside the secret one")
            : "not signed: " + faultCounts(check) + ", which lumen library check reports, too";
    return {std::move(json),
            libraryFaultsText(m_folder, check) + Lines().add(m_folder + ": " + line).text(),
            signature != nullptr ? 0 : kInvalidCode, signature == nullptr};
  }

  std::string m_folder, m_key, m_journal;
};

}  // namespace

std::unique_ptr<Command> makeLibrarySignCommand() {
  return std::make_unique<LibrarySignCommand>();
}

}  // namespace lumen::engine
