#include "renderer/film/film.h"

#include <algorithm>
#include <stdexcept>

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

Film::Film(int w, int h, int lane_count, bool are_shares)
    : width(w),
      height(h),
      lanes(lane_count),
      shares(are_shares),
      sum(std::size_t(3) * w * h * lane_count, 0.0f),
      m2(std::size_t(3) * w * h, 0.0f) {}

PictureSums::PictureSums(const std::vector<float>& sum, std::size_t size, bool shares) : sum_(sum) {
  if (shares) {
    added_.assign(size, 0.0f);
    for (std::size_t lane = 0; lane < sum.size(); lane += size)
      for (std::size_t i = 0; i < size; ++i) added_[i] += sum[lane + i];
    sum_ = added_;
  }
  sum_ = sum_.first(size);
}

void merge(Film& film, const PassFilm& pass) {
  if (film.passes == 0) film = Film(pass.width, pass.height, pass.lanes, pass.shares);
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
    const PictureSums old(film), fresh(pass);
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

float to_mean(const Film& film) {
  return film.samples > 0 ? 1.0f / static_cast<float>(film.samples) : 0.0f;
}

Image develop(const Film& film, int lane) {
  Image image(film.width, film.height);
  const float scale = to_mean(film);
  const float* sum = film.sum.data() + image.pixels.size() * static_cast<std::size_t>(lane);
  std::transform(sum, sum + image.pixels.size(), image.pixels.begin(),
                 [=](float s) { return s * scale; });
  return image;
}

Image develop(const Film& film) {
  if (!film.shares) return develop(film, 0);
  Image image(film.width, film.height);
  const PictureSums picture(film);
  const float scale = to_mean(film);
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

}  // namespace translucube
