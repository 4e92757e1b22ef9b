#include "server/pictures/sheet_artifact.h"

#include <spdlog/spdlog.h>

#include "server/base/ids.h"
#include "server/pictures/sweep_sheet.h"

namespace translucube::server {
namespace {

using api::Problem;
using api::ProblemCode;
using api::Result;

std::optional<StoredResult> result_of(const Darkroom& darkroom, const api::SweepStatus& sweep,
                                      std::uint32_t point, Look look) {
  const auto picture = darkroom.store.picture_of_point(sweep.id, point);
  if (!picture) return std::nullopt;
  return whole_result(darkroom.store, darkroom.artifacts, picture->content, look);
}

/// What the sheet shows, beside its form: the points that are there, and why others are not.
std::string states_of(const Darkroom& darkroom, const api::SweepStatus& sweep) {
  std::string states;
  for (const api::SweepImageStatus& image : sweep.images) {
    states += name(image.state);
    if (image.state != api::JobState::succeeded) continue;
    for (const std::uint32_t point : image.points)
      states += result_of(darkroom, sweep, point, Look::quick) ? '+' : '-';
  }
  return states;
}

/// A picture that is there and cannot be read is not gone. Throws FileError for it.
void compose(Darkroom& darkroom, const api::SweepStatus& sweep, SweepSheet& sheet) {
  for (const api::SweepImageStatus& image : sweep.images)
    for (const std::uint32_t point : image.points) {
      if (image.state != api::JobState::succeeded) {
        sheet.mark(point, name(image.state));
        continue;
      }
      const auto result = result_of(darkroom, sweep, point, Look::thorough);
      try {
        if (result)
          sheet.place(point, read_image(darkroom.artifacts.path(result->content, result->image)));
        else
          sheet.mark(point, "gone");
      } catch (const ImageError& error) {
        if (result_of(darkroom, sweep, point, Look::quick)) throw FileError(error.what());
        sheet.mark(point, "gone");
      }
    }
}

std::string stem_of(const std::string& states, const ImageForm& form) {
  const std::string name = form_name(form);
  const auto extension = row_of(form.format).extension;
  return "sheet-" + content_hash(states) + '-' + name.substr(0, name.size() - extension.size());
}

/// The name of a new sheet, which takes the place of older ones of its form.
std::string write_sheet(Darkroom& darkroom, const api::SweepStatus& sweep, const ImageForm& form) {
  ArtifactStore& artifacts = darkroom.artifacts;
  const std::string extension(row_of(form.format).extension);
  SweepSheet sheet(sweep.sweep, form, darkroom.colors);
  compose(darkroom, sweep, sheet);
  // Pictures that were found lost meanwhile are shown so.
  const std::string stem = stem_of(states_of(darkroom, sweep), form);
  std::string made = write_picture(artifacts, sweep.id, stem, extension,
                                   [&](const std::filesystem::path& temporary) {
                                     sheet.write(temporary, api::canonical_json(sweep.sweep));
                                   });
  const std::string of_form = stem.substr(stem.find('-', stem.find('-') + 1)) + '.';
  for (const std::string& old : artifacts.names(sweep.id))
    if (old != made && old.find(of_form) != old.npos && old.ends_with(extension))
      artifacts.remove(sweep.id, old);
  return made;
}

}  // namespace

Result<ImageFile> sheet_artifact(Darkroom& darkroom, const api::SweepStatus& sweep,
                                 const ImageQuery& query) {
  const auto checked = image_form(query, darkroom.colors.displays());
  if (!checked) return checked.problem();
  const auto& form = *checked;
  ArtifactStore& artifacts = darkroom.artifacts;

  const Places::Place turn = darkroom.making.take();
  if (!turn) return busy_darkroom();
  std::string name = artifacts
                         .hashed_name(sweep.id, stem_of(states_of(darkroom, sweep), form),
                                      row_of(form.format).extension)
                         .value_or(std::string());
  auto file = name.empty() ? nullptr : artifacts.open_whole(sweep.id, name);
  if (!file) try {
      name = write_sheet(darkroom, sweep, form);
      file = artifacts.open(sweep.id, name);
    } catch (const SheetError&) {
      return Problem{
          ProblemCode::conflict, "The sweep has too many points for a contact sheet.", {}};
    } catch (const TextError& error) {
      spdlog::error("sweep {}: {}", sweep.id, error.what());
      return Problem{ProblemCode::internal, "The service has no font for a contact sheet.", {}};
    }
  if (!file) return Problem{ProblemCode::internal, "The contact sheet cannot be read.", {}};
  return ImageFile{file, std::string(mime_type(form.format)),
                   '"' + content_hash(sweep.id + name) + '"'};
}

}  // namespace translucube::server
