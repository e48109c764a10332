// SPDX-License-Identifier: Apache-2.0
// Session: corrections, tracking further, and the vessel under the pointer.
#include <utility>

#include "converters/app/centerline_input.h"
#include "converters/app/stages.h"
#include "converters/common/error.h"
#include "converters/fitting/fit.h"
#include "viewer/session/session.h"

namespace lumen::viewer {

Json Session::editOperation(const std::string& op, const Arguments&, const Moment&) {
  throw Error(ErrorKind::Usage, "there is no operation \"" + op + "\"");
}

Json Session::snap(const Json& request) {
  const Arguments arguments(request);
  const Eigen::Vector3d p = arguments.position("position");
  return {{"found", false}, {"position", {p.x(), p.y(), p.z()}}};
}

Json Session::track(const Arguments&, const Moment& from) {
  if (!from.document.volume || from.document.seeds->empty())
    throw Error(ErrorKind::Usage, "tracking needs a volume and seeds");
  return startJob("tracking", true, [this, from](Progress& progress) {
    app::TrackArguments arguments = m_options.track;
    arguments.seeds = "the seeds";
    auto tracked =
        app::trackSeeds(*from.document.volume, *from.document.seeds, arguments, progress);
    auto value = std::make_shared<formats::Case>(std::move(tracked.result));
    convert::fit(*value, app::fitOptionsFor(*value, m_options.fit.options()), progress);
    Document document = from.document;
    const std::size_t count = value->tree.branches.size();
    document.value = std::move(value);
    commit("track", from, std::move(document));
    return app::counted(count, "vessel", "vessels") + " tracked";
  });
}

}  // namespace lumen::viewer
