// SPDX-License-Identifier: Apache-2.0
// lumen library sample: a library of synthetic patients, to try things on.
#include <filesystem>
#include <string>
#include <vector>

#include "converters/base/number_text.h"
#include "converters/engine/file_access.h"
#include "converters/engine/library_build.h"
#include "converters/engine/operations/operations.h"
#include "converters/library/index/library_file.h"
#include "converters/library/rows/build.h"

namespace lumen::engine {

namespace fs = std::filesystem;

namespace {

std::string patientName(int number) {
  return std::string("patient-").append(paddedNumber(static_cast<std::uint64_t>(number), 2));
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

  void addRows(OptionTable& table) override {
    table.argument("LIBRARY", &m_library, "Library to make, or to go on with");
    table.add("patients", &m_patients, "N", "Number of patients: the phantoms of the seeds 1 to N")
        .in(WholeRange{1, 99});
    table.add("size", &m_size, "N", "Voxels along an edge of their volumes, of 0.2 mm")
        .in(WholeRange{128, 512});
    addBuildRows(table, m_options);
  }

  Answer run(const RunContext& context) override {
    if (m_options.work.empty())
      m_options.work = (fs::path(m_library) / "").parent_path().string() + ".build";
    makeLibrary(context);
    const fs::path list = makeList(context);
    return buildLibrary(loadBuildList(list.string()), list.string(), m_library, m_options, context);
  }

private:
  void makeLibrary(const RunContext& context) const {
    if (fs::exists(fs::path(m_library) / convert::kLibraryFile)) return;
    Operation init{"library init", {m_library}, {}};
    init.with("title", "Synthetic patients")
        .with("description",
              "Arteries that a program grew and drew into volumes: nobody's. Made by lumen library "
              "sample.")
        .with("licence", "CC0-1.0");
    (void)context.engine.run(init, context);
  }

  /// The volumes and the list of them, in the folder for work.
  [[nodiscard]] fs::path makeList(const RunContext& context) const {
    const fs::path work = fs::absolute(m_options.work);
    convert::claimWorkFolder(work);
    std::string text = "input,seeds,id,targets,title,description,anatomy,modality,synthetic\n";
    context.progress.begin("drawing patients", static_cast<std::size_t>(m_patients));
    for (int k = 1; k <= m_patients; ++k) {
      const std::string name = patientName(k),
                        volume = name + "-" + std::to_string(m_size) + ".nrrd",
                        seeds = name + "-" + std::to_string(m_size) + ".json";
      if (!fs::exists(work / volume) || !fs::exists(work / seeds))
        (void)context.engine.run(Operation{"phantom", {"patient", (work / volume).string()}, {}}
                                     .with("seeds", (work / seeds).string())
                                     .with("size", std::to_string(m_size))
                                     .with("seed", std::to_string(k)),
                                 context);
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

}  // namespace lumen::engine
