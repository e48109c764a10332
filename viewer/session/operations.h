// SPDX-License-Identifier: Apache-2.0
// Operations that pages ask for (viewer/README.md). Each answers {"revision"}, or {"job"} for work
// that takes long. `from` is the document as the page saw it. Each throws Error(Usage) for a request
// that does not fit it, and Conflict. One call at a time.
#pragma once

#include <string>

#include "viewer/session/corrections.h"
#include "viewer/session/session.h"

namespace lumen::viewer {

using PageOperation = Json(Session& session, const Arguments& request, const Moment& from);

/// The operation of that name. Throws as the stages, too.
Json runOperation(Session& session, const std::string& op, const Arguments& request,
                  const Moment& from);

// Files (file_operations.cpp).

/// Looks through dropped files of DICOM: opens their only series, or lets pages choose.
PageOperation listSeries;
/// One of the listed series, as the volume or as the second one.
PageOperation openSeries;
PageOperation closeSeries;
/// Opens a case of the library in place of all that is open.
PageOperation openCase;
PageOperation reload;
PageOperation closeFile;
PageOperation save;
/// Takes the unsaved work of an earlier program, or removes it.
PageOperation recover;
PageOperation forget;

// Stages of the chain as jobs (stage_jobs.cpp).

PageOperation track;
/// Places a seed and tracks it, as one change.
PageOperation trackFrom;
/// Finds the vessels that the case lacks: they become the proposals.
PageOperation find;
/// Makes vessels of proposals, and fits them.
PageOperation accept;
/// Fits all models anew.
PageOperation fit;
PageOperation check;
PageOperation compare;
PageOperation measure;
/// Fits the stale models of a correction, and then commits it.
Json refit(Session& session, Correction correction, const Moment& from);

}  // namespace lumen::viewer
