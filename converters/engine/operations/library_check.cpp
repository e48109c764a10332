// SPDX-License-Identifier: Apache-2.0
// lumen library check: all that is wrong with a library.
#include "converters/base/option_name.h"
#include "converters/engine/about_options.h"
#include "converters/engine/answers/library_answer.h"
#include "converters/engine/operations/operations.h"
#include "converters/library/library_lock.h"

namespace lumen::engine {

namespace {

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
        kOption.resume.name, m_options.journal,
        "Keep in FILE which cases are whole, and pass over those that nothing has touched since: "
        "same devices, inodes, sizes and times of change of all their files. Damage by the disk "
        "itself is not seen then");
    addFaultsRow(table, m_options.mostFaults);
  }

  Answer run(const RunContext& context) override {
    using convert::LibraryLock;
    const LibraryLock lock(m_folder, context.progress, LibraryLock::Use::Read);
    const convert::PlainFolder folder(m_folder);
    convert::LibraryCheck check{convert::FaultList(m_options.mostFaults), {}, 0, 0, 0, 0};
    if (const auto text = convert::readLibraryText(folder, check.faults, context.progress))
      check = convert::checkLibrary(folder, *text, {m_options.mostFaults, m_options.journal},
                                    context.progress);
    const bool isRefused = context.strict && check.faults.counts().warnings > 0;
    const bool isWhole = check.faults.counts().errors == 0 && !isRefused;
    Json json = libraryCheckJson(m_folder, check);
    json["whole"] = isWhole;
    const std::string verdict =
        isWhole
            ? "whole" + (check.faults.counts().warnings > 0 ? ", with " + faultCounts(check) : "")
            : "not whole: " + faultCounts(check) +
                  (check.faults.counts().errors == 0 ? ", which --strict makes errors" : "");
    return {std::move(json),
            libraryFaultsText(m_folder, check) +
                Lines().add(m_folder + ": " + verdict + "; " + checkedText(check)).text(),
            isWhole ? 0 : kInvalidCode, !isWhole};
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

}  // namespace lumen::engine
