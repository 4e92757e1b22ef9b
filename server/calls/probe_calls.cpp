#include "server/calls/answers.h"

namespace translucube::server {

HttpResponse get_livez(CallContext&, const HttpRequest&, const PathParameters&) {
  return json_response(200, R"({"status":"alive"})");
}

HttpResponse get_readyz(CallContext& context, const HttpRequest&, const PathParameters&) {
  if (const auto reason = context.service.unready_reason())
    return problem_response({api::ProblemCode::overloaded, *reason, {}});
  return json_response(200, R"({"status":"ready"})");
}

}  // namespace translucube::server
