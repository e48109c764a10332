// SPDX-License-Identifier: Apache-2.0
// lumen library sample: a library of synthetic patients, to try things on.
#include <array>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "converters/cli/command.h"
#include "converters/cli/run_lumen.h"
#include "converters/cli/value_checks.h"
#include "converters/engine/file_access.h"
#include "converters/engine/library_build.h"
#include "converters/library/build.h"
#include "converters/library/library_file.h"

namespace lumen::app {

namespace fs = std::filesystem;

namespace {

std::string patientName(int number) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "patient-%02d", number);
  return text.data();
}

class LibrarySampleCommand : public Command {
public:
  [[nodiscard]] std::string name() const override { return "library sample"; }
  [[nodiscard]] std::string summary() const override {
    return "Make a library of synthetic patients, each with two exports, to try things on";
  }
  [[nodiscard]] std::string example() const override {
    return "  lumen library sample patients --jobs 2\n"
           "  lumen library index patients && lumen library check patients";
  }

  void bind(CLI::App& app) override {
    addFile(app, "LIBRARY", m_library, "Library to make, or to go on with");
    app.add_option("--patients", m_patients, "How many: the phantoms of the seeds 1 to N")
        ->type_name("N")
        ->check(wholeIn(1, 99))
        ->capture_default_str();
    app.add_option("--size", m_size, "Voxels along an edge of their volumes, of 0.2 mm")
        ->type_name("N")
        ->check(wholeIn(128, 512))
        ->capture_default_str();
    addBuildOptions(app, m_options);
  }

  int run(Context& context) override {
    if (m_options.work.empty())
      m_options.work = (fs::path(m_library) / "").parent_path().string() + ".build";
    makeLibrary(context);
    const fs::path list = makeList(context);
    return buildAndReport(loadBuildList(list.string()), list.string(), m_library, m_options,
                          context);
  }

private:
  void makeLibrary(const Context& context) const {
    if (fs::exists(fs::path(m_library) / convert::kLibraryFile)) return;
    runLumen({"library", "init", m_library, "--title", "Synthetic patients", "--description",
              "Arteries that a program grew and drew into volumes: nobody's. Made by lumen library "
              "sample.",
              "--licence", "CC0-1.0"},
             context.progress);
  }

  /// The volumes and the list of them, in the folder for work.
  [[nodiscard]] fs::path makeList(const Context& context) const {
    const fs::path work = fs::absolute(m_options.work);
    convert::claimWorkFolder(work);
    std::string text = "input,seeds,id,targets,title,description,anatomy,modality,synthetic\n";
    context.progress.begin("drawing patients", static_cast<std::size_t>(m_patients));
    for (int k = 1; k <= m_patients; ++k) {
      const std::string name = patientName(k),
                        volume = name + "-" + std::to_string(m_size) + ".nrrd",
                        seeds = name + "-" + std::to_string(m_size) + ".json";
      if (!fs::exists(work / volume) || !fs::exists(work / seeds))
        runLumen(
            {"phantom", "patient", (work / volume).string(), "--seeds", (work / seeds).string(),
             "--size", std::to_string(m_size), "--seed", std::to_string(k)},
            context.progress);
      text += volume + "," + seeds + "," + name + ",sofa;svzerod,Arteries grown from seed " +
              std::to_string(k) + ",\"A program grew them and drew the volume: nobody's\"" +
              ",synthetic arterial tree,synthetic,yes\n";
      context.progress.advance();
    }
    context.progress.end();
    writeText(text, work / "list.csv");
    return work / "list.csv";
  }

  std::string m_library;
  int m_patients = 10, m_size = 128;
  BuildArguments m_options;
};

}  // namespace

std::unique_ptr<Command> makeLibrarySampleCommand() {
  return std::make_unique<LibrarySampleCommand>();
}

}  // namespace lumen::app
