#pragma once

#include <string>

namespace holdfast::simulation {

/// What is in the air. Clear by default.
struct Weather {
  double rain_mm_h = 0;
  double visibility_m = 0;  ///< at which a dark thing stands out by 5 % against fog or dust; 0: far

  bool is_clear() const { return rain_mm_h == 0 && visibility_m == 0; }
};

/// What is wrong with it, empty when nothing is.
std::string complaint(const Weather& weather);

/// What rain and dust do to a beam. Both weaken it over the way, and throw it back here and there:
/// echoes of rain and those of dust are Poisson processes along the beam whose densities fall off
/// with range as density * exp(-r / fall_off), because a drop's echo falls off with its square. The
/// first echo before the surface hides it. In thin air its ranges are distributed exponentially.
class Air {
 public:
  explicit Air(const Weather& weather);

  bool is_clear() const { return extinction_ == 0; }
  /// Of light, per metre of way. Rain: 1.076 R^0.67 dB/km (ITU-R P.1814); dust and fog: ln(20) / V,
  /// from the definition of the visibility V.
  double extinction() const { return extinction_; }
  /// Mean number of echoes between two ranges, in metres.
  double echoes(double from_m, double to_m) const;
  /// Range of the first echo from `from_m` on, for `depth` drawn from the exponential distribution
  /// of mean 1; infinite when there is none before `to_m`.
  double first_echo(double from_m, double to_m, double depth) const;

 private:
  double extinction_ = 0;
  double density_ = 0;  ///< echoes a metre at the LiDAR
};

}  // namespace holdfast::simulation
