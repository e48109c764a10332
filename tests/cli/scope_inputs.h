// SPDX-License-Identifier: Apache-2.0
// One small file of each kind that commands read, and runs of commands in this process, whose effects
// can be compared.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "converters/base/options/operation.h"
#include "converters/cli/commands.h"
#include "converters/engine/command.h"
#include "converters/engine/scope.h"
#include "tests/cli/run_lumen.h"

namespace lumen::test {

/// Names of options, and their values.
using Given = std::vector<std::pair<std::string, std::string>>;

/// An input of a command, with the options that it needs.
struct Input {
  std::string file;
  Given options;
  ContentMask content;
};

/// The effect of a run: the error, or else the answer and the files that it wrote.
struct Effect {
  std::string error;  ///< empty if there is none
  std::string answer, files;

  friend bool operator==(const Effect&, const Effect&) = default;
};

/// A folder, which is the current one during a test, with:
///
/// | file | content |
/// |---|---|
/// | tube.nrrd, seeds.json | a vessel of 6 mm in 32^3 voxels, and a click on it |
/// | labels.nrrd | its lumen as label 1 |
/// | halves.nii | its lower half as label 1, its upper half as label 2 |
/// | plain.stl, truth.swc | its surface, its centerline |
/// | vessels.scn | a scene that loads its surface and another mesh |
/// | tracked.lumen, case.lumen, tree.lumen | its case with points, with models too, without both |
/// | moving-case.lumen.json, moving-tracked.lumen.json | case.lumen and tracked.lumen with a motion |
/// | two.nrrd, two.json, two.lumen | two vessels that touch, and clicks on them |
/// | one-label.nrrd | one of the vessels of apart.nrrd as a label |
/// | apart.nrrd, apart.lumen, apart-labels.nrrd, apart.stl | two vessels that are apart, in two trees |
/// | apart.json, one.json | clicks on both of them, and on one |
/// | series | a folder of DICOM: the tube as series 1, the other two vessels as series 2 |
/// | times.nii | both as a volume of two times |
/// | header/tube.nhdr | a header of voxels outside of its folder |
/// | header/vessels.scn | a scene of a mesh outside of its folder |
/// | ends.lumen | a vessel with a thin branch and a short one |
/// | table.csv | names of labels |
class ScopeTest : public CliTest {
protected:
  void SetUp() override;
  void TearDown() override;

  /// Runs the operation. Files that it writes below out/ are part of the effect, those named
  /// lumen-export.json excepted, which hold the options that were given. Copies of `folders` are
  /// there before.
  [[nodiscard]] Effect effectOf(const Operation& operation,
                                const std::vector<std::string>& folders = {}) const;
  [[nodiscard]] static Operation operationOf(const std::string& command,
                                             std::vector<std::string> arguments,
                                             const Given& options);
  /// The operation with this option, whose other values are dropped.
  [[nodiscard]] static Operation withOption(Operation operation,
                                            const std::pair<std::string, std::string>& option);

  engine::Engine m_engine = cli::allCommands();
  bool m_hasDicom = false;  ///< lumen reads DICOM

private:
  void makeVolumes() const;
  void makeSurfaces() const;
  void makeDicom() const;
  std::filesystem::path m_before;
};

/// An operation, and options that are given in further runs of it.
struct Trial {
  Operation operation;
  Given tried;
};

/// Trials as lines: `command argument... --option value...`, and below it, indented, tried options.
/// A flag has the value true or false.
std::vector<Trial> trialsOf(const std::string& lines);

/// Whether it is the refusal of an option that would do nothing, or excludes another.
bool isRefusal(const std::string& message);

/// A value of each option of track, fit and convert that differs from its default and makes sense
/// for a straight tube.
const std::string& sampleOf(const std::string& option);

}  // namespace lumen::test
