#include "simulation/aliases/aliases.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "simulation/aliases/place_index.hpp"
#include "simulation/aliases/twin_check.hpp"
#include "simulation/log_output.hpp"

namespace holdfast::simulation {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kElsewhere = 1;  // metres, or
constexpr double kOtherway = 15 * std::numbers::pi / 180;
constexpr double kSameMetres = 0.3;  // that an alias may wander within a stretch
constexpr double kSameTurn = 3 * std::numbers::pi / 180;
constexpr double kAsideStep = 0.5;
constexpr double kLevel = 0.15;  // metres that the ground beside the route may differ
constexpr float kKerb = 0.3F;    // height above the ground at which nothing may stand between

/// A pose of the drive that is asked about, and what looks like it.
struct Asked {
  TimeNs t = 0;
  SE3 T_map_body;
  std::vector<SE3> twins;  ///< T_map_body of each, best first
};

bool is_same_place(const SE3& a, const SE3& b, double metres, double turn) {
  return (a.translation - b.translation).norm() < metres &&
         a.rotation.angularDistance(b.rotation) < turn;
}

SE3 turned(const SE3& pose, double yaw, const Vector3d& position) {
  const Quaterniond turn(Eigen::AngleAxisd(yaw, Vector3d::UnitZ()));
  return {(turn * pose.rotation).normalized(), position};
}

class AliasFinder {
 public:
  AliasFinder(const Simulation& simulation, const AliasModel& model)
      : simulation_(simulation),
        model_(model),
        world_(simulation.scenario().world),
        lidar_(simulation.options().lidar),
        caster_(world_),
        rays_(rays_of(lidar_, model)),
        check_(world_, caster_, rays_, std::max(1e-3, lidar_.range_sigma_m)),
        index_(rays_) {}

  std::vector<Asked> find() {
    WorkerPool pool(simulation_.options().threads);
    index_.add(caster_, places(), pool);
    std::vector<Asked> asked = poses();
    for_each_chunk(pool, asked.size(), 1, [&](std::size_t, std::size_t i, std::size_t) {
      asked[i].twins = twins_of(asked[i].T_map_body);
    });
    return asked;
  }

 private:
  static ImageRays rays_of(const LidarModel& lidar, const AliasModel& model) {
    const auto [low, high] = std::minmax_element(
        lidar.beams.begin(), lidar.beams.end(),
        [](const LidarBeam& a, const LidarBeam& b) { return a.elevation_rad < b.elevation_rad; });
    return ImageRays::over(low->elevation_rad, high->elevation_rad, model.rows, model.columns,
                           lidar.max_range_m);
  }

  double lidar_height() const {
    return simulation_.scenario().style.body_height_m + lidar_.T_body_lidar.translation.z();
  }

  /// Along the route and beside it, where nothing stands between.
  std::vector<Vector3d> places() const {
    std::vector<Vector3d> out;
    const Route& route = simulation_.scenario().route;
    const int lanes = static_cast<int>(model_.aside_m / kAsideStep);
    for (double s = 0; s < route.length(); s += model_.station_m) {
      const Route::Place place = route.at(s);
      const Vector3d left(-std::sin(place.heading), std::cos(place.heading), 0);
      for (int lane = -lanes; lane <= lanes; ++lane) {
        const Vector3d foot = place.position + kAsideStep * lane * left;
        if (lane == 0 || is_free(place.position, foot)) {
          out.emplace_back(foot + lidar_height() * Vector3d::UnitZ());
        }
      }
    }
    return out;
  }

  bool is_free(const Vector3d& from, const Vector3d& to) const {
    const auto over = [](const Vector3d& foot, double height) {
      return Eigen::Vector3f((foot + height * Vector3d::UnitZ()).cast<float>());
    };
    const double height = lidar_height();
    return caster_.is_visible(over(from, kKerb), over(to, kKerb)) &&
           caster_.is_visible(over(from, height), over(to, height)) &&
           !caster_.is_visible(over(to, height), over(to, -kLevel)) &&
           caster_.is_visible(over(to, height), over(to, kLevel));
  }

