// SPDX-License-Identifier: Apache-2.0
// lumen library index: the pages of a library.
#include <filesystem>
#include <memory>
#include <string>

#include "converters/cli/command.h"
#include "converters/cli/value_checks.h"
#include "converters/engine/report.h"
#include "converters/library/site/site.h"
#include "formats/container/printable.h"

namespace lumen::app {

namespace {

class LibraryIndexCommand : public Command {
public:
  [[nodiscard]] std::string name() const override { return "library index"; }
  [[nodiscard]] std::string summary() const override {
    return "Write the pages of a library, for people with a browser";
  }
  [[nodiscard]] std::string example() const override {
    return "  lumen library index siphons && xdg-open siphons/index.html\n"
           "  rsync -a siphons/ publisher.example:/srv/www/siphons/";
  }
  void bind(CLI::App& app) override {
    addFile(app, "LIBRARY", m_library,
            "Folder of the library, in which index.html and site/ are made anew");
  }
  int run(Context& context) override {
    const std::filesystem::path first = std::filesystem::path(m_library) / "index.html";
    context.interrupts.watchOutput(first);
    const convert::SiteReport site = convert::writeSite(m_library, context.progress);
    if (context.common.json)
      answerJson(Json{{"cases", site.cases}, {"pages", site.pages}, {"bytes", site.bytes}});
    else if (!context.common.quiet)
      answer(formats::printable(first.string()) + ": " + counted(site.cases, "case", "cases") +
             ", " + counted(site.pages, "page", "pages") + "\n");
    return 0;
  }

private:
  std::string m_library;
};

}  // namespace

std::unique_ptr<Command> makeLibraryIndexCommand() {
  return std::make_unique<LibraryIndexCommand>();
}

}  // namespace lumen::app
