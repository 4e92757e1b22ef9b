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
                                      std::uint32_t point) {
  const auto picture = darkroom.store.picture_of_point(sweep.id, point);
  return picture ? darkroom.store.find_result(picture->content) : std::nullopt;
}

/// What the sheet shows, beside its form: the points that are there, and why others are not.
std::string states_of(const Darkroom& darkroom, const api::SweepStatus& sweep) {
  std::string states;
  for (const api::SweepImageStatus& image : sweep.images) {
    states += name(image.state);
    if (image.state != api::JobState::succeeded) continue;
    for (const std::uint32_t point : image.points)
      states += result_of(darkroom, sweep, point) ? '+' : '-';
  }
  return states;
}

void compose(Darkroom& darkroom, const api::SweepStatus& sweep, SweepSheet& sheet) {
  for (std::size_t i = 0; i < sweep.images.size(); ++i) {
    const api::SweepImageStatus& image = sweep.images[i];
    for (const std::uint32_t point : image.points) {
      if (image.state != api::JobState::succeeded) {
        sheet.mark(point, name(image.state));
        continue;
      }
      const auto result = result_of(darkroom, sweep, point);
      try {
        if (result)
          sheet.place(point, read_image(darkroom.artifacts.path(result->content, result->image)));
        else
          sheet.mark(point, "gone");
      } catch (const ImageError& error) {
        spdlog::error("sweep {}: {}", sweep.id, error.what());
        sheet.mark(point, "gone");
      }
    }
  }
}

}  // namespace

Result<ImageFile> sheet_artifact(Darkroom& darkroom, const api::SweepStatus& sweep,
                                 const ImageQuery& query) {
  const auto checked = image_form(query, darkroom.colors.displays());
  if (!checked) return checked.problem();
  const auto& form = *checked;
  const std::string artifact =
      "sheet-" + content_hash(states_of(darkroom, sweep)) + '-' + form_name(form);
  ArtifactStore& artifacts = darkroom.artifacts;

  const Places::Place turn = darkroom.making.take();
  if (!turn) return busy_darkroom();
  auto file = artifacts.open(sweep.id, artifact);
  if (!file) try {
      SweepSheet sheet(sweep.sweep, form, darkroom.colors);
      compose(darkroom, sweep, sheet);
      for (const std::string& old : artifacts.names(sweep.id))
        if (old.ends_with('-' + form_name(form))) artifacts.remove(sweep.id, old);
      write_picture(artifacts, sweep.id, artifact, [&](const std::filesystem::path& temporary) {
        sheet.write(temporary, api::canonical_json(sweep.sweep));
      });
      file = artifacts.open(sweep.id, artifact);
    } catch (const SheetError&) {
      return Problem{
          ProblemCode::conflict, "The sweep has too many points for a contact sheet.", {}};
    } catch (const TextError& error) {
      spdlog::error("sweep {}: {}", sweep.id, error.what());
      return Problem{ProblemCode::internal, "The service has no font for a contact sheet.", {}};
    }
  if (!file) return Problem{ProblemCode::internal, "The contact sheet cannot be read.", {}};
  return ImageFile{file, std::string(mime_type(form.format)),
                   '"' + content_hash(sweep.id + artifact + file->version()) + '"'};
}

}  // namespace translucube::server
