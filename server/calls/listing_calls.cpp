#include "api/answer/listings.h"
#include "api/openapi.h"
#include "server/calls/answers.h"

namespace translucube::server {

HttpResponse get_absorbers(CallContext& context, const HttpRequest&, const PathParameters&) {
  return tagged_json(api::absorbers_json(context.catalog));
}

HttpResponse get_environments(CallContext& context, const HttpRequest&, const PathParameters&) {
  const auto uploads = context.uploads.list(api::UploadKind::environment);
  if (!uploads) return problem_response(uploads.problem());
  return tagged_json(api::environments_json(context.catalog, *uploads));
}

HttpResponse get_objects(CallContext& context, const HttpRequest&, const PathParameters&) {
  return tagged_json(api::objects_json(context.catalog));
}

HttpResponse get_displays(CallContext& context, const HttpRequest&, const PathParameters&) {
  return tagged_json(api::displays_json(context.colors.displays()));
}

HttpResponse get_openapi(CallContext&, const HttpRequest&, const PathParameters&) {
  return tagged_json(std::string(api::openapi_document()));
}

}  // namespace translucube::server
