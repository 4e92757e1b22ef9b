// What is read from a client's headers. The first line of the input says which header it is and
// what else belongs to it; the rest is its value.

#include <map>

#include "api/base/text.h"
#include "server/calls/access.h"
#include "server/http/negotiation.h"
#include "server/http/wire.h"
#include "tests/fuzz/requests.h"

using namespace translucube;
using namespace translucube::server;
using fuzz::require;

namespace {

/// As the library's request, with one header for each line "Name: value".
struct Request {
  std::multimap<std::string, std::string> headers;
  std::size_t get_header_value_count(const std::string& name) const { return headers.count(name); }
  std::string get_header_value(const std::string& name) const {
    const auto it = headers.find(name);
    return it == headers.end() ? std::string() : it->second;
  }
};

void check_range(std::string_view value) {
  for (const std::uint64_t size :
       {std::uint64_t(0), std::uint64_t(1), std::uint64_t(1000), std::uint64_t(1) << 40}) {
    const auto range = requested_range(value, size);
    if (const auto* part = std::get_if<ByteRange>(&range))
      require(part->length > 0 && part->first < size && part->length <= size - part->first,
              "a range lies within the body");
  }
}

void check_access(const Request& request) {
  HttpRequest plain{request.get_header_value("Method"), "/v1/renders", {}, {}, {}};
  for (const auto& [name, value] : request.headers) {
    plain.headers.emplace(api::lower_case(name), value);
  }
  AccessPolicy policy{true, {}, {"render.example:8080"}, {"https://page.example"}};
  static_cast<void>(admit(policy, plain));
  policy.tokens.push_back({"somebody", {}});
  require(!admit(policy, plain), "nobody has a token whose hash is zero");
  is_loopback(plain.header("host"));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  Request request;
  for (std::string_view rest = text; !rest.empty();) {
    const std::string_view line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(rest.size(), line.size() + 1));
    const std::size_t colon = line.find(": ");
    if (colon != line.npos) request.headers.emplace(line.substr(0, colon), line.substr(colon + 2));
  }
  check_access(request);
  const BodyAnnouncement announced = announced_body(request);
  if (announced.kind != BodyAnnouncement::Kind::present)
    require(announced.length == 0, "no length without a body");

  for (const auto& [name, value] : request.headers) {
    const auto image = negotiate_image(value);
    require(image.has_value() || !value.empty(), "an empty Accept takes anything");
    is_json(value);
    require(etag_matches(value, "\"some\"") == etag_matches(value, "W/\"some\""), "weakly");
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
