#pragma once

#include <atomic>

#include "server/http/connection.h"

namespace translucube::server {

/// Whether an answer was sent whole, and the connection can be used again.
enum class Sent { cut, ends, persists };

/// Sends the answer to the connection's exchange, as its method and version ask. `close`: the
/// connection ends after it, because its stream cannot be read on. A stream ends once the service
/// is `stopping`.
Sent write_answer(Connection& connection, HttpResponse answer, bool close,
                  const std::atomic<bool>& stopping);

/// An answer with a text body as bytes for a connection that ends with it.
std::string last_answer(const HttpResponse& answer);

}  // namespace translucube::server
