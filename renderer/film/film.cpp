#include "renderer/film/film.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <span>
#include <stdexcept>
#include <type_traits>

#include "renderer/base/sampler.h"

namespace translucube {

TraceCounters& TraceCounters::operator+=(const TraceCounters& other) {
  camera_samples += other.camera_samples;
  flights += other.flights;
  boundary_events += other.boundary_events;
  light_samples += other.light_samples;
  nan_samples += other.nan_samples;
  truncated_energy += other.truncated_energy;
  return *this;
}

namespace {

/// The sums of the picture that errors refer to.
class Picture {
 public:
  template <class AnyFilm>
  explicit Picture(const AnyFilm& film) : sum_(film.sum) {
    const auto size = std::size_t(3) * film.width * film.height;
    if (film.shares) {
      shared_.assign(size, 0.0f);
      for (std::size_t lane = 0; lane < film.sum.size(); lane += size)
        for (std::size_t i = 0; i < size; ++i) shared_[i] += film.sum[lane + i];
      sum_ = shared_;
    }
    sum_ = sum_.first(size);
  }
  Picture(const Picture&) = delete;
  Picture& operator=(const Picture&) = delete;
  float operator[](std::size_t i) const { return sum_[i]; }

 private:
  std::vector<float> shared_;
  std::span<const float> sum_;
};

}  // namespace

Film::Film(int w, int h, int lane_count, bool are_shares)
    : width(w),
      height(h),
      lanes(lane_count),
      shares(are_shares),
      sum(std::size_t(3) * w * h * lane_count, 0.0f),
      m2(std::size_t(3) * w * h, 0.0f) {}

void merge(Film& film, const PassFilm& pass) {
  if (pass.width != film.width || pass.height != film.height || pass.lanes != film.lanes ||
      pass.shares != film.shares)
    throw std::invalid_argument("films of different shape cannot be merged");
  if (pass.pass.index != film.passes || pass.pass.first_sample != film.samples)
    throw std::invalid_argument("passes must be merged in order");
  const double before = film.samples, added = pass.pass.count;
  if (before > 0) {
    const auto factor = static_cast<float>(before * added / (before + added));
    const auto inverse_before = static_cast<float>(1 / before),
               inverse_added = static_cast<float>(1 / added);
    const Picture old(film), fresh(pass);
    for (std::size_t i = 0; i < film.m2.size(); ++i) {
      const float delta = fresh[i] * inverse_added - old[i] * inverse_before;
      film.m2[i] += delta * delta * factor;
    }
  }
  for (std::size_t i = 0; i < film.sum.size(); ++i) film.sum[i] += pass.sum[i];
  film.samples += pass.pass.count;
  film.passes += 1;
  film.counters += pass.counters;
  film.cpu_seconds += pass.cpu_seconds;
}

Image develop(const Film& film, int lane) {
  Image image(film.width, film.height);
  const float scale = film.samples > 0 ? 1.0f / static_cast<float>(film.samples) : 0.0f;
  const float* sum = film.sum.data() + image.pixels.size() * static_cast<std::size_t>(lane);
  std::transform(sum, sum + image.pixels.size(), image.pixels.begin(),
                 [=](float s) { return s * scale; });
  return image;
}

Image develop(const Film& film) {
  if (!film.shares) return develop(film, 0);
  Image image(film.width, film.height);
  const Picture picture(film);
  const float scale = film.samples > 0 ? 1.0f / static_cast<float>(film.samples) : 0.0f;
  for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = picture[i] * scale;
  return image;
}

Image variance(const Film& film) {
  // With n_k samples in pass k and variance v / n_k of its mean, E[m2] = (K - 1) v and Var(mean) =
  // v / N.
  if (film.passes < 2) throw std::invalid_argument("the variance needs two passes");
  Image image(film.width, film.height);
  const float scale =
      1.0f / (static_cast<float>(film.passes - 1) * static_cast<float>(film.samples));
  std::ranges::transform(film.m2, image.pixels.begin(), [=](float m2) { return m2 * scale; });
  return image;
}

namespace {

/// Row by row, the picture with less noise: the mean over the 5 x 5 pixels about a pixel (fewer at
/// the edges), and of its own deviation from that as much as the noise there does not explain (Lee
/// 1980, "Digital Image Enhancement and Noise Filtering by Use of Local Statistics").
class Denoised {
 public:
  /// Per sample: `to_mean` times the sums is the picture, `to_variance` times m2 its noise.
  Denoised(const Film& film, const Picture& picture, double to_mean, double to_variance)
      : film_(film),
        picture_(picture),
        to_mean_(static_cast<float>(to_mean)),
        to_variance_(static_cast<float>(to_variance)),
        columns_(std::size_t(3) * film.width) {}

