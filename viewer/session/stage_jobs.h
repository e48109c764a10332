// SPDX-License-Identifier: Apache-2.0
// Stages of the chain as jobs: tracking, fitting, checks, comparisons and measures.
#pragma once

#include "viewer/session/corrections.h"
#include "viewer/session/workspace.h"

namespace lumen::viewer {

/// Each call checks what its stage needs, starts a job and answers {"job"}. Throws Error(Usage),
/// and Conflict while another job runs. One call at a time.
class StageJobs {
public:
  explicit StageJobs(Workspace& workspace) : m_workspace(workspace) {}

  Json track(const Arguments& request, const Moment& from);
  /// Places a seed and tracks it, as one change.
  Json trackFrom(const Arguments& request, Moment from);
  /// Finds the vessels that the case lacks: they become the proposals.
  Json find(const Moment& from);
  /// Makes vessels of proposals, and fits them.
  Json accept(const Arguments& request, const Moment& from);
  /// Fits all models anew.
  Json fit(const Moment& from);
  /// Fits the stale models of a correction, and then commits it.
  Json refit(Correction correction, const Moment& from);
  Json check(const Moment& from);
  Json compare(const Moment& from);
  /// Measures the case.
  Json measure(const Moment& from);

private:
  Json trackSeeds(const Seeds& seeds, const Moment& from);

  Workspace& m_workspace;
};

}  // namespace lumen::viewer
