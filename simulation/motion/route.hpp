#pragma once

#include <Eigen/Core>
#include <vector>

namespace holdfast::simulation {

/// A corner of a route, rounded by an arc.
struct RouteCorner {
  Eigen::Vector3d position;  ///< on the ground
  double radius_m = 1.0;     ///< of the rounding; shortened where the neighbours are too close
  bool on_spot = false;      ///< no rounding: one stops, turns and goes on
  double ride_m = 0;         ///< a lift takes the robot up by so much here; below 0 down
};

/// A closed way over the ground: straights and arcs, tangent to each other. Heights change linearly
/// along each piece. `s` is the length gone, in metres; any real number, the way goes round.
class Route {
 public:
  /// At least 3 corners; successive ones differ in x or y.
  static Route closed(const std::vector<RouteCorner>& corners);
  /// The same with one radius.
  static Route closed(const std::vector<Eigen::Vector2d>& corners, double radius_m);

  /// A turn on the spot takes as long as so many metres a radian, at the greatest rate of turning,
  /// and standing still before and after it as long as so many metres.
  static constexpr double kSpotMetresPerRadian = 0.1;
  static constexpr double kSpotRest = 0.12;

  struct Place {
    Eigen::Vector3d position;
    double heading = 0;    ///< rad, continuous in s (grows by the loop's turning each round)
    double curvature = 0;  ///< 1/m, positive to the left
    double slope = 0;      ///< rise over length
    bool on_spot = false;  ///< one stands and turns: s goes on, the position does not
  };
  Place at(double s) const;
  double length() const { return length_; }

  /// A place where the way goes on so much higher.
  struct Lift {
    double s;
    double rise_m;
  };
  const std::vector<Lift>& lifts() const { return lifts_; }
  /// Metres by which lifts raise the way from `s` to `to` (that of a lift at `to` included).
  double lifted(double s, double to) const;
  Route reversed() const;
  /// The same corners; at those that turn by `least_turn` (rad) or more, one turns on the spot.
  Route turning_on_spot(double least_turn) const;
  /// Length on reversed() at which it passes the place at `s` the other way.
  double reversed_s(double s) const { return length_ - last_straight_ - s; }

 private:
  struct Piece {
    double s;
    double length;
    Eigen::Vector3d begin;
    double rise;  ///< over the whole piece
    double heading;
    double curvature;
    double spot_turn = 0;  ///< rad, of a piece that turns on the spot
  };
  void append(Piece piece);
  static Place on_spot(const Piece& piece, double along, double turned);

  std::vector<RouteCorner> corners_;
  std::vector<Piece> pieces_;
  std::vector<Lift> lifts_;
  double length_ = 0;
  double last_straight_ = 0;  ///< length from the last corner to the first
  double turning_ = 0;        ///< of one round, rad
};

}  // namespace holdfast::simulation