  /// Of the values of this row.
  void row(int y, std::vector<float>& values) {
    const std::size_t line = columns_.size();
    const int first = std::max(0, y - reach), last = std::min(film_.height - 1, y + reach);
    std::ranges::fill(columns_, Moments{});
    for (int v = first; v <= last; ++v)
      for (std::size_t i = 0; i < line; ++i) columns_[i] += moments(v * line + i);
    for (int x = 0; x < film_.width; ++x) {
      const int left = std::max(0, x - reach), right = std::min(film_.width - 1, x + reach);
      const float share = 1 / static_cast<float>((last - first + 1) * (right - left + 1));
      for (int c = 0; c < 3; ++c) {
        Moments all;
        for (int u = left; u <= right; ++u) all += columns_[3 * u + c];
        const float mean = all.mean * share;
        const float spread = all.square * share - mean * mean, noise = all.noise * share;
        const float own = spread > 0 ? std::max(0.0f, 1 - noise / spread) : 0;
        values[3 * x + c] = mean + own * (picture_[y * line + 3 * x + c] * to_mean_ - mean);
      }
    }
  }

 private:
  static constexpr int reach = 2;

  struct Moments {
    float mean = 0, square = 0, noise = 0;
    Moments& operator+=(const Moments& other) {
      mean += other.mean;
      square += other.square;
      noise += other.noise;
      return *this;
    }
  };
  Moments moments(std::size_t i) const {
    const float value = picture_[i] * to_mean_;
    return {value, value * value, film_.m2[i] * to_variance_};
  }

  const Film& film_;
  const Picture& picture_;
  float to_mean_, to_variance_;
  std::vector<Moments> columns_;
};

}  // namespace

double relative_error(const Film& film) {
  if (film.passes < 2) return std::numeric_limits<double>::quiet_NaN();
  const double to_mean = 1.0 / film.samples;
  const double to_variance = 1.0 / (double(film.passes - 1) * film.samples);
  const Picture picture(film);
  // A pixel that met rare bright light has too large a mean and too large a spread: relative to its
  // own mean it would not tell.
  Denoised denoised(film, picture, to_mean, to_variance);
  std::vector<float> reference(std::size_t(3) * film.width);
  std::vector<float> error(film.m2.size() / 3, 0.0f);
  for (int y = 0; y < film.height; ++y) {
    denoised.row(y, reference);
    const std::size_t first = reference.size() * y;
    for (std::size_t i = 0; i < reference.size(); ++i) {
      const double variance = film.m2[first + i] * to_variance;
      error[(first + i) / 3] +=
          static_cast<float>(variance / (reference[i] * reference[i] + 0.01) / 3);
    }
  }
  const std::size_t kept = error.size() - error.size() / 1000;
  std::ranges::nth_element(error, error.begin() + static_cast<std::ptrdiff_t>(kept - 1));
  double sum = 0;
  for (std::size_t i = 0; i < kept; ++i) sum += error[i];
  return std::sqrt(sum / static_cast<double>(kept));
}

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

/// Of the header with its own field blank, and of the floats.
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
  return header;
}

}  // namespace

std::string to_bytes(const PassFilm& film) {
  Header header = header_of(pass_magic, film);
  header.pass_index = film.pass.index;
  header.first_sample = film.pass.first_sample;
  header.samples = film.pass.count;
  header.counters = film.counters;
  header.cpu_seconds = film.cpu_seconds;
  return pack(header, {&film.sum});
}

std::string to_bytes(const Film& film) {
  Header header = header_of(film_magic, film);
  header.pass_index = film.passes;
  header.samples = film.samples;
  header.counters = film.counters;
  header.cpu_seconds = film.cpu_seconds;
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
