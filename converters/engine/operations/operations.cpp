// SPDX-License-Identifier: Apache-2.0
// The order of the help.
#include "converters/engine/operations/operations.h"

namespace lumen::engine {

Engine makeEngine() {
  Engine engine;
  for (const auto make :
       {makeConvertCommand, makeExportCommand, makeTrackCommand, makeSeedsCommand, makeFitCommand,
        makeMotionCommand, makeTrimCommand, makeEndsCommand, makeNamesCommand, makeInfoCommand,
        makeValidateCommand, makeCompareCommand, makeCheckCommand, makeMeasureCommand,
        makePictureCommand, makeXrayCommand, makeReportCommand, makePhantomCommand})
    engine.add(make);
#ifdef LUMEN_WITH_LIBRARY
  for (const auto make :
       {makeBatchCommand, makeLibraryInitCommand, makeLibraryAddCommand, makeLibraryUpdateCommand,
        makeLibraryRemoveCommand, makeLibraryExtractCommand, makeLibraryListCommand,
        makeLibraryCheckCommand, makeLibrarySignCommand, makeLibraryVerifyCommand,
        makeLibraryIndexCommand, makeLibraryBuildCommand, makeLibrarySampleCommand})
    engine.add(make);
#endif
  return engine;
}

}  // namespace lumen::engine
