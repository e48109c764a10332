// SPDX-License-Identifier: Apache-2.0
// Declared in compare.h.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include <tbb/parallel_for.h>

#include "converters/geometry/tube_tree_distance.h"
#include "converters/judge/compare/compare.h"
#include "converters/judge/compare/sampled_path.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

enum class State : std::uint8_t { Unmatched, Matched, Ignored };

struct TrueBranch {
  SampledPath path;
  std::size_t begin = 0;  // number of leading samples in the parent's lumen
  int parent = -1;        // branch
  bool vessel = true;
  int answer = -1;  // found branch with the same label
};

struct FoundBranch {
  SampledPath path;
  std::vector<State> state;
  int label = -1;      // true branch with the same label
  bool counts = true;  // towards the overall false length
};

// A contiguous range of samples of a found branch.
struct SampleRange {
  std::size_t branch, first, last;  // last is excluded
  bool reversed;
};

// Sums from which a score is made; those of several branches add up.
struct Tally {
  double tpm = 0, tpr = 0, fn = 0, fp = 0;  // samples
  double beforeError = 0, reference = 0;    // samples
  double inside = 0, insideCount = 0;
  double distance = 0, distanceCount = 0;
  double limited = 0, limitedCount = 0;
  double bias = 0, square = 0, radiusCount = 0;
  double missed = 0, falseLength = 0;

  void add(const Tally& o) {
    tpm += o.tpm, tpr += o.tpr, fn += o.fn;
    beforeError += o.beforeError, reference += o.reference;
    inside += o.inside, insideCount += o.insideCount;
    distance += o.distance, distanceCount += o.distanceCount;
    limited += o.limited, limitedCount += o.limitedCount;
    bias += o.bias, square += o.square, radiusCount += o.radiusCount;
    missed += o.missed;
  }
};

double ratio(double part, double whole) {
  return whole > 0 ? part / whole : std::numeric_limits<double>::quiet_NaN();
}

CenterlineScore computeScore(const Tally& t) {
  CenterlineScore score;
  score.overlap = ratio(t.tpm + t.tpr, t.tpm + t.tpr + t.fn + t.fp);
  score.overlapUntilFirstError = ratio(t.beforeError, t.reference);
  score.averageInside = ratio(t.inside, t.insideCount);
  score.assd = ratio(t.distance, t.distanceCount);
  score.assdLimited = ratio(t.limited, t.limitedCount);
  score.radiusBias = ratio(t.bias, t.radiusCount);
  score.radiusRms = std::sqrt(ratio(t.square, t.radiusCount));
  score.missed = t.missed;
  score.falseLength = t.falseLength;
  return score;
}

class Comparer {
public:
  Comparer(const formats::CenterlineTree& found, const formats::CenterlineTree& truth, double step,
           Progress& progress)
      : m_wall(truth), m_axes(makeAxes(found)), m_progress(progress) {
    for (std::uint32_t b = 0; b < truth.branches.size(); ++b) addTrue(truth, b, step);
    for (std::uint32_t b = 0; b < found.branches.size(); ++b) findAndAdd(found, b, step);
    matchLabels(found, truth);
  }

  CenterlineComparison run() {
    std::vector<Tally> tallies(m_true.size());
    // each found branch answers for one true branch, so these share no state
    tbb::parallel_for(std::size_t{0}, m_true.size(), [&](std::size_t b) {
      m_progress.check();
      if (m_true[b].answer >= 0) tallies[b] = scoreLabelled(b);
      m_progress.advance();
    });
    for (std::size_t b = 0; b < m_true.size(); ++b)
      if (m_true[b].answer < 0) tallies[b] = score(b, stretchesFor(b));
    CenterlineComparison result;
    Tally all;
    for (std::size_t b = 0; b < m_true.size(); ++b) {
      result.branch.push_back(computeScore(tallies[b]));
      if (m_true[b].vessel) all.add(tallies[b]);
    }
    for (const FoundBranch& branch : m_found) {
      if (!branch.counts) continue;
      const auto wrong = static_cast<double>(
          std::count(branch.state.begin(), branch.state.end(), State::Unmatched));
      all.fp += wrong;
      all.falseLength += wrong * branch.path.spacing;
    }
    result.all = computeScore(all);
    return result;
  }

private:
  // The found tree without thickness: its wall is the centerline.
  static TubeTreeDistance makeAxes(formats::CenterlineTree tree) {
    std::fill(tree.radius.begin(), tree.radius.end(), 0.0F);
    return TubeTreeDistance(tree);
  }

