// SPDX-License-Identifier: Apache-2.0
// lumen library check: all that is wrong with a library.
#include "converters/cli/command.h"
#include "converters/cli/value_checks.h"
#include "converters/engine/library_check_report.h"
#include "converters/library/library_lock.h"

namespace lumen::app {

namespace {

class LibraryCheckCommand : public Command {
public:
  [[nodiscard]] std::string name() const override { return "library check"; }
  [[nodiscard]] std::string summary() const override {
    return "Tell all that is wrong with a library; exit with 3 if anything is";
  }
  [[nodiscard]] std::string example() const override {
    return "  lumen library check siphons\n"
           "  lumen library check siphons --resume siphons.checked   # goes on where it was "
           "interrupted";
  }

  void bind(CLI::App& app) override {
    addFile(app, "LIBRARY", m_folder, "Folder of the library");
    addFile(
        app, "--resume", m_options.journal,
        "Keep in FILE which cases are whole, and pass over those that nothing has touched since: "
        "same devices, inodes, sizes and times of change of all their files. What a disk loses by "
        "itself is not seen then")
        ->required(false);
    app.add_option("--max-faults", m_options.mostFaults,
                   "List so many faults; all count for the verdict")
        ->type_name("N")
        ->check(wholeIn(0, 1000000))
        ->capture_default_str();
  }

  int run(Context& context) override {
    using convert::LibraryLock;
    const LibraryLock lock(m_folder, context.progress, LibraryLock::Use::Read);
    const convert::PlainFolder folder(m_folder);
    convert::LibraryCheck check{convert::FaultList(m_options.mostFaults), {}, 0, 0, 0, 0};
    if (const auto text = convert::readLibraryText(folder, check.faults, context.progress))
      check = convert::checkLibrary(folder, *text, {m_options.mostFaults, m_options.journal},
                                    context.progress);
    const bool isRefused = context.common.strict && check.faults.counts().warnings > 0;
    const bool isWhole = check.faults.counts().errors == 0 && !isRefused;
    if (context.common.json) {
      Json json = libraryCheckJson(m_folder, check);
      json["whole"] = isWhole;
      answerJson(json);
    } else if (!context.common.quiet || !isWhole) {
      const std::string verdict =
          isWhole ? "whole" + (check.faults.counts().warnings > 0 ? ", with " + faultCounts(check) : "")
                  : "not whole: " + faultCounts(check) +
                        (check.faults.counts().errors == 0 ? ", which --strict makes errors" : "");
      answer(libraryFaultsText(m_folder, check) +
             Lines().add(m_folder + ": " + verdict + "; " + checkedText(check)).text());
    }
    return isWhole ? 0 : kFaulty;
  }

private:
  struct Options {
    std::string journal;
    std::size_t mostFaults = convert::LibraryCheckOptions().mostFaults;
  };
  std::string m_folder;
  Options m_options;
};

}  // namespace

std::unique_ptr<Command> makeLibraryCheckCommand() {
  return std::make_unique<LibraryCheckCommand>();
}

}  // namespace lumen::app
