// SPDX-License-Identifier: Apache-2.0
// edit_request.h: corrections of one case, made again in another.
#include <algorithm>
#include <string_view>

#include "converters/base/error.h"
#include "converters/base/options/edit_steps.h"
#include "converters/stages/editing/edit_request.h"

namespace lumen::convert {

namespace {

constexpr std::string_view kNotMade = "not made again: ";

bool holdsSentence(const formats::Metadata& metadata, const std::string& sentence) {
  const std::vector<RecordedEdit> edits = recordedEdits(metadata);
  return std::any_of(edits.begin(), edits.end(),
                     [&](const RecordedEdit& edit) { return edit.sentence == sentence; });
}

/// The sentence of a change that an earlier replay could not make.
std::string withoutMark(const std::string& sentence) {
  return sentence.starts_with(kNotMade) ? sentence.substr(kNotMade.size()) : sentence;
}

}  // namespace

ReplayedEdits replayEdits(const formats::Case& corrected, formats::Case& target) {
  ReplayedEdits done;
  const auto leave = [&](const RecordedEdit& edit, const std::string& why) {
    const std::string sentence = withoutMark(edit.sentence);
    done.left.push_back({sentence, why});
    recordEdit(target.metadata, std::string(kNotMade) + sentence);
    if (!edit.request.empty()) recordRequest(target.metadata, edit.request);
  };
  for (const RecordedEdit& edit : recordedEdits(corrected.metadata)) {
    if (edit.request.empty()) {
      if (!holdsSentence(target.metadata, edit.sentence))
        leave(edit, "this kind of change keeps no request");
      continue;
    }
    try {
      done.made.push_back(applyEdit(target, requestInTree(edit.request, target.tree)).sentence);
    } catch (const Error& error) {
      leave(edit, error.what());
    }
  }
  return done;
}

}  // namespace lumen::convert
