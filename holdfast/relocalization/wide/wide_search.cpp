#include "holdfast/relocalization/wide/wide_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace holdfast::relocalization {
namespace {

constexpr int kTop = OccupancyPyramid::kLevels - 1;
constexpr std::size_t kBatch = 8;
constexpr std::size_t kMostKept = 1 << 15;

bool better(const Mode& a, const Mode& b) {
  if (a.hits != b.hits) return a.hits > b.hits;
  if (a.yaw != b.yaw) return a.yaw < b.yaw;
  if (a.cell.y != b.cell.y) return a.cell.y < b.cell.y;
  if (a.cell.x != b.cell.x) return a.cell.x < b.cell.x;
  return a.cell.z < b.cell.z;
}

/// The first of the sorted `modes` that are not near a better one.
std::vector<Mode> apart(const std::vector<Mode>& modes, const WideOptions& options, int yaws) {
  const double least_cells = options.apart_m / kCellM;
  const double least_yaws = options.apart_rad / (2 * std::numbers::pi) * yaws;
  std::vector<Mode> kept;
  for (const Mode& mode : modes) {
    const bool copy = std::any_of(kept.begin(), kept.end(), [&](const Mode& other) {
      const int turn = std::abs(mode.yaw - other.yaw);
      const int dx = mode.cell.x - other.cell.x, dy = mode.cell.y - other.cell.y;
      const int dz = mode.cell.z - other.cell.z;
      return std::min(turn, yaws - turn) <= least_yaws &&
             dx * dx + dy * dy + dz * dz <= least_cells * least_cells;
    });
    if (!copy) kept.push_back(mode);
    if (kept.size() == options.most_modes) break;
  }
  return kept;
}

}  // namespace

WideSearch::WideSearch(const OccupancyPyramid& map, const Standpoints& standpoints,
                       const TurnedPoints& points, const WideOptions& options)
    : map_(map), standpoints_(standpoints), points_(points), options_(options) {}

WideResult WideSearch::run(std::size_t points) {
  real_points_ = static_cast<int>(points);
  best_ = 0;
  work_ = 0;
  kept_.clear();
  too_alike_ = false;
  std::vector<Node> roots;
  open_roots(roots);
  for (const Node& root : roots) {
    if (root.bound < least_hits() || work_ >= options_.most_work) break;
    descend(kTop, root);
  }
  thin_out();
  std::sort(kept_.begin(), kept_.end(), better);
  return {apart(kept_, options_, points_.yaws()), real_points_, work_, work_ >= options_.most_work,
          too_alike_};
}

/// Of a mode that is still worth finding.
int WideSearch::least_hits() const {
  const double by_best = options_.keep_share * best_;
  return static_cast<int>(std::ceil(std::max(by_best, options_.least_share * real_points_)));
}

/// All blocks of the coarsest level that may hold a mode, the most promising first.
void WideSearch::open_roots(std::vector<Node>& roots) {
  for (int yaw = 0; yaw < points_.yaws() && work_ < options_.most_work; ++yaw) {
    for (const Standpoints::Block& block : standpoints_.roots()) {
      Node node{0,
                block.x,
                block.y,
                static_cast<std::int16_t>(yaw),
                static_cast<std::int16_t>(block.word),
                block.lanes};
      if (bound(kTop, node)) roots.push_back(node);
    }
  }
  std::stable_sort(roots.begin(), roots.end(),
                   [](const Node& a, const Node& b) { return a.bound > b.bound; });
}

/// How many points hit something from anywhere in the block, at most; false if that is too few.
bool WideSearch::bound(int level, Node& node) {
  LaneCounter counter;
  const bool strided = level >= OccupancyPyramid::kFirstStrided;
  const bool one = map_.words() == 1;
  const bool enough = strided ? (one ? count<true, true>(level, node, counter)
                                     : count<true, false>(level, node, counter))
                              : (one ? count<false, true>(level, node, counter)
                                     : count<false, false>(level, node, counter));
  if (!enough) return false;
  const int least = least_hits();
  node.lanes &= counter.at_least(least);
  if (node.lanes == 0) return false;
  node.bound = counter.largest(node.lanes);
  if (level > 0) return true;
  best_ = std::max(best_, node.bound);
  for (std::uint64_t left = node.lanes; left != 0; left &= left - 1) {
    const int lane = std::countr_zero(left);
    kept_.push_back(
        {{node.x, node.y, standpoints_.low_z(node.word) + lane}, node.yaw, counter.count(lane)});
  }
  return true;
}