  void addTrue(const formats::CenterlineTree& truth, std::uint32_t index, double step) {
    const formats::Branch& branch = truth.branches[index];
    TrueBranch t;
    t.path = samplePath(truth, index, step, false);
    t.vessel = branch.kind == formats::BranchKind::Vessel;
    if (branch.parentNode != formats::kNoParent) {
      const std::uint32_t parent = truth.branch[static_cast<std::size_t>(branch.parentNode)];
      t.parent = static_cast<int>(parent);
      t.begin =
          samplesInside(TubeTreeDistance(truth, parent), t.path.samples, t.path.samples.size());
    }
    m_true.push_back(std::move(t));
    m_lumen.emplace_back(truth, index);
  }

  void findAndAdd(const formats::CenterlineTree& found, std::uint32_t index, double step) {
    FoundBranch f;
    f.path = samplePath(found, index, step, true);
    f.counts = found.branches[index].kind == formats::BranchKind::Vessel;
    f.state.assign(f.path.samples.size(), State::Unmatched);
    for (std::size_t i = 0; i < f.state.size(); ++i)
      if (f.path.samples[i].onLink && m_wall.nearest(f.path.samples[i].position).distance <= 0)
        f.state[i] = State::Ignored;
    m_found.push_back(std::move(f));
  }

  void matchLabels(const formats::CenterlineTree& found, const formats::CenterlineTree& truth) {
    std::map<std::string, int> index;
    for (std::size_t b = 0; b < truth.branches.size(); ++b)
      index.emplace(truth.branches[b].label, static_cast<int>(b));
    for (std::size_t f = 0; f < m_found.size(); ++f) {
      const auto same = index.find(found.branches[f].label);
      if (same == index.end() || m_found[f].path.samples.empty()) continue;
      TrueBranch& t = m_true[static_cast<std::size_t>(same->second)];
      if (t.answer >= 0) continue;
      t.answer = static_cast<int>(f);
      m_found[f].label = same->second;
      m_found[f].counts = t.vessel;
    }
  }

  // Number of samples from the first on that lie in the lumen, at most `limit`.
  static std::size_t samplesInside(const TubeTreeDistance& lumen,
                                   const std::vector<PathSample>& path, std::size_t limit) {
    std::size_t n = 0;
    while (n < std::min(limit, path.size()) && lumen.nearest(path[n].position).distance < 0) ++n;
    return n;
  }

  Tally scoreLabelled(std::size_t b) {
    const TrueBranch& t = m_true[b];
    FoundBranch& f = m_found[static_cast<std::size_t>(t.answer)];
    const std::vector<PathSample>& path = f.path.samples;
    SampleRange all{static_cast<std::size_t>(t.answer), 0, path.size(), false};
    const PathSample &start = t.path.samples.front(), &end = t.path.samples.back();
    const auto apart = [](const PathSample& p, const PathSample& q) {
      return (p.position - q.position).norm();
    };
    all.reversed = apart(path.front(), start) + apart(path.back(), end) >
                   apart(path.front(), end) + apart(path.back(), start);
    if (t.parent >= 0 && !all.reversed) {
      // limit: the length of the true child in its parent, and the detour of a link
      const auto p = static_cast<std::size_t>(t.parent);
      const double radius = closestOn(m_true[p].path.samples, start.position).radius;
      const double allowed = static_cast<double>(t.begin) * t.path.spacing + 2 * radius;
      const auto limit = static_cast<std::size_t>(allowed / std::max(f.path.spacing, 1e-6));
      const std::size_t inside = samplesInside(m_lumen[p], path, limit);
      std::fill_n(f.state.begin(), inside, State::Ignored);
      all.first = inside;
    }
    return score(b, {all});
  }

  // The unmatched samples that lie in this branch's lumen, in the order in which the branch passes
  // them.
  std::vector<SampleRange> stretchesFor(std::size_t b) {
    std::vector<SampleRange> candidates;
    for (std::size_t f = 0; f < m_found.size(); ++f) {
      const std::vector<PathSample>& path = m_found[f].path.samples;
      const auto here = [&](std::size_t i) {
        if (m_found[f].state[i] != State::Unmatched) return false;
        const WallHit hit = m_wall.nearest(path[i].position);
        return hit.distance <= 0 && hit.branch == b;
      };
      for (std::size_t i = 0; i < path.size(); ++i) {
        if (!here(i)) continue;
        const std::size_t first = i;
        while (i < path.size() && here(i)) ++i;
        candidates.push_back({f, first, i, false});
      }
    }
    return arrange(b, std::move(candidates));
  }

