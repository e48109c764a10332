# SPDX-License-Identifier: Apache-2.0
"""Plausible faults of one line each, and the test that must find each; planted by plant.py.

A fault is found if its test fails, or no longer compiles. A line that moves to another file is changed here, too.
"""
from typing import NamedTuple


class Fault(NamedTuple):
    what: str    # what is wrong afterwards
    file: str    # from the repository's root
    before: str  # text that the file has exactly once
    after: str   # what it is replaced by
    target: str  # the test program
    cases: str = "*"  # of the program, as --gtest_filter takes them


FAULTS = [
    # formats
    Fault("a branch begins at its own radius, not at its parent's wall", "formats/case/topology.cpp",
          "length - double{tree.radius[parent]}", "length - double{tree.radius[node]}", "formats_test"),
    Fault("the same link may be there twice", "formats/view/tree_rules.cpp",
          "view.links[i - 1] >= view.links[i]", "view.links[i - 1] > view.links[i]", "formats_test"),
    Fault("an extension stays required when its array is gone", "formats/case/node_words.cpp",
          "  std::erase(value.metadata.extensionsRequired, extension);\n", "", "formats_test"),
    Fault("bits behind the end of base64 are passed over", "formats/json/base64.cpp",
          "if (bytes[i] != std::byte{0}) return std::nullopt;", "if (bytes[i] != bytes[i]) return std::nullopt;",
          "formats_test"),
    Fault("steps along an edge are those of the wider node", "formats/case/reachability.cpp",
          "double{std::min(m_tree.radius[node], m_tree.radius[parent])}",
          "double{std::max(m_tree.radius[node], m_tree.radius[parent])}", "formats_test"),
    Fault("a node borrows blobs from the node beside it, which has none", "formats/field/neighbourhood.cpp",
          "lender[node] = lender[queue[head]];", "lender[node] = queue[head];", "field_test"),
    Fault("the plane between two nodes lies on the wrong side of the middle", "formats/field/radical_disc.cpp",
          "0.5 * (1.0 + (ra * ra - rb * rb) / square)", "0.5 * (1.0 - (ra * ra - rb * rb) / square)", "field_test"),
    # libblob
    Fault("a segment downward along z is clipped at the wrong ends", "libblob/src/segment.cpp",
          "if (delta < 0) std::swap(enter, leave);", "if (delta < 0 && i < 2) std::swap(enter, leave);", "blob_test"),
    Fault("two entries of the Hessian are exchanged in the curvature", "libblob/src/hessian.cpp",
          "h[4] * g[0] + h[5] * g[1] + h[2] * g[2]", "h[5] * g[0] + h[4] * g[1] + h[2] * g[2]", "blob_test"),
    Fault("the second node of a link is not checked", "libblob/src/build_model.cpp",
          "def.link[i][0] >= count || def.link[i][1] >= count", "def.link[i][0] >= count || def.link[i][0] >= count",
          "blob_test"),
    Fault("a box of nodes knows the radius of its last node only", "libblob/src/locate.cpp",
          "radius = std::max(radius, greatest);", "radius = greatest;", "blob_test"),
    # readers
    Fault("a file's coordinate system overrules --seeds-frame", "converters/io/seeds/seeds_fcsv.cpp",
          'if (key != "coordinatesystem" || m_reading.system) return;', 'if (key != "coordinatesystem") return;',
          "seeds_test"),
    Fault("a doubled quotation mark ends a label", "converters/io/seeds/seeds_fcsv.cpp",
          "      fields.back() += '\"';\n      ++i;\n", "      ++i;\n", "seeds_test"),
    Fault("names of vessels begin with a space", "converters/io/centerline/read_swc.cpp",
          "m_vessels[id] = text.substr(used + 1);", "m_vessels[id] = text.substr(used);", "centerline_test"),
    Fault("axes of space left-anterior-superior are flipped in x", "converters/io/volume/nrrd_geometry.cpp",
          "space.toLps = Vector3d(1, -1, 1);", "space.toLps = Vector3d(-1, -1, 1);", "volume_test"),
    Fault("a quaternion that is too long is read", "converters/io/volume/nifti_geometry.cpp",
          "if (!quaternion.allFinite() || quaternion.norm() > kLongQuaternion)", "if (!quaternion.allFinite())",
          "volume_test"),
    Fault("a round cone ends too early at its thinner end", "converters/geometry/tube_tree_distance.cpp",
          "const double foot = x - y * m_tangent;", "const double foot = x + y * m_tangent;", "phantom_test",
          "TubeTreeDistance*:RoundCone*:*Distance*"),
    Fault("triangles' middles are not on the sphere", "converters/geometry/icosphere.cpp",
          "(sphere.vertices[i] + sphere.vertices[j]).normalized()", "(sphere.vertices[i] + sphere.vertices[j]) * 0.5",
          "tracking_test", "Icosphere*"),
    # stages
    Fault("a parabola's maximum is on the wrong side", "converters/stages/tracking/cylinders/steepest_fall.cpp",
          "0.5 * (before - after) / bend", "0.5 * (after - before) / bend", "tracking_test", "Steepest*:Ray*:Wall*:PointSpread*"),
    Fault("the tilt of a cylinder is that of the other axis", "converters/stages/tracking/cylinders/cylinder.cpp",
          "-w * u / distance, -w * v / distance, -1.0;", "-w * v / distance, -w * u / distance, -1.0;",
          "tracking_test", "Cylinder*"),
    Fault("a blob may shrink without bound in one step", "converters/stages/fitting/levenberg_marquardt.cpp",
          "std::abs(s[3]) / (kLargestResize", "s[3] / (kLargestResize", "fitting_test", "LevenbergMarquardt*"),
    Fault("a hole is joined to a reflex corner through the outside", "converters/stages/surface/closing/flat_region.cpp",
          "return orientation(at, after, p) > 0 || orientation(before, at, p) > 0;",
          "return orientation(at, after, p) > 0 && orientation(before, at, p) > 0;", "ends_test"),
    Fault("a label with an equals sign is cut at the first", "converters/stages/surface/closing/length.cpp",
          "text.rfind('=')", "text.find('=')", "ends_test"),
    Fault("the radius of a link's sample counts at the branch's first node", "converters/judge/compare/sampled_path.cpp",
          "a.onLink && u < 1", "a.onLink", "compare_test"),
    # export, library
    Fault("a tree with a loop of its own is taken for one without", "converters/export/shared/network.cpp",
          "segments[t] >= joints[t]", "segments[t] > joints[t]", "flow_test"),
    Fault("LSA axes are a mirror image", "converters/export/shared/frame.cpp",
          "r << 1, 0, 0, 0, 0, 1, 0, -1, 0;", "r << 1, 0, 0, 0, 0, 1, 0, 1, 0;", "export_test", "*Frame*"),
    Fault("a licence of one's own may have no name", "converters/library/index/spdx.cpp",
          "return text.size() > prefix.size() &&", "return text.size() >= prefix.size() &&", "library_test"),
    Fault("a link in a library is followed", "converters/library/publish/plain_folder.cpp",
          "O_RDONLY | O_NOFOLLOW | O_NONBLOCK", "O_RDONLY | O_NONBLOCK", "library_trust_test"),
    # engine, viewer
    Fault("a name that is nothing but an ending has a format", "converters/engine/file_format.cpp",
          "file.size() > ending.size()", "file.size() >= ending.size()", "cli_test", "FileFormat*"),
    Fault("seeds that change keep their revision", "viewer/session/document/history.cpp",
          "parts.seeds += document.seeds != old.seeds;", "parts.seeds += document.seeds == old.seeds;",
          "viewer_test", "Document*:History*"),
    # eleven that no test found in commit d4cf630, at their present places
    Fault("distant neighbours are capped by the node that has fewer", "formats/field/neighbourhood.cpp",
          "std::max(count[pair.first], count[pair.second])", "std::min(count[pair.first], count[pair.second])",
          "field_test"),
    Fault("the portable back end takes every z for one in range", "libblob/src/simd/f8_pair.h",
          "(within[0] & within[1] & within[2]) != 0", "(within[0] & within[1]) != 0", "blob_test"),
    Fault("a branch that is cut in its parent's core keeps its parent node", "converters/stages/tracking/joining.cpp",
          "branch.parentNode = static_cast<int>(at.node);", "static_cast<void>(at.node);", "tracking_test"),
    Fault("the tip is dropped of a vessel that leaves the volume", "converters/stages/tracking/track_steps.cpp",
          "if (branch.stopReason == StopReason::NoValidCylinder) dropTip(nodes);",
          "if (branch.stopReason != StopReason::NoValidCylinder) dropTip(nodes);", "tracking_test"),
    Fault("a blob is not held in the fit's reach along z", "converters/stages/fitting/levenberg_marquardt.cpp",
          "to.z *= back;", "to.z *= 1;", "fitting_test", "LevenbergMarquardt*"),
    Fault("an edge of bone lies amid soft tissue", "converters/stages/finding/ct_lumen.cpp",
          "isSoft(cell + away) && isSoft(cell - away)", "isSoft(cell + away) || isSoft(cell - away)", "finding_test", "Ct*"),
    Fault("short calm stretches of marrow are blood", "converters/stages/finding/ct_lumen.cpp",
          " && reach(part) >= kLeastReach", "", "finding_test", "Ct*"),
    Fault("systems of vessels spread by number, not by depth", "converters/stages/finding/find_vessels.cpp",
          "std::pair(depth, other.voxel) < std::pair(other.depth, voxel)", "other.voxel < voxel", "finding_test",
          "FindVessels.NoCourse*"),
    Fault("bone of the first map hides the vessel of the second", "converters/operations/label_prior.cpp",
          " || said[i] == Prior::kNoVessel)", ")", "operations_test", "LabelPrior*"),
    Fault("a loop is closed through a wall", "converters/voxels/vessel_paths.cpp",
          " || !isOpen(tip, j)) return;", ") return;", "voxels_test"),
    Fault("slope and intercept count for integers only", "converters/io/volume/stored_voxels.cpp",
          "if (!m_stored.scaling) return", "if (!m_stored.scaling || std::is_floating_point_v<From>) return",
          "volume_test"),
    Fault("the ends of a thick wall point inward", "converters/export/shared/insertion.cpp",
          "if (faceArea(mesh, g).dot(end.direction) < 0) end.direction = -end.direction;\n", "", "export_test"),
    Fault("a truth that changes keeps its revision", "viewer/session/document/history.cpp",
          "parts.truth += document.truth != old.truth;", "parts.truth += 0;", "viewer_test", "Document*:History*"),
    Fault("secrets are alike if their last bytes are", "viewer/server/http_server.cpp",
          "difference |= static_cast", "difference = static_cast", "viewer_test"),
    Fault("the steepest place lies on the other side of the wall", "converters/judge/check/wall_offsets.cpp",
          "result.fromSteepest = -edge.steepest", "result.fromSteepest = edge.steepest", "check_test"),
]
