// SPDX-License-Identifier: Apache-2.0
// The page and its data as one file, which opens from disk and uses no network.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "viewer/session/session.h"

namespace lumen::viewer {

// The files of the page, which are built apart from the program and lie beside it.

struct PageFile {
  std::string type;  ///< media type
  std::string bytes;
};

/// Files by the name that the page asks for; "" is the page itself.
using PageFiles = std::map<std::string, PageFile>;

/// share/lumen/viewer of the installation that the running program is in, or that of its build
/// folder. Empty if the page is in neither.
std::filesystem::path findPageFolder();

/// Reads the files in findPageFolder(). Empty if there is none.
PageFiles findPageFiles();

/// A page with instructions, for a build without the page.
extern const char* const kNoPage;

struct HtmlOptions {
  bool volume = false;  ///< the volume too: around the case, with 8 bits a voxel
  bool points = false;  ///< the wall points too, which are most of a case
  int level = 0;        ///< level of the surface: see Surfaces
};

/// "volume", "points" and "level". Throws Error(Usage) for others.
HtmlOptions htmlOptions(const SavingOptions& options);

/// The page with everything in it. Throws Error(Failed) if the page was not built, Error(Usage) if
/// there is nothing to show, and Error(Cancelled).
std::string htmlPage(Session& session, const PageFiles& page, const HtmlOptions& options,
                     Progress& progress);

/// The page of a case in memory, called `name`, as `lumen view --html` makes it of a file. Throws as
/// htmlPage(), and Error(InvalidInput) for bytes that are no case.
std::string pageOfCase(std::string_view bytes, const std::string& name, Progress& progress);

}  // namespace lumen::viewer