  std::vector<SampleRange> arrange(std::size_t b, std::vector<SampleRange> candidates) {
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const SampleRange& p, const SampleRange& q) {
                       return p.last - p.first > q.last - q.first;
                     });
    struct Placed {
      SampleRange stretch;
      std::size_t low, high;  // samples of the true branch
    };
    std::vector<Placed> placed;
    for (SampleRange s : candidates) {
      const std::vector<PathSample>& path = m_found[s.branch].path.samples;
      const std::size_t from = closestOn(m_true[b].path.samples, path[s.first].position).index;
      const std::size_t to = closestOn(m_true[b].path.samples, path[s.last - 1].position).index;
      s.reversed = from > to;
      const auto [low, high] = std::minmax(from, to);
      std::size_t shared = 0;
      for (const Placed& p : placed)
        if (low <= p.high && p.low <= high)
          shared += std::min(high, p.high) - std::max(low, p.low) + 1;
      if (2 * shared <= high - low + 1) placed.push_back({s, low, high});
    }
    std::sort(placed.begin(), placed.end(),
              [](const Placed& p, const Placed& q) { return p.low < q.low; });
    std::vector<SampleRange> result;
    for (const Placed& p : placed) result.push_back(p.stretch);
    return result;
  }

  Tally score(std::size_t b, const std::vector<SampleRange>& stretches) {
    const TrueBranch& t = m_true[b];
    std::vector<PathSample> answer;
    std::vector<State*> states;
    std::vector<double> lengths;
    for (const SampleRange& s : stretches) {
      FoundBranch& f = m_found[s.branch];
      for (std::size_t i = s.first; i < s.last; ++i) {
        const std::size_t at = s.reversed ? s.first + s.last - 1 - i : i;
        answer.push_back(f.path.samples[at]);
        states.push_back(&f.state[at]);
        lengths.push_back(f.path.spacing);
      }
    }
    const std::vector<PathSample> reference(
        t.path.samples.begin() + static_cast<std::ptrdiff_t>(t.begin), t.path.samples.end());
    Tally tally;
    std::vector<char> hit(reference.size(), 0);
    for (const auto& [r, f] : correspond(reference, answer)) {
      const double distance = (reference[r].position - answer[f].position).norm();
      if (distance > reference[r].radius) continue;
      tally.inside += distance;
      tally.insideCount += 1;
      hit[r] = 1;
      *states[f] = State::Matched;
    }
    countReference(reference, hit, t.path.spacing, tally);
    for (std::size_t i = 0; i < answer.size(); ++i) {
      if (*states[i] == State::Ignored) continue;
      (*states[i] == State::Matched ? tally.tpm : tally.fp) += 1;
      if (*states[i] != State::Matched) tally.falseLength += lengths[i];
    }
    measure(t, reference, answer, states, tally);
    return tally;
  }

  void countReference(const std::vector<PathSample>& reference, const std::vector<char>& hit,
                      double spacing, Tally& tally) const {
    bool error = false;
    for (std::size_t i = 0; i < reference.size(); ++i) {
      const bool passedOver =
          hit[i] == 0 && static_cast<double>(i) * spacing <= 2 * reference.front().radius;
      if (!passedOver) tally.reference += 1;
      (hit[i] != 0 ? tally.tpr : tally.fn) += 1;
      if (hit[i] == 0) {
        error = error || !passedOver;
        if (m_axes.nearest(reference[i].position).distance > reference[i].radius)
          tally.missed += spacing;
      } else if (!error) {
        tally.beforeError += 1;
      }
    }
  }

  // Distances between the centerlines, and radii.
  static void measure(const TrueBranch& t, const std::vector<PathSample>& reference,
                      const std::vector<PathSample>& answer, const std::vector<State*>& states,
                      Tally& tally) {
    if (answer.empty() || reference.empty()) return;
    double limit = 0;
    for (const PathSample& sample : reference) limit += sample.radius;
    limit /= static_cast<double>(reference.size());
    const auto count = [&](double distance) {
      tally.distance += distance;
      tally.distanceCount += 1;
      if (distance >= limit) return;
      tally.limited += distance;
      tally.limitedCount += 1;
    };
    for (const PathSample& sample : reference) count(closestOn(answer, sample.position).distance);
    for (std::size_t i = 0; i < answer.size(); ++i) {
      if (*states[i] == State::Ignored) continue;
      const ClosestPoint closest = closestOn(t.path.samples, answer[i].position);
      count(closest.distance);
      if (*states[i] != State::Matched || answer[i].onLink) continue;
      const double error = answer[i].radius - closest.radius;
      tally.bias += error;
      tally.square += error * error;
      tally.radiusCount += 1;
    }
  }

  TubeTreeDistance m_wall, m_axes;
  Progress& m_progress;
  std::vector<TrueBranch> m_true;
  std::vector<TubeTreeDistance> m_lumen;  // lumen of each true branch
  std::vector<FoundBranch> m_found;
};

}  // namespace

CenterlineComparison compareCenterlines(const formats::CenterlineTree& found,
                                        const formats::CenterlineTree& truth, double step,
                                        Progress& progress) {
  return Comparer(found, truth, step, progress).run();
}

}  // namespace lumen::convert
