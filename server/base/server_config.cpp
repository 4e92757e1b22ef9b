#include "server/base/server_config.h"

#include <nlohmann/json.hpp>

#include "api/base/config_file.h"
#include "api/base/text.h"

namespace translucube::server {
namespace {

using nlohmann::json;

/// Names of hosts and origins, which compare without case (RFC 6454, 4; RFC 9110, 4.2.3).
std::vector<std::string> read_names(api::FieldReader& object, const char* key, const char* form,
                                    bool (*right)(const std::string&)) {
  std::vector<std::string> names;
  const json* value = object.find(key);
  if (!value) return names;
  if (!value->is_array()) {
    object.fault(key, std::string("must be an array of ") + form);
    return names;
  }
  for (const json& item : *value) {
    std::string name = item.is_string() ? api::lower_case(item.get<std::string>()) : std::string();
    if (right(name))
      names.push_back(std::move(name));
    else
      object.fault(key, std::string("each must be ") + form);
  }
  return names;
}

bool is_host(const std::string& name) {
  return !name.empty() && name.size() <= 255 &&
         name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789.-:[]_") == name.npos;
}

bool is_origin(const std::string& name) {
  for (const std::string scheme : {"http://", "https://"})
    if (name.starts_with(scheme)) return is_host(name.substr(scheme.size()));
  return false;
}

}  // namespace

ServerConfig read_server_config(api::ConfigFile& file) {
  ServerConfig server;
  server.data_folder = file.resolved("../data");
  const json* section = file.fields().find("server");
  if (section == nullptr) return server;
  api::FieldReader object(*section, "/server", file.faults());
  const auto integer = [&](const char* key, std::uint64_t low, std::uint64_t high, int& out) {
    if (const auto number = object.integer(key, low, high)) out = static_cast<int>(*number);
  };
  if (auto host = object.string("host")) server.host = std::move(*host);
  integer("port", 0, 65535, server.port);
  if (const auto data = object.string("data_folder")) server.data_folder = file.resolved(*data);
  integer("workers", 1, 1024, server.workers);
  integer("threads_per_worker", 0, 1024, server.threads_per_worker);

  if (const json* tokens = object.find("tokens_file"); tokens && !tokens->is_null())
    if (const auto path = object.string("tokens_file")) server.tokens_file = file.resolved(*path);
  server.hosts = read_names(object, "hosts", "host or host:port", is_host);
  server.origins = read_names(object, "origins", "http[s]://host[:port]", is_origin);

  integer("http_threads", 1, 1024, server.http_threads);
  integer("event_streams", 1, 4096, server.event_streams);
  integer("waiting_requests", 1, 4096, server.waiting_requests);
  integer("uploads", 1, 1024, server.uploads);
  integer("transfers", 1, 4096, server.transfers);
  integer("connections", 1, 100'000, server.connections);
  integer("header_timeout_s", 1, 3600, server.header_timeout_s);
  integer("idle_timeout_s", 1, 3600, server.idle_timeout_s);
  integer("transfer_timeout_s", 1, 3600, server.transfer_timeout_s);
  integer("drain_s", 0, 7, server.drain_s);

  if (const auto length = object.integer("queue_length", 1, 10'000'000))
    server.queue_length = *length;
  if (const auto seconds = object.number("interactive_seconds", {0, 1e9}))
    server.interactive_seconds = *seconds;
  if (const auto bytes = object.integer("artifact_bytes", 1 << 20, std::uint64_t{1} << 60))
    server.artifact_bytes = *bytes;
  if (const auto bytes = object.integer("upload_quota_bytes", 1 << 20, std::uint64_t{1} << 60))
    server.upload_quota_bytes = *bytes;
  integer("keep_days", 1, 36'500, server.keep_days);
  if (const auto bytes = object.integer("memory_bytes", 0, std::uint64_t{1} << 60))
    server.memory_bytes = *bytes;
  if (const auto bytes = object.integer("explorable_memory_bytes", 0, std::uint64_t{1} << 60))
    server.explorable_memory_bytes = *bytes;

  if (const auto format = object.string("log_format")) {
    if (*format == "json")
      server.log_format = LogFormat::json;
    else if (*format != "logfmt")
      object.fault("log_format", "must be logfmt or json");
  }
  object.refuse_unknown_keys();
  return server;
}

}  // namespace translucube::server
