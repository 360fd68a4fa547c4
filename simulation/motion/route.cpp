#include "simulation/motion/route.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "simulation/motion/smoothing.hpp"

namespace holdfast::simulation {
namespace {

constexpr double kShortest = 1e-9;  // pieces shorter than this are left out

double wrapped(double angle) { return std::remainder(angle, 2 * std::numbers::pi); }

/// A corner with the points where its arc begins and ends.
struct Rounding {
  Eigen::Vector3d begin;
  Eigen::Vector3d end;
  double heading;  ///< of the way into the corner
  double turn;     ///< angle of the arc, positive to the left
  double radius;
};

Rounding round_corner(const Eigen::Vector3d& before, const RouteCorner& corner,
                      const Eigen::Vector3d& after) {
  const Eigen::Vector3d up(0, 0, corner.ride_m);
  const Eigen::Vector3d in = corner.position - before;
  const Eigen::Vector3d out = after - corner.position - up;
  const double in_length = in.head<2>().norm();
  const double out_length = out.head<2>().norm();
  assert(in_length > kShortest && out_length > kShortest);
  const double heading = std::atan2(in.y(), in.x());
  const double turn = wrapped(std::atan2(out.y(), out.x()) - heading);
  const double half_tan = std::tan(0.5 * std::abs(turn));
  if (corner.on_spot) return {corner.position, corner.position + up, heading, turn, 0};
  const double cut = std::min({corner.radius_m * half_tan, 0.5 * in_length, 0.5 * out_length});
  return {corner.position - in * (cut / in_length), corner.position + up + out * (cut / out_length),
          heading, turn, half_tan > kShortest ? cut / half_tan : 0.0};
}

double spot_length(double turn) {
  return 2 * Route::kSpotRest + kSmoothStepSteepest * Route::kSpotMetresPerRadian * std::abs(turn);
}

}  // namespace

Route Route::closed(const std::vector<RouteCorner>& corners) {
  const std::size_t n = corners.size();
  assert(n >= 3);
  std::vector<Rounding> roundings;
  for (std::size_t i = 0; i < n; ++i) {
    const RouteCorner& before = corners[(i + n - 1) % n];
    const Eigen::Vector3d left = before.position + Eigen::Vector3d(0, 0, before.ride_m);
    roundings.push_back(round_corner(left, corners[i], corners[(i + 1) % n].position));
  }
  Route route;
  route.corners_ = corners;
  double heading = roundings[0].heading;
  for (std::size_t i = 0; i < n; ++i) {
    const Rounding& r = roundings[i];
    const double rise = r.end.z() - r.begin.z() - corners[i].ride_m;
    const double arc = std::abs(r.turn) * r.radius;
    if (corners[i].on_spot) {
      route.append({0, spot_length(r.turn), r.begin, 0, heading, 0, r.turn});
    }
    route.append({0, arc, r.begin, rise, heading, arc > 0 ? r.turn / arc : 0});
    heading += r.turn;
    if (corners[i].ride_m != 0) route.lifts_.push_back({route.length_, corners[i].ride_m});
    const Eigen::Vector3d straight = roundings[(i + 1) % n].begin - r.end;
    route.append({0, straight.head<2>().norm(), r.end, straight.z(), heading, 0});
    route.last_straight_ = straight.head<2>().norm();
  }
  route.turning_ = heading - roundings[0].heading;
  return route;
}

Route Route::closed(const std::vector<Eigen::Vector2d>& corners, double radius_m) {
  std::vector<RouteCorner> rounded;
  rounded.reserve(corners.size());
  for (const auto& c : corners) rounded.push_back({{c.x(), c.y(), 0}, radius_m});
  return closed(rounded);
}

void Route::append(Piece piece) {
  if (piece.length < kShortest) return;
  piece.s = length_;
  length_ += piece.length;
  pieces_.push_back(piece);
}

Route::Place Route::at(double s) const {
  const double rounds = std::floor(s / length_);
  const double in_round = s - rounds * length_;
  const auto next = std::upper_bound(pieces_.begin(), pieces_.end(), in_round,
                                     [](double value, const Piece& p) { return value < p.s; });
  const Piece& piece = next == pieces_.begin() ? *next : *(next - 1);
  const double along = in_round - piece.s;
  if (piece.spot_turn != 0) return on_spot(piece, along, rounds * turning_);
  const double turn = piece.curvature * along;
  // Chord of an arc: length along * sinc(turn / 2) in the direction of half the turn.
  const double half_sinc = std::abs(turn) < 1e-6 ? 1.0 : std::sin(0.5 * turn) / (0.5 * turn);
  const double chord = along * half_sinc;
  const double direction = piece.heading + 0.5 * turn;
  const double slope = piece.rise / piece.length;
  const Eigen::Vector3d step(chord * std::cos(direction), chord * std::sin(direction),
                             along * slope);
  return {piece.begin + step, piece.heading + turn + rounds * turning_, piece.curvature, slope};
}

Route::Place Route::on_spot(const Piece& piece, double along, double turned) {
  const double turning = piece.length - 2 * kSpotRest;
  const double share = (along - kSpotRest) / turning;
  Place place{piece.begin, piece.heading + piece.spot_turn * smooth_step(share) + turned};
  place.curvature = piece.spot_turn * smooth_step_slope(share) / turning;
  place.on_spot = true;
  return place;
}

double Route::lifted(double s, double to) const {
  double sum = 0;
  for (const Lift& lift : lifts_) {
    const auto passed = [&](double place) { return std::floor((place - lift.s) / length_); };
    sum += (passed(to) - passed(s)) * lift.rise_m;
  }
  return sum;
}

Route Route::reversed() const {
  std::vector<RouteCorner> corners(corners_.rbegin(), corners_.rend());
  for (RouteCorner& corner : corners) {
    corner.position.z() += corner.ride_m;
    corner.ride_m = -corner.ride_m;
  }
  return closed(corners);
}

Route Route::turning_on_spot(double least_turn) const {
  std::vector<RouteCorner> corners = corners_;
  const std::size_t n = corners.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Rounding r = round_corner(corners_[(i + n - 1) % n].position, corners_[i],
                                    corners_[(i + 1) % n].position);
    corners[i].on_spot = std::abs(r.turn) >= least_turn;
  }
  return closed(corners);
}

}  // namespace holdfast::simulation
