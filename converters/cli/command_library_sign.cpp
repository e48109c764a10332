// SPDX-License-Identifier: Apache-2.0
// lumen library sign: a signature of library.json, and so of all that a library has.
#include <optional>
#include <span>
#include <string>

#include "converters/cli/command.h"
#include "converters/cli/value_checks.h"
#include "converters/engine/library_check_report.h"
#include "converters/library/change.h"
#include "converters/library/signature.h"
#include "formats/case/atomic_file.h"

namespace lumen::app {

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

  void bind(CLI::App& app) override {
    addFile(app, "LIBRARY", m_folder, "Folder of the library");
    addFile(
        app, "--key", m_key,
        "The secret key, of minisign or OpenSSH, or a public key of OpenSSH whose secret one an "
        "agent has. The program asks for a password if the key has one")
        ->required();
    addFile(app, "--resume", m_journal,
            "Of the check: pass over cases that lumen library check --resume FILE found whole")
        ->required(false);
  }

  int run(Context& context) override {
    const convert::KeyFile key = convert::readKeyFile(m_key);
    convert::requireSigningKey(key);
    convert::LibraryCheckOptions options;
    options.journal = m_journal;
    convert::LibraryCheck check{convert::FaultList(options.mostFaults), {}, 0, 0, 0, 0};
    const std::optional<std::string> text = checkAll(options, check, context);
    const bool isFaulty =
        check.faults.counts().errors > 0 || (context.common.strict && check.faults.counts().warnings > 0);
    if (isFaulty) {
      report(check, nullptr, context);
      return kFaulty;
    }
    const convert::Signature signature =
        convert::sign(*text, *check.library, key, context.progress);
    write(signature, *text, context);
    report(check, &signature, context);
    return 0;
  }

private:
  /// The text of library.json that is to be signed; nothing if it cannot be read.
  std::optional<std::string> checkAll(const convert::LibraryCheckOptions& options,
                                      convert::LibraryCheck& check, Context& context) const {
    using convert::LibraryLock;
    const LibraryLock lock(m_folder, context.progress, LibraryLock::Use::Read);
    const convert::PlainFolder folder(m_folder);
    auto text = convert::readLibraryText(folder, check.faults, context.progress);
    if (text) check = convert::checkLibrary(folder, *text, options, context.progress);
    return text;
  }

  void write(const convert::Signature& signature, const std::string& text, Context& context) const {
    const std::filesystem::path file = std::filesystem::path(m_folder) / signature.file;
    const auto unchanged = [&] {
      convert::FaultList ignored(0);
      const convert::PlainFolder folder(m_folder);  // it may be another by now
      return convert::readLibraryText(folder, ignored, context.progress) == text;
    };
    const convert::LibraryLock lock(m_folder, context.progress);
    if (!unchanged())
      throw failed(m_folder + ": library.json was changed while it was signed; nothing is written");
    context.interrupts.watchOutput(file);
    const auto done = formats::writeFileAtomically(std::as_bytes(std::span(signature.bytes)), file);
    if (!done) throw failed(done.error().message);
  }

  void report(const convert::LibraryCheck& check, const convert::Signature* signature,
              const Context& context) const {
    if (context.common.json) {
      Json json = libraryCheckJson(m_folder, check);
      json["signed"] = signature != nullptr;
      json["signature"] = signature != nullptr ? Json(signature->file) : Json(nullptr);
      json["program"] = signature != nullptr ? Json(signature->signer.program) : Json(nullptr);
      json["key"] = signature != nullptr ? Json(signature->signer.key) : Json(nullptr);
      json["verified"] = signature != nullptr && signature->isVerified;
      answerJson(json);
      return;
    }
    if (context.common.quiet && signature != nullptr) return;
    const std::string line =
        signature != nullptr
            ? "signed: " + libraryName(check) + ", by " + signature->signer.program + "'s key " +
                  signature->signer.key + ", in " + signature->file +
                  (signature->isVerified
                       ? ""
                       : "; not verified, as no public key lies beside the secret one")
            : "not signed: " + faultCounts(check) + ", which lumen library check tells, too";
    answer(libraryFaultsText(m_folder, check) + Lines().add(m_folder + ": " + line).text());
  }

  std::string m_folder, m_key, m_journal;
};

}  // namespace

std::unique_ptr<Command> makeLibrarySignCommand() {
  return std::make_unique<LibrarySignCommand>();
}

}  // namespace lumen::app
