#include "holdfast/io/ros/point_decoder.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <type_traits>

#include "holdfast/io/files/bytes.hpp"

namespace holdfast::io::ros {
namespace {

// Points are decoded in blocks that stay in the first-level cache, field after field: one loop a
// field, specialised for the field's type once a message, instead of a look-up a point.
constexpr std::size_t kBlock = 256;
constexpr std::int32_t kNoTime = std::numeric_limits<std::int32_t>::min();

/// The numbers that turn a raw time into an offset: (raw - base) * scale - rest.
struct TimeOrigin {
  double base = 0;                ///< for floating-point times, in the field's unit
  std::int64_t base_integer = 0;  ///< for integer times
  double scale = 0;               ///< nanoseconds a unit
  double rest = 0;                ///< nanoseconds
};

/// What the loops need beside a field's bytes.
struct Context {
  TimeOrigin time;
  std::ptrdiff_t y_from_x = 0;  ///< bytes
  std::ptrdiff_t z_from_x = 0;
};

/// Whether all three are finite (bit tests are cheaper than comparisons here).
bool is_finite(const ScanPoint& p) {
  constexpr std::uint32_t kExponent = 0x7f800000;
  const auto bits = [](float value) { return std::bit_cast<std::uint32_t>(value) & kExponent; };
  return (bits(p.x) != kExponent) & (bits(p.y) != kExponent) & (bits(p.z) != kExponent);
}

bool is_return(const ScanPoint& p) {
  const auto bits = [](float value) { return std::bit_cast<std::uint32_t>(value); };
  return ((bits(p.x) | bits(p.y) | bits(p.z)) << 1) != 0;  // without the signs
}

// Each put() sets what its field says of a point and returns whether the point is good by it.

struct PutCoordinates {
  template <class T>
  static bool put(const char* from, const Context& context, ScanPoint& to) {
    to.x = static_cast<float>(files::load<T>(from));
    to.y = static_cast<float>(files::load<T>(from + context.y_from_x));
    to.z = static_cast<float>(files::load<T>(from + context.z_from_x));
    return is_finite(to) & is_return(to);
  }
};

struct PutIntensity {
  template <class T>
  static bool put(const char* from, const Context&, ScanPoint& to) {
    to.intensity = static_cast<float>(files::load<T>(from));
    return true;
  }
};

struct PutRing {
  template <class T>
  static bool put(const char* from, const Context&, ScanPoint& to) {
    // find_layout() lets integers through only; a ring is never negative.
    if constexpr (std::is_integral_v<T>) {
      to.ring = static_cast<std::uint16_t>(files::load<std::make_unsigned_t<T>>(from));
    }
    return true;
  }
};

struct PutTime {
  template <class T>
  static bool put(const char* from, const Context& context, ScanPoint& to) {
    const TimeOrigin& origin = context.time;
    const T raw = files::load<T>(from);
    double units = 0;
    if constexpr (std::is_floating_point_v<T>) {
      units = static_cast<double>(raw) - origin.base;
    } else {
      // Unsigned, because a damaged time may be anything.
      units = static_cast<double>(static_cast<std::int64_t>(
          static_cast<std::uint64_t>(raw) - static_cast<std::uint64_t>(origin.base_integer)));
    }
    const double ns = units * origin.scale - origin.rest;
    const bool good = std::abs(ns) <= kMostTimeOffsetNs;
    to.time_offset_ns = good ? static_cast<std::int32_t>(std::lrint(good ? ns : 0.0)) : kNoTime;
    return good;
  }
};

using Loop = std::size_t (*)(const char* from, std::size_t step, std::size_t count,
                             const Context& context, ScanPoint* to);

/// Loads one field of a block and returns how many points are good by it.
template <class Put, class T>
std::size_t load_block(const char* from, std::size_t step, std::size_t count, const Context& shared,
                       ScanPoint* to) {
  const Context context = shared;  // in registers: nothing written below can change it
  std::size_t good = 0;
  for (std::size_t i = 0; i < count; ++i) {
    good += Put::template put<T>(from + i * step, context, to[i]);
  }
  return good;
}

/// One field of the points and the loop that loads it.
struct FieldLoop {
  std::uint32_t offset = 0;
  Loop loop = nullptr;
};

template <class Put>
FieldLoop make_loop(const FieldPlace& field) {
  const Loop loop = files::visit_scalar(
      field.type, [](auto zero) -> Loop { return &load_block<Put, decltype(zero)>; });
  return {field.offset, loop};
}

std::vector<FieldLoop> make_loops(const CloudLayout& layout, bool with_times) {
  std::vector<FieldLoop> loops = {make_loop<PutCoordinates>(layout.x)};
  if (layout.intensity) loops.push_back(make_loop<PutIntensity>(layout.intensity));
  if (layout.ring) loops.push_back(make_loop<PutRing>(layout.ring));
  if (with_times) loops.push_back(make_loop<PutTime>(layout.time));
  return loops;
}

/// So that absolute times of 19 digits lose nothing, whole units are taken away before scaling.
TimeOrigin make_origin(const CloudMessage& message, const CloudLayout& layout,
                       const TimeRule& rule) {
  TimeOrigin origin;
  origin.scale = rule.ns_per_unit;
  if (rule.reference == TimeReference::kEpoch) {
    const auto unit = static_cast<std::int64_t>(rule.ns_per_unit);
    // The double nearest to a large number of ns is a whole number too.
    const std::int64_t whole = message.stamp / unit;
    origin.base = static_cast<double>(whole);
    origin.base_integer = static_cast<std::int64_t>(origin.base);
    origin.rest = static_cast<double>(message.stamp - origin.base_integer * unit);
  }
  if (rule.reference == TimeReference::kOwnClock) {
    const auto sample = sample_times(message, layout);
    origin.base = sample ? sample->min : 0;
    const bool fits = std::abs(origin.base) < 9e18;
    origin.base_integer = fits ? static_cast<std::int64_t>(origin.base) : 0;
  }
  return origin;
}

Context make_context(const CloudMessage& message, const CloudLayout& layout, const TimeRule& rule) {
  const auto from_x = [&layout](const FieldPlace& field) {
    return static_cast<std::ptrdiff_t>(field.offset) - static_cast<std::ptrdiff_t>(layout.x.offset);
  };
  return {make_origin(message, layout, rule), from_x(layout.y), from_x(layout.z)};
}

/// Drops the points of blocks that are not good, counts them, and follows the times of the others.
class BlockFilter {
 public:
  /// Moves the good points to the front and returns their number. `all_good` saves the search.
  std::size_t keep_good(ScanPoint* block, std::size_t count, bool all_good) {
    const std::size_t kept = all_good ? count : drop_bad(block, count);
    for (std::size_t i = 0; i < kept; ++i) {
      first_ = std::min(first_, block[i].time_offset_ns);
      last_ = std::max(last_, block[i].time_offset_ns);
    }
    return kept;
  }

