#pragma once

// The real service in a process of its own.

#include <httplib.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

#include "tests/server/process/process.h"
#include "tests/support/repository.h"

namespace translucube::server::test {

class Service {
 public:
  /// On a free port; returns once it listens.
  explicit Service(const std::filesystem::path& data, const std::string& threads = "2",
                   const std::filesystem::path& config = in_repository("config/service.json"))
      : process_({TRANSLUCUBE_BINARY, "serve", "--port", "0", "--data", data.string(), "--threads",
                  threads, "--config", config.string()}) {
    const std::string line = process_.line(), listening = "listening on http://127.0.0.1:";
    if (!line.starts_with(listening)) throw std::runtime_error("the service did not start");
    port_ = std::stoi(line.substr(listening.size()));
  }

  nlohmann::json get(const std::string& path) const {
    const auto answer = client().Get(path);
    return answer ? nlohmann::json::parse(answer->body) : nlohmann::json();
  }
  httplib::Client client() const {
    httplib::Client client("127.0.0.1", port_);
    client.set_read_timeout(120);
    return client;
  }
  Process& process() { return process_; }
  int port() const { return port_; }

 private:
  Process process_;
  int port_ = 0;
};

}  // namespace translucube::server::test
