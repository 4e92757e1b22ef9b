#include "renderer/film/explorable_file.h"

#include <charconv>
#include <sstream>

#include "picture/half_image.h"
#include "picture/image_io_rules.h"

namespace translucube {
namespace {

constexpr const char* bins_attribute = "translucube:bins";  ///< "first last nodes"
constexpr const char* unit_attribute = "translucube:unit_mm";
constexpr const char* lengths_attribute = "translucube:lengths_mm";
constexpr const char* scales_attribute = "translucube:scales";

/// Numbers as text, shortest form that reads back to the same value.
template <class... Numbers>
std::string numbers_text(const Numbers&... numbers) {
  std::string text;
  const auto add = [&](auto number) {
    char digits[32];
    const auto end = std::to_chars(digits, digits + sizeof digits, number).ptr;
    text.append(text.empty() ? "" : " ").append(digits, end);
  };
  (add(numbers), ...);
  return text;
}

/// Layers are named so that their order is the alphabet's, which EXR files keep.
std::string channel_name(int bin, int channel) {
  const std::string digits = std::to_string(1000 + bin).substr(1);
  return "bin" + digits + '.' + "RGB"[channel];
}

std::string attribute(const HalfImage& image, const char* name, const std::filesystem::path& file) {
  const auto found = image.attributes.find(name);
  if (found == image.attributes.end())
    throw ImageError(file.string() + ": is not an explorable film (no " + name + ")");
  return found->second;
}

}  // namespace

void write_explorable(const std::filesystem::path& file, const ExplorableFilm& film,
                      const std::string& canonical_request) {
  HalfImage image;
  image.width = film.width;
  image.height = film.height;
  std::string lengths, scales;
  for (int bin = 0; bin < film.bins.count(); ++bin) {
    for (int c = 0; c < 3; ++c) image.channels.push_back(channel_name(bin, c));
    const double length = bin == 1 ? 0 : film.bins.length(bin) * film.unit_mm;
    lengths += (bin > 0 ? " " : "") + numbers_text(length);
    scales += (bin > 0 ? " " : "") + numbers_text(film.scales[bin]);
  }
  image.attributes = {
      {bins_attribute, numbers_text(film.bins.first, film.bins.last, film.bins.nodes)},
      {unit_attribute, numbers_text(film.unit_mm)},
      {lengths_attribute, lengths},
      {scales_attribute, scales},
      {request_attribute, canonical_request}};
  write_half_image(file, image, film.halves);
}

StoredExplorable read_explorable(const std::filesystem::path& file) {
  StoredExplorable stored;
  ExplorableFilm& film = stored.film;
  HalfImage image = read_half_image(file, film.halves);
  film.width = image.width;
  film.height = image.height;
  std::istringstream bins(attribute(image, bins_attribute, file)),
      unit(attribute(image, unit_attribute, file)),
      scales(attribute(image, scales_attribute, file));
  bins >> film.bins.first >> film.bins.last >> film.bins.nodes;
  unit >> film.unit_mm;
  for (float scale; scales >> scale;) film.scales.push_back(scale);
  stored.request = attribute(image, request_attribute, file);
  const bool sound = bins && unit && film.bins.first > 0 && film.bins.last > film.bins.first &&
                     film.bins.nodes >= 4 && film.bins.nodes < 900 && film.unit_mm > 0 &&
                     std::ssize(film.scales) == film.bins.count() &&
                     std::ssize(image.channels) == std::ptrdiff_t{3} * film.bins.count();
  bool named = sound;
  for (int i = 0; named && i < std::ssize(image.channels); ++i)
    named = image.channels[i] == channel_name(i / 3, i % 3);
  if (!named) throw ImageError(file.string() + ": is not a whole explorable film");
  return stored;
}

}  // namespace translucube
