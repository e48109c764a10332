// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/operations.h"

#include <algorithm>
#include <iterator>
#include <string_view>
#include <utility>
#include <vector>

#include "formats/container/printable.h"
#include "viewer/session/document/document_labels.h"
#include "viewer/session/proposals.h"
#include "viewer/session/source_match.h"

namespace lumen::viewer {

namespace {

constexpr std::size_t kMaxIndex = 1U << 20U;  // limit: of any number in a request

Json acceptVolume(Session& session, const Arguments&, const Moment& from) {
  return session.commit("accept " + formats::printable(from.document.labelOf(FileRole::Volume)),
                        from, withAcceptedVolume(from.document));
}

void requireCase(const Moment& from) {
  if (!from.document.value) refuse("there is no case whose places could be ignored");
}

Json ignore(Session& session, const Arguments& request, const Moment& from) {
  requireCase(from);
  const WorkItem item = session.findings.workItem(request.index("item", kMaxIndex));
  return session.commit("ignore a place", from,
                        withIgnored(from.document, item, request.text("reason")));
}

Json stopIgnoring(Session& session, const Arguments& request, const Moment& from) {
  requireCase(from);
  return session.commit("stop ignoring a place", from,
                        withoutIgnored(from.document, request.index("ignored", kMaxIndex)));
}

Json reject(Session& session, const Arguments& request, const Moment& from) {
  const std::vector<bool> chosen = chosenProposals(from.document, request);
  return session.commit(makeTitle("reject", *from.document.proposals, chosen), from,
                        rejected(from.document, chosen));
}

Json changeRole(Session& session, const Arguments& request, const Moment& from) {
  ChangedRole changed = withRole(from.document, request);
  return session.commit(changed.title, from, std::move(changed.document));
}

Json step(Session& session, bool forward) {
  History& history = session.history;
  if (!(forward ? history.redo() : history.undo()))
    refuse(forward ? "nothing to redo" : "nothing to undo");
  session.announce();
  return session.revision();
}

Json undo(Session& session, const Arguments&, const Moment&) {
  return step(session, false);
}

Json redo(Session& session, const Arguments&, const Moment&) {
  return step(session, true);
}

enum class Needs : std::uint8_t {
  Nothing,    ///< it may come while a job works on the document
  NoChange,   ///< no job changes the document
  OneSource,  ///< nor is the case of another volume
};

struct NamedOperation {
  std::string_view name;
  PageOperation* run;
  Needs needs = Needs::NoChange;
};

constexpr NamedOperation kOperations[] = {{"save", save, Needs::Nothing},
                                          {"forget", forget, Needs::Nothing},
                                          {"check", check, Needs::Nothing},
                                          {"compare", compare, Needs::Nothing},
                                          {"measure", measure, Needs::Nothing},
                                          {"undo", undo},
                                          {"redo", redo},
                                          {"open_case", openCase},
                                          {"list_series", listSeries},
                                          {"open_series", openSeries},
                                          {"close_series", closeSeries},
                                          {"reload", reload},
                                          {"recover", recover},
                                          {"close_file", closeFile},
                                          {"accept_volume", acceptVolume},
                                          {"ignore", ignore},
                                          {"unignore", stopIgnoring},
                                          {"track", track, Needs::OneSource},
                                          {"track_from", trackFrom, Needs::OneSource},
                                          {"find", find, Needs::OneSource},
                                          {"accept", accept, Needs::OneSource},
                                          {"reject", reject},
                                          {"role", changeRole},
                                          {"fit", fit}};

}  // namespace

Json runOperation(Session& session, const std::string& op, const Arguments& request,
                  const Moment& from) {
  const auto* const named =
      std::find_if(std::begin(kOperations), std::end(kOperations),
                   [&op](const NamedOperation& operation) { return operation.name == op; });
  const bool isNamed = named != std::end(kOperations);
  if (!isNamed || named->needs != Needs::Nothing) session.jobs.requireNoChange();
  if (isNamed && named->needs == Needs::OneSource) requireOneSource(from.document);
  if (isNamed) return named->run(session, request, from);
  if (auto seeds = changeSeeds(op, request, from.document)) {
    Json answer = session.commit(seeds->title, from, std::move(seeds->document));
    answer["label"] = seeds->label;
    return answer;
  }
  auto correction = viewer::correct(op, request, from.document);
  if (!correction) refuse("there is no operation \"" + op + "\"");
  session.warnOfDropped(correction->change.droppedArrays);
  if (!correction->change.stale.empty()) return refit(session, std::move(*correction), from);
  return session.commit(correction->change.sentence, from, std::move(correction->document));
}

}  // namespace lumen::viewer