  /// Of the drive, the first and then each so many metres on.
  std::vector<Asked> poses() const {
    std::vector<Asked> out;
    const TimeNs end = simulation_.end_time();
    for (TimeNs t = simulation_.start_time(); t <= end; t += lidar_.period) {
      const SE3 pose = simulation_.truth_at(t);
      const bool on =
          out.empty() ||
          (pose.translation - out.back().T_map_body.translation).norm() >= model_.every_m;
      if (on) out.push_back({t, pose, {}});
    }
    return out;
  }

  std::size_t most_differing() const {
    return check_.explained_by_noise() +
           static_cast<std::size_t>(model_.differing_share * static_cast<double>(rays_.size()));
  }

  std::vector<SE3> twins_of(const SE3& T_map_body) const {
    const SE3 T_map_lidar = T_map_body * lidar_.T_body_lidar;
    const RangeImage level =
        render(caster_, rays_, {Quaterniond::Identity(), T_map_lidar.translation});
    const RangeImage seen = render(caster_, rays_, T_map_lidar);
    std::vector<SE3> twins;
    for (const auto& match : index_.similar(level, model_.places, model_.verified)) {
      const SE3 start = turned(T_map_lidar, match.turn_rad, match.position);
      const SE3 twin = check_.refined(seen, start) * lidar_.T_body_lidar.inverse();
      const auto is_known = [&](const SE3& other) {
        return is_same_place(twin, other, kElsewhere, kOtherway);
      };
      if (is_known(T_map_body) || std::any_of(twins.begin(), twins.end(), is_known)) continue;
      const std::size_t differing = check_.differing(seen, twin * lidar_.T_body_lidar);
      if (differing <= most_differing()) twins.push_back(twin);
    }
    return twins;
  }

  const Simulation& simulation_;
  const AliasModel& model_;
  const World& world_;
  const LidarModel& lidar_;
  RayCaster caster_;
  ImageRays rays_;
  TwinCheck check_;
  PlaceIndex index_;
};

/// True when the aliases at `next` are those of `stretch`, moved on as the robot has.
bool goes_on(const AliasedStretch& stretch, const Asked& first, const Asked& next) {
  if (stretch.poses.size() != next.twins.size()) return false;
  const SE3 gone = first.T_map_body.inverse() * next.T_map_body;
  return std::all_of(stretch.poses.begin(), stretch.poses.end(), [&](const SE3& pose) {
    return std::any_of(next.twins.begin(), next.twins.end(), [&](const SE3& twin) {
      return is_same_place(pose * gone, twin, kSameMetres, kSameTurn);
    });
  });
}

}  // namespace

std::vector<AliasedStretch> find_aliases(const Simulation& simulation, const AliasModel& model) {
  const std::vector<Asked> asked = AliasFinder(simulation, model).find();
  std::vector<AliasedStretch> out;
  const Asked* first = nullptr;  // of the stretch that is being gone along
  for (std::size_t i = 0; i < asked.size(); ++i) {
    if (asked[i].twins.empty()) {
      first = nullptr;
      continue;
    }
    // Each pose asked about stands for the times up to the next one.
    const TimeNs until = i + 1 < asked.size() ? asked[i + 1].t : simulation.end_time();
    if (first == nullptr || !goes_on(out.back(), *first, asked[i])) {
      first = &asked[i];
      out.push_back({asked[i].t, until, asked[i].twins});
    }
    out.back().t1 = until;
  }
  return out;
}

std::string alias_json(const AliasedStretch& stretch) {
  std::vector<std::string> poses;
  for (const SE3& pose : stretch.poses) {
    std::string text = pose_text(pose);
    std::replace(text.begin(), text.end(), ' ', ',');
    poses.push_back(fmt::format("[{}]", text));
  }
  return fmt::format("{{\"t0\":{},\"t1\":{},\"poses\":[{}]}}", format_seconds(stretch.t0),
                     format_seconds(stretch.t1), fmt::join(poses, ","));
}

}  // namespace holdfast::simulation
