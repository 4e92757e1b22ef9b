#pragma once

// The room of the forms of pictures: what is made of a result, or of a film that is still growing,
// for whoever asks. It reads the store, and forgets results there that are not whole; tasks, and
// how light is traced, stay out.

#include <chrono>
#include <compare>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "api/base/result.h"
#include "api/request/catalog.h"
#include "api/request/redevelop.h"
#include "picture/color.h"
#include "picture/image_io.h"
#include "server/base/metrics.h"
#include "server/base/turns.h"
#include "server/pictures/explorable_cache.h"
#include "server/store/artifact_store.h"
#include "server/store/job_store.h"

namespace translucube::server {

/// Which form of a render's image: scene-linear formats are in a colorspace, the others are made
/// for a display and a view.
struct ImageQuery {
  ImageFormat format = ImageFormat::png;
  std::optional<std::string> display, view, colorspace;
  api::Redevelopment redevelopment{};  ///< of an explorable render
  bool partial = false;                ///< also of a render that has not ended

  auto operator<=>(const ImageQuery&) const = default;
};

/// An image query with every default filled in.
struct ImageForm {
  ImageFormat format = ImageFormat::png;
  std::string display, view;  ///< where the format is for a display
  std::string colorspace;     ///< where it is scene-linear
};

/// The form as a file's name: "sRGB-plain.png".
std::string form_name(const ImageForm& form);

/// Checks the query against what there is.
api::Result<ImageForm> image_form(const ImageQuery& query, const std::vector<Display>& displays);

/// Brings scene-linear Rec.709 into the form and writes it. Throws ImageError, ColorError.
void write_form(const std::filesystem::path& file, Image image, const ImageForm& form,
                const ColorConfig& colors, const std::string& canonical_request);

/// Writes a hashed artifact by an image writer, whose ImageError the disk is to blame for; its
/// name. Throws FileError.
std::string write_picture(ArtifactStore& artifacts, const std::string& folder,
                          const std::string& stem, const std::string& extension,
                          const std::function<void(const std::filesystem::path&)>& writer);

struct ImageFile {
  std::shared_ptr<const OpenFile> file;
  std::string mime_type;
  std::string etag;  ///< strong, with its quotes
};

/// The artifact that holds the path lengths of an explorable render, beside its image of this stem.
std::string explorable_stem(const std::string& image_stem);
/// Its name, where the result has one.
std::optional<std::string> explorable_name(const ArtifactStore& artifacts,
                                           const StoredResult& result);

/// True for what is made of a result, or of a sweep, on demand.
bool is_derived(std::string_view name);

/// Removes the files of a result that the store no longer has. A picture that was made anew
/// meanwhile has another name and stays. Throws FileError.
void remove_files(ArtifactStore& artifacts, const StoredResult& result);

/// What makes pictures of other pictures.
struct Darkroom {
  const api::Catalog& catalog;
  const ColorConfig& colors;
  JobStore& store;
  ArtifactStore& artifacts;
  Metrics& metrics;
  ExplorableCache& explorables;
  // Each takes much memory and all of a core, and whoever makes one holds an answering thread: a
  // few stand in line, more are told to come later.
  Turns making{1, 3, std::chrono::seconds(5)};      ///< pictures that are kept
  Turns developing{2, 4, std::chrono::seconds(5)};  ///< pictures that are not
  std::mutex reading{};                             ///< explorable films, from the disk
};

/// What is answered where there is no turn.
api::Problem busy_darkroom();

/// The result, if its picture lies there whole; else the store forgets it, so that it is made again
/// when it is asked for. A thorough look reads its bytes. Throws FileError where that cannot be
/// told, StoreError.
enum class Look { quick, thorough };
std::optional<StoredResult> whole_result(JobStore& store, ArtifactStore& artifacts,
                                         const std::string& content, Look look);

/// A finished picture in the form asked for: made on the first demand, then kept beside the EXR,
/// unless it is of another absorber (developed_image.h).
/// `request`: the picture's, canonical. A problem where it has been removed to make room, or is not
/// whole: then the store forgets it. Throws FileError, StoreError.
api::Result<ImageFile> image_artifact(Darkroom& darkroom, const std::string& content,
                                      const std::string& request, const ImageQuery& query);

}  // namespace translucube::server
