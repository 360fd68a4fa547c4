#pragma once

#include <type_traits>

#include "holdfast/io/config_io.hpp"

namespace holdfast::io {

template <class T>
constexpr FieldRef::Type field_type() {
  using Type = FieldRef::Type;
  if constexpr (std::is_same_v<T, bool>) return Type::kBool;
  else if constexpr (std::is_same_v<T, int>) return Type::kInt;
  else if constexpr (std::is_same_v<T, double>) return Type::kDouble;
  else if constexpr (std::is_same_v<T, std::string>) return Type::kString;
  else if constexpr (std::is_same_v<T, std::vector<double>>) return Type::kDoubles;
  else {
    static_assert(std::is_same_v<T, SE3>, "not a type that a configuration field may have");
    return Type::kPose;
  }
}

template <class Config>
void collect_fields(const std::string& module, Config& config, std::vector<FieldRef>& out) {
  const auto visit = [&](const char* key, auto& value, const FieldDoc& doc,
                         bool* is_set = nullptr) {
    using T = std::remove_reference_t<decltype(value)>;
    out.push_back({module.empty() ? key : module + "." + key, &value, field_type<T>(), doc, is_set});
  };
  Config::fields(config, visit);
}

}  // namespace holdfast::io
