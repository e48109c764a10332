// SPDX-License-Identifier: Apache-2.0
// lumen library index: the pages of a library.
#include <filesystem>
#include <memory>
#include <string>

#include "converters/engine/answers/answer_text.h"
#include "converters/engine/operations/operations.h"
#include "converters/library/site/site.h"
#include "formats/container/printable.h"

namespace lumen::engine {

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
  void addRows(OptionTable& table) override {
    table.argument("LIBRARY", &m_library,
                   "Folder of the library, in which index.html and site/ are made anew");
  }
  Answer run(const RunContext& context) override {
    const std::filesystem::path first = std::filesystem::path(m_library) / "index.html";
    const convert::SiteReport site = convert::writeSite(m_library, context.progress);
    return {Json{{"cases", site.cases}, {"pages", site.pages}, {"bytes", site.bytes}},
            formats::printable(first.string()) + ": " + counted(site.cases, "case", "cases") +
                ", " + counted(site.pages, "page", "pages") + "\n"};
  }

private:
  std::string m_library;
};

}  // namespace

std::unique_ptr<Command> makeLibraryIndexCommand() {
  return std::make_unique<LibraryIndexCommand>();
}

}  // namespace lumen::engine
