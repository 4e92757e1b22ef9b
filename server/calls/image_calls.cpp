#include "api/base/faults.h"
#include "server/calls/answers.h"

namespace translucube::server {
namespace {

using api::Problem;
using api::ProblemCode;
using api::Result;

std::string what_there_is() {
  return "An image can be had as " + list_formats(&ImageFormatRow::mime_type, " or ") +
         " (?format=" + list_formats(&ImageFormatRow::name, ", ") + ").";
}

HttpResponse with_headers_of(const ImageFile& image, HttpResponse response) {
  response.headers.insert(response.headers.end(), {{"ETag", image.etag},
                                                   {"Vary", "Accept"},
                                                   {"Accept-Ranges", "bytes"},
                                                   {"Cache-Control", "no-cache"}});
  return response;
}

HttpResponse body_response(const HttpRequest& request, const ImageFile& image) {
  const std::uint64_t size = image.file->size();
  // A range of another version of the picture would not fit to what the client has (If-Range).
  const std::string_view if_range = request.header("if-range");
  const bool same_version = if_range.empty() || if_range == image.etag;
  const bool may_be_part = request.method == "GET" && same_version;
  const auto range = requested_range(may_be_part ? request.header("range") : "", size);
  const std::string of_size = '/' + std::to_string(size);

  if (std::holds_alternative<UnsatisfiableRange>(range)) {
    HttpResponse response = problem_response(
        {api::ProblemCode::range_not_satisfiable, "The image ends before the range begins.", {}});
    response.headers.emplace_back("Content-Range", "bytes *" + of_size);
    return response;
  }
  if (const auto* part = std::get_if<ByteRange>(&range)) {
    return {206,
            {{"Content-Range", "bytes " + std::to_string(part->first) + '-' +
                                   std::to_string(part->first + part->length - 1) + of_size}},
            image.mime_type,
            FileSlice{image.file, part->first, part->length}};
  }
  return {200, {}, image.mime_type, FileSlice{image.file, 0, size}};
}

/// The format that the query names, else the best of those that the client accepts.
std::optional<ImageFormat> wanted_format(const HttpRequest& request) {
  const auto named = request.parameter("format");
  return named ? format_named(*named) : negotiate_image(request.header("accept"));
}

/// The query of an image, with what the headers ask for.
Result<ImageQuery> image_query(const HttpRequest& request) {
  ImageQuery query;
  query.display = request.parameter("display");
  query.view = request.parameter("view");
  query.colorspace = request.parameter("colorspace");
  const auto partial = flag_query(request, "partial");
  if (!partial) return partial.problem();
  query.partial = *partial;
  query.redevelopment.absorber = request.parameter("absorber");
  if (const auto text = request.parameter("absorption")) {
    query.redevelopment.absorption = api::absorption_number(*text);
    if (!query.redevelopment.absorption)
      return api::invalid_query({{"?absorption", "must be a number in [0, 1]"}});
  }
  const auto format = wanted_format(request);
  if (!format) return Problem{ProblemCode::not_acceptable, what_there_is(), {}};
  query.format = *format;
  return query;
}

template <typename Find>
HttpResponse image_response(const HttpRequest& request, Find&& find) {
  const auto query = image_query(request);
  if (!query) return problem_response(query.problem());
  const auto result = find(*query);
  if (!result) return problem_response(result.problem());
  return with_headers_of(*result, body_response(request, *result));
}

}  // namespace

HttpResponse get_image(CallContext& context, const HttpRequest& request,
                       const PathParameters& path) {
  return image_response(
      request, [&](const ImageQuery& query) { return context.service.image(path.id, query); });
}

HttpResponse get_point_image(CallContext& context, const HttpRequest& request,
                             const PathParameters& path) {
  return image_response(request, [&](const ImageQuery& query) {
    return context.service.point_image(path.id, path.point, query);
  });
}

HttpResponse get_sheet(CallContext& context, const HttpRequest& request,
                       const PathParameters& path) {
  return image_response(
      request, [&](const ImageQuery& query) { return context.service.sheet(path.id, query); });
}

}  // namespace translucube::server
