// The web explorer: a page that talks to the calls beside it. It is open where the calls need a
// token, since a browser cannot send one with a page; it asks for the token itself (access.cpp).

#include <algorithm>
#include <array>

#include "server/base/ids.h"
#include "server/calls/answers.h"
#include "server/calls/web_files.h"

namespace translucube::server {
namespace {

/// Nothing inline and nothing from elsewhere; pictures are blobs, since an <img> cannot send a
/// token.
constexpr const char* content_security_policy =
    "default-src 'self'; img-src 'self' blob:; base-uri 'none'; form-action 'none'; "
    "frame-ancestors 'none'";

HttpResponse web_response(std::string_view name) {
  const WebFile* file = find_web_file(name);
  if (file == nullptr)
    return problem_response({api::ProblemCode::not_found, "There is nothing at this path.", {}});
  const std::string etag = '"' + content_hash(file->bytes) + '"';
  HttpResponse response{200, {}, std::string(web_content_type(name)), std::string(file->bytes)};
  response.headers = {{"ETag", etag},
                      {"Cache-Control", "no-cache"},
                      {"Content-Security-Policy", content_security_policy},
                      {"Referrer-Policy", "no-referrer"}};
  return response;
}

}  // namespace

const WebFile* find_web_file(std::string_view name) {
  const auto files = web_files();
  const auto found = std::ranges::find(files, name, &WebFile::name);
  return found == files.end() ? nullptr : &*found;
}

std::string_view web_content_type(std::string_view name) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 4> types{
      {{".html", "text/html; charset=utf-8"},
       {".css", "text/css; charset=utf-8"},
       {".js", "text/javascript; charset=utf-8"},
       {".svg", "image/svg+xml"}}};
  for (const auto& [extension, type] : types)
    if (name.ends_with(extension)) return type;
  return "application/octet-stream";
}

HttpResponse get_page(CallContext&, const HttpRequest&, const PathParameters&) {
  return web_response("index.html");
}

HttpResponse get_web_file(CallContext&, const HttpRequest&, const PathParameters& path) {
  return web_response(path.file);
}

}  // namespace translucube::server
