#pragma once

#include <string>

#include "api/base/problem.h"
#include "server/http/message.h"

namespace translucube::server {

/// The answer that carries a problem, with the headers that its status asks for.
HttpResponse problem_response(const api::Problem& problem);

/// An answer with a text body as bytes for a connection that ends with it.
std::string wire_text(const HttpResponse& response);

}  // namespace translucube::server
