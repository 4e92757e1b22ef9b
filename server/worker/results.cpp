#include "server/worker/results.h"

#include "picture/image_io.h"
#include "renderer/film/explorable_develop.h"
#include "renderer/film/explorable_file.h"
#include "server/pictures/image_artifacts.h"

namespace translucube::server {
namespace {

std::uint64_t bytes_of(const Workshop& workshop, const std::string& content,
                       const std::string& name) {
  return std::filesystem::file_size(workshop.artifacts.path(content, name));
}

/// What a lane of the film shows. Where the film keeps the path lengths, it is written as well and
/// its bytes are added to the result's.
Image developed(Workshop& workshop, const Hand& hand, std::size_t lane, const std::string& stem,
                StoredResult& result) {
  if (!hand.film().shares) return develop(hand.film(), static_cast<int>(lane));
  const ExplorableBasis& basis = hand.scene.explorable.value();
  const auto film = std::make_shared<const ExplorableFilm>(
      explorable_film(basis.bins, basis.unit_mm, hand.film()));
  const std::string name = write_picture(workshop.artifacts, result.content, explorable_stem(stem),
                                         ".exr", [&](const std::filesystem::path& file) {
                                           write_explorable(file, *film, hand.job.canonical[lane]);
                                         });
  result.bytes += bytes_of(workshop, result.content, name);
  workshop.explorables.keep(name, film);
  return develop_explorable(*film, basis.own, workshop.threads);
}

}  // namespace

std::vector<StoredResult> write_results(Workshop& workshop, const Hand& hand, const Task& task,
                                        const std::string& stats) {
  // A late double of this claim writes the same bytes under the same name, or others under another:
  // it cannot touch a picture that is served.
  const std::string stem = "image-" + task.job_id;
  std::vector<StoredResult> results;
  for (std::size_t lane = 0; lane < hand.job.requests.size(); ++lane) {
    StoredResult result{hand.job.contents[lane], {}, {}, 0, stats};
    const Image picture = developed(workshop, hand, lane, stem, result);
    result.image = write_picture(
        workshop.artifacts, result.content, stem, ".exr", [&](const std::filesystem::path& file) {
          write_image(file, picture, ImageFormat::exr, {hand.job.canonical[lane], "lin_rec709"});
        });
    result.image_bytes = bytes_of(workshop, result.content, result.image);
    result.bytes += *result.image_bytes;
    results.push_back(std::move(result));
  }
  return results;
}

void discard_refused(Workshop& workshop, const std::vector<StoredResult>& results) {
  for (const StoredResult& ours : results) {
    const std::optional<StoredResult> kept = workshop.store.find_result(ours.content);
    if (kept && kept->image == ours.image) continue;
    if (const auto film = explorable_name(workshop.artifacts, ours))
      workshop.artifacts.remove(ours.content, *film);
    workshop.artifacts.remove(ours.content, ours.image);
  }
}

}  // namespace translucube::server
