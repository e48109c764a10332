// SPDX-License-Identifier: Apache-2.0
// Operations that pages ask for.
#pragma once

#include <memory>
#include <mutex>
#include <string>

#include "viewer/session/file_operations.h"
#include "viewer/session/stage_jobs.h"
#include "viewer/session/workspace.h"

namespace lumen::viewer {

/// Takes requests one at a time: no other request comes between the look at the document and the
/// change of it, or the start of the job that will change it. All calls are thread-safe.
class Operations {
public:
  explicit Operations(Workspace& workspace)
      : m_workspace(workspace), m_files(workspace), m_stages(workspace) {}

  /// Runs the operation of a request (viewer/README.md): {"revision"} or {"job"}. Throws Conflict,
  /// Error(Usage) for a request that does not fit the document, and as the stages.
  Json run(formats::JsonValue request);
  /// Opens a dropped file as a job: {"job"}.
  Json openDropped(std::shared_ptr<const DroppedFile> file, const std::string& label, OpenAs as);

private:
  Json change(const std::string& op, const Arguments& request, const Moment& from);
  Json acceptVolume(const Moment& from);
  /// Ignores a place of the check, or stops ignoring one.
  Json decide(const std::string& op, const Arguments& request, const Moment& from);
  Json reject(const Arguments& request, const Moment& from);
  Json step(bool forward);

  Workspace& m_workspace;
  FileOperations m_files;
  StageJobs m_stages;
  std::mutex m_gate;  ///< held while a request is taken, not while its job runs
};

}  // namespace lumen::viewer