/// False as soon as too few can hit, whatever the rest does.
template <bool kStrided, bool kOneWord>
bool WideSearch::count(int level, const Node& node, LaneCounter& counter) {
  constexpr std::size_t kCheckEvery = 4 * kBatch;
  const TurnedPoint* points = points_.at(node.yaw, node.word);
  const int x = node.x << level, y = node.y << level;
  const std::uint64_t* here = map_.column(level, x, y);
  const int may_miss = real_points_ - least_hits();
  const std::size_t all = points_.points();
  std::uint64_t hit[kBatch];
  for (std::size_t begin = 0; begin < all; begin += kBatch) {
    for (std::size_t i = 0; i < kBatch; ++i) {
      const TurnedPoint& p = points[begin + i];
      const std::uint64_t* column = kStrided ? map_.column(level, x + p.x, y + p.y) : here + p.step;
      if (kOneWord) {
        const std::uint64_t low = p.has_low ? *column >> p.shift : 0;
        hit[i] = p.has_high ? *column << 1 << (63 - p.shift) : low;
      } else {
        const std::uint64_t low = p.has_low ? column[p.low] >> p.shift : 0;
        hit[i] = low | (p.has_high ? column[p.high] << 1 << (63 - p.shift) : 0);
      }
    }
    counter.add8(hit);
    const std::size_t done = begin + kBatch;
    if (done % kCheckEvery == 0 && done < all) {
      const int missed = static_cast<int>(done) - counter.largest(node.lanes);
      if (missed > may_miss) {
        work_ += done;
        return false;
      }
    }
  }
  work_ += all;
  return true;
}

void WideSearch::descend(int level, const Node& node) {
  if (work_ >= options_.most_work || too_alike_) return;
  std::array<Node, 4> children;
  std::size_t count = 0;
  for (int i = 0; i < 4; ++i) {
    Node child = node;
    child.x = 2 * node.x + (i & 1);
    child.y = 2 * node.y + (i >> 1);
    child.lanes &= standpoints_.lanes(level - 1, child.x, child.y, node.word);
    if (child.lanes != 0 && bound(level - 1, child)) children[count++] = child;
  }
  if (level == 1) {
    if (kept_.size() >= kMostKept) make_room();
    return;
  }
  std::stable_sort(children.begin(), children.begin() + count,
                   [](const Node& a, const Node& b) { return a.bound > b.bound; });
  for (std::size_t i = 0; i < count; ++i) {
    if (children[i].bound >= least_hits()) descend(level - 1, children[i]);
  }
}

void WideSearch::make_room() {
  thin_out();
  if (kept_.size() < kMostKept / 2) return;
  options_.keep_share = std::max(options_.keep_share, options_.least_keep_share);
  thin_out();
  too_alike_ = kept_.size() >= kMostKept / 2;
}

/// Keeps the best of each small neighbourhood, and only what still is near the best of all.
void WideSearch::thin_out() {
  const int least = least_hits();
  std::erase_if(kept_, [&](const Mode& mode) { return mode.hits < least; });
  const int yaws_together = std::max(1, points_.yaws() / 72);
  const auto key = [&](const Mode& m) {
    return std::array{m.cell.x >> 1, m.cell.y >> 1, m.cell.z >> 1, m.yaw / yaws_together};
  };
  std::sort(kept_.begin(), kept_.end(), [&](const Mode& a, const Mode& b) {
    const auto ka = key(a), kb = key(b);
    return ka != kb ? ka < kb : better(a, b);
  });
  const auto last = std::unique(kept_.begin(), kept_.end(),
                                [&](const Mode& a, const Mode& b) { return key(a) == key(b); });
  kept_.erase(last, kept_.end());
}

}  // namespace holdfast::relocalization
