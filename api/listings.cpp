#include "api/listings.h"

#include <nlohmann/json.hpp>

namespace translucube::api {

using nlohmann::json;

std::string absorbers_json(const Catalog& catalog) {
  json list = json::array();
  for (const auto& [name, absorber] : catalog.absorbers)
    list.push_back({{"name", name},
                    {"description", absorber.description},
                    {"wavelengths_nm", absorber.spectrum.wavelengths_nm},
                    {"values", absorber.spectrum.values}});
  return json{{"absorbers", std::move(list)}}.dump();
}

std::string environments_json(const Catalog& catalog) {
  json list = json::array();
  for (const auto& [name, file] : catalog.environments) list.push_back({{"name", name}});
  return json{{"environments", std::move(list)}}.dump();
}

std::string displays_json(const std::vector<Display>& displays) {
  json list = json::array();
  for (const Display& display : displays)
    list.push_back({{"name", display.name}, {"views", display.views}});
  return json{{"displays", std::move(list)}}.dump();
}

}  // namespace translucube::api
