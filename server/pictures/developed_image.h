#pragma once

// Pictures that are developed for whoever asks and not kept: of an explorable render for another
// absorber, and of a render that is still being traced.

#include <optional>
#include <string>

#include "api/base/result.h"
#include "server/pictures/image_artifacts.h"
#include "server/pictures/live_films.h"

namespace translucube::server {

/// Through what absorber the query wants a picture of this request; empty where through its own.
api::Result<std::optional<api::Redeveloped>> redevelopment_of(const std::string& request,
                                                              const ImageQuery& query,
                                                              const api::Catalog& catalog);

/// A finished explorable render through another absorber. Throws ImageError where its film cannot
/// be read, FileError too where that is lost, which the store is told; ColorError.
ImageFile redeveloped_image(Darkroom& darkroom, const StoredResult& result,
                            const api::Redeveloped& redeveloped, const ImageForm& form);

/// What is there of a render, through another absorber where the query asks for one. Empty where
/// nothing is to be seen yet. It carries the request with the samples so far; of an explorable
/// render, whose finished film is kept in half floats, it differs from that by their rounding.
std::optional<api::Result<ImageFile>> partial_image(Darkroom& darkroom, LiveFilm& live,
                                                    const std::string& id,
                                                    const std::string& request,
                                                    const ImageQuery& query);

}  // namespace translucube::server
