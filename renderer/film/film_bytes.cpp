#include "renderer/film/film_bytes.h"

#include <cstring>
#include <stdexcept>
#include <type_traits>

#include "renderer/base/sampler.h"

namespace translucube {
namespace {

// The checkpoint format. One struct, so that writing and reading cannot disagree.
struct Header {
  char magic[8];
  std::int32_t width, height, lanes;
  std::uint32_t pass_index, first_sample, samples;  // of a Film: passes, 0, samples
  std::uint32_t shares;                             // 0 or 1
  TraceCounters counters;
  double cpu_seconds;
  std::uint64_t floats;
  std::uint64_t checksum;  // of the header with checksum 0, and of the floats
};
static_assert(std::is_trivially_copyable_v<Header>);

constexpr char pass_magic[8] = {'T', 'C', 'P', 'A', 'S', 'S', '0', '2'};
constexpr char film_magic[8] = {'T', 'C', 'F', 'I', 'L', 'M', '0', '2'};

std::uint64_t checksum(std::string_view bytes) {
  std::uint64_t h = bytes.size();
  std::size_t i = 0;
  for (; i + 8 <= bytes.size(); i += 8) {
    std::uint64_t word;
    std::memcpy(&word, bytes.data() + i, 8);
    h = hash_combine(h, word);
  }
  std::uint64_t rest = 0;
  if (i < bytes.size()) std::memcpy(&rest, bytes.data() + i, bytes.size() - i);
  return hash_combine(h, rest);
}

/// The checksum of the header with its own field blank, and of the floats.
std::uint64_t checksum(Header header, std::string_view floats) {
  header.checksum = 0;
  const std::string_view head(reinterpret_cast<const char*>(&header), sizeof header);
  return hash_combine(checksum(head), checksum(floats));
}

std::string pack(Header header, std::initializer_list<const std::vector<float>*> parts) {
  std::string bytes(sizeof header, '\0');
  for (const auto* part : parts) {
    header.floats += part->size();
    bytes.append(reinterpret_cast<const char*>(part->data()), part->size() * sizeof(float));
  }
  header.checksum = checksum(header, std::string_view(bytes).substr(sizeof header));
  std::memcpy(bytes.data(), &header, sizeof header);
  return bytes;
}

struct Unpacked {
  Header header;
  std::string_view floats;
};

/// `extra` planes of width x height x 3 lie behind those of the lanes.
Unpacked unpack(std::string_view bytes, const char (&magic)[8], std::uint64_t extra) {
  Header header;
  if (bytes.size() < sizeof header) throw std::runtime_error("the film is cut short");
  std::memcpy(&header, bytes.data(), sizeof header);
  if (std::memcmp(header.magic, magic, sizeof magic) != 0)
    throw std::runtime_error("not a film of this version");
  const std::string_view floats = bytes.substr(sizeof header);
  if (floats.size() % sizeof(float) != 0 || header.floats != floats.size() / sizeof(float))
    throw std::runtime_error("the film is cut short");
  if (checksum(header, floats) != header.checksum)
    throw std::runtime_error("the film's checksum is wrong");
  const auto pixels = std::uint64_t(header.width) * std::uint64_t(header.height);
  if (header.width <= 0 || header.height <= 0 || header.lanes <= 0 || header.shares > 1 ||
      header.floats != 3 * pixels * (std::uint64_t(header.lanes) + extra))
    throw std::runtime_error("the film's size is wrong");
  return {header, floats};
}

std::vector<float> take(std::string_view& floats, std::size_t count) {
  std::vector<float> values(count);
  std::memcpy(values.data(), floats.data(), count * sizeof(float));
  floats.remove_prefix(count * sizeof(float));
  return values;
}

template <class AnyFilm>
Header header_of(const char (&magic)[8], const AnyFilm& film) {
  Header header;
  std::memset(static_cast<void*>(&header), 0,
              sizeof header);  // padding too: it is part of the checksum
  std::memcpy(header.magic, magic, sizeof magic);
  header.width = film.width;
  header.height = film.height;
  header.lanes = film.lanes;
  header.shares = film.shares;
  header.counters = film.counters;
  header.cpu_seconds = film.cpu_seconds;
  return header;
}

}  // namespace

std::string to_bytes(const PassFilm& film) {
  Header header = header_of(pass_magic, film);
  header.pass_index = film.pass.index;
  header.first_sample = film.pass.first_sample;
  header.samples = film.pass.count;
  return pack(header, {&film.sum});
}

std::string to_bytes(const Film& film) {
  Header header = header_of(film_magic, film);
  header.pass_index = film.passes;
  header.samples = film.samples;
  return pack(header, {&film.sum, &film.m2});
}

PassFilm pass_film_from_bytes(std::string_view bytes) {
  auto [header, floats] = unpack(bytes, pass_magic, 0);
  PassFilm film;
  film.width = header.width;
  film.height = header.height;
  film.lanes = header.lanes;
  film.shares = header.shares != 0;
  film.pass = {header.pass_index, header.first_sample, header.samples};
  film.counters = header.counters;
  film.cpu_seconds = header.cpu_seconds;
  film.sum = take(floats, header.floats);
  return film;
}

Film film_from_bytes(std::string_view bytes) {
  auto [header, floats] = unpack(bytes, film_magic, 1);
  Film film(header.width, header.height, header.lanes, header.shares != 0);
  film.passes = header.pass_index;
  film.samples = header.samples;
  film.counters = header.counters;
  film.cpu_seconds = header.cpu_seconds;
  film.sum = take(floats, film.sum.size());
  film.m2 = take(floats, film.m2.size());
  return film;
}

}  // namespace translucube
