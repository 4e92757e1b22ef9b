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

std::string write_picture(ArtifactStore& artifacts, const std::string& folder,
                          const std::string& stem, const std::string& extension,
                          const std::function<void(const std::filesystem::path&)>& writer) {
  return artifacts.write_hashed(folder, stem, extension,
                                [&](const std::filesystem::path& temporary) {
                                  try {
                                    writer(temporary);
                                  } catch (const ImageError& error) {
                                    throw FileError(error.what());
                                  }
                                });
}

std::string explorable_stem(const std::string& image_stem) { return "explorable-" + image_stem; }

std::optional<std::string> explorable_name(const ArtifactStore& artifacts,
                                           const StoredResult& result) {
  const auto hash = hash_in(result.image);
  if (!hash) return "explorable-" + result.image;  // of an old store
  return artifacts.hashed_name(
      result.content, explorable_stem(result.image.substr(0, result.image.find('.'))), ".exr");
}

bool is_derived(std::string_view name) {
  return name.starts_with("derived-") || name.starts_with("sheet-");
}

void remove_files(ArtifactStore& artifacts, const StoredResult& result) {
  const auto film = explorable_name(artifacts, result);
  for (const std::string& name : artifacts.names(result.content))
    if (name == result.image || name == film || is_derived(name) || name.starts_with("damaged-"))
      artifacts.remove(result.content, name);
  artifacts.remove_if_empty(result.content);
}

Problem busy_darkroom() {
  return {ProblemCode::overloaded, "Too many pictures are being made.", {}};
}

std::optional<StoredResult> whole_result(JobStore& store, ArtifactStore& artifacts,
                                         const std::string& content, Look look) {
  std::optional<StoredResult> result = store.find_result(content);
  if (!result) return std::nullopt;
  const auto file = look == Look::thorough ? artifacts.open_whole(content, result->image)
                                           : artifacts.open(content, result->image);
  if (file && (!result->image_bytes || *result->image_bytes == file->size())) return result;
  spdlog::error("result {}: its picture is not whole", content);
  store.lose_result(*result);
  return std::nullopt;
}

namespace {

Problem gone() {
  return {ProblemCode::gone,
          "The picture was removed to make room; the same request makes it again.",
          {}};
}

/// The picture in a form that is kept, made if it is not there; a problem where too many are.
Result<std::shared_ptr<const OpenFile>> derived_file(Darkroom& darkroom, const StoredResult& result,
                                                     const ImageForm& form,
                                                     const std::string& request,
                                                     std::string& name) {
  ArtifactStore& artifacts = darkroom.artifacts;
  const std::string& content = result.content;
  const std::string extension(row_of(form.format).extension);
  std::string stem = "derived-" + form_name(form);
  stem.resize(stem.size() - extension.size());
  const auto known = [&]() -> std::shared_ptr<const OpenFile> {
    const auto found = artifacts.hashed_name(content, stem, extension);
    if (!found) return nullptr;
    name = *found;
    return artifacts.open_whole(content, name);
  };
  if (auto file = known()) return file;
  const Places::Place turn = darkroom.making.take();
  if (!turn) return busy_darkroom();
  if (auto file = known()) return file;  // another request has made it meanwhile
  const Image image = read_image(artifacts.path(content, result.image));
  name = write_picture(artifacts, content, stem, extension,
                       [&](const std::filesystem::path& temporary) {
                         write_form(temporary, image, form, darkroom.colors, request);
                       });
  darkroom.store.resize_result(content, artifacts.bytes(content));
  return artifacts.open(content, name);
}

/// Whether the store has still this picture of this content. One that was made of a picture that
/// went meanwhile goes too.
bool is_kept(Darkroom& darkroom, const StoredResult& result) {
  const auto now = darkroom.store.find_result(result.content);
  if (now) return now->image == result.image;
  for (const std::string& name : darkroom.artifacts.names(result.content))
    if (is_derived(name)) darkroom.artifacts.remove(result.content, name);
  darkroom.artifacts.remove_if_empty(result.content);
  return false;
}

}  // namespace

Result<ImageFile> image_artifact(Darkroom& darkroom, const std::string& content,
                                 const std::string& request, const ImageQuery& query) {
  const auto checked = image_form(query, darkroom.colors.displays());
  if (!checked) return checked.problem();
  const auto& form = *checked;
  const auto redeveloped = redevelopment_of(request, query, darkroom.catalog);
  if (!redeveloped) return redeveloped.problem();
  const auto result = whole_result(darkroom.store, darkroom.artifacts, content, Look::thorough);
  if (!result) return gone();
  darkroom.store.touch_result(content);
  const bool as_stored = form.format == ImageFormat::exr && form.colorspace == colorspaces[0];
  std::string name = result->image;
  std::shared_ptr<const OpenFile> file;
  try {
    if (*redeveloped) {
      const Places::Place turn = darkroom.developing.take();
      if (!turn) return busy_darkroom();
      return redeveloped_image(darkroom, *result, **redeveloped, form);
    }
    if (as_stored) {
      file = darkroom.artifacts.open(content, name);
    } else {
      const auto derived = derived_file(darkroom, *result, form, request, name);
      if (!derived) return derived.problem();
      file = *derived;
    }
  } catch (const ImageError& error) {
    // Its bytes are right: what failed is the reading.
    if (is_kept(darkroom, *result)) throw FileError(error.what());
  } catch (const FileError&) {
    if (is_kept(darkroom, *result)) throw;
  }
  if (!is_kept(darkroom, *result) || !file) return gone();
  const std::string version = hash_in(name).value_or(content + name + file->version());
  return ImageFile{file, std::string(mime_type(form.format)), '"' + content_hash(version) + '"'};
}

}  // namespace translucube::server
