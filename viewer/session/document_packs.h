// SPDX-License-Identifier: Apache-2.0
// Parts of the document as pages fetch them.
#pragma once

#include <memory>
#include <mutex>
#include <string>

#include "converters/base/progress.h"
#include "viewer/session/document/arguments.h"
#include "viewer/session/document/history.h"
#include "viewer/session/packs/pack.h"
#include "viewer/session/packs/volume_pack.h"
#include "viewer/session/surfaces.h"

namespace lumen::viewer {

/// Keeps the packs of the case and of the volumes until a later moment has other ones. All calls are
/// thread-safe.
class DocumentPacks {
public:
  Tagged casePack(const Moment& now, Progress& progress);
  /// The volume, or with `role` Second the other one, or with Labels the places of labels in the
  /// list; null without it. `tag` names it.
  std::shared_ptr<const VolumePack> volumePack(const Moment& now, FileRole role, std::string& tag);

private:
  struct Packed {
    std::shared_ptr<const convert::Volume> volume;
    std::shared_ptr<const VolumePack> pack;
  };
  std::mutex m_mutex;  ///< guards all that follow
  Tagged m_case;
  Packed m_volume, m_second, m_labels;
};

/// The proposals as a case's pack, without wall points.
Tagged proposalsPack(const Moment& now, Progress& progress);

/// The case as a file.
Tagged caseFile(const Moment& now);

/// The mesh of that number.
Tagged meshPack(const Moment& now, int id);

/// The signed distances of that mesh's vertices to the wall of the case, and their figures.
Tagged deviationPack(const Moment& now, int id, Progress& progress);

/// The distances of a surface's vertices to the truth, and the figures of a comparison with it.
Tagged distancePack(const Moment& now, const std::shared_ptr<const ReadySurface>& surface,
                    const Json& figures, Progress& progress);

}  // namespace lumen::viewer
