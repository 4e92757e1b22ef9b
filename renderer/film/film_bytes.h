#pragma once

// Films as bytes, for checkpoints.

#include <string>
#include <string_view>

#include "renderer/film/film.h"

namespace translucube {

/// Binary form for checkpoints: header, counters, floats, checksum; same machine only.
/// The parsers throw std::runtime_error for anything short, foreign or corrupt.
std::string to_bytes(const PassFilm& film);
std::string to_bytes(const Film& film);
PassFilm pass_film_from_bytes(std::string_view bytes);
Film film_from_bytes(std::string_view bytes);

}  // namespace translucube
