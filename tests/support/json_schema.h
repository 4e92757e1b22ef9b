#pragma once

// JSON Schema 2020-12, as far as the OpenAPI document uses it. Debian's libraries for C++ know
// older drafts only.

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace translucube::test {

/// What is wrong with the value: "/progress/samples: against type \"integer\"". References are
/// looked up in `document`.
std::vector<std::string> schema_faults(const nlohmann::json& document, const nlohmann::json& schema,
                                       const nlohmann::json& value);

/// Keywords of the schema, and of those inside it, that schema_faults would pass over.
std::vector<std::string> unknown_keywords(const nlohmann::json& schema);

}  // namespace translucube::test
