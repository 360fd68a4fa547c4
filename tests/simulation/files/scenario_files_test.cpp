#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include "holdfast/io/config_io.hpp"
#include "simulation/scenario.hpp"

namespace holdfast::simulation {
namespace {

/// FNV-1a over the bits of what is fed to it.
class Fingerprint {
 public:
  void add(const void* data, std::size_t bytes) {
    const auto* byte = static_cast<const unsigned char*>(data);
    for (std::size_t i = 0; i < bytes; ++i) hash_ = (hash_ ^ byte[i]) * 1099511628211ULL;
  }
  void add(std::string_view text) { add(text.data(), text.size()); }
  void add(double value) {
    value += 0.0;  // -0 is 0
    add(&value, sizeof(value));
  }
  template <class Vector>
  void add_list(const Vector& list) {
    add(list.data(), list.size() * sizeof(list[0]));
  }
  std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = 14695981039346656037ULL;
};

void add_point(const Eigen::Vector3d& point, Fingerprint& print) {
  for (int k = 0; k < 3; ++k) print.add(point[k]);
}

/// Of a way at each decimetre, to the nanometre.
void add_route(const Route& route, Fingerprint& print) {
  for (double s = 0; s < route.length(); s += 0.1) {
    add_point((1e9 * route.at(s).position).array().round(), print);
  }
}

/// Of all that a scenario is made of; its world bit by bit.
std::uint64_t fingerprint_of(const Scenario& scenario) {
  Fingerprint print;
  for (const auto& vertex : scenario.world.vertices) add_point(vertex.cast<double>(), print);
  print.add_list(scenario.world.triangles);
  print.add_list(scenario.world.material_of);
  print.add_list(scenario.world.object_of);
  for (const Material& material : scenario.world.materials) {
    print.add(std::string_view(material.name));
  }
  for (const WorldObject& object : scenario.world.objects) {
    print.add(std::string_view(object.name));
    print.add(object.mounted + 2.0 * object.spare);
  }
  add_route(scenario.route, print);
  DriveStyle style = scenario.style;
  std::vector<io::FieldRef> fields;
  io::collect_fields("drive", style, fields);
  print.add(std::string_view(io::config_reference(fields)));
  for (const WalkerPlan& walker : scenario.walkers) {
    add_route(walker.route, print);
    print.add(walker.speed_m_s);
  }
  return print.value();
}

/// What the scenarios were before they became files.
TEST(ScenarioFiles, HoldTheWorldsThatWereProgramsBefore) {
  const std::array<std::pair<const char*, std::uint64_t>, 5> known = {{
      {"box", 0x01c051de6e4dc499ULL},
      {"corridor", 0x11e79bd864ea926eULL},
      {"warehouse", 0x70282690f0d0f8b1ULL},
      {"yard", 0x93a6642c0c8ad0beULL},
      {"tunnel", 0xa7213798b2b4f29eULL},
  }};
  for (const auto& [name, fingerprint] : known) {
    const auto scenario = make_scenario(name);
    ASSERT_TRUE(scenario) << scenario.error().message;
    EXPECT_EQ(fingerprint_of(*scenario), fingerprint) << name;
  }
}

}  // namespace
}  // namespace holdfast::simulation
