// SPDX-License-Identifier: Apache-2.0
// operations.h: stages of the chain as jobs.

#include <string>
#include <tuple>
#include <utility>

#include "converters/base/text.h"
#include "converters/engine/answers/answer_text.h"
#include "converters/engine/answers/check_answer.h"
#include "converters/judge/compare/compare.h"
#include "converters/operations/case_of.h"
#include "converters/operations/check_of.h"
#include "converters/operations/measures_of.h"
#include "converters/stages/fitting/fit.h"
#include "viewer/session/operations.h"
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
    for (const Eigen::Vector3d& point : clicks.points) points.push_back(engine::vectorJson(point));
    answer["missing_vessels"][i]["clicks"] = {
        {"points", std::move(points)}, {"radius_mm", clicks.radius}, {"beside", clicks.beside}};
  }
}

Json trackSeeds(Session& session, const Seeds& seeds, const Moment& from) {
  return session.startJob("tracking", true, [&session, from, seeds](Progress& progress) {
    TrackedCase tracked =
        trackUntracked(from.document, seeds, session.tracking, session.options, progress);
    Document document = from.document;
    document.value = std::move(tracked.value);
    document.proposals = proposalsFor(document, document.proposals);
    const std::string title =
        "track " +
        (seeds.size() == 1 ? seeds.front().label : counted(seeds.size(), "seed", "seeds"));
    session.commit(title, from, std::move(document));
    session.warnOfDropped(tracked.droppedArrays);
    return counted(tracked.newVessels, "vessel", "vessels") + " tracked";
  });
}

}  // namespace

Json track(Session& session, const Arguments& request, const Moment& from) {
  if (!from.document.volume) refuse("tracking needs a volume");
  const Seeds seeds = untrackedSeeds(from.document, request);
  if (seeds.empty()) refuse("there is no seed that is not tracked yet");
  return trackSeeds(session, seeds, from);
}

Json trackFrom(Session& session, const Arguments& request, const Moment& from) {
  if (!from.document.volume) refuse("tracking needs a volume");
  Moment seeded = from;
  seeded.document = changeSeeds("seed_add", request, from.document)->document;
  return trackSeeds(session, {seeded.document.seeds->back()}, seeded);
}

Json find(Session& session, const Arguments&, const Moment& from) {
  if (!from.document.volume) refuse("there is no volume to find vessels in");
  return session.startJob("finding vessels", true, [&session, from](Progress& progress) {
    Document document = from.document;
    document.proposals = findProposals(document, session.tracking, session.options, progress);
    if (document.proposals || from.document.proposals)
      session.commit("find vessels", from, document);
    if (!document.proposals) return std::string("no vessel is found that the case lacks");
    return counted(document.proposals->tree.branches.size(), "vessel is", "vessels are") +
           " proposed: accept or reject them";
  });
}

Json accept(Session& session, const Arguments& request, const Moment& from) {
  Acceptance acceptance = accepted(from.document, chosenProposals(from.document, request));
  return session.startJob(
      "fitting", true, [&session, from, acceptance](Progress& progress) mutable {
        formats::Case& value = *acceptance.value;
        if (acceptance.firstNewNode == 0)
          value = operations::fitted(std::move(value), {session.options.fit},
                                     engine::operationContext(progress));
        else
          fitNewNodes(value, *from.document.value, acceptance.firstNewNode, progress);
        session.commit(acceptance.title, from, acceptance.document);
        session.warnOfDropped(acceptance.droppedArrays);
        return counted(acceptance.count, "vessel", "vessels") + " accepted";
      });
}

Json fit(Session& session, const Arguments&, const Moment& from) {
  if (!from.document.value || !from.document.value->points)
    refuse("there are no wall points to fit to");
  return session.startJob("fitting", true, [&session, from](Progress& progress) {
    auto value = std::make_shared<formats::Case>(*from.document.value);
    *value = operations::fitted(std::move(*value), {session.options.fit},
                                engine::operationContext(progress));
    Document document = from.document;
    document.value = std::move(value);
    session.commit("fit", from, std::move(document));
    return std::string("every node has its model");
  });
}

Json refit(Session& session, Correction correction, const Moment& from) {
  return session.startJob(
      "fitting what changed", true, [&session, from, correction](Progress& progress) {
        const auto& [change, value, document] = correction;
        convert::refit(*value, change.stale, convert::recordedFitOptions(*value), progress);
        session.commit(change.sentence, from, document);
        return change.sentence;
      });
}

Json check(Session& session, const Arguments&, const Moment& from) {
  if (!from.document.volume || !from.document.hasModels())
    refuse("a check needs a volume and a case with models");
  return session.startJob("checking", false, [&session, from](Progress& progress) {
    const auto value = from.document.value;
    const convert::Volume& volume = *from.document.volume;
    const operations::Checked made = operations::checked(
        *value, volume, *from.document.volumeSource, {}, engine::operationContext(progress));
    Json answer = engine::checkJson(made.report, value->tree, made.source.word());
    addClicks(answer, made.report.missing);
    std::vector<WorkItem> work =
        listWork(*value, made.report, convert::measureReach(*value, progress), volume.geometry);
    const std::size_t places = work.size();
    session.findings.setCheck(std::move(answer), std::move(work), value);
    return places == 0 ? "the check found nothing to do"
                       : "the check lists " + counted(places, "place", "places") + " to look at";
  });
}

Json compare(Session& session, const Arguments&, const Moment& from) {
  if (!from.document.value || !from.document.truth) refuse("a comparison needs a case and a truth");
  return session.startJob("comparing", false, [&session, from](Progress& progress) {
    const auto& [value, truth] = std::tie(from.document.value, from.document.truth);
    const auto comparison = convert::compareCases(*value, *truth, progress);
    session.findings.setFigures(engine::comparisonJson(comparison), value, truth);
    return std::string("compared");
  });
}

Json measure(Session& session, const Arguments&, const Moment& from) {
  if (!from.document.value) refuse("there is no case to measure");
  return session.startJob("measuring", false, [&session, from](Progress& progress) {
    operations::CaseMeasures measures =
        operations::measuresOf(*from.document.value, {}, engine::operationContext(progress));
    session.findings.setMeasures(from.document.labelOf(FileRole::Case), std::move(measures.tables),
                                 from.document.value);
    return counted(measures.values.vessels.size(), "branch is", "branches are") + " measured";
  });
}

}  // namespace lumen::viewer
