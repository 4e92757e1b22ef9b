#include "server/base/descriptors.h"

#include <spdlog/spdlog.h>
#include <sys/resource.h>

#include <algorithm>
#include <stdexcept>
#include <string>

#include "server/base/server_config.h"

namespace translucube::server {
namespace {

// The store with its journal, the log, libraries and what is open for a moment.
constexpr std::size_t for_the_process = 48;
constexpr std::size_t for_each_worker = 4;   // checkpoints and films
constexpr std::size_t for_each_request = 1;  // the file that is sent or made
constexpr std::size_t for_each_upload = 4;   // the file, and what has it read
constexpr std::size_t fewest_connections = 8;

}  // namespace

std::size_t raise_descriptor_limit() {
  rlimit limit{};
  ::getrlimit(RLIMIT_NOFILE, &limit);
  limit.rlim_cur = limit.rlim_max;
  ::setrlimit(RLIMIT_NOFILE, &limit);
  ::getrlimit(RLIMIT_NOFILE, &limit);
  return static_cast<std::size_t>(std::min<rlim_t>(limit.rlim_cur, 1 << 30));
}

void fit_descriptors(ServerConfig& config, std::size_t limit) {
  const auto wanted = static_cast<std::size_t>(config.connections);
  const std::size_t others =
      for_the_process + for_each_worker * static_cast<std::size_t>(config.workers) +
      for_each_upload * static_cast<std::size_t>(config.uploads) +
      for_each_request * static_cast<std::size_t>(config.http_threads + config.transfers);
  const std::size_t left = limit > others ? limit - others : 0;
  // Of what is left, connections come before files that are held open to save a look-up.
  const std::size_t pictures =
      std::min<std::size_t>(static_cast<std::size_t>(config.open_pictures), left / 4);
  const std::size_t connections = std::min(wanted, left - pictures);
  if (connections < std::min(wanted, fewest_connections))
    throw std::runtime_error("the limit of open files (ulimit -n) is " + std::to_string(limit) +
                             ": too few to serve; " + std::to_string(others + wanted + 256) +
                             " are enough");
  if (connections < wanted)
    spdlog::warn("the limit of open files (ulimit -n) is {}: {} connections instead of {}", limit,
                 connections, wanted);
  config.connections = static_cast<int>(connections);
  config.open_pictures = static_cast<int>(std::max<std::size_t>(pictures, 1));
}

}  // namespace translucube::server
