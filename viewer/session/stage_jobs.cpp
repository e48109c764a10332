// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/stage_jobs.h"

#include <string>
#include <tuple>
#include <utility>

#include "converters/base/error.h"
#include "converters/base/text.h"
#include "converters/engine/answers/answer_text.h"
#include "converters/engine/answers/check_answer.h"
#include "converters/judge/compare/compare.h"
#include "converters/operations/case_of.h"
#include "converters/operations/check_of.h"
#include "converters/operations/measures_of.h"
#include "converters/stages/fitting/fit.h"
#include "viewer/session/corrections.h"
#include "viewer/session/proposals.h"
#include "viewer/session/vessel_tracking.h"
#include "viewer/session/work_list.h"

namespace lumen::viewer {

namespace {

/// Adds to each missing vessel of `answer` the clicks from which it is tracked.
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

Json StageJobs::track(const Arguments& request, const Moment& from) {
  if (!from.document.volume) throw Error(ErrorKind::Usage, "tracking needs a volume");
  const Seeds seeds = untrackedSeeds(from.document, request);
  if (seeds.empty()) throw Error(ErrorKind::Usage, "there is no seed that is not tracked yet");
  return trackSeeds(seeds, from);
}

Json StageJobs::trackFrom(const Arguments& request, Moment from) {
  if (!from.document.volume) throw Error(ErrorKind::Usage, "tracking needs a volume");
  from.document = changeSeeds("seedAdd", request, from.document)->document;
  return trackSeeds({from.document.seeds->back()}, from);
}

Json StageJobs::trackSeeds(const Seeds& seeds, const Moment& from) {
  Workspace& workspace = m_workspace;
  return workspace.startJob("tracking", true, [&workspace, from, seeds](Progress& progress) {
    TrackedCase tracked =
        trackUntracked(from.document, seeds, workspace.tracking, workspace.options, progress);
    Document document = from.document;
    document.value = std::move(tracked.value);
    document.proposals = proposalsFor(document, document.proposals);
    const std::string title =
        "track " +
        (seeds.size() == 1 ? seeds.front().label : counted(seeds.size(), "seed", "seeds"));
    workspace.commit(title, from, std::move(document));
    workspace.warnOfDropped(tracked.droppedArrays);
    return counted(tracked.newVessels, "vessel", "vessels") + " tracked";
  });
}

Json StageJobs::find(const Moment& from) {
  if (!from.document.volume) throw Error(ErrorKind::Usage, "there is no volume to find vessels in");
  Workspace& workspace = m_workspace;
  return workspace.startJob("finding vessels", true, [&workspace, from](Progress& progress) {
    Document document = from.document;
    document.proposals =
        findProposals(document, workspace.tracking, workspace.options.track.options, progress);
    if (document.proposals || from.document.proposals)
      workspace.commit("find vessels", from, document);
    if (!document.proposals) return std::string("no vessel is found that the case lacks");
    return counted(document.proposals->tree.branches.size(), "vessel is", "vessels are") +
           " proposed: accept or reject them";
  });
}

Json StageJobs::accept(const Arguments& request, const Moment& from) {
  Workspace& workspace = m_workspace;
  Acceptance acceptance = accepted(from.document, chosenProposals(from.document, request));
  return workspace.startJob(
      "fitting", true, [&workspace, from, acceptance](Progress& progress) mutable {
        formats::Case& value = *acceptance.value;
        if (acceptance.firstNewNode == 0)
          value = operations::fitted(std::move(value), {workspace.options.fit},
                                     engine::operationContext(progress));
        else
          fitNewNodes(value, *from.document.value, acceptance.firstNewNode, progress);
        workspace.commit(acceptance.title, from, acceptance.document);
        workspace.warnOfDropped(acceptance.droppedArrays);
        return counted(acceptance.count, "vessel", "vessels") + " accepted";
      });
}

Json StageJobs::fit(const Moment& from) {
  if (!from.document.value || !from.document.value->points)
    throw Error(ErrorKind::Usage, "there are no wall points to fit to");
  Workspace& workspace = m_workspace;
  return workspace.startJob("fitting", true, [&workspace, from](Progress& progress) {
    auto value = std::make_shared<formats::Case>(*from.document.value);
    *value = operations::fitted(std::move(*value), {workspace.options.fit},
                                engine::operationContext(progress));
    Document document = from.document;
    document.value = std::move(value);
    workspace.commit("fit", from, std::move(document));
    return std::string("every node has its model");
  });
}

Json StageJobs::refit(Correction correction, const Moment& from) {
  Workspace& workspace = m_workspace;
  return workspace.startJob(
      "fitting what changed", true, [&workspace, from, correction](Progress& progress) {
        const auto& [change, value, document] = correction;
        convert::refit(*value, change.stale, convert::recordedFitOptions(*value), progress);
        workspace.commit(change.sentence, from, document);
        return change.sentence;
      });
}

Json StageJobs::check(const Moment& from) {
  if (!from.document.volume || !from.document.hasModels())
    throw Error(ErrorKind::Usage, "a check needs a volume and a case with models");
  Workspace& workspace = m_workspace;
  return workspace.startJob("checking", false, [&workspace, from](Progress& progress) {
    const auto value = from.document.value;
    const convert::Volume& volume = *from.document.volume;
    const operations::Checked made = operations::checked(
        *value, volume, *from.document.volumeSource, {}, engine::operationContext(progress));
    Json answer = engine::checkJson(made.report, value->tree, made.source.word());
    addClicks(answer, made.report.missing);
    std::vector<WorkItem> work =
        listWork(*value, made.report, convert::measureReach(*value, progress), volume.geometry);
    const std::size_t places = work.size();
    workspace.findings.setCheck(std::move(answer), std::move(work), value);
    return places == 0 ? "the check found nothing to do"
                       : "the check lists " + counted(places, "place", "places") + " to look at";
  });
}

Json StageJobs::compare(const Moment& from) {
  if (!from.document.value || !from.document.truth)
    throw Error(ErrorKind::Usage, "a comparison needs a case and a truth");
  Workspace& workspace = m_workspace;
  return workspace.startJob("comparing", false, [&workspace, from](Progress& progress) {
    const auto& [value, truth] = std::tie(from.document.value, from.document.truth);
    const auto comparison = convert::compareCases(*value, *truth, progress);
    workspace.findings.setFigures(engine::comparisonJson(comparison), value, truth);
    return std::string("compared");
  });
}

Json StageJobs::measure(const Moment& from) {
  if (!from.document.value) throw Error(ErrorKind::Usage, "there is no case to measure");
  Workspace& workspace = m_workspace;
  return workspace.startJob("measuring", false, [&workspace, from](Progress& progress) {
    operations::CaseMeasures measures =
        operations::measuresOf(*from.document.value, {}, engine::operationContext(progress));
    workspace.findings.setMeasures(from.document.labelOf(FileRole::Case),
                                   std::move(measures.tables), from.document.value);
    return counted(measures.values.vessels.size(), "branch is", "branches are") + " measured";
  });
}

}  // namespace lumen::viewer
