#pragma once

#include <cstddef>

namespace translucube::server {

struct ServerConfig;

/// Raises the process's limit of open files to the most it may have. What it is then.
std::size_t raise_descriptor_limit();

/// Lowers what holds descriptors, connections and open pictures, to what `limit` has room for
/// beside the store, the workers and the requests under way. Throws std::runtime_error where that
/// is too little to serve at all.
void fit_descriptors(ServerConfig& config, std::size_t limit);

}  // namespace translucube::server
