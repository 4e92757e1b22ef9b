#pragma once

// The room of the calls: what each route of the service does, from a plain request to a plain
// answer. The routes stand in router.cpp; the calls are declared here by the file that defines
// them. No sockets (server/http) and no work of its own (server/service).

#include <string>

#include "api/request/catalog.h"
#include "picture/color.h"
#include "server/base/places.h"
#include "server/base/server_config.h"
#include "server/http/message.h"
#include "server/service/job_service.h"
#include "server/service/uploads.h"

namespace translucube::server {

/// What the calls work with.
struct CallContext {
  CallContext(JobService& the_service, Uploads& the_uploads, const api::Catalog& the_catalog,
              const ColorConfig& the_colors, const ServerConfig& config)
      : service(the_service),
        uploads(the_uploads),
        catalog(the_catalog),
        colors(the_colors),
        waiting(config.waiting_requests),
        streams(config.event_streams) {}

  JobService& service;
  Uploads& uploads;
  const api::Catalog& catalog;
  const ColorConfig& colors;
  /// Each request that waits and each event stream holds a thread: without a place, a wait is not
  /// honoured and a stream is refused, so that probes and statuses keep answering.
  Places waiting, streams;
};

/// What stands in a path in the places of "{id}", "{point}", "{file}" and "{sha256}".
struct PathParameters {
  std::string id, point, file, sha256;

  /// Where a segment of a pattern goes; nullptr where it stands for itself.
  std::string* place(std::string_view segment) {
    return segment == "{id}"       ? &id
           : segment == "{point}"  ? &point
           : segment == "{file}"   ? &file
           : segment == "{sha256}" ? &sha256
                                   : nullptr;
  }
};

// render_calls.cpp
HttpResponse post_render(CallContext&, const HttpRequest&, const PathParameters&);
HttpResponse list_renders(CallContext&, const HttpRequest&, const PathParameters&);
HttpResponse get_render(CallContext&, const HttpRequest&, const PathParameters&);
HttpResponse cancel_render(CallContext&, const HttpRequest&, const PathParameters&);
HttpResponse delete_render(CallContext&, const HttpRequest&, const PathParameters&);

// sweep_calls.cpp
HttpResponse post_sweep(CallContext&, const HttpRequest&, const PathParameters&);
HttpResponse list_sweeps(CallContext&, const HttpRequest&, const PathParameters&);
HttpResponse get_sweep(CallContext&, const HttpRequest&, const PathParameters&);
HttpResponse cancel_sweep(CallContext&, const HttpRequest&, const PathParameters&);
HttpResponse delete_sweep(CallContext&, const HttpRequest&, const PathParameters&);

// upload_calls.cpp: a body goes to the disk as it comes.
std::optional<HttpResponse> receive_upload(CallContext&, HttpRequest&, const PathParameters&);
HttpResponse put_mesh(CallContext&, const HttpRequest&, const PathParameters&);
HttpResponse put_environment(CallContext&, const HttpRequest&, const PathParameters&);
HttpResponse get_meshes(CallContext&, const HttpRequest&, const PathParameters&);

// image_calls.cpp: negotiated, tagged, whole or in part.
HttpResponse get_image(CallContext&, const HttpRequest&, const PathParameters&);
HttpResponse get_point_image(CallContext&, const HttpRequest&, const PathParameters&);
HttpResponse get_sheet(CallContext&, const HttpRequest&, const PathParameters&);

// event_calls.cpp
HttpResponse get_render_events(CallContext&, const HttpRequest&, const PathParameters&);
HttpResponse get_sweep_events(CallContext&, const HttpRequest&, const PathParameters&);

// listing_calls.cpp: what a request may name and how it is said.
HttpResponse get_absorbers(CallContext&, const HttpRequest&, const PathParameters&);
HttpResponse get_environments(CallContext&, const HttpRequest&, const PathParameters&);
HttpResponse get_objects(CallContext&, const HttpRequest&, const PathParameters&);
HttpResponse get_displays(CallContext&, const HttpRequest&, const PathParameters&);
HttpResponse get_openapi(CallContext&, const HttpRequest&, const PathParameters&);

// probe_calls.cpp
HttpResponse get_livez(CallContext&, const HttpRequest&, const PathParameters&);
HttpResponse get_readyz(CallContext&, const HttpRequest&, const PathParameters&);

// web_calls.cpp
HttpResponse get_page(CallContext&, const HttpRequest&, const PathParameters&);
HttpResponse get_web_file(CallContext&, const HttpRequest&, const PathParameters&);

}  // namespace translucube::server
