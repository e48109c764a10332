// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/session.h"

#include <utility>

#include "viewer/session/vessel_tracking.h"

namespace lumen::viewer {

void Session::openLibrary(CaseList list) {
  m_workspace.library.open(std::move(list), [this] { m_workspace.announceState(); });
}

void Session::lookAtFiles() {
  if (m_workspace.changedFiles.look(now().document)) m_workspace.announceState();
}

Tagged Session::surfacePack(int level, bool quick) {
  Surfaces& surfaces = m_workspace.surfaces;
  const auto surface = quick ? surfaces.quick() : surfaces.get(level);
  if (!surface) return {};
  return {surface->tag, {surface, &surface->pack}};
}

Tagged Session::finishedSurface(int level, const Progress& progress) {
  m_workspace.surfaces.waitFor(level, progress);
  return surfacePack(level, false);
}

Tagged Session::distancePack(int level, bool quick, Progress& progress) {
  const Moment moment = now();
  if (!moment.document.truth) return {};
  Surfaces& surfaces = m_workspace.surfaces;
  return viewer::distancePack(moment, quick ? surfaces.quick() : surfaces.get(level),
                              m_workspace.findings.figures(moment.document), progress);
}

std::string Session::encoded(const std::string& format, const SavingOptions& options,
                             Progress& progress) {
  return viewer::encoded(now().document, format, options, m_workspace.options, progress);
}

Json Session::vesselAtClick(formats::JsonValue request) {
  const Arguments arguments(request);
  return vesselNear(arguments.position("position"), now().document, m_workspace.tracking,
                    m_workspace.options.track.options);
}

void Session::cancelAll() {
  m_workspace.jobs.cancelAll();
  m_workspace.surfaces.allow(false);
}

}  // namespace lumen::viewer
