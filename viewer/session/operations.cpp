// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/operations.h"

#include <utility>
#include <vector>

#include "converters/base/error.h"
#include "formats/container/printable.h"
#include "viewer/session/corrections.h"
#include "viewer/session/proposals.h"
#include "viewer/session/source_match.h"

namespace lumen::viewer {

Json Operations::run(formats::JsonValue request) {
  const Arguments arguments(request);
  const std::string op = arguments.text("op");
  const std::lock_guard gate(m_gate);
  const Moment from = m_workspace.momentFor(arguments);
  if (op == "save") return m_files.save(arguments, from);
  if (op == "forget") return m_files.forget(arguments);
  if (op == "check") return m_stages.check(from);
  if (op == "compare") return m_stages.compare(from);
  if (op == "measure") return m_stages.measure(from);
  m_workspace.jobs.requireNoChange();
  return change(op, arguments, from);
}

Json Operations::openDropped(std::shared_ptr<const DroppedFile> file, const std::string& label,
                             OpenAs as) {
  const std::lock_guard gate(m_gate);
  return m_files.openDropped(std::move(file), label, as);
}

Json Operations::change(const std::string& op, const Arguments& request, const Moment& from) {
  if (op == "undo" || op == "redo") return step(op == "redo");
  if (op == "openCase") return m_files.openCase(request);
  if (op == "listSeries") return m_files.listSeries(request);
  if (op == "openSeries") return m_files.openSeries(request);
  if (op == "closeSeries") return m_files.closeSeries();
  if (op == "reload") return m_files.reload(request, from);
  if (op == "recover") return m_files.recover(request, from);
  if (op == "closeFile") return m_files.close(request, from);
  if (op == "acceptVolume") return acceptVolume(from);
  if (op == "ignore" || op == "unignore") return decide(op, request, from);
  if (op == "track" || op == "trackFrom" || op == "find" || op == "accept") {
    requireOneSource(from.document);
    if (op == "track") return m_stages.track(request, from);
    if (op == "trackFrom") return m_stages.trackFrom(request, from);
    if (op == "find") return m_stages.find(from);
    return m_stages.accept(request, from);
  }
  if (op == "reject") return reject(request, from);
  if (op == "fit") return m_stages.fit(from);
  if (auto seeds = changeSeeds(op, request, from.document)) {
    m_workspace.commit(seeds->title, from, std::move(seeds->document));
    Json answer = m_workspace.revision();
    answer["label"] = seeds->label;
    return answer;
  }
  if (auto correction = viewer::correct(op, request, from.document)) {
    m_workspace.warnOfDropped(correction->change.droppedArrays);
    if (!correction->change.stale.empty()) return m_stages.refit(std::move(*correction), from);
    m_workspace.commit(correction->change.sentence, from, std::move(correction->document));
    return m_workspace.revision();
  }
  throw Error(ErrorKind::Usage, "there is no operation \"" + op + "\"");
}

Json Operations::acceptVolume(const Moment& from) {
  m_workspace.commit("accept " + formats::printable(from.document.labelOf(FileRole::Volume)), from,
                     withAcceptedVolume(from.document));
  return m_workspace.revision();
}

Json Operations::decide(const std::string& op, const Arguments& request, const Moment& from) {
  if (!from.document.value) refuse("there is no case whose places could be ignored");
  constexpr std::size_t kMaxIndex = 1U << 20U;  // limit: of any number in a request
  if (op == "unignore") {
    m_workspace.commit("stop ignoring a place", from,
                       withoutIgnored(from.document, request.index("ignored", kMaxIndex)));
    return m_workspace.revision();
  }
  const WorkItem item = m_workspace.findings.workItem(request.index("item", kMaxIndex));
  m_workspace.commit("ignore a place", from,
                     withIgnored(from.document, item, request.text("reason")));
  return m_workspace.revision();
}

Json Operations::reject(const Arguments& request, const Moment& from) {
  const std::vector<bool> chosen = chosenProposals(from.document, request);
  m_workspace.commit(makeTitle("reject", *from.document.proposals, chosen), from,
                     rejected(from.document, chosen));
  return m_workspace.revision();
}

Json Operations::step(bool forward) {
  History& history = m_workspace.history;
  if (!(forward ? history.redo() : history.undo()))
    throw Error(ErrorKind::Usage, forward ? "nothing to redo" : "nothing to undo");
  m_workspace.announce();
  return m_workspace.revision();
}

}  // namespace lumen::viewer
