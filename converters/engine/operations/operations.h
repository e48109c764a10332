// SPDX-License-Identifier: Apache-2.0
// The commands of this folder, each in the source of its name.
#pragma once

#include <memory>

#include "converters/engine/command.h"

namespace lumen::engine {

std::unique_ptr<Command> makeConvertCommand();
std::unique_ptr<Command> makeExportCommand();
std::unique_ptr<Command> makeTrackCommand();
std::unique_ptr<Command> makeSeedsCommand();
std::unique_ptr<Command> makeFitCommand();
std::unique_ptr<Command> makeMotionCommand();
std::unique_ptr<Command> makeTrimCommand();
std::unique_ptr<Command> makeEndsCommand();
std::unique_ptr<Command> makeNamesCommand();
std::unique_ptr<Command> makeInfoCommand();
std::unique_ptr<Command> makeValidateCommand();
std::unique_ptr<Command> makeCompareCommand();
std::unique_ptr<Command> makeCheckCommand();
std::unique_ptr<Command> makeMeasureCommand();
std::unique_ptr<Command> makePictureCommand();
std::unique_ptr<Command> makeXrayCommand();
std::unique_ptr<Command> makeReportCommand();
std::unique_ptr<Command> makePhantomCommand();
std::unique_ptr<Command> makeBatchCommand();
std::unique_ptr<Command> makeLibraryInitCommand();
std::unique_ptr<Command> makeLibraryAddCommand();
std::unique_ptr<Command> makeLibraryUpdateCommand();
std::unique_ptr<Command> makeLibraryRemoveCommand();
std::unique_ptr<Command> makeLibraryExtractCommand();
std::unique_ptr<Command> makeLibraryListCommand();
std::unique_ptr<Command> makeLibraryCheckCommand();
std::unique_ptr<Command> makeLibrarySignCommand();
std::unique_ptr<Command> makeLibraryVerifyCommand();
std::unique_ptr<Command> makeLibraryIndexCommand();
std::unique_ptr<Command> makeLibraryBuildCommand();
std::unique_ptr<Command> makeLibrarySampleCommand();

}  // namespace lumen::engine