  std::uint32_t invalid() const { return invalid_; }
  std::uint32_t no_returns() const { return no_returns_; }
  /// Least and greatest offset of the good points.
  std::int32_t first() const { return first_; }
  std::int32_t last() const { return last_; }

 private:
  std::size_t drop_bad(ScanPoint* block, std::size_t count) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const ScanPoint p = block[i];
      const bool valid = is_finite(p) & (p.time_offset_ns != kNoTime);
      const bool good = valid & is_return(p);
      invalid_ += !valid;
      no_returns_ += valid & !good;
      block[kept] = p;
      kept += good;
    }
    return kept;
  }

  std::uint32_t invalid_ = 0;
  std::uint32_t no_returns_ = 0;
  std::int32_t first_ = std::numeric_limits<std::int32_t>::max();
  std::int32_t last_ = std::numeric_limits<std::int32_t>::min();
};

// Less than this before its reference, a time is early by the rounding of a float only.
constexpr std::int32_t kRoundingNs = 100;

/// Makes all offsets >= 0 and sets end_time.
void settle_times(const BlockFilter& filter, Scan& scan) {
  if (scan.points.empty()) return;
  const std::int32_t early = std::min(filter.first(), 0);
  const std::int32_t shift = early < -kRoundingNs ? early : 0;
  if (early < 0) {
    for (auto& point : scan.points) {
      point.time_offset_ns = std::max(point.time_offset_ns - shift, 0);
    }
  }
  scan.stamp += shift;
  scan.end_time = scan.stamp + std::max(filter.last() - shift, 0);
}

}  // namespace

DecodedScan decode_cloud(const CloudMessage& message, const CloudLayout& layout,
                         const TimeRule& rule) {
  DecodedScan out;
  Scan& scan = out.scan;
  scan.stamp = message.stamp;
  scan.end_time = message.stamp;
  scan.has_ring = static_cast<bool>(layout.ring);
  scan.has_point_times = rule.reference != TimeReference::kNone;
  const auto loops = make_loops(layout, scan.has_point_times);
  const Context context = make_context(message, layout, rule);
  if (message.points() == 0) return out;
  scan.points.reserve(message.points());
  std::array<ScanPoint, kBlock> block;
  BlockFilter filter;
  for (std::uint32_t row = 0; row < message.height; ++row) {
    const char* begin = message.data.data() + std::size_t{row} * message.row_step;
    for (std::size_t done = 0; done < message.width; done += kBlock) {
      const std::size_t count = std::min<std::size_t>(kBlock, message.width - done);
      const char* from = begin + done * message.point_step;
      bool all_good = true;
      for (const auto& [offset, loop] : loops) {
        all_good &= loop(from + offset, message.point_step, count, context, block.data()) == count;
      }
      const std::size_t kept = filter.keep_good(block.data(), count, all_good);
      scan.points.insert(scan.points.end(), block.begin(),
                         block.begin() + static_cast<std::ptrdiff_t>(kept));
    }
  }
  scan.invalid_points = filter.invalid();
  out.no_returns = filter.no_returns();
  settle_times(filter, scan);
  return out;
}

std::string swap_fields(const CloudMessage& message, const CloudLayout& layout) {
  std::string data(message.data);
  for (const auto* field :
       {&layout.x, &layout.y, &layout.z, &layout.intensity, &layout.ring, &layout.time}) {
    if (!*field) continue;
    const std::size_t size = files::size_of(field->type);
    for (std::uint64_t i = 0; i < message.points(); ++i) {
      const std::size_t at = (i / message.width) * message.row_step +
                             (i % message.width) * message.point_step + field->offset;
      std::reverse(data.begin() + static_cast<std::ptrdiff_t>(at),
                   data.begin() + static_cast<std::ptrdiff_t>(at + size));
    }
  }
  return data;
}

}  // namespace holdfast::io::ros
