// SPDX-License-Identifier: Apache-2.0
// lumen library build: the cases of a list, made and put into a library.
#include "converters/engine/library_build.h"

#include <string>

#include "converters/base/option_name.h"
#include "converters/engine/about_options.h"
#include "converters/engine/operations/operations.h"

namespace lumen::engine {

namespace {

class LibraryBuildCommand : public Command {
public:
  [[nodiscard]] std::string name() const override { return "library build"; }
  [[nodiscard]] std::string summary() const override {
    return "Make the cases of a list, and put them into a library";
  }
  [[nodiscard]] std::string example() const override {
    return "  lumen library init siphons --title \"Carotid siphons\" --licence CC-BY-4.0\n"
           "  lumen library build siphons.csv siphons --jobs 4\n"
           "A list begins with a row of names, such as\n"
           "  input,seeds,id,targets,title,synthetic,consent,deidentification,--crop";
  }

  void addRows(OptionTable& table) override {
    table.argument(
        "LIST", &m_list,
        "Comma-separated values: a row for each case, with input (a volume, mesh, centerline "
        "or case), seeds, id, targets of lumen export and codes (with ; between), title, "
        "description, anatomy, laterality, modality, synthetic, licence, attribution, doi, "
        "origin, consent, deidentification, and any option of lumen convert");
    table.argument("LIBRARY", &m_library, "Library that lumen library init made");
    addBuildRows(table, m_options);
    table.add(
        "profile", &m_options.profile, "NAME",
        "Judge the cases of volumes as lumen check --profile does: one that needs a person stays "
        "out of the library, and its row names the place to look at");
    table
        .add("accept", &m_options.accepted, "ID",
             "A person has looked at this case, and it goes in as it is; may be repeated")
        .many()
        .checkedBy(caseIdText());
    table.flag(
        "keep-going", m_options.keepGoing,
        "Make the other rows where some have a fault that is seen before any work, such as a "
        "missing input; otherwise nothing is made then");
  }

  Answer run(Surroundings& around) override {
    return buildLibrary(loadBuildList(m_list), m_list, m_library, m_options, around);
  }

private:
  std::string m_list, m_library;
  BuildArguments m_options;
};

}  // namespace

std::unique_ptr<Command> makeLibraryBuildCommand() {
  return std::make_unique<LibraryBuildCommand>();
}

}  // namespace lumen::engine
