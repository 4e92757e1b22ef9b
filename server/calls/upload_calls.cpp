#include "api/base/text.h"
#include "server/base/received_file.h"
#include "server/calls/answers.h"

namespace translucube::server {
namespace {

using api::Problem;
using api::ProblemCode;
using api::UploadKind;

HttpResponse put(CallContext& context, const HttpRequest& request, const PathParameters& path,
                 UploadKind kind) {
  request.give_way();  // to parse it may take a while
  const auto kept = context.uploads.keep(kind, path.sha256, *request.body_file);
  if (!kept) return problem_response(kept.problem());
  return json_response(kept->created ? 201 : 200, to_json(kept->report));
}

}  // namespace

std::optional<HttpResponse> receive_upload(CallContext& context, HttpRequest& request,
                                           const PathParameters& path) {
  if (!api::is_sha256(path.sha256))
    return problem_response(
        {ProblemCode::invalid_request,
         "The name of an upload is the SHA-256 of its bytes: 64 hexadecimal digits in lower case.",
         {}});
  std::optional<std::uint64_t> length = 0;
  if (request.headers.contains("transfer-encoding")) length.reset();
  if (request.headers.contains("content-length"))
    length = api::number_of<std::uint64_t>(request.header("content-length"));
  auto file = context.uploads.receive(length);
  if (!file) return problem_response(file.problem());
  request.body_file = *std::move(file);
  return std::nullopt;
}

HttpResponse put_mesh(CallContext& context, const HttpRequest& request,
                      const PathParameters& path) {
  return put(context, request, path, UploadKind::mesh);
}

HttpResponse put_environment(CallContext& context, const HttpRequest& request,
                             const PathParameters& path) {
  return put(context, request, path, UploadKind::environment);
}

HttpResponse get_meshes(CallContext& context, const HttpRequest&, const PathParameters&) {
  const auto uploads = context.uploads.list(UploadKind::mesh);
  if (!uploads) return problem_response(uploads.problem());
  return tagged_json(api::meshes_json(*uploads));
}

}  // namespace translucube::server
