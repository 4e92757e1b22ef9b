#include "server/pictures/image_artifacts.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <cstdio>

#include "api/base/faults.h"
#include "server/base/ids.h"
#include "server/pictures/developed_image.h"

namespace translucube::server {
namespace {

using api::Problem;
using api::ProblemCode;
using api::Result;

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

std::string list_of(const auto& items, const auto& name_of) {
  std::string list;
  for (const auto& item : items) list += (list.empty() ? "" : ", ") + std::string(name_of(item));
  return list;
}

}  // namespace

std::string form_name(const ImageForm& form) {
  const std::string look = is_scene_linear(form.format)
                               ? escaped(form.colorspace)
                               : escaped(form.display) + '-' + escaped(form.view);
  return look + std::string(row_of(form.format).extension);
}

Result<ImageForm> image_form(const ImageQuery& query, const std::vector<Display>& displays) {
  std::vector<api::Fault> faults;
  ImageForm form;
  form.format = query.format;
  if (is_scene_linear(query.format)) {
    form.colorspace = query.colorspace.value_or(std::string(colorspaces[0]));
    if (std::ranges::find(colorspaces, form.colorspace) == colorspaces.end())
      faults.push_back(
          {"?colorspace", "must be one of " + list_of(colorspaces, [](auto c) { return c; })});
    for (const char* given : {query.display ? "?display" : "", query.view ? "?view" : ""})
      if (*given) faults.push_back({given, "an EXR is scene-linear: it has no display and view"});
  } else {
    if (query.colorspace) faults.push_back({"?colorspace", "only an EXR is scene-linear"});
    const auto display = query.display ? std::ranges::find(displays, *query.display, &Display::name)
                                       : displays.begin();
    if (display == displays.end()) {
      faults.push_back(
          {"?display", "must be one of " + list_of(displays, [](auto& d) { return d.name; })});
    } else {
      form.display = display->name;
      form.view = query.view.value_or(display->views.front());
      if (std::ranges::find(display->views, form.view) == display->views.end())
        faults.push_back(
            {"?view", "must be one of " + list_of(display->views, [](auto& v) { return v; })});
    }
  }
  if (!faults.empty()) return api::invalid_query(std::move(faults));
  return form;
}

void write_form(const std::filesystem::path& file, Image image, const ImageForm& form,
                const ColorConfig& colors, const std::string& canonical_request) {
  ImageMetadata metadata{canonical_request, form.colorspace};
  if (is_scene_linear(form.format)) {
    if (form.colorspace != colorspaces[0]) colors.apply_colorspace(image, form.colorspace);
  } else {
    colors.apply_display(image, form.display, form.view);
    metadata.colorspace = form.display + '/' + form.view;
  }
  write_image(file, image, form.format, metadata);
}

void write_picture(ArtifactStore& artifacts, const std::string& folder, const std::string& name,
                   const std::function<void(const std::filesystem::path&)>& writer) {
  artifacts.write(folder, name, [&](const std::filesystem::path& temporary) {
    try {
      writer(temporary);
    } catch (const ImageError& error) {
      throw FileError(error.what());
    }
  });
}

void remove_files(ArtifactStore& artifacts, const StoredResult& result) {
  for (const std::string& name : artifacts.names(result.content))
    if (name == result.image || name == explorable_name(result.image) ||
        name.starts_with("derived-"))
      artifacts.remove(result.content, name);
  artifacts.remove_if_empty(result.content);
}

Problem busy_darkroom() {
  return {ProblemCode::overloaded, "Too many pictures are being made.", {}};
}

std::string explorable_name(const std::string& image) { return "explorable-" + image; }

namespace {

/// What a broken disk took can be made again once it is forgotten.
void forget(Darkroom& darkroom, const StoredResult& result) {
  if (darkroom.store.remove_result(result)) remove_files(darkroom.artifacts, result);
}

/// The result, if its picture lies there whole.
std::optional<StoredResult> whole_result(Darkroom& darkroom, const std::string& content) {
  std::optional<StoredResult> result = darkroom.store.find_result(content);
  if (!result) return std::nullopt;
  const auto file = darkroom.artifacts.open(content, result->image);
  if (file && (!result->image_bytes || *result->image_bytes == file->size())) return result;
  spdlog::error("result {}: its picture is not whole", content);
  forget(darkroom, *result);
  return std::nullopt;
}

}  // namespace

Result<ImageFile> image_artifact(Darkroom& darkroom, const std::string& content,
                                 const std::string& request, const ImageQuery& query) {
  JobStore& store = darkroom.store;
  ArtifactStore& artifacts = darkroom.artifacts;
  const auto checked = image_form(query, darkroom.colors.displays());
  if (!checked) return checked.problem();
  const auto& form = *checked;
  const auto redeveloped = redevelopment_of(request, query, darkroom.catalog);
  if (!redeveloped) return redeveloped.problem();
  const Problem gone{ProblemCode::gone,
                     "The picture was removed to make room; the same request makes it again.",
                     {}};
  const std::optional<StoredResult> result = whole_result(darkroom, content);
  if (!result) return gone;
  store.touch_result(content);
  const std::string& original = result->image;
  if (*redeveloped) try {
      const Places::Place turn = darkroom.developing.take();
      if (!turn) return busy_darkroom();
      return redeveloped_image(darkroom, *result, **redeveloped, form);
    } catch (const ImageError& error) {
      spdlog::error("result {}: {}", content, error.what());
      forget(darkroom, *result);
      return gone;
    }
  const bool as_stored = form.format == ImageFormat::exr && form.colorspace == colorspaces[0];
  const std::string artifact = as_stored ? original : "derived-" + form_name(form);
  auto file = artifacts.open(content, artifact);
  if (!file && !as_stored) {
    const Places::Place turn = darkroom.making.take();
    if (!turn) return busy_darkroom();
    file = artifacts.open(content, artifact);  // another request may have made it meanwhile
    if (!file) try {
        Image image = read_image(artifacts.path(content, original));
        write_picture(artifacts, content, artifact, [&](const std::filesystem::path& temporary) {
          write_form(temporary, std::move(image), form, darkroom.colors, request);
        });
        store.resize_result(content, artifacts.bytes(content));
        file = artifacts.open(content, artifact);
      } catch (const ImageError& error) {
        spdlog::error("result {}: {}", content, error.what());
        forget(darkroom, *result);
      }
  }
  if (!file) return gone;
  return ImageFile{file, std::string(mime_type(form.format)),
                   '"' + content_hash(content + artifact + file->version()) + '"'};
}

}  // namespace translucube::server
