#include "holdfast/places/ground/viewpoints.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <numeric>
#include <span>
#include <tuple>

namespace holdfast::places {
namespace {

constexpr float kStepM = 0.3F;
// Smaller pieces that nothing leads to are left out, unless nothing is much larger.
constexpr float kIslandM2 = 10.0F;
constexpr float kIslandShare = 0.5F;
// Columns to which a step may lead: up to 1 m away, over a gap in the floor. One of each pair.
constexpr std::array<std::array<int, 2>, 6> kSteps = {
    {{1, 0}, {2, 0}, {0, 1}, {0, 2}, {1, 1}, {-1, 1}}};
constexpr std::array<std::array<int, 2>, 4> kAround = {{{2, 0}, {-2, 0}, {0, 2}, {0, -2}}};

/// The standing room of a map, by row, column and height.
class Ground {
 public:
  explicit Ground(std::vector<Standing> room) : room_(std::move(room)) {
    std::sort(room_.begin(), room_.end(), [](const Standing& a, const Standing& b) {
      return std::tie(a.cy, a.cx, a.z_m) < std::tie(b.cy, b.cx, b.z_m);
    });
    for (std::size_t i = 0; i < room_.size(); ++i) {
      if (i == 0 || room_[i].cy != room_[i - 1].cy) rows_.push_back(i);
    }
    rows_.push_back(room_.size());
  }

  std::size_t size() const { return room_.size(); }
  const Standing& operator[](std::size_t i) const { return room_[i]; }

  /// Number of the piece that a step from `s` leads to, or size().
  std::size_t step(const Standing& s, const std::array<int, 2>& way) const {
    const auto [begin, end] = row(s.cy + way[1]);
    const std::int32_t cx = s.cx + way[0];
    const auto first = std::lower_bound(room_.begin() + begin, room_.begin() + end, cx,
                                        [](const Standing& a, std::int32_t x) { return a.cx < x; });
    for (auto other = first; other != room_.begin() + end && other->cx == cx; ++other) {
      if (std::abs(other->z_m - s.z_m) <= kStepM) {
        return static_cast<std::size_t>(other - room_.begin());
      }
    }
    return size();
  }

 private:
  std::pair<std::ptrdiff_t, std::ptrdiff_t> row(std::int32_t cy) const {
    const auto found =
        std::lower_bound(rows_.begin(), rows_.end() - 1, cy,
                         [this](std::size_t i, std::int32_t y) { return room_[i].cy < y; });
    if (found == rows_.end() - 1 || room_[*found].cy != cy) return {0, 0};
    return {static_cast<std::ptrdiff_t>(*found), static_cast<std::ptrdiff_t>(*(found + 1))};
  }

  std::vector<Standing> room_;
  std::vector<std::size_t> rows_;  // first piece of each row, and the end
};

/// Pieces of ground that steps lead between, as a forest: each names one of its own.
class Connected {
 public:
  explicit Connected(const Ground& ground) : parent_(ground.size()), pieces_(ground.size(), 0) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
    for (std::size_t i = 0; i < ground.size(); ++i) {
      for (const auto& way : kSteps) {
        const std::size_t other = ground.step(ground[i], way);
        if (other != ground.size()) join(i, other);
      }
    }
    for (std::size_t i = 0; i < ground.size(); ++i) ++pieces_[root(i)];
    const std::size_t largest =
        pieces_.empty() ? 0 : *std::max_element(pieces_.begin(), pieces_.end());
    least_ =
        std::min(kIslandM2 / (kColumnM * kColumnM), kIslandShare * static_cast<float>(largest));
  }

  bool is_island(std::size_t i) { return static_cast<float>(pieces_[root(i)]) < least_; }

 private:
  std::size_t root(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::size_t a, std::size_t b) {
    a = root(a);
    b = root(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

  std::vector<std::size_t> parent_;
  std::vector<std::size_t> pieces_;  // of each root
  float least_ = 0;
};

/// Positions that keep a distance from each other, floor by floor.
class Spread {
 public:
  explicit Spread(float spacing_m) : spacing_m_(spacing_m) {}

  void add_if_apart(const Standing& s) {
    const Eigen::Vector3f p(s.x_m(), s.y_m(), s.z_m);
    const int x = cell(p.x());
    const int y = cell(p.y());
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        const auto near = cells_.find({y + dy, x + dx});
        if (near == cells_.end()) continue;
        for (const std::size_t i : near->second) {
          if (is_near(chosen_[i], p)) return;
        }
      }
    }
    cells_[{y, x}].push_back(chosen_.size());
    chosen_.push_back(p);
  }

  std::vector<Eigen::Vector3f> take() { return std::move(chosen_); }

 private:
  int cell(float v) const { return static_cast<int>(std::floor(v / spacing_m_)); }
  bool is_near(const Eigen::Vector3f& a, const Eigen::Vector3f& b) const {
    constexpr float kFloorM = 1.0F;  // a slope over the spacing is less, another floor more
    return (a - b).head<2>().norm() < spacing_m_ && std::abs(a.z() - b.z()) < kFloorM;
  }

  float spacing_m_;
  std::map<std::pair<int, int>, std::vector<std::size_t>> cells_;
  std::vector<Eigen::Vector3f> chosen_;
};

/// Is there clear room 1 m away to all sides?
bool is_open(const Ground& ground, const Standing& s) {
  return std::all_of(kAround.begin(), kAround.end(), [&](const auto& way) {
    const std::size_t other = ground.step(s, way);
    return other != ground.size() && ground[other].clear;
  });
}

}  // namespace

std::vector<Eigen::Vector3f> choose_viewpoints(std::vector<Standing> room, float spacing_m) {
  const Ground ground(std::move(room));
  Connected connected(ground);
  Spread spread(spacing_m);
  for (const bool in_the_open : {true, false}) {
    for (std::size_t i = 0; i < ground.size(); ++i) {
      if (!ground[i].clear || connected.is_island(i)) continue;
      if (in_the_open && !is_open(ground, ground[i])) continue;
      spread.add_if_apart(ground[i]);
    }
  }
  return spread.take();
}

}  // namespace holdfast::places
