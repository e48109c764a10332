// SPDX-License-Identifier: Apache-2.0
#include "converters/operations/pictures_of.h"

#include <algorithm>
#include <numbers>

#include "converters/operations/naming.h"

namespace lumen::operations {

void picturesOf(const formats::Case& value, const std::string& name, const PicturesOptions& options,
                const std::function<void(const convert::Picture&)>& take, const Context& context) {
  Progress& progress = context.progress;
  convert::CasePainter painter = naming(name, [&] { return convert::CasePainter(value); });
  if (options.behind)
    naming(options.behindName, [&] { painter.setVolume(*options.behind, progress); });
  convert::PictureOptions picture = options.picture;
  picture.allTurns = options.turns > 0;
  const int count = std::max(1, options.turns);
  progress.detail("drawing " + std::to_string(count) + " of " + std::to_string(picture.width) +
                  " by " + std::to_string(picture.height) + " pixels");
  progress.begin("pictures", static_cast<std::size_t>(count));
  for (int turn = 0; turn < count; ++turn) {
    picture.turn = 2 * std::numbers::pi * turn / count;
    take(naming(name, [&] { return painter.draw(picture, progress); }));
    progress.advance();
  }
  progress.end();
}

}  // namespace lumen::operations
