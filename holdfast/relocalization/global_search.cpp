#include "holdfast/relocalization/global_search.hpp"

#include <fmt/format.h>

#include "holdfast/map/prior_map.hpp"
#include "holdfast/places/places.hpp"

namespace holdfast::relocalization {

struct GlobalSearch::Parts {
  SearchConfig config;
  map::PriorMap map;
  places::Places places;
};

GlobalSearch::GlobalSearch(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
GlobalSearch::GlobalSearch(GlobalSearch&& other) noexcept = default;
GlobalSearch& GlobalSearch::operator=(GlobalSearch&& other) noexcept = default;
GlobalSearch::~GlobalSearch() = default;

Result<GlobalSearch> GlobalSearch::create(const std::filesystem::path& dir,
                                          const SearchConfig& config) {
  auto map = map::PriorMap::open(dir);
  if (!map) return map.error();
  auto places = places::Places::open(dir);
  if (!places) return places.error();
  if (places->all().empty()) {
    return Error{fmt::format("{}: a map without places, which a search needs: import it again",
                             dir.string())};
  }
  return GlobalSearch(
      std::make_unique<Parts>(Parts{config, std::move(*map), std::move(*places)}));
}

SearchReport GlobalSearch::find(const SearchQuery&) {
  SearchReport report;
  report.reason = "the search is not built yet";
  return report;
}

}  // namespace holdfast::relocalization
