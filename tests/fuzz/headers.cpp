// What is read from a client's headers. The first line of the input says which header it is and
// what else belongs to it; the rest is its value.

#include <map>

#include "api/base/text.h"
#include "server/calls/access.h"
#include "server/http/negotiation.h"
#include "tests/fuzz/requests.h"

using namespace translucube;
using namespace translucube::server;
using fuzz::require;

namespace {

/// One for each line "Name: value".
using Headers = std::multimap<std::string, std::string>;

void check_range(std::string_view value) {
  for (const std::uint64_t size :
       {std::uint64_t(0), std::uint64_t(1), std::uint64_t(1000), std::uint64_t(1) << 40}) {
    const auto range = requested_range(value, size);
    if (const auto* part = std::get_if<ByteRange>(&range))
      require(part->length > 0 && part->first < size && part->length <= size - part->first,
              "a range lies within the body");
  }
}

void check_access(const Headers& headers) {
  const auto method = headers.find("Method");
  HttpRequest plain{method == headers.end() ? "" : method->second, "/v1/renders", {}, {}, {}};
  for (const auto& [name, value] : headers) plain.headers.emplace(api::lower_case(name), value);
  AccessPolicy policy{true, {}, {"render.example:8080"}, {"https://page.example"}};
  static_cast<void>(admit(policy, plain));
  policy.tokens.push_back({"somebody", {}});
  require(!admit(policy, plain), "nobody has a token whose hash is zero");
  is_loopback(plain.header("host"));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  Headers headers;
  for (std::string_view rest = text; !rest.empty();) {
    const std::string_view line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(rest.size(), line.size() + 1));
    const std::size_t colon = line.find(": ");
    if (colon != line.npos) headers.emplace(line.substr(0, colon), line.substr(colon + 2));
  }
  check_access(headers);
  for (const auto& [name, value] : headers) {
    const auto image = negotiate_image(value);
    require(image.has_value() || !value.empty(), "an empty Accept takes anything");
    is_json(value);
    require(etag_matches(value, "\"some\"") == etag_matches(value, "W/\"some\""), "weakly");
    require(etag_matches(value, "\"some\"") || !etag_matches_strongly(value, "\"some\""),
            "what matches strongly matches weakly");
    const std::optional<int> wait = preferred_wait(value);
    require(!wait || *wait >= 0, "nobody waits for less than nothing");
    check_range(value);
    require(!is_idempotency_key(value) || (value.size() <= 255 && printable(value).size() <= 200),
            "a key is short");
    last_event_id(value);
    require(printable(value).find('\n') == std::string::npos, "one line of a log");
  }
  return 0;
}
