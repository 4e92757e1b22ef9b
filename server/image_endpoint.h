#pragma once

#include <string>

#include "server/http_message.h"
#include "server/job_service.h"

namespace translucube::server {

/// GET /v1/renders/{id}/image: negotiated, tagged, whole or in part.
HttpResponse image_response(JobService& service, const HttpRequest& request, const std::string& id);

}  // namespace translucube::server
