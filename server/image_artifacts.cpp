#include "server/image_artifacts.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <cstdio>

#include "renderer/explorable.h"
#include "server/ids.h"

namespace translucube::server {
namespace {

using api::Problem;
using api::ProblemCode;

constexpr std::array<std::string_view, 3> colorspaces{"lin_rec709", "ACEScg", "XYZ"};

/// A client's or a config's name as a part of a file name, one to one.
std::string escaped(std::string_view name) {
  std::string text;
  for (const char c : name) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    std::array<char, 4> code{};
    if (!plain)
      std::snprintf(code.data(), code.size(), "%%%02X",
                    static_cast<unsigned>(static_cast<unsigned char>(c)));
    text += plain ? std::string(1, c) : std::string(code.data());
  }
  return text;
}

std::string derived_name(const ImageForm& form) {
  const std::string format(name(form.format));
  if (form.format == ImageFormat::exr) return "derived-" + escaped(form.colorspace) + ".exr";
  return "derived-" + escaped(form.display) + '-' + escaped(form.view) + '.' + format;
}

std::string list_of(const auto& items, const auto& name_of) {
  std::string list;
  for (const auto& item : items) list += (list.empty() ? "" : ", ") + std::string(name_of(item));
  return list;
}

}  // namespace

std::variant<ImageForm, Problem> image_form(const ImageQuery& query,
                                            const std::vector<Display>& displays) {
  Problem problem{ProblemCode::invalid_request, "A query parameter is not valid.", {}};
  ImageForm form;
  form.format = query.format;
  if (query.format == ImageFormat::exr) {
    form.colorspace = query.colorspace.value_or(std::string(colorspaces[0]));
    if (std::ranges::find(colorspaces, form.colorspace) == colorspaces.end())
      problem.faults.push_back(
          {"?colorspace", "must be one of " + list_of(colorspaces, [](auto c) { return c; })});
    for (const char* given : {query.display ? "?display" : "", query.view ? "?view" : ""})
      if (*given)
        problem.faults.push_back({given, "an EXR is scene-linear: it has no display and view"});
  } else {
    if (query.colorspace) problem.faults.push_back({"?colorspace", "only an EXR is scene-linear"});
    const auto display = query.display ? std::ranges::find(displays, *query.display, &Display::name)
                                       : displays.begin();
    if (display == displays.end()) {
      problem.faults.push_back(
          {"?display", "must be one of " + list_of(displays, [](auto& d) { return d.name; })});
    } else {
      form.display = display->name;
      form.view = query.view.value_or(display->views.front());
      if (std::ranges::find(display->views, form.view) == display->views.end())
        problem.faults.push_back(
            {"?view", "must be one of " + list_of(display->views, [](auto& v) { return v; })});
    }
  }
  if (!problem.faults.empty()) return problem;
  return form;
}

void write_form(const std::filesystem::path& file, Image image, const ImageForm& form,
                const ColorConfig& colors, const std::string& canonical_request) {
  ImageMetadata metadata{canonical_request, form.colorspace};
  if (form.format == ImageFormat::exr) {
    if (form.colorspace != colorspaces[0]) colors.apply_colorspace(image, form.colorspace);
  } else {
    colors.apply_display(image, form.display, form.view);
    metadata.colorspace = form.display + '/' + form.view;
  }
  write_image(file, image, form.format, metadata);
}

std::string explorable_name(const std::string& image) { return "explorable-" + image; }

namespace {

/// Pictures of other absorbers that are kept for a render: whoever explores asks for many.
constexpr std::ptrdiff_t most_redeveloped = 64;
constexpr std::string_view redeveloped_prefix = "derived-redeveloped-";

void make_room(ArtifactStore& artifacts, const std::string& id) {
  const std::vector<std::string> names = artifacts.names(id);
  const auto redeveloped = [](const std::string& name) {
    return name.starts_with(redeveloped_prefix);
  };
  if (std::ranges::count_if(names, redeveloped) < most_redeveloped) return;
  for (const std::string& name : names)
    if (redeveloped(name)) artifacts.remove(id, name);
}

}  // namespace

std::variant<ImageFile, Problem> image_artifact(Darkroom& darkroom, const Job& job,
                                                const ImageQuery& query) {
  auto& [catalog, colors, artifacts, busy] = darkroom;
  const auto checked = image_form(query, colors.displays());
  if (const auto* problem = std::get_if<Problem>(&checked)) return *problem;
  const auto& form = std::get<ImageForm>(checked);
  std::optional<api::Redeveloped> redeveloped;
  if (query.redevelopment.asked()) {
    auto made = api::redevelop(job.request, query.redevelopment, catalog);
    if (auto* problem = std::get_if<Problem>(&made)) return std::move(*problem);
    redeveloped = std::get<api::Redeveloped>(std::move(made));
  }
  const std::string original = job.image.value_or("");
  const bool as_stored =
      !redeveloped && form.format == ImageFormat::exr && form.colorspace == colorspaces[0];
  std::string artifact = as_stored ? original : derived_name(form);
  if (redeveloped)
    artifact =
        std::string(redeveloped_prefix) + content_hash(redeveloped->request) + '-' + artifact;

  auto file = artifacts.open(job.id, artifact);
  if (!file && !as_stored) {
    const std::lock_guard lock(busy);
    file = artifacts.open(job.id, artifact);  // another request may have made it meanwhile
    if (!file) try {
        Image image;
        if (redeveloped) {
          make_room(artifacts, job.id);
          const StoredExplorable stored =
              read_explorable(artifacts.path(job.id, explorable_name(original)));
          image = develop_explorable(stored.film, redeveloped->absorption.absorber,
                                     redeveloped->absorption.sigma_a_peak);
        } else {
          image = read_image(artifacts.path(job.id, original));
        }
        const std::string& request = redeveloped ? redeveloped->request : job.request;
        artifacts.write(job.id, artifact, [&](const std::filesystem::path& temporary) {
          try {
            write_form(temporary, std::move(image), form, colors, request);
          } catch (const ImageError& error) {
            throw FileError(error.what());
          }
        });
        file = artifacts.open(job.id, artifact);
      } catch (const ImageError& error) {
        spdlog::error("render {}: {}", job.id, error.what());
      }
  }
  if (!file) return Problem{ProblemCode::internal, "The image of the render cannot be read.", {}};
  return ImageFile{file, std::string(mime_type(form.format)),
                   '"' + content_hash(job.id + artifact + file->version()) + '"'};
}

}  // namespace translucube::server
