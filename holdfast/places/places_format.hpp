#pragma once

#include <cstdint>
#include <string_view>

#include "holdfast/places/place.hpp"

/// Layout of places.bin: PlacesHeader, then `count` records of Place. All values little endian.
namespace holdfast::places {

constexpr std::uint32_t kPlacesMagic = 0x4c504648;  // "HFPL"
constexpr std::uint32_t kPlacesVersion = 1;

struct PlacesHeader {
  std::uint32_t magic = kPlacesMagic;
  std::uint32_t version = kPlacesVersion;
  std::uint32_t count = 0;
  std::uint32_t record_bytes = sizeof(Place);
};

}  // namespace holdfast::places
