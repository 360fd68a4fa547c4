#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "holdfast/io/files/bytes.hpp"

namespace holdfast::io::files {

/// Number types that point fields have in PCD, PLY and PointCloud2.
enum class ScalarType : std::uint8_t {
  kInt8,
  kUint8,
  kInt16,
  kUint16,
  kInt32,
  kUint32,
  kInt64,
  kUint64,
  kFloat32,
  kFloat64
};

/// Calls `visit(T{})` with a zero of the C++ type that `type` stands for.
template <class Visitor>
decltype(auto) visit_scalar(ScalarType type, const Visitor& visit) {
  switch (type) {
    case ScalarType::kInt8: return visit(std::int8_t{});
    case ScalarType::kUint8: return visit(std::uint8_t{});
    case ScalarType::kInt16: return visit(std::int16_t{});
    case ScalarType::kUint16: return visit(std::uint16_t{});
    case ScalarType::kInt32: return visit(std::int32_t{});
    case ScalarType::kUint32: return visit(std::uint32_t{});
    case ScalarType::kInt64: return visit(std::int64_t{});
    case ScalarType::kUint64: return visit(std::uint64_t{});
    case ScalarType::kFloat32: return visit(float{});
    case ScalarType::kFloat64: break;
  }
  return visit(double{});
}

inline std::size_t size_of(ScalarType type) {
  return visit_scalar(type, [](auto zero) { return sizeof(zero); });
}

inline bool is_floating(ScalarType type) {
  return type == ScalarType::kFloat32 || type == ScalarType::kFloat64;
}

inline double load_as_double(ScalarType type, const char* at) {
  return visit_scalar(type,
                      [at](auto zero) { return static_cast<double>(load<decltype(zero)>(at)); });
}

inline std::string_view name_of(ScalarType type) {
  constexpr std::string_view kNames[] = {"int8",   "uint8", "int16",  "uint16",  "int32",
                                         "uint32", "int64", "uint64", "float32", "float64"};
  return kNames[static_cast<std::size_t>(type)];
}

}  // namespace holdfast::io::files
