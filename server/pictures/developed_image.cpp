#include "server/pictures/developed_image.h"

#include "renderer/film/explorable_develop.h"
#include "renderer/film/explorable_file.h"
#include "server/base/ids.h"

namespace translucube::server {
namespace {

using api::Result;

ImageFile unkept(const Darkroom& darkroom, Image image, const ImageForm& form,
                 const std::string& request, const std::string& identity) {
  auto file = OpenFile::in_memory([&](const std::filesystem::path& path) {
    write_form(path, std::move(image), form, darkroom.colors, request);
  });
  return {std::move(file), std::string(mime_type(form.format)),
          '"' + content_hash(identity + '\n' + request + '\n' + form_name(form)) + '"'};
}

/// Through the absorber asked for, or the film's own.
Image developed(const Film& film, const ExplorableBasis& basis,
                const std::optional<api::Redeveloped>& redeveloped) {
  if (!redeveloped) return develop_shares(basis, film);
  const Absorption& absorption = redeveloped->absorption;
  return develop_shares(basis, film, absorption.absorber, absorption.sigma_a_peak);
}

}  // namespace

Result<std::optional<api::Redeveloped>> redevelopment_of(const std::string& request,
                                                         const ImageQuery& query,
                                                         const api::Catalog& catalog) {
  if (!query.redevelopment.asked()) return std::optional<api::Redeveloped>();
  auto made = api::redevelop(request, query.redevelopment, catalog);
  if (!made) return made.problem();
  return std::optional(*std::move(made));
}

ImageFile redeveloped_image(Darkroom& darkroom, const StoredResult& result,
                            const api::Redeveloped& redeveloped, const ImageForm& form) {
  const std::string name = explorable_name(darkroom.artifacts, result).value_or(std::string());
  const auto film = darkroom.explorables.get(name, [&] {
    // One at a time: each takes much memory.
    const std::lock_guard lock(darkroom.reading);
    if (name.empty() || !darkroom.artifacts.open_whole(result.content, name)) {
      darkroom.store.lose_result(result);
      throw FileError("the film of result " + result.content + " is lost");
    }
    return read_explorable(darkroom.artifacts.path(result.content, name)).film;
  });
  Image image = develop_explorable(*film, redeveloped.absorption.absorber,
                                   redeveloped.absorption.sigma_a_peak);
  darkroom.metrics.count_developed_image();
  return unkept(darkroom, std::move(image), form, redeveloped.request, name);
}

std::optional<Result<ImageFile>> partial_image(Darkroom& darkroom, LiveFilm& live,
                                               const std::string& id, const std::string& request,
                                               const ImageQuery& query) {
  const auto checked = image_form(query, darkroom.colors.displays());
  if (!checked) return checked.problem();
  const auto redeveloped = redevelopment_of(request, query, darkroom.catalog);
  if (!redeveloped) return redeveloped.problem();
  const Places::Place turn = darkroom.developing.take();
  if (!turn) return Result<ImageFile>(busy_darkroom());
  Image image;
  std::uint32_t samples = 0;
  {
    const std::lock_guard lock(live.mutex);
    const Film& film = live.film;
    samples = film.samples;
    if (samples == 0 || film.counters.nan_samples > 0) return std::nullopt;
    image = live.explorable ? developed(film, *live.explorable, *redeveloped) : develop(film, 0);
  }
  const std::string so_far =
      api::with_samples(*redeveloped ? (*redeveloped)->request : request, samples);
  return unkept(darkroom, std::move(image), *checked, so_far, "live " + id);
}

}  // namespace translucube::server
