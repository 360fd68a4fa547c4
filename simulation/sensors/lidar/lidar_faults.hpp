#pragma once

#include <string>

#include "holdfast/core/fields.hpp"

namespace holdfast::simulation {

/// What a real LiDAR does beside measuring the surface on the axis of each beam. Everything is off
/// by default: then ranges have white noise of one size, and surfaces are lost by their material
/// alone. What the faults need to know of the device (divergence, pulse, reach) stands in
/// LidarModel.
struct LidarFaults {
  /// The standard deviation of a range r, met at the angle theta from the normal:
  ///   sigma^2 = range_sigma^2 + (range_noise_per_m r)^2
  ///             + (incidence_noise r divergence / 4 tan(theta))^2,  sigma <= most_range_sigma_m.
  /// A beam of full angle `divergence` lights a disc; on a surface that is tilted by theta the
  /// ranges over the disc have the standard deviation r divergence / 4 tan(theta), of which this
  /// share becomes noise of the one range that is returned.
  double range_noise_per_m = 0;
  double incidence_noise = 0;
  double most_range_sigma_m = 0.3;
  /// Errors of calibration that a beam keeps for good: of all its ranges, and of its elevation and
  /// azimuth each.
  double beam_offset_sigma_m = 0;
  double beam_angle_sigma_deg = 0;

  bool limited_reach = false;  ///< by the link budget, see LinkBudget
  double dropout_share = 0;    ///< of returns, lost at random
  bool mixed_pixels = false;   ///< beams have an extent, see Footprint
  std::string kept_return = "strongest";
  double ghost_share = 0;      ///< see Mirrors
  double multipath_share = 0;  ///< likewise

  /// What is usual for spinning LiDARs of 16 beams.
  static LidarFaults usual();

  /// True when nothing is on.
  bool none() const;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("range_noise_per_m", self.range_noise_per_m,
          FieldDoc{"noise of a range, for each metre of it; the parts add up as squares", 0, 0.1});
    visit("incidence_noise", self.incidence_noise,
          FieldDoc{"noise of a range on a tilted surface, as a share of the spread of ranges over "
                   "the spot that the beam lights there: range * divergence / 4 * tan(angle from "
                   "the normal)",
                   0, 10});
    visit("most_range_sigma_m", self.most_range_sigma_m,
          FieldDoc{"noise of a range is never more than that", 0, 10});
    visit("beam_offset_sigma_m", self.beam_offset_sigma_m,
          FieldDoc{"of the error of calibration that all ranges of a beam share; drawn once for "
                   "each beam and seed",
                   0, 1});
    visit("beam_angle_sigma_deg", self.beam_angle_sigma_deg,
          FieldDoc{"likewise of its elevation and of its azimuth, each: the points lie where the "
                   "beam should point",
                   0, 5});
    visit("limited_reach", self.limited_reach,
          FieldDoc{"dark, tilted and far surfaces are lost: half of the returns where "
                   "reflectivity * cos(angle) / range^2 is that of a square surface of 10 % at "
                   "`reach_at_10_percent_m`"});
    visit("dropout_share", self.dropout_share, FieldDoc{"of returns, lost at random", 0, 1});
    visit("mixed_pixels", self.mixed_pixels,
          FieldDoc{"a beam that straddles a depth edge returns a range in between, or that of the "
                   "surface it keeps if they are more than `pulse_length_m` apart"});
    FieldDoc kept{"which of several surfaces along a beam is kept"};
    kept.choices = "strongest|last";
    visit("kept_return", self.kept_return, kept);
    visit("ghost_share", self.ghost_share,
          FieldDoc{"of the beams that a mirroring surface (glass, polished stone) throws on; what "
                   "they meet is seen behind the mirror",
                   0, 1});
    visit("multipath_share", self.multipath_share,
          FieldDoc{"of the beams in concave corners, that come back by way of both faces and look "
                   "too long",
                   0, 1});
  }
};

}  // namespace holdfast::simulation
