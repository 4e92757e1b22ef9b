#include "api/base/faults.h"

#include <utility>

namespace translucube::api {

void Faults::add(std::string pointer, std::string detail) {
  if (++count_ <= most) kept_.push_back({std::move(pointer), std::move(detail)});
}

std::vector<Fault> Faults::list() const {
  std::vector<Fault> all = kept_;
  if (count_ > most) all.push_back({"", "and " + std::to_string(count_ - most) + " more faults"});
  return all;
}

Problem invalid_request(const Faults& faults) {
  const std::string number =
      faults.count() == 1 ? "one fault" : std::to_string(faults.count()) + " faults";
  return {ProblemCode::invalid_request, number + " found", faults.list()};
}

Problem invalid_query(std::vector<Fault> faults) {
  return {ProblemCode::invalid_request, "A query parameter is not valid.", std::move(faults)};
}

std::string pointer_token(std::string_view key) {
  constexpr std::size_t longest = 64;
  const bool cut = key.size() > longest;
  if (cut) {
    std::size_t end = longest;
    const auto continues = [&](std::size_t i) {
      return (static_cast<unsigned char>(key[i]) & 0xC0) == 0x80;
    };
    while (end > 0 && continues(end)) --end;
    key = key.substr(0, end);
  }
  std::string token;
  for (const char c : key) {
    if (c == '~')
      token += "~0";
    else if (c == '/')
      token += "~1";
    else
      token += c;
  }
  return cut ? token + "..." : token;
}

}  // namespace translucube::api
