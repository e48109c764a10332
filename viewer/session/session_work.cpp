// SPDX-License-Identifier: Apache-2.0
// Session: operations.
#include <tuple>
#include <utility>

#include "converters/base/error.h"
#include "converters/base/text.h"
#include "converters/engine/centerline_input.h"
#include "converters/engine/check_report.h"
#include "converters/engine/comparison_report.h"
#include "converters/engine/stages.h"
#include "converters/io/volume/write_volume.h"
#include "converters/judge/compare/compare.h"
#include "converters/stages/fitting/fit.h"
#include "viewer/session/session.h"

namespace lumen::viewer {

namespace {

/// Where to click for each missing vessel of `answer`, so that it is tracked.
void addClicks(Json& answer, const convert::Missing& missing) {
  for (std::size_t i = 0; i < missing.vessels.size(); ++i) {
    const convert::Clicks clicks = convert::clicksOn(missing.vessels[i]);
    Json points = Json::array();
    for (const Eigen::Vector3d& p : clicks.points) points.push_back({p.x(), p.y(), p.z()});
    answer["missing_vessels"][i]["clicks"] = {
        {"points", std::move(points)}, {"radius", clicks.radius}, {"beside", clicks.beside}};
  }
}

}  // namespace

void Session::commit(const std::string& name, const Moment& from, Document document) {
  if (!m_history.commit(name, from.revision, std::move(document)))
    throw Conflict("the document has changed meanwhile; look, and try again");
  changed();
}

Moment Session::momentFor(const Arguments& request) const {
  Moment now = m_history.now();
  const std::int64_t seen = request.whole("revision");
  if (seen < 0 || static_cast<std::uint64_t>(seen) != now.revision)
    throw Conflict("the document has changed meanwhile; look, and try again");
  return now;
}

void Session::requireIdle() const {
  const auto running = m_jobs.running();
  const std::lock_guard lock(m_mutex);
  if (running && m_jobChanges)
    throw Conflict("busy with " + running->name + "; wait for its end, or cancel it");
}

Json Session::startJob(const std::string& name, bool changes, JobRunner::Work work) {
  if (const auto running = m_jobs.running())
    throw Conflict("busy with " + running->name + "; wait for its end, or cancel it");
  {
    const std::lock_guard lock(m_mutex);
    m_jobChanges = changes;
  }
  return {{"job", m_jobs.start(name, std::move(work))}};
}

void Session::cancelAll() {
  m_jobs.cancelAll();
  m_surfaces.allow(false);
}

Json Session::step(bool forward) {
  const auto name = forward ? m_history.redo() : m_history.undo();
  if (!name) throw Error(ErrorKind::Usage, forward ? "nothing to redo" : "nothing to undo");
  changed();
  return {{"revision", m_history.now().revision}};
}

Json Session::run(formats::JsonValue request) {
  const Arguments arguments(request);
  const std::string op = arguments.text("op");
  if (op == "save") return save(arguments);
  const Moment from = momentFor(arguments);
  if (op == "forget") return forget(arguments);
  if (op == "check") return check(from);
  if (op == "compare") return compare(from);
  requireIdle();
  if (op == "undo" || op == "redo") return step(op == "redo");
  if (op == "openCase") return openCase(arguments);
  if (op == "reload") return reload(arguments, from);
  if (op == "recover") return recover(arguments, from);
  if (op == "closeFile") {
    commit("close a file", from,
           withoutFile(from.document, static_cast<int>(arguments.index("id", 1U << 30))));
    return {{"revision", m_history.now().revision}};
  }
  if (op == "track") return track(arguments, from);
  if (op == "fit") return fit(from);
  if (op.starts_with("seed")) return seedOperation(op, arguments, from);
  return editOperation(op, arguments, from);
}

Json Session::fit(const Moment& from) {
  if (!from.document.value || !from.document.value->points)
    throw Error(ErrorKind::Usage, "there are no wall points to fit to");
  return startJob("fitting", true, [this, from](Progress& progress) {
    auto value = std::make_shared<formats::Case>(*from.document.value);
    convert::fit(*value, app::fitOptionsFor(*value, m_options.fit.options()), progress);
    Document document = from.document;
    document.value = std::move(value);
    commit("fit", from, std::move(document));
    return std::string("every node has its model");
  });
}

Json Session::check(const Moment& from) {
  if (!from.document.volume || !from.document.hasModels())
    throw Error(ErrorKind::Usage, "a check needs a volume and a case with models");
  return startJob("checking", false, [this, from](Progress& progress) {
    const auto& [volume, value] = std::tie(from.document.volume, from.document.value);
    std::string source = "unknown";
    if (value->metadata.source) {
      const auto difference =
          convert::sourceDifference(convert::describeSource(*volume), *value->metadata.source);
      source = difference ? "other " + difference->what : "same";
    }
    const auto result =
        convert::checkCase(*volume, *value, convert::recordedEdgeOptions(*value), progress);
    Json answer = app::checkJson(result.report, value->tree, source);
    addClicks(answer, result.report.missing);
    const std::size_t missing = result.report.missing.vessels.size();
    const std::lock_guard lock(m_mutex);
    m_check = std::move(answer);
    m_checkedCase = value;
    return missing == 0 ? std::string("the check found no vessel that is missing")
                        : counted(missing, "vessel", "vessels") + " of the volume " +
                              (missing == 1 ? "is" : "are") + " missing";
  });
}

Json Session::compare(const Moment& from) {
  if (!from.document.value || !from.document.truth)
    throw Error(ErrorKind::Usage, "a comparison needs a case and a truth");
  return startJob("comparing", false, [this, from](Progress& progress) {
    const auto comparison =
        convert::compareCases(*from.document.value, *from.document.truth, progress);
    const std::lock_guard lock(m_mutex);
    m_figures = app::comparisonJson(comparison);
    m_comparedCase = from.document.value;
    m_comparedTruth = from.document.truth;
    return std::string("compared");
  });
}

}  // namespace lumen::viewer
